"""The program of docs/cuts-and-meshes.md prints what the page says, and its figures are those of the code."""

from pathlib import Path

import pytest

from crystal_core.geometry.boxes import RIM_FACES
from crystal_core.geometry.brilliant import PROPORTIONS
from crystal_core.geometry.convex_mesh import MOST_PLANES
from crystal_core.geometry.mesh_contents import MAX_BYTES, MAX_FACES
from crystal_core.geometry.planar_faces import FLAT
from crystal_core.geometry.surface import COINCIDENT
from tests.docs.blocks import ROOT, programs, run, section

PAGE = "docs/cuts-and-meshes.md"


def test_the_program_prints_what_the_page_shows(tmp_path: Path) -> None:
    (program,) = programs(PAGE)
    _, printed = run(program, tmp_path)
    assert printed == program.prints


@pytest.mark.parametrize(("column", "name"), [(2, "tolkowsky"), (3, "modern")])
def test_proportions(column: int, name: str) -> None:
    cut = PROPORTIONS[name]
    expected = {
        "table, corner": f"{cut.table_percent:g} %",
        "crown angle": f"{cut.crown_deg:g}°",
        "pavilion angle": f"{cut.pavilion_deg:g}°",
        "girdle,": f"{cut.girdle_percent:g} %",
        "stars,": f"{cut.star_percent:g} %",
        "lower halves,": f"{cut.lower_half_percent:g} %",
        "culet": "none" if cut.culet_percent == 0 else f"{cut.culet_percent:g} %",
        "crown height": f"{cut.crown_height_percent:.2f} %",
        "pavilion depth": f"{cut.pavilion_depth_percent:.2f} %",
    }
    lines = (ROOT / PAGE).read_text(encoding="utf-8").splitlines()
    for begins, value in expected.items():
        (row,) = [line.split("|") for line in lines if line.startswith(f"| {begins}")]
        assert row[column].strip() == value


def test_limits() -> None:
    assert (MAX_FACES, MAX_BYTES) == (20_000, 16 * 2**20)
    assert (COINCIDENT, FLAT) == (1e-6, 1e-5)
    meshes = section(PAGE, "Meshes of your own")
    assert f"{MAX_FACES:,} triangles, 16 MiB" in meshes
    assert f"at most {MOST_PLANES} faces" in meshes
    assert f"a round one has {RIM_FACES} flat faces" in section(PAGE, "Cuts")
