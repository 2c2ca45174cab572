"""docs/minerals.md: its files load, its commands answer as it says, and it leaves out no field."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
import yaml
from fastapi.testclient import TestClient
from pydantic import TypeAdapter

import minerals_db
from crystal_core.materials import swatches
from minerals_db import MonoclinicOrientation
from minerals_db.fields import Status
from minerals_db.one_term import OneTerm
from minerals_db.orientation import AnyOrientation
from minerals_db.refractive_index import Dispersion
from minerals_db.schema import VARIETY_OWN
from minerals_db.symmetry import PointGroup
from service.app import create_app
from service.engine import InlineEngine
from service.settings import Settings
from service.workshop import Workshop
from tests.docs.blocks import FENCE, ROOT, programs, run, section

PAGE = "docs/minerals.md"
TEXT = (ROOT / PAGE).read_text(encoding="utf-8")
BLOCKS = FENCE.findall(TEXT)
COMMAND = Path(sys.executable).with_name("isogyre")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the page's files into a folder."""
    made = tmp_path_factory.mktemp("own")
    for language, body in BLOCKS:
        name = re.match(r"# (\S+\.yaml)\n", body)
        if language == "yaml" and name:
            (made / name[1]).parent.mkdir(exist_ok=True)
            (made / name[1]).write_text(body, encoding="utf-8")
    return made


