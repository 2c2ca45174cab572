"""Write docs/minerals-table.md, the page that lists every mineral of the package, with its swatches.

    python tools/make_minerals_table.py [FOLDER]

writes minerals-table.md and pictures/minerals/<id>.svg into docs, or into another folder. Run it after any change of
the data; a test compares the page with what it writes.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from crystal_core.materials import SODIUM_D_NM, axial_dispersion, birefringence, swatches, two_v_deg
from crystal_core.materials.swatches import hexadecimal
from minerals_db import Mineral
from minerals_db.library import builtin_minerals
from minerals_db.orientation import MonoclinicOrientation, OrthorhombicOrientation
from minerals_db.properties import AxialAngle
from minerals_db.quality import colour_quality, dispersion_quality

__all__ = ["page", "pictures", "write"]

DOCS = Path(__file__).resolve().parent.parent / "docs"
PAGE, PICTURES = "minerals-table.md", Path("pictures") / "minerals"

THICKNESS_MM, THIN_MM = 1.0, 0.03
"""Of a small gem, and of a petrographer's thin section, for what is black in a gem."""

BLACK = 0.12
"""The lightness up to which a colour tells nothing."""

CHIP = (56, 24)
"""Size of a chip with its margins, pixels: as high as a line of the page, so that it stands beside its index."""

GREEK = {"alpha": "α", "beta": "β", "gamma": "γ", "n": "", "o": "o", "e": "e"}

SECTIONS = {
    "Isotropic": "One index, no birefringence: black between crossed polarizers in any position.",
    "Uniaxial positive": "Two indices, n<sub>e</sub> > n<sub>o</sub>; the optic axis lies along c.",
    "Uniaxial negative": "Two indices, n<sub>e</sub> < n<sub>o</sub>; the optic axis lies along c.",
    "Biaxial positive": "Three indices; γ halves the acute angle 2V of the two optic axes.",
    "Biaxial negative": "Three indices; α halves the acute angle 2V of the two optic axes.",
    "Glasses": "Isotropic, for prisms and lenses; no crystals.",
}

LEGEND = """\
# The minerals

*Written by `python tools/make_minerals_table.py` from the data; a test holds it to them. [Minerals](minerals.md) says
how an entry is made, and what every field of it means.*

{counts}

{contents}

**How to read it**

- **Indices** are those at the sodium line D, 589.3 nm, and δ is the largest less the smallest. Four decimals come from
  a published curve, three from a handbook's value. Beside each index of a biaxial mineral stands the direction of the
  crystal along which its light vibrates (α, β, γ are X, Y, Z of other books): ∥ c along c, ∧ c +42° at 42° from +c
  towards +a, through the obtuse angle β of the cell ([why that needs saying](minerals.md#orientation)).
- **2V** is the acute angle between the optic axes that follows from the three indices. Below it stands what has been
  measured, if it is known; 2V<sub>α</sub> and 2V<sub>γ</sub> are the angles about α and γ. A † marks what the indices
  do not agree with; the entry says why. **r > v**: the angle is larger in red light than in violet.
- **Colours**: daylight through {thickness:g} mm of the crystal that vibrates along each direction, as a dichroscope
  shows it; where one of them is black, those of a thin section of {thin:g} mm follow. Chips that differ make a
  pleochroic mineral. With a prime (α′, β′, γ′) the directions are those of the absorption, which has a frame of its own
  in some monoclinic and triclinic crystals. A dash: the entry knows of no absorption, and pictures show it colourless,
  whatever it looks like in nature.
- **Data** says how far to trust them, first the dispersion, then the colour:

{trust}

A variety (↳) stands below its mineral and has its optics, unless the entry says otherwise; what makes it a variety is
its colour. All of it, with sources: `isogyre minerals show ID`. The id is the English name in small letters, with
hyphens for blanks, unless it stands in the first column in `type`.
"""

