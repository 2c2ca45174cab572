"""Lists of wavelengths as one writes them: 400,500,600 or 400:700:10."""

from __future__ import annotations

from decimal import Decimal, InvalidOperation

__all__ = ["LONGEST_NM", "MAX_WAVELENGTHS", "SHORTEST_NM", "read_wavelengths"]

MAX_WAVELENGTHS = 2000
"""Most wavelengths of one question."""

SHORTEST_NM, LONGEST_NM = 10, 100_000


def read_wavelengths(text: str) -> tuple[float, ...]:
    """Return the wavelengths that a text lists.

    Parameters
    ----------
    text : str
        Numbers in nm with commas between. ``start:stop:step`` stands for those from start on, to stop itself if a step
        falls on it.

    Returns
    -------
    tuple of float
        In the order of the text; each as exact as decimals are.

    Raises
    ------
    ValueError
        Naming the first part that is no wavelength, or saying that there are more than `MAX_WAVELENGTHS`.
    """
    found: list[Decimal] = []
    for part in text.split(","):
        steps = part.split(":")
        if len(steps) == 1:
            found.append(_wavelength(part))
        elif len(steps) == 3:
            start, stop, step = _wavelength(steps[0]), _wavelength(steps[1]), _number(steps[2])
            if stop < start:
                raise ValueError(f"{part.strip()}: must not fall, from {start} to {stop}")
            if step <= 0:
                raise ValueError(f"{part.strip()}: the step must be above zero")
            step = min(step, Decimal(LONGEST_NM))  # products of it stay numbers
            if step * MAX_WAVELENGTHS <= stop - start:
                raise ValueError(f"{part.strip()}: at most {MAX_WAVELENGTHS} wavelengths are answered at once")
            found += [start + index * step for index in range(int((stop - start) / step) + 1)]
        else:
            raise ValueError(f"{part.strip()}: must be a wavelength in nm or start:stop:step")
        if len(found) > MAX_WAVELENGTHS:
            raise ValueError(f"at most {MAX_WAVELENGTHS} wavelengths are answered at once")
    return tuple(map(float, found))


def _wavelength(text: str) -> Decimal:
    value = _number(text)
    if not SHORTEST_NM <= value <= LONGEST_NM:
        raise ValueError(f"{text.strip()}: must be from {SHORTEST_NM} to {LONGEST_NM} nm")
    return value


def _number(text: str) -> Decimal:
    try:
        value = Decimal(text.strip())
    except InvalidOperation:
        raise ValueError(f"{text.strip()!r} is no number; such as 400,500,600 or 400:700:10 is expected") from None
    if not value.is_finite():
        raise ValueError(f"{text.strip()!r} is no finite number")
    return value
