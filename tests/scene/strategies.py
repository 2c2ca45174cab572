"""Random scenes as mappings, all constructs of the language among them, and random mutations of them."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from typing import Any

from hypothesis import strategies as st

Mapping = dict[str, Any]
Path = tuple[str | int, ...]

NAMES = st.from_regex(r"[A-Za-z][A-Za-z0-9_-]{0,8}", fullmatch=True)


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_nan=False, allow_subnormal=False)


def one_of_keys(**kinds: st.SearchStrategy[Any]) -> st.SearchStrategy[Mapping]:
    return st.one_of(*(st.fixed_dictionaries({key: value}) for key, value in kinds.items()))


def keys(optional: Mapping | None = None, **required: Any) -> st.SearchStrategy[Mapping]:
    return st.fixed_dictionaries(required, optional=optional or {})


POINTS = st.lists(numbers(-500, 500), min_size=3, max_size=3)
LENGTHS = numbers(0.01, 500)
ANGLES = numbers(-360, 360)
DIRECTIONS = st.one_of(
    st.sampled_from(["x", "y", "z", "-x", "-y", "-z"]),
    POINTS.filter(lambda v: sum(c * c for c in v) > 1e-6),
)
HKL = st.lists(st.integers(-5, 5), min_size=3, max_size=3).filter(any)
WAVELENGTHS = numbers(380, 780)


@st.composite
def tables(draw: st.DrawFn, low: float = 0.0, high: float = 1.0) -> Mapping:
    wavelengths = sorted(set(draw(st.lists(st.integers(380, 780), min_size=2, max_size=6, unique=True))))
    values = draw(st.lists(numbers(low, high), min_size=len(wavelengths), max_size=len(wavelengths)))
    return {"wavelengths_nm": wavelengths, "values": values}


INDICES = st.one_of(
    numbers(1.0, 3.0),
    one_of_keys(table=tables(1.0, 3.0), cauchy=keys({"b_um2": numbers(0, 0.02)}, a=numbers(1.2, 2.5))),
)
ABSORBED = st.one_of(numbers(0, 10), keys(table=tables(0.0, 10.0)))
OPTICS = st.one_of(
    keys({"absorption_per_mm": keys(n=ABSORBED)}, n=INDICES),
    keys({"absorption_per_mm": keys(o=ABSORBED, e=ABSORBED)}, o=INDICES, e=INDICES),
    keys(
        {"axes": st.just([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]])},
        alpha=INDICES,
        beta=INDICES,
        gamma=INDICES,
    ),
)
CRYSTAL_DIRECTIONS = one_of_keys(hkl=HKL, uvw=HKL, optical=st.sampled_from(["optic-axis", "gamma"]), crystal=DIRECTIONS)
ORIENTATIONS = st.one_of(
    keys(z=CRYSTAL_DIRECTIONS),
    keys(z=CRYSTAL_DIRECTIONS, x=CRYSTAL_DIRECTIONS),
    keys(x=CRYSTAL_DIRECTIONS, y=CRYSTAL_DIRECTIONS),
    keys(matrix=st.just([[0, -1, 0], [1, 0, 0], [0, 0, 1]])),
)
SIZES = st.lists(LENGTHS, min_size=2, max_size=2)
FORMS = st.lists(keys({"central_distance": numbers(0.1, 10)}, hkl=HKL), min_size=1, max_size=3)
HABITS = st.one_of(keys({"size_mm": LENGTHS}), keys({"size_mm": LENGTHS}, forms=FORMS))
SHAPES = one_of_keys(
    cleavage=keys({"spacing_mm": st.one_of(LENGTHS, st.lists(LENGTHS, min_size=1, max_size=4)), "hkl": HKL}),
    habit=HABITS,
)
CUTS = one_of_keys(
    box=keys({"size_mm": st.lists(LENGTHS, min_size=3, max_size=3)}),
    plate=keys({"size_mm": st.one_of(LENGTHS, SIZES)}, thickness_um=numbers(1, 1e5)),
    wedge=keys({"size_mm": SIZES}, thickness_um=st.tuples(numbers(0, 10), numbers(11, 500)).map(list)),
    prism=keys({"apex_deg": numbers(5, 120), "side_mm": LENGTHS, "length_mm": LENGTHS}),
    column=keys({"sides": st.integers(3, 12), "diameter_mm": LENGTHS}),
    sphere=keys({"diameter_mm": LENGTHS}),
    cabochon=keys({"size_mm": SIZES, "height_mm": LENGTHS, "profile": st.sampled_from(["ellipsoid", "cap"])}),
    brilliant=keys({"diameter_mm": LENGTHS, "proportions": st.just("modern"), "crown_deg": numbers(20, 40)}),
    step_cut=keys({"size_mm": SIZES, "crown_deg": st.just([40, 30])}),
    mesh=keys({"size_mm": LENGTHS}, file=st.sampled_from(["a.ply", "b/c.STL", "asset:" + 64 * "a"])),
)
TURNS = st.lists(keys({"about": DIRECTIONS}, angle_deg=ANGLES), max_size=2)
BODIES = st.one_of(
    keys(
        {"turns": TURNS, "orientation": ORIENTATIONS, "position_mm": POINTS, "twin": keys(plane_hkl=HKL)},
        mineral=st.sampled_from(["calcite", "quartz", "spinel"]),
        shape=keys(habit=HABITS),
    ),
    keys({"orientation": ORIENTATIONS}, mineral=st.just("calcite"), shape=st.one_of(SHAPES, CUTS)),
    keys({"turns": TURNS, "position_mm": POINTS}, optics=OPTICS, shape=CUTS),
    keys({"concentrations": keys(chromium=numbers(0, 5))}, mineral=st.just("ruby"), shape=CUTS),
)
OUTLINES = one_of_keys(rectangle=keys({"width_mm": LENGTHS, "height_mm": LENGTHS}), disc=keys({"diameter_mm": LENGTHS}))
REFLECTANCES = st.one_of(
    numbers(0, 1), one_of_keys(srgb=st.lists(numbers(0, 1), min_size=3, max_size=3), table=tables(0.0, 1.0))
)
SURFACES = st.one_of(
    keys({"shape": st.one_of(OUTLINES, keys(endless=keys())), "facing": DIRECTIONS}, reflectance=REFLECTANCES),
    keys({"position_mm": POINTS, "shape": keys(room=keys())}, reflectance=REFLECTANCES),
    keys(
        {"marks_mm": st.lists(st.lists(numbers(-20, 20), min_size=2, max_size=2), max_size=3)},
        print=st.sampled_from(["digits", "page.png", "asset:" + 64 * "0"]),
    ),
)
PLATES = keys({"orientation": ORIENTATIONS}, mineral=st.just("gypsum"), thickness_um=numbers(1, 1000))
SHEETS = st.builds(
    lambda kind, place: kind | place,
    one_of_keys(
        polarizer=keys({"angle_deg": ANGLES, "extinction": numbers(0, 0.1)}),
        retarder=keys({"slow_deg": ANGLES}, retardation_nm=numbers(0, 2000)),
        plate=PLATES,
    ),
    keys({"position_mm": POINTS, "facing": DIRECTIONS, "shape": OUTLINES}),
)
SPECTRA = st.one_of(
    st.sampled_from(["D65", "A", "E"]),
    one_of_keys(
        lines=st.lists(keys({"power": numbers(0.01, 10)}, wavelength_nm=WAVELENGTHS), min_size=1, max_size=3),
        black_body=keys(temperature_k=numbers(1000, 10000)),
        table=tables(0.01, 1.0),
    ),
)
LIGHTS = st.builds(
    lambda kind, how: kind | how,
    one_of_keys(
        point=keys({"illuminance_lx": numbers(1, 1e4)}),
        beam=keys({"shape": OUTLINES}, position_mm=POINTS, direction=DIRECTIONS),
        area=keys({"facing": DIRECTIONS, "shape": OUTLINES}, position_mm=POINTS),
        sky=keys({"illuminance_lx": numbers(1, 1e4)}),
    ),
    keys(
        {
            "spectrum": SPECTRA,
            "polarization": st.builds(
                lambda kind, degree: kind | degree,
                one_of_keys(vibration=DIRECTIONS, circular=st.just("clockwise")),
                keys({"degree": numbers(0, 1)}),
            ),
        }
    ),
)
CAMERAS = st.builds(
    lambda kind, analyser: kind | analyser,
    one_of_keys(
        fitted=keys({"tilt_deg": numbers(0, 180), "azimuth_deg": ANGLES}),
        perspective=keys({"vfov_deg": numbers(1, 90)}, eye_mm=POINTS.filter(lambda v: sum(c * c for c in v) > 1)),
        orthographic=keys({"height_mm": LENGTHS}, eye_mm=POINTS.filter(lambda v: sum(c * c for c in v) > 1)),
    ),
    keys({"analyser_deg": ANGLES}),
)
RENDERS = keys(
    {
        "size_px": st.lists(st.integers(16, 2048), min_size=2, max_size=2),
        "quality": st.sampled_from(["draft", "fine"]),
        "seed": st.integers(0, 2**63 - 1),
        "exposure": numbers(0.01, 100),
        "dispersion": st.booleans(),
        "interference": st.booleans(),
    }
)
TEXT = st.text(st.characters(codec="utf-8", exclude_categories=("Cc", "Cs")), min_size=1, max_size=20)


@st.composite
def scenes(draw: st.DrawFn) -> Mapping:
    """Draw a mapping that describes a scene; whether it can be staged is another question."""
    names = draw(st.lists(NAMES, min_size=4, max_size=8, unique=True))
    scene: Mapping = {"isogyre": 1, "bodies": {names[0]: draw(BODIES)}}
    for section, strategy in (("bodies", BODIES), ("surfaces", SURFACES), ("sheets", SHEETS), ("lights", LIGHTS)):
        if draw(st.booleans()):
            index = ("bodies", "surfaces", "sheets", "lights").index(section)
            scene.setdefault(section, {})[names[4 + index] if len(names) > 4 + index else names[index]] = draw(strategy)
    taken = [name for section in ("bodies", "surfaces", "sheets", "lights") for name in scene.get(section, {})]
    if len(set(taken)) != len(taken) or {"lamp", "sky"} & set(taken):
        scene = {key: value for key, value in scene.items() if key in {"isogyre", "bodies"}}
        scene["bodies"] = {"only": next(iter(scene["bodies"].values()))}
    for key, strategy in (("title", TEXT), ("camera", CAMERAS), ("render", RENDERS)):
        if draw(st.booleans()):
            scene[key] = draw(strategy)
    if draw(st.booleans()):
        body = next(iter(scene["bodies"]))
        moves: list[Mapping] = [{"turn": {"what": body, "angles_deg": draw(st.lists(ANGLES, min_size=2, max_size=4))}}]
        if draw(st.booleans()):
            moves.append({"stage": {"angles_deg": [0, 90], "at": [0, 1]}})
        if scene.get("camera", {}).get("analyser_deg") is not None:
            moves.append({"analyser": {"angles_deg": [0, 90]}})
        scene["motion"] = {"frames": draw(st.integers(1, 360)), "cyclic": draw(st.booleans()), "moves": moves}
    return scene


def paths(value: Any, at: Path = ()) -> Iterator[Path]:
    """Yield the places of all keys and items."""
    items: Any = ()
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value)
    for key, item in items:
        yield (*at, key)
        yield from paths(item, (*at, key))


def value_at(value: Any, path: Path) -> Any:
    for key in path:
        value = value[key]
    return value


ODD = st.sampled_from(
    [
        "text",
        "12",
        "",
        -1,
        0,
        3,
        1e12,
        -1e12,
        0.5,
        True,
        None,
        [],
        {},
        [1, 2],
        {"x": 1},
        [[1]],
        "asset:zz",
        float("nan"),
    ]
)


@st.composite
def mutations(draw: st.DrawFn) -> tuple[Mapping, Mapping, str]:
    """Draw a scene, a mutation of it, and what was done."""
    scene = draw(scenes())
    mutant = copy.deepcopy(scene)
    path = draw(st.sampled_from(list(paths(scene))))
    holder, key = value_at(mutant, path[:-1]), path[-1]
    how = draw(st.sampled_from(["drop", "rename", "retype", "unknown key"]))
    if how == "drop":
        del holder[key]
    elif how == "rename" and isinstance(holder, dict):
        holder[f"{key}x" if draw(st.booleans()) else f"{key}_mm"] = holder.pop(key)
    elif how == "unknown key" and isinstance(holder, dict):
        holder["colour_temperature"] = 1
    else:
        how = "retype"
        holder[key] = draw(ODD)
    return scene, mutant, how