TRUST = (
    ("Word", "What it means", "What you may believe in a picture"),
    (
        "dispersion *published*",
        "each index follows a published curve over the wavelengths",
        "doubling, 2V, interference colours",
    ),
    (
        "dispersion *fallback*",
        "the indices are known at one wavelength; how they change with it is one number for all directions",
        "the doubling, and 2V in yellow light; not how interference colours and 2V change with the wavelength",
    ),
    (
        "colour *measured*",
        "spectra of a sample that the entry names, for every direction",
        "the colour, at any thickness, of that sample",
    ),
    (
        "colour *estimated*",
        "spectra made to look like the mineral, by what is known of its bands and colours",
        "the hue, roughly; no number",
    ),
)
"""What the words for the quality of the data mean, with a head."""


def page(minerals: Mapping[str, Mineral]) -> str:
    """Return the page, Markdown."""
    sections: dict[str, list[Mineral]] = {title: [] for title in SECTIONS}
    for mineral in minerals.values():
        sections[_section(mineral)].append(mineral)
    links = " · ".join(
        f"[{title}](#{title.lower().replace(' ', '-')}) ({len(members)})" for title, members in sections.items()
    )
    rows = [f"| {' | '.join(row)} |" for row in TRUST]
    trust = "\n".join((rows[0], "|---|---|---|", *rows[1:]))
    text = [LEGEND.format(counts=_counts(minerals), contents=links, thickness=THICKNESS_MM, thin=THIN_MM, trust=trust)]
    for title, members in sections.items():
        text += [f"## {title}", "", SECTIONS[title], "", *_table(members), ""]
    return "\n".join(text)


def pictures(minerals: Mapping[str, Mineral]) -> dict[str, str]:
    """Return the swatches of every mineral that absorbs, SVG by the name of the file."""
    return {name: _svg(chips) for mineral in minerals.values() for name, _, chips in _swatches(mineral)}


def write(folder: Path) -> None:
    """Write the page and its pictures; remove pictures of minerals that are gone."""
    minerals = builtin_minerals()
    (folder / PICTURES).mkdir(parents=True, exist_ok=True)
    (folder / PAGE).write_text(page(minerals), encoding="utf-8")
    made = pictures(minerals)
    for name, svg in made.items():
        (folder / PICTURES / name).write_text(svg, encoding="utf-8")
    for file in (folder / PICTURES).iterdir():
        if file.name not in made:
            file.unlink()


def _section(mineral: Mineral) -> str:
    if mineral.kind == "glass":
        return "Glasses"
    return f"{mineral.optical_class} {mineral.optic_sign or ''}".strip().capitalize()


def _counts(minerals: Mapping[str, Mineral]) -> str:
    every = minerals.values()
    varieties = sum(mineral.is_variety for mineral in every)
    kinds = {
        kind: sum(mineral.kind == kind and not mineral.is_variety for mineral in every)
        for kind in ("mineral", "synthetic", "glass")
    }
    published = sum(dispersion_quality(mineral) == "published" for mineral in every)
    colours = {word: sum(colour_quality(mineral) == word for mineral in every) for word in ("measured", "estimated")}
    return (
        f"{len(minerals)} entries: {kinds['mineral']} minerals and {varieties} varieties of them, {kinds['synthetic']} "
        f"synthetic crystals, {kinds['glass']} glasses.\n{published} have a published dispersion; of "
        f"{colours['measured']} the colour has been measured, of {colours['estimated']} it is estimated."
    )


def _table(members: Iterable[Mineral]) -> Iterator[str]:
    rows = list(_with_varieties(members))
    biaxial = any(mineral.optical_class == "biaxial" for mineral, _ in rows)
    birefringent = any(mineral.optical_class != "isotropic" for mineral, _ in rows)
    heads = ["Mineral", "System, class", "n at D"]
    heads += ["δ"] if birefringent else []
    heads += ["2V, axial dispersion"] if biaxial else []
    heads += [f"Colours, {THICKNESS_MM:g} mm", "Data: dispersion, colour"]
    yield f"| {' | '.join(heads)} |"
    yield "|---" * len(heads) + "|"
    for mineral, indented in rows:
        cells = [_name(mineral, indented), _class(mineral), "<br>".join(_indices(mineral))]
        cells += [_decimals(float(birefringence(mineral, SODIUM_D_NM)), mineral)] if birefringent else []
        cells += ["<br>".join(_axial(mineral))] if biaxial else []
        words = [dispersion_quality(mineral), colour_quality(mineral)]
        cells += ["<br>".join(_colours(mineral)), "<br>".join(word for word in words if word != "none")]
        yield f"| {' | '.join(cells)} |"


