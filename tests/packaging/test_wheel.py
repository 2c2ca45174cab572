"""The wheel holds all that the command, the service and its page need, and works where no checkout is."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.packaging.sources import PACKAGES, ROOT, source_files


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the path of the wheel of this checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    built = subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert built.returncode == 0, built.stderr
    (path,) = folder.glob("isogyre-*.whl")
    return path


@pytest.fixture(scope="module")
def names(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as archive:
        return set(archive.namelist())


def test_every_source_file_is_inside(names: set[str]) -> None:
    expected = {path.relative_to(ROOT).as_posix() for path in source_files(*PACKAGES)}
    assert expected <= names


@pytest.mark.parametrize("package", PACKAGES)
def test_types_are_announced(names: set[str], package: str) -> None:
    assert f"{package}/py.typed" in names


def test_data_and_tables_are_inside(names: set[str]) -> None:
    assert "minerals_db/data/calcite.yaml" in names
    assert "minerals_db/data/sources-structures.yaml" in names
    assert {name for name in names if name.endswith(".csv")} >= {
        "crystal_core/spectra/data/cie_1931_2_degree.csv",
        "crystal_core/spectra/data/cie_d65.csv",
        "crystal_core/spectra/data/mallett_yuksel_2019.csv",
    }


def test_the_page_is_inside_whole(names: set[str]) -> None:
    assert "service/web/index.html" in names
    assert {f"service/{path.relative_to(ROOT).as_posix()}" for path in source_files("web")} <= names


def test_nothing_else_is_inside(names: set[str]) -> None:
    assert {name.split("/")[0].split("-")[0] for name in names} == {*PACKAGES, "isogyre"}
    assert not [name for name in names if "__pycache__" in name or "test" in name.split("/")[-1]]


def test_metadata(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (info,) = {name.split("/")[0] for name in archive.namelist() if ".dist-info/" in name}
        metadata = archive.read(f"{info}/METADATA").decode()
        commands = archive.read(f"{info}/entry_points.txt").decode()
        assert archive.read(f"{info}/licenses/LICENSE").decode() == (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert "License-Expression: Apache-2.0" in metadata
    assert "Requires-Python: >=3.11" in metadata
    assert "isogyre = service.cli:main" in commands


PROBE = """
import json
from pathlib import Path
import crystal_core, minerals_db, service
from crystal_core.sequence import parse_request
from crystal_core.spectra.illuminants import d65
from service.app import page_folder

print(json.dumps({
    "files": [str(Path(module.__file__).parent) for module in (crystal_core, minerals_db, service)],
    "minerals": sorted(minerals_db.minerals()),
    "d65": float(d65(560.0)),
    "frames": parse_request({"demonstration": "rotating-calcite"}).frames,
    "page": str(page_folder()),
}))
"""


def test_it_works_away_from_the_checkout(wheel: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    # PYTHONPATH comes before the checkout's own entry: what the wheel lacks is missed here.
    done = subprocess.run(
        [sys.executable, "-P", "-c", PROBE],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(site)},
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    minerals = {
        path.stem for path in (ROOT / "minerals_db" / "data").glob("*.yaml") if not path.stem.startswith("sources")
    }
    assert json.loads(done.stdout) == {
        "files": [str(site / package) for package in PACKAGES],
        "minerals": sorted(minerals),
        "d65": 100.0,
        "frames": 36,
        "page": str(site / "service" / "web"),
    }
