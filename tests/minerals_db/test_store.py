"""Loading the data: what is sound loads, what is faulty is named whole."""

from __future__ import annotations

import math
import pickle
import sys
from importlib import resources
from pathlib import Path
from subprocess import run

import pytest
import yaml

import minerals_db
from minerals_db import MineralDataError, UnknownMineralError, load_minerals
from minerals_db.schema import Mineral
from minerals_db.symmetry import OPTICAL_CLASS, POINT_GROUPS, PRINCIPAL_AXES

SOUND = """
id: testite
names: {en: Testite, ru: Тестит}
formula: SiO2
system: trigonal
point_group: "32"
optical_class: uniaxial
optic_sign: positive
cell:
  {a_angstrom: 4.9, b_angstrom: 4.9, c_angstrom: 5.4, alpha_deg: 90, beta_deg: 90, gamma_deg: 120,
   space_group: P 32 2 1, source: me, status: measured}
dispersion:
  o:
    {model: sellmeier-2, terms: [{strength: 1.4, resonance_um2: 0.01}],
     range_nm: [400, 700], source: me, status: fitted}
  e:
    {model: sellmeier-2, terms: [{strength: 1.5, resonance_um2: 0.01}],
     range_nm: [400, 700], source: me, status: fitted}
cleavage:
  - {hkl: [1, 0, 1], quality: poor, source: me, status: recalled}
sources:
  me: {citation: My own notebook., licence: CC0 1.0}
"""


def load(folder: Path, text: str, name: str = "testite.yaml") -> Mineral:
    (folder / name).write_text(text, encoding="utf-8")
    return load_minerals(folder)["testite"]


def faults(folder: Path, *changes: tuple[str, str], name: str = "testite.yaml") -> list[str]:
    """Return what is said of the sound file after the changes, each of which must change something."""
    text = SOUND
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    with pytest.raises(MineralDataError) as caught:
        load(folder, text, name)
    assert str(caught.value).splitlines() == [str(fault) for fault in caught.value.faults]
    return str(caught.value).splitlines()