def _with_varieties(members: Iterable[Mineral]) -> Iterator[tuple[Mineral, bool]]:
    """Yield minerals by name, each followed by its varieties, which are marked."""
    by_name = sorted(members, key=lambda mineral: mineral.names.en.casefold())
    there = {mineral.id for mineral in by_name}
    for mineral in by_name:
        if mineral.variety_of in there:
            continue
        yield mineral, False
        yield from ((variety, True) for variety in by_name if variety.variety_of == mineral.id)


def _name(mineral: Mineral, indented: bool) -> str:
    lines = [f"{'↳ ' if indented else ''}**{mineral.names.en}**", mineral.names.ru]
    if not indented:
        lines.append(mineral.formula if mineral.kind == "glass" else _formula(mineral.formula))
    if mineral.kind == "synthetic":
        lines.append("(synthetic)")
    if mineral.id != mineral.names.en.lower().replace(" ", "-"):
        lines.append(f"`{mineral.id}`")
    return "<br>".join(lines)


def _formula(text: str) -> str:
    """Return a formula with its counts below the line."""
    return re.sub(r"(?<=[A-Za-z)\]])(\d+(?:\.\d+)?)(?![\d+−-])", r"<sub>\1</sub>", text)


def _class(mineral: Mineral) -> str:
    if mineral.point_group is None:
        return "glass"
    bars = re.sub(r"-(\d)", "\\1\u0305", mineral.point_group)  # a bar above the figure
    return f"{mineral.system}<br>{bars}"


def _indices(mineral: Mineral) -> Iterator[str]:
    """Yield the principal indices, α before β before γ, with their directions."""
    orientation = mineral.orientation
    named = {axis: axis for axis in mineral.dispersion}
    if isinstance(orientation, OrthorhombicOrientation):
        named = {name: getattr(orientation, name) for name in ("alpha", "beta", "gamma")}
    for name, axis in named.items():
        curve = mineral.dispersion[axis]
        text = _decimals(float(curve.index(SODIUM_D_NM)), mineral)
        letter = GREEK[name]
        text = f"{letter} {text}" if letter else text
        if isinstance(orientation, OrthorhombicOrientation):
            text += f" ∥ {axis}"
        elif isinstance(orientation, MonoclinicOrientation):
            text += _direction(orientation, name)
        if not curve.covers(SODIUM_D_NM, SODIUM_D_NM):
            shortest, longest = curve.range_nm
            text += f" (at {longest if longest < SODIUM_D_NM else shortest:g} nm)"
        yield text.replace(" ", "\u00a0")


def _direction(orientation: MonoclinicOrientation, name: str) -> str:
    if name == orientation.parallel_to_b:
        return " ∥ b"
    if name != orientation.direction:
        return ""
    angle = orientation.angle_deg
    degrees = angle if isinstance(angle, float | int) else float(angle.degrees(SODIUM_D_NM))
    if degrees == 0.0:
        return f" ∥ {orientation.from_axis}"
    return f" ∧ {orientation.from_axis} {degrees:+g}°".replace("-", "−")


def _decimals(value: float, mineral: Mineral) -> str:
    return f"{value:.{4 if dispersion_quality(mineral) == 'published' else 3}f}"


def _axial(mineral: Mineral) -> Iterator[str]:
    yield f"{float(two_v_deg(mineral, SODIUM_D_NM)):.0f}°"
    for bisectrix in ("alpha", "gamma"):
        measured = [_interval(angle) for angle in mineral.axial_angle if angle.bisectrix == bisectrix]
        if measured:
            yield f"measured\u00a02V<sub>{GREEK[bisectrix]}</sub>\u00a0{', '.join(measured)}"
    told = mineral.axial_dispersion
    if told is not None:
        words = [told.sense.replace(">", "\u00a0>\u00a0").replace("<", "\u00a0<\u00a0"), told.strength, told.kind]
        yield ", ".join(word for word in words if word)
    elif dispersion_quality(mineral) == "published":
        found = axial_dispersion(mineral)
        if found.crossed_planes:
            yield "crossed planes (by the curves)"
        elif found.sense is not None:
            yield f"{found.sense[0]}\u00a0{found.sense[1]}\u00a0{found.sense[2]} (by the curves)"