def isogyre(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    own = {**os.environ, "ISOGYRE_MINERALS_DIR": str(folder)}
    return subprocess.run([COMMAND, *arguments], cwd=folder, env=own, capture_output=True, text=True, timeout=120)


def commands(body: str) -> list[list[str]]:
    """Return the arguments of every `isogyre` in a block of shell, without comments."""
    lines = (re.sub(r"\s+#.*", "", line).split() for line in body.splitlines())
    return [words[1:] for words in lines if words and words[0] == "isogyre"]


ANSWERED = [
    (body, BLOCKS[number + 1][1])
    for number, (language, body) in enumerate(BLOCKS)
    if language == "sh"
    and number + 1 < len(BLOCKS)
    and BLOCKS[number + 1][0] == "text"
    and "GET" not in BLOCKS[number + 1][1]
]


def test_files_of_the_page_are_written(folder: Path) -> None:
    assert {str(file.relative_to(folder)) for file in folder.rglob("*.yaml")} == {
        "brucite.yaml",
        "faulty/brucite.yaml",
        "rose-quartz.yaml",
    }


@pytest.mark.parametrize("body", [body for body, _ in ANSWERED])
def test_commands_print_what_the_page_says(body: str, folder: Path) -> None:
    prints = dict(ANSWERED)[body]
    answers = [isogyre(arguments, folder) for arguments in commands(body)]
    assert "".join(answer.stdout for answer in answers) == prints
    # Only faults make the exit code 1.
    assert [answer.returncode for answer in answers] == [int("faulty" in body)] * len(answers)


def test_brucite_is_a_mineral_like_any_other(folder: Path) -> None:
    (arguments,) = (line for line in commands(TEXT) if line[0] == "render")
    answer = isogyre([*arguments, "--frames", "1", "--size", "16x16", "--quality", "draft"], folder)
    assert answer.returncode == 0, answer.stderr
    assert (folder / "out" / "brucite" / "frame-0000.png").exists()


def test_both_of_the_folder_are_sound(folder: Path) -> None:
    answer = isogyre(["minerals", "check"], folder)
    assert answer.returncode == 0, answer.stdout
    assert answer.stdout.endswith(", 2 of your own: nothing wrong\n")


def test_rose_quartz_is_pink_through_20_mm(folder: Path) -> None:
    own = minerals_db.load_minerals(folder, minerals_db.minerals())["rose-quartz"]
    for red, green, blue in swatches(own, 20.0).values():
        assert red > blue > green > 0.5


FINDING = next(body for _, body in BLOCKS if "--group tourmaline" in body)


@pytest.mark.parametrize("arguments", commands(FINDING), ids=" ".join)
def test_searches_find_something(arguments: list[str], folder: Path) -> None:
    answer = isogyre(arguments, folder)
    assert answer.returncode == 0, answer.stderr
    assert len(answer.stdout.splitlines()) > 1 or answer.stdout.startswith("[{")


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    settings = Settings(data_dir=tmp_path_factory.mktemp("data"), workers=1, log_level="error")
    with TestClient(create_app(settings, workshop=Workshop(settings, InlineEngine))) as client:
        yield client


@pytest.mark.parametrize("address", re.findall(r"^GET (\S+)$", TEXT, re.MULTILINE))
def test_addresses_answer(address: str, client: TestClient) -> None:
    assert client.get(address).status_code == 200


@pytest.mark.parametrize("program", programs(PAGE), ids=lambda program: program.source.splitlines()[-1][:30])
def test_programs_print_what_the_page_says(program: Any, tmp_path: Path) -> None:
    assert run(program, tmp_path)[1] == program.prints


# What is told of the schema


def properties(node: object) -> Iterator[str]:
    """Yield the name of every field in a JSON Schema."""
    if isinstance(node, dict):
        yield from node.get("properties", ())
        for child in node.values():
            yield from properties(child)
    elif isinstance(node, list):
        for child in node:
            yield from properties(child)


def test_every_field_is_explained() -> None:
    told = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", FENCE.sub("", TEXT)))))
    axes = {"n", "o", "e", "a", "b", "c", "alpha", "beta", "gamma", "en", "ru"}
    assert sorted(set(properties(minerals_db.entry_schema())) - told - axes) == []


def words_of(node: object) -> Iterator[str]:
    """Yield every word that a JSON Schema allows in a place."""
    if isinstance(node, dict):
        yield from (word for word in node.get("enum", ()) if isinstance(word, str))
        yield from ([node["const"]] if isinstance(node.get("const"), str) else ())
        for child in node.values():
            yield from words_of(child)
    elif isinstance(node, list):
        for child in node:
            yield from words_of(child)


def test_every_word_of_a_list_is_told() -> None:
    classes = set(get_args(PointGroup))  # the page says: one of the 32
    missing = {word for word in words_of(minerals_db.entry_schema()) if word not in TEXT} - classes
    assert missing == set()


def test_every_status_is_explained() -> None:
    rows = set(re.findall(r"^\| `(\w+)` \|", section_text("Sources and statuses"), re.MULTILINE))
    assert rows == set(get_args(Status))


def section_text(heading: str) -> str:
    """Return the lines of a section."""
    found = re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", TEXT, re.MULTILINE | re.DOTALL)
    assert found is not None
    return found[1]


def models(base: Any = Dispersion) -> Iterator[type[Dispersion]]:
    """Yield every kind of curve that a file may name."""
    for one in base.__subclasses__():
        if "model" in one.__annotations__:
            yield one
        yield from models(one)


@pytest.mark.parametrize("model", list(models()), ids=lambda model: str(model.__name__))
def test_every_dispersion_model_is_told_with_its_formula(model: type[Dispersion]) -> None:
    (key,) = get_args(model.model_fields["model"].annotation)
    rows = [line for line in section_text("Dispersion").splitlines() if line.startswith(f"| `{key}` |")]
    assert len(rows) == 1
    formula = rows[0].split("|")[2].strip()
    if key == "table":
        return
    assert (model.__doc__ or "").startswith(formula)
    number = re.search(r"formula (\d) of refractiveindex", model.__doc__ or "")
    assert rows[0].split("|")[3].strip() == (number[1] if number else "")


def test_what_a_variety_does_not_take_over() -> None:
    text = section_text("A variety")
    own = VARIETY_OWN - {"id", "names", "variety_of", "sources"}
    assert all(f"`{field}`" in text.split("**except**")[1].split(":")[0] for field in own)


def test_what_the_fallback_costs_calcite() -> None:
    calcite = minerals_db.mineral("calcite").dispersion
    text = section(PAGE, "The fallback")
    for line, nm in (("F", 486.13), ("C", 656.28)):
        assert f"{float(calcite['o'].index(nm) - calcite['e'].index(nm)):.4f} at" in text, line
    made = {
        axis: OneTerm.model_validate(
            {
                "model": "one-term",
                "n_d": float(curve.index(589.3)),
                "n_f_minus_n_c": 0.58 * 0.017,
                "range_nm": [400.0, 700.0],
                "source": "textbooks",
                "status": "derived",
            }
        )
        for axis, curve in calcite.items()
    }
    blue, red = (float(made["o"].index(nm) - made["e"].index(nm)) for nm in (486.13, 656.28))
    assert blue == pytest.approx(red, abs=1e-9)


def test_orientations_of_the_page_are_orientations() -> None:
    (block,) = (body for language, body in BLOCKS if language == "yaml" and body.startswith("# orthorhombic"))
    kinds = []
    for snippet in block.split("\n\n"):
        told = TypeAdapter(AnyOrientation).validate_python(yaml.safe_load(snippet)["orientation"])
        kinds.append(type(told).__name__.removesuffix("Orientation").lower())
    assert kinds == re.findall(r"^# (\w+):", block, re.MULTILINE)


def test_the_sign_of_the_angle() -> None:
    """Positive from +c towards +a through the obtuse β, by the right hand about +b; from +a out of β."""
    beta = 110.0
    c = np.array((np.cos(np.deg2rad(beta)), 0.0, np.sin(np.deg2rad(beta))))  # x ∥ a, z ∥ c*
    a = np.array((1.0, 0.0, 0.0))

    def gamma(axis: str, angle: float) -> np.ndarray[Any, np.dtype[np.float64]]:
        told = MonoclinicOrientation.model_validate(
            {
                "parallel_to_b": "beta",
                "direction": "gamma",
                "from_axis": axis,
                "angle_deg": angle,
                "source": "textbooks",
                "status": "recalled",
            }
        )
        return np.asarray(told.axes(beta, 589.3)[2])

    between = gamma("c", 40.0)
    assert np.rad2deg(np.arccos(between @ c)) == pytest.approx(40.0)
    assert np.rad2deg(np.arccos(between @ a)) == pytest.approx(beta - 40.0)
    assert np.cross(c, between)[1] > 0.0, "the right hand about +b"
    assert np.rad2deg(np.arccos(gamma("a", 5.0) @ c)) == pytest.approx(beta + 5.0)
    assert np.rad2deg(np.arccos(gamma("a", -5.0) @ c)) == pytest.approx(beta - 5.0)
