"""Sawn bodies: boxes, plane-parallel plates, wedges. Their labels name the sides of the cut's own frame."""

from __future__ import annotations

from math import cos, hypot, isfinite, pi, radians, tan

from crystal_core.errors import InputError
from crystal_core.geometry.facets import Facet, check_between, check_sizes, compass, cut_stone, upright
from crystal_core.geometry.habit import check_size
from crystal_core.geometry.solid import Solid

__all__ = ["RIM_FACES", "box", "plate", "wedge", "wedge_thickness"]

RIM_FACES = 64
"""Flat faces around a round plate: its rim departs from a circle by 0.12 % of the radius."""


def box(size_mm: tuple[float, float, float], *, pointer: str = "") -> Solid:
    """Return a rectangular block, its edges along x, y, z, its centre at the origin.

    Parameters
    ----------
    size_mm : tuple of float
        Along x, y, z.
    pointer : str
        Where the box stands in the input, for errors.

    Returns
    -------
    Solid
        Faces +x, -x, +y, -y, +z, -z.

    Raises
    ------
    InputError
        At ``/size_mm/0`` to ``/size_mm/2``: not a length.
    """
    check_sizes(size_mm, f"{pointer}/size_mm")
    return cut_stone(_sides(("+x", "-x", "+y", "-y", "+z", "-z"), size_mm), (0.0, 0.0, 0.0), pointer=pointer)


def plate(size_mm: float | tuple[float, float], thickness_mm: float, *, pointer: str = "") -> Solid:
    """Return a plane-parallel plate, its faces horizontal, its centre at the origin.

    Parameters
    ----------
    size_mm : float or tuple of float
        Diameter of a round plate, or lengths along x and y of a rectangular one.
    thickness_mm : float
        Along z.
    pointer : str
        Where the plate stands in the input, for errors.

    Returns
    -------
    Solid
        Faces upper, lower and the rim: +x, -x, +y, -y, or `RIM_FACES` of a round one, whose corners lie on the circle.

    Raises
    ------
    InputError
        At ``/size_mm`` or ``/thickness_mm``: not a length.
    """
    check_size(thickness_mm, f"{pointer}/thickness_mm")
    if isinstance(size_mm, tuple):
        check_sizes(size_mm, f"{pointer}/size_mm")
        labels = ("rim +x", "rim -x", "rim +y", "rim -y", "upper", "lower")
        return cut_stone(_sides(labels, (*size_mm, thickness_mm)), (0.0, 0.0, 0.0), pointer=pointer)
    check_size(size_mm, f"{pointer}/size_mm")
    radius = 0.5 * size_mm * cos(pi / RIM_FACES)
    facets = [
        Facet("upper", (0.0, 0.0, 1.0), 0.5 * thickness_mm),
        Facet("lower", (0.0, 0.0, -1.0), 0.5 * thickness_mm),
    ]
    facets += [
        upright(f"rim {number + 1}", compass(2 * number + 1, 2 * RIM_FACES), radius) for number in range(RIM_FACES)
    ]
    return cut_stone(facets, (0.0, 0.0, 0.0), pointer=pointer)


def wedge(size_mm: tuple[float, float], thickness_mm: tuple[float, float], *, pointer: str = "") -> Solid:
    """Return a wedge on a horizontal lower face, its centre of mass at the origin.

    Parameters
    ----------
    size_mm : tuple of float
        Lengths along x and y.
    thickness_mm : tuple of float
        At the ends −x and +x; the first may be 0: an edge.
    pointer : str
        Where the wedge stands in the input, for errors.

    Returns
    -------
    Solid
        Faces lower, upper, thick end, thin end (unless it is an edge), side +y, side -y.

    Raises
    ------
    InputError
        At ``/size_mm``: not a length. At ``/thickness_mm``: not two thicknesses of which the second is greater.
    """
    check_sizes(size_mm, f"{pointer}/size_mm")
    thin, thick = thickness_mm
    if not (isfinite(thin) and isfinite(thick) and 0.0 <= thin < thick):
        raise InputError.at(
            f"{pointer}/thickness_mm",
            f"a wedge grows from one thickness to a greater one, not from {thin!r} to {thick!r}",
        )
    length, width = size_mm
    rise = (thick - thin) / length
    scale = hypot(1.0, rise)
    facets = [
        Facet("lower", (0.0, 0.0, -1.0), 0.0),
        Facet("upper", (-rise / scale, 0.0, 1.0 / scale), 0.5 * (thin + thick) / scale),
        Facet("thick end", (1.0, 0.0, 0.0), 0.5 * length),
    ]
    if thin > 0.0:
        facets.append(Facet("thin end", (-1.0, 0.0, 0.0), 0.5 * length))
    facets += [Facet("side +y", (0.0, 1.0, 0.0), 0.5 * width), Facet("side -y", (0.0, -1.0, 0.0), 0.5 * width)]
    return cut_stone(facets, (0.0, 0.0, 0.25 * (thin + thick)), pointer=pointer)


def wedge_thickness(
    length_mm: float, angle_deg: float, thin_mm: float = 0.0, *, pointer: str = ""
) -> tuple[float, float]:
    """Return the two thicknesses of a wedge of an angle, mm: what `wedge` takes.

    Raises
    ------
    InputError
        At ``/angle_deg``: not between 0 and 90.
    """
    check_between(angle_deg, 0.0, 90.0, "degrees", f"{pointer}/angle_deg")
    return thin_mm, thin_mm + length_mm * tan(radians(angle_deg))


def _sides(labels: tuple[str, ...], size_mm: tuple[float, float, float]) -> list[Facet]:
    x, y, z = (0.5 * size for size in size_mm)
    normals = ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0))
    return [
        Facet(label, normal, offset) for label, normal, offset in zip(labels, normals, (x, x, y, y, z, z), strict=True)
    ]
