"""`isogyre wave-surface`: what it prints, what it writes, and what it refuses."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import minerals_db
from service.cli import run


@pytest.fixture(autouse=True)
def _work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def ask(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, Any]:
    assert run(["wave-surface", *arguments]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out.count("\n") == 1
    document: dict[str, Any] = json.loads(out)
    return document


def points(document: dict[str, Any], sheet: str) -> Any:
    return np.array(document[sheet]["vertices"]).T


def test_calcite_is_a_sphere_around_a_spheroid(capsys: pytest.CaptureFixture[str]) -> None:
    document = ask(capsys, "calcite", "--resolution", "8")
    assert list(document) == [
        "mineral",
        "wavelength_nm",
        "kind",
        "indices",
        "axes",
        "optical_class",
        "optic_axes",
        "two_v_deg",
        "optic_sign",
        "contact_points",
        "outer",
        "inner",
    ]
    assert (document["mineral"], document["wavelength_nm"], document["kind"]) == ("calcite", 589.3, "index")
    assert (document["optical_class"], document["optic_sign"], document["two_v_deg"]) == ("uniaxial", "negative", None)
    n_o, n_e = document["indices"]
    entry = minerals_db.mineral("calcite").dispersion
    assert (n_o, n_e) == (float(entry["o"].index(589.3)), float(entry["e"].index(589.3)))
    assert document["optic_axes"] == [[0.0, 0.0, 1.0]]
    assert document["axes"][2] == [0.0, 0.0, 1.0]
    assert document["contact_points"] == [[0.0, 0.0, n_o], [0.0, 0.0, -n_o]]
    assert (document["outer"]["mode"], document["inner"]["mode"]) == ("ordinary", "extraordinary")
    np.testing.assert_allclose(np.linalg.norm(points(document, "outer"), axis=0), n_o, rtol=1e-14)
    x, y, z = points(document, "inner")
    np.testing.assert_allclose((x**2 + y**2) / n_e**2 + z**2 / n_o**2, 1.0, rtol=1e-14)


def test_the_ray_surface_of_a_positive_crystal_at_another_wavelength(capsys: pytest.CaptureFixture[str]) -> None:
    document = ask(capsys, "quartz", "--kind", "ray", "--wavelength-nm", "450", "--resolution", "4")
    assert (document["kind"], document["wavelength_nm"], document["optic_sign"]) == ("ray", 450.0, "positive")
    entry = minerals_db.mineral("quartz").dispersion
    n_o, n_e = (float(entry[axis].index(450.0)) for axis in "oe")
    assert document["indices"] == [n_o, n_e]
    np.testing.assert_allclose(np.linalg.norm(points(document, "outer"), axis=0), 1 / n_o, rtol=1e-14)
    x, y, z = points(document, "inner")
    np.testing.assert_allclose((x**2 + y**2) * n_e**2 + z**2 * n_o**2, 1.0, rtol=1e-14)


def test_aragonite_touches_itself_at_four_points(capsys: pytest.CaptureFixture[str]) -> None:
    document = ask(capsys, "aragonite", "--resolution", "8")
    assert (document["optical_class"], document["optic_sign"]) == ("biaxial", "negative")
    assert document["axes"] == np.eye(3).tolist()
    n = np.array(document["indices"])
    alpha, beta, gamma = np.sort(n)
    v_alpha = np.arctan(np.sqrt((beta**-2 - gamma**-2) / (alpha**-2 - beta**-2)))
    assert document["two_v_deg"] == pytest.approx(np.degrees(2 * v_alpha), rel=1e-12)
    assert document["two_v_deg"] == pytest.approx(18, abs=1.0)
    # The acute bisectrix is the direction of α, the axis c; the optic axes lie in the plane of c and b (γ).
    assert np.argmin(n) == 2
    for axis in document["optic_axes"]:
        assert np.degrees(np.arccos(abs(axis[2]))) == pytest.approx(document["two_v_deg"] / 2, abs=1e-6)
        assert axis[int(np.argsort(n)[1])] == pytest.approx(0.0, abs=1e-15)
    contacts = np.array(document["contact_points"])
    assert contacts.shape == (4, 3)
    np.testing.assert_allclose(np.linalg.norm(contacts, axis=1), beta, rtol=1e-15)
    for sheet in ("outer", "inner"):
        vertices = {tuple(p) for p in document[sheet]["vertices"]}
        assert {tuple(p) for p in contacts.tolist()} <= vertices
        # Fresnel's equation on the crystal's own axes.
        k2 = points(document, sheet) ** 2
        length2 = k2.sum(axis=0)
        eps = n[:, None] ** 2
        value = length2 * (eps * k2).sum(axis=0) - ((eps * (eps.sum() - eps)) * k2).sum(axis=0) + eps.prod()
        np.testing.assert_allclose(value / eps.prod(), 0.0, atol=1e-13)


def test_fluorite_is_one_sphere_twice(capsys: pytest.CaptureFixture[str]) -> None:
    document = ask(capsys, "fluorite", "--resolution", "3")
    (n,) = document["indices"]
    assert (document["optical_class"], document["optic_axes"], document["contact_points"]) == ("isotropic", [], [])
    assert (document["axes"], document["two_v_deg"], document["optic_sign"]) == (None, None, None)
    assert document["outer"]["vertices"] == document["inner"]["vertices"]
    np.testing.assert_allclose(np.linalg.norm(points(document, "outer"), axis=0), n, rtol=1e-15)


def test_every_mineral_has_both_surfaces(capsys: pytest.CaptureFixture[str]) -> None:
    for mineral, entry in minerals_db.minerals().items():
        if not all(curve.covers(589.3, 589.3) for curve in entry.dispersion.values()):
            continue  # refused, as another test tells
        for kind in ("index", "ray"):
            document = ask(capsys, mineral, "--kind", kind, "--resolution", "2")
            assert len(document["contact_points"]) == {"isotropic": 0, "uniaxial": 2, "biaxial": 4}[entry.optical_class]
            assert document["optic_sign"] == entry.optic_sign


def test_a_json_file_holds_what_stdout_would_get(capsys: pytest.CaptureFixture[str]) -> None:
    document = ask(capsys, "calcite", "--resolution", "4")
    assert run(["wave-surface", "calcite", "--resolution", "4", "--out", "calcite.json"]) == 0
    assert capsys.readouterr() == ("", "")
    assert json.loads(Path("calcite.json").read_text(encoding="utf-8")) == document
    assert [p.name for p in Path().iterdir()] == ["calcite.json"]


@pytest.mark.parametrize("mineral", ["aragonite", "calcite", "fluorite"])
@pytest.mark.parametrize("kind", ["index", "ray"])
def test_a_ply_file_holds_both_sheets(capsys: pytest.CaptureFixture[str], mineral: str, kind: str) -> None:
    document = ask(capsys, mineral, "--kind", kind, "--resolution", "6")
    options = ("--kind", kind, "--resolution", "6", "--out", "surface.PLY")
    assert run(["wave-surface", mineral, *options]) == 0
    assert capsys.readouterr() == ("", "")
    data = Path("surface.PLY").read_bytes()
    header = data[: data.index(b"end_header")].decode("ascii")
    assert f"{kind} surface of {mineral} at 589.3 nm" in header
    mesh = trimesh.load(io.BytesIO(data), file_type="ply", process=False)
    assert isinstance(mesh, trimesh.Trimesh)
    count = len(document["outer"]["vertices"])
    assert np.array_equal(mesh.vertices[:count], document["outer"]["vertices"])
    assert np.array_equal(mesh.vertices[count:], document["inner"]["vertices"])
    triangles = len(document["outer"]["triangles"])
    assert np.array_equal(mesh.faces[:triangles], document["outer"]["triangles"])
    assert np.array_equal(mesh.faces[triangles:] - count, document["inner"]["triangles"])
    assert mesh.is_watertight
    assert mesh.body_count == 2
    colours = mesh.visual.vertex_colors[:, :3]
    assert np.array_equal(colours[:count], np.broadcast_to((230, 159, 0), (count, 3)))
    assert np.array_equal(colours[count:], np.broadcast_to((0, 114, 178), (count, 3)))
    sheet = mesh.metadata["_ply_raw"]["vertex"]["data"]["sheet"].ravel()
    assert np.array_equal(sheet, np.repeat((0, 1), count))


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["unobtainium"], "mineral: no mineral 'unobtainium'; "),
        ([""], "mineral: no mineral ''"),
        (["calcite", "--kind", "rays"], "--kind: must be one of index, ray, not 'rays'"),
        (["calcite", "--wavelength-nm", "50"], "--wavelength-nm: the indices of calcite are known from 204 to 2172 nm"),
        (
            ["calcite", "--wavelength-nm", "nan"],
            "--wavelength-nm: the indices of calcite are known from 204 to 2172 nm",
        ),
        (["calcite", "--wavelength-nm", "-589"], "--wavelength-nm: the indices of calcite "),
        (["calcite", "--wavelength-nm", "red"], "Invalid value for '--wavelength-nm': "),
        (["calcite", "--resolution", "1"], "Invalid value for '--resolution': "),
        (["calcite", "--resolution", "100000"], "Invalid value for '--resolution': "),
        (["calcite", "--resolution", "2.5"], "Invalid value for '--resolution': "),
        (["calcite", "--out", "calcite.stl"], "--out: must end in .ply or .json, not 'calcite.stl'"),
        (["calcite", "--out", "calcite"], "--out: must end in .ply or .json, not 'calcite'"),
        (["calcite", "--out", ""], "--out: must end in .ply or .json, not ''"),
        (["calcite", "--out", "none/calcite.ply"], "--out: none/calcite.ply cannot be written: No such file"),
        (["calcite", "--out", "folder.ply"], "--out: folder.ply cannot be written: Is a directory"),
        (["calcite", "--out", "file/a.json"], "--out: file/a.json cannot be written: Not a directory"),
        (["calcite", "--out", "x" * 300 + ".ply"], "--out: xxxxx"),
        (["calcite", "--out", "a\0b.ply"], "--out: 'a\\x00b.ply' cannot be written: "),
        ([], "Missing argument"),
        (["calcite", "quartz"], "Got unexpected extra argument"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_made(
    capsys: pytest.CaptureFixture[str], arguments: list[str], line: str
) -> None:
    Path("folder.ply").mkdir()
    Path("file").write_bytes(b"")
    before = sorted(Path().rglob("*"))
    assert run(["wave-surface", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"isogyre: {line}")
    assert err.count("\n") == 1
    assert sorted(Path().rglob("*")) == before


def test_a_full_disk_leaves_the_old_file(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    Path("calcite.ply").write_bytes(b"old")

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    assert run(["wave-surface", "calcite", "--resolution", "2", "--out", "calcite.ply"]) == 1
    assert capsys.readouterr().err == "isogyre: a file: No space left on device\n"
    assert [(p.name, p.read_bytes()) for p in Path().iterdir()] == [("calcite.ply", b"old")]


def test_the_help_tells_of_both_formats_and_loads_nothing_slow() -> None:
    script = """
import sys
from service.cli import run
assert run(["wave-surface", "--help"]) == 0
slow = {"numpy", "scipy", "fastapi", "distributed", "sqlalchemy", "PIL", "trimesh"} & set(sys.modules)
assert not slow, slow
"""
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, timeout=60)
    text = " ".join(done.stdout.decode().split())
    for part in (
        "JSON on stdout",
        "PLY (binary) holds both sheets",
        "By Loose Parts",
        "[default: 589.3]",
        "--resolution",
    ):
        assert part in text


def test_a_reader_may_leave_early() -> None:
    script = "import sys; from service.cli import run; sys.exit(run(['wave-surface', 'calcite']))"
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.read(10)
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(timeout=60) == 0