def test_sound_file_loads(tmp_path: Path) -> None:
    mineral = load(tmp_path, SOUND)
    assert mineral.names.ru == "Тестит"
    assert mineral.cell.c_angstrom == 5.4
    assert mineral.cleavage[0].hkl == (1, 0, 1)
    assert mineral.sources["me"].licence == "CC0 1.0"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"32"', '"6/m"', "point_group: 6/m is no trigonal class; those are 3, -3, 32, 3m, -3m"),
        ("uniaxial", "biaxial", "optical_class: trigonal crystals are uniaxial, not biaxial"),
        ("optic_sign: positive", "optic_sign: negative", "optic_sign: negative, but n_o is 1.56"),
        ("optic_sign: positive\n", "", "optic_sign: a uniaxial mineral has an optic sign"),
        ("gamma_deg: 120", "gamma_deg: 90", "cell: not a trigonal cell: gamma_deg must be 120, not 90"),
        ("b_angstrom: 4.9", "b_angstrom: 5.0", "cell: not a trigonal cell: a_angstrom and b_angstrom must be equal"),
        ("a_angstrom: 4.9", "a_nm: 0.49", "cell.a_nm: unknown field; the quantity is wanted as a_angstrom"),
        ("a_angstrom: 4.9", "a_angstrom: 0.49", "cell.a_angstrom: Input should be greater than or equal to 1"),
        ("a_angstrom: 4.9", "a_nm: 0.49", "cell.a_angstrom: missing"),
        ("c_angstrom: 5.4", "c_angstrom: .nan", "cell.c_angstrom: Input should be a finite number"),
        ("c_angstrom: 5.4", "c_angstrom: -5.4", "cell.c_angstrom: Input should be greater than or equal to 1"),
        ("c_angstrom: 5.4", "c_angstrom: '5.4'", "cell.c_angstrom: Input should be a valid number"),
        ("  e:\n", "  n:\n", "dispersion: trigonal minerals have the indices o, e, not n, o"),
        ("strength: 1.5,", "strength: nought,", "dispersion.e.terms.0.strength: Input should be a valid number"),
        (
            "[400, 700], source: me, status: fitted}\n  e",
            "[400, 700], status: fitted}\n  e",
            "dispersion.o.source: missing",
        ),
        ("source: me, status: measured", "source: you, status: measured", "cell.source: unknown source 'you'"),
        ("status: measured", "status: sure", "cell.status: Input should be 'published'"),
        ("licence: CC0 1.0", "licence: CC0 1.0, via: nobody", "sources.me.via: unknown source 'nobody'"),
        (", licence: CC0 1.0", "", "sources.me.licence: missing"),
        ("[1, 0, 1]", "[0, 0, 0]", "cleavage.0.hkl: (0 0 0) is no direction"),
        ("[1, 0, 1]", "[1, 0]", "cleavage.0.hkl.2: missing"),
        ("[1, 0, 1]", "[1, 0, 0.5]", "cleavage.0.hkl.2: Input should be a valid integer"),
        ("ru: Тестит", "de: Testit", "names.ru: missing"),
        ("id: testite", "id: other", "id: must be the name of the file, not 'other'"),
        ("id: testite", "id: Test ite", "id: String should match pattern"),
        ("system: trigonal", "system: rhombic", "system: Input should be 'cubic', 'tetragonal'"),
        (
            "system: trigonal",
            "system: monoclinic",
            "dispersion: monoclinic minerals have the indices alpha, beta, gamma, not e, o",
        ),
        ("formula: SiO2", "formula: SiO2\ncolour: red", "colour: unknown field"),
        ("formula: SiO2", "formula: SiO2\nformula: TiO2", "not YAML: repeated key 'formula'"),
        ("formula: SiO2", "formula: [SiO2", "not YAML: "),
        ("formula: SiO2", "? [a]\n: b", "not YAML: "),
        ("formula: SiO2", "formula: !!python/object/apply:os.getcwd []", "not YAML: could not determine a constructor"),
    ],
)
def test_one_fault_names_file_field_and_reason(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert any(line.startswith(f"testite.yaml: {said}") for line in faults(tmp_path, (old, new)))


def test_all_faults_are_named_at_once(tmp_path: Path) -> None:
    (tmp_path / "worse.yaml").write_text("[1, 2]", encoding="utf-8")
    (tmp_path / "wrong.yml").write_text("{}", encoding="utf-8")
    said = faults(
        tmp_path,
        ("optic_sign: positive", "optic_sign: negative"),
        ("gamma_deg: 120", "gamma_deg: 90"),
        ("ru: Тестит", "ru: 7"),
        ("status: measured", "status: sure"),
        ("source: me, status: recalled", "source: you, status: recalled"),
    )
    for expected in (
        "testite.yaml: optic_sign: negative, but",
        "testite.yaml: names.ru: Input should be a valid string",
        "testite.yaml: cell.status: ",
        "testite.yaml: cleavage.0.source: unknown source 'you'",
        "worse.yaml: must hold a mapping",
        "wrong.yml: must end in .yaml",
    ):
        assert any(line.startswith(expected) for line in said), expected


def test_shared_sources(tmp_path: Path) -> None:
    (tmp_path / "sources.yaml").write_text(
        "you: {citation: Yours., licence: CC0 1.0, via: them}\n"
        "them: {citation: Theirs., licence: CC0 1.0}\n"
        "nobody: {citation: Unused., licence: CC0 1.0}\n",
        encoding="utf-8",
    )
    mineral = load(tmp_path, SOUND.replace("source: me, status: measured", "source: you, status: measured"))
    assert list(mineral.sources) == ["me", "them", "you"]


def test_fault_of_a_shared_source_is_told_once(tmp_path: Path) -> None:
    (tmp_path / "sources.yaml").write_text("you: {citation: Yours., via: them}\n", encoding="utf-8")
    said = faults(tmp_path, ("source: me, status: measured", "source: you, status: measured"))
    assert said == ["sources.yaml: you.via: unknown source 'them'", "sources.yaml: you.licence: missing"]


def test_file_that_is_not_utf8(tmp_path: Path) -> None:
    (tmp_path / "testite.yaml").write_bytes(b"id: \xff\xfe\n")
    with pytest.raises(MineralDataError, match=r"testite\.yaml: not YAML"):
        load_minerals(tmp_path)


def test_empty_folder(tmp_path: Path) -> None:
    assert dict(load_minerals(tmp_path)) == {}


def test_errors_travel_between_processes() -> None:
    unknown = UnknownMineralError("Quarz", ["beryl", "quartz"])
    assert str(pickle.loads(pickle.dumps(unknown))) == str(unknown) == "no mineral 'Quarz'; do you mean quartz?"
    faulty = MineralDataError([minerals_db.DataFault("f.yaml", "cell", "wrong")])
    assert str(pickle.loads(pickle.dumps(faulty))) == str(faulty) == "f.yaml: cell: wrong"


def test_unknown_mineral() -> None:
    with pytest.raises(KeyError) as caught:
        minerals_db.mineral("xyz")
    assert isinstance(caught.value, UnknownMineralError)
    assert caught.value.known == tuple(minerals_db.minerals())
    assert str(caught.value) == f"no mineral 'xyz'; {len(caught.value.known)} are known, none of them like it"


def test_minerals_are_sorted_read_only_and_loaded_once() -> None:
    minerals = minerals_db.minerals()
    assert list(minerals) == sorted(minerals)
    assert minerals_db.minerals() is minerals
    assert minerals_db.mineral("calcite") is minerals["calcite"]
    with pytest.raises(TypeError):
        minerals["x"] = minerals["calcite"]  # type: ignore[index]


@pytest.mark.parametrize("mineral_id", minerals_db.minerals())
def test_entries_agree_with_their_symmetry(mineral_id: str) -> None:
    mineral = minerals_db.mineral(mineral_id)
    assert mineral.id == mineral_id
    assert mineral.point_group in (POINT_GROUPS[mineral.system] or (None,))
    assert mineral.optical_class == OPTICAL_CLASS[mineral.system]
    assert tuple(mineral.dispersion) == PRINCIPAL_AXES[mineral.system]
    assert (mineral.orientation is None) == (mineral.optical_class != "biaxial")
    assert (mineral.optic_sign is None) == (mineral.optical_class == "isotropic")
    if mineral.optical_class == "uniaxial":
        assert mineral.system in ("trigonal", "tetragonal", "hexagonal")
        positive = float(mineral.dispersion["e"].index(589.3)) > float(mineral.dispersion["o"].index(589.3))
        assert positive == (mineral.optic_sign == "positive")


@pytest.mark.parametrize("mineral_id", minerals_db.minerals())
def test_entries_travel_between_processes_and_to_json(mineral_id: str) -> None:
    mineral = minerals_db.mineral(mineral_id)
    assert pickle.loads(pickle.dumps(mineral)) == mineral
    assert Mineral.model_validate_json(mineral.model_dump_json()) == mineral


@pytest.mark.parametrize("mineral_id", minerals_db.minerals())
def test_russian_names_are_russian(mineral_id: str) -> None:
    names = minerals_db.mineral(mineral_id).names
    assert any("\u0400" <= letter <= "\u04ff" for letter in names.ru)
    assert names.en.isascii()


def test_cleavages_on_the_axes_of_the_structural_cell() -> None:
    expected = {"calcite": (1, 0, 4), "diamond": (1, 1, 1), "fluorite": (1, 1, 1), "halite": (0, 0, 1)}
    for mineral_id, hkl in expected.items():
        plane = minerals_db.mineral(mineral_id).cleavage[0]
        assert (plane.hkl, plane.quality) == (hkl, "perfect")


def test_optic_axis_of_calcite_stands_about_45_degrees_from_its_cleavage() -> None:
    # The normal of (h k l) and c in hexagonal axes: tan = c/a · sqrt(4/3 (h² + hk + k²)) / l. Published: 44°36'.
    cell = minerals_db.mineral("calcite").cell
    assert cell is not None
    h, k, third = minerals_db.mineral("calcite").cleavage[0].hkl
    tangent = cell.c_angstrom / cell.a_angstrom * math.sqrt(4.0 / 3.0 * (h * h + h * k + k * k)) / third
    assert math.degrees(math.atan(tangent)) == pytest.approx(44.6, abs=0.1)


def test_every_source_is_used_and_has_terms() -> None:
    data = resources.files("minerals_db") / "data"
    shared = {
        key
        for file in data.iterdir()
        if file.name.startswith("sources")
        for key in yaml.safe_load(file.read_text(encoding="utf-8"))
    }
    used = {key for mineral in minerals_db.minerals().values() for key in mineral.sources}
    assert shared - used == set()


def test_schema_can_be_published() -> None:
    schema = Mineral.model_json_schema()
    assert schema["additionalProperties"] is False
    assert {"names", "formula", "dispersion", "sources"} <= set(schema["required"])


def test_importing_is_cheap_and_loading_needs_no_scipy() -> None:
    program = """
import sys, time
begin = time.process_time()
import minerals_db
spent = time.process_time() - begin
heavy = {"numpy", "pydantic", "yaml", "scipy"} & set(sys.modules)
minerals_db.minerals()
print(spent, *sorted(heavy), "scipy" if "scipy" in sys.modules else "")
"""
    outputs = [
        run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout.split()
        for _ in range(3)
    ]
    assert all(len(output) == 1 for output in outputs), outputs
    assert min(float(output[0]) for output in outputs) < 0.05