def _interval(angle: AxialAngle) -> str:
    low, high = angle.two_v_deg
    told = f"{low:g}°" if low == high else f"{low:g}–{high:g}°"
    at = f" at {angle.wavelength_nm:g} nm" if angle.wavelength_nm not in (None, SODIUM_D_NM) else ""
    return f"{told}{at}{'†' if angle.disagreement else ''}"


def _swatches(mineral: Mineral) -> list[tuple[str, float, list[tuple[str, str]]]]:
    """Return the pictures of a mineral: name of the file, thickness in mm, chips; none if it does not absorb."""
    if mineral.absorption is None:
        return []
    made = [(f"{mineral.id}.svg", THICKNESS_MM, _chips(mineral, THICKNESS_MM))]
    thin = _chips(mineral, THIN_MM)
    if min(_lightness(colour) for _, colour in made[0][2]) < BLACK <= max(_lightness(colour) for _, colour in thin):
        made.append((f"{mineral.id}-thin.svg", THIN_MM, thin))
    return made


def _chips(mineral: Mineral, thickness_mm: float) -> list[tuple[str, str]]:
    """Return the label and the colour (#rrggbb) of every principal direction, in the order of the indices."""
    colours = swatches(mineral, thickness_mm)
    orientation = mineral.orientation
    if isinstance(orientation, OrthorhombicOrientation):
        axes = {GREEK[name]: getattr(orientation, name) for name in ("alpha", "beta", "gamma")}
    else:
        own = mineral.absorption is not None and mineral.absorption.frame is not None
        axes = {GREEK[axis] + ("′" if own else ""): axis for axis in mineral.dispersion}
    return [(label, hexadecimal(colours[axis])) for label, axis in axes.items()]


def _colours(mineral: Mineral) -> Iterator[str]:
    """Yield the pictures of a mineral, and what colours it."""
    made = _swatches(mineral)
    if mineral.absorption is None:
        yield "–"
        return
    for name, thickness, chips in made:
        told = ", ".join(f"{label} {colour}".strip() for label, colour in chips)
        width, height = CHIP[0], CHIP[1] * len(chips)
        size = f'width="{width}" height="{height}"'
        if thickness != THICKNESS_MM:
            yield f"{thickness:g} mm:"
        yield f'<img src="{(PICTURES / name).as_posix()}" {size} alt="{thickness:g} mm: {told}">'
    for chromophore in mineral.absorption.chromophores.values():
        yield f"{chromophore.weight_percent:g} wt%\u00a0{_formula(chromophore.formula)}"


def _svg(chips: Sequence[tuple[str, str]]) -> str:
    """Return chips of colour, one below the other, each with its label."""
    width, height = CHIP
    parts = []
    for number, (label, colour) in enumerate(chips):
        top = number * height
        ink = "#1b1d1e" if _lightness(colour) > 0.45 else "#ffffff"
        parts.append(
            f'<rect x="0.5" y="{top + 1.5}" width="{width - 1}" height="{height - 3}" rx="3" fill="{colour}" '
            'stroke="#8a8f90"/>'
        )
        if label:
            parts.append(f'<text x="{width / 2:g}" y="{top + 17}" fill="{ink}" text-anchor="middle">{label}</text>')
    total = height * len(chips)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {total}" width="{width}" height="{total}" '
        'font-family="DejaVu Serif, Georgia, serif" font-style="italic" font-size="15">'
    )
    return "\n".join((head, *parts, "</svg>\n"))


def _lightness(colour: str) -> float:
    """Return how light a colour (#rrggbb) looks, 0 to 1: the weighted mean of its stored channels."""
    red, green, blue = (int(colour[place : place + 2], 16) / 255.0 for place in (1, 3, 5))
    return 0.30 * red + 0.59 * green + 0.11 * blue


if __name__ == "__main__":
    write(Path(sys.argv[1]) if len(sys.argv) > 1 else DOCS)
