"""What holds for the files of the checkout: the two commands, short files, no place of one machine."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tomllib

import pytest

from tests.packaging.sources import PACKAGES, ROOT, all_files, source_files

MAX_LINES = 400


def dry_run(target: str, makefile: str = "Makefile") -> str:
    """Return what `make` would do for a target in a checkout where nothing is installed."""
    make = shutil.which("make")
    assert make is not None, "the two commands need make"
    done = subprocess.run(
        [make, "--dry-run", "--always-make", "-f", makefile, target],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        env={key: value for key, value in os.environ.items() if key not in {"MAKEFLAGS", "MAKELEVEL", "PORT"}},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_make_install_sets_up_from_the_locks() -> None:
    commands = dry_run("install")
    assert "-m venv .venv" in commands
    assert "--require-hashes -r requirements/runtime.txt -r requirements/build.txt" in commands
    assert "--no-deps --no-build-isolation --editable ." in commands
    assert "requirements/test.txt" not in commands


def test_make_demo_installs_and_serves_on_loopback() -> None:
    commands = dry_run("demo")
    assert dry_run("install") in commands
    assert commands.splitlines()[-1] == ".venv/bin/isogyre serve --host 127.0.0.1 --port 8000"


@pytest.mark.parametrize(("target", "ends"), [("test", '-m pytest -m "not full"'), ("test-all", "-m pytest")])
def test_make_test_checks_and_tests(target: str, ends: str) -> None:
    commands = dry_run(target)
    for tool in ("ruff check .", "ruff format --check .", "mypy", "lint-imports"):
        assert f".venv/bin/{tool}\n" in commands
    assert commands.rstrip().endswith(ends)


def test_continuous_integration_runs_make_test_with_a_browser() -> None:
    script = ROOT / ".ci" / "run"
    assert os.access(script, os.X_OK)
    text = script.read_text(encoding="utf-8")
    assert "install -y -qq --no-install-recommends chromium" in text
    assert "export ISOGYRE_REQUIRE_BROWSER=1" in text
    assert text.rstrip().endswith("make test")


def test_version_is_one() -> None:
    import crystal_core

    with (ROOT / "pyproject.toml").open("rb") as file:
        version = tomllib.load(file)["project"]["version"]
    assert crystal_core.__version__ == version
    assert f"## [{version}]" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_files_are_short() -> None:
    lengths = {
        path.relative_to(ROOT).as_posix(): len(path.read_text(encoding="utf-8").splitlines())
        for path in source_files(*PACKAGES)
        if path.suffix == ".py"
    }
    assert len(lengths) > 50
    assert {name: length for name, length in lengths.items() if length >= MAX_LINES} == {}


# Put together here, so that this file does not name them either.
PLACES = re.compile(r"\.\./" + "shared" + r"|(?<![\w.$}-])/(?:" + "tmp|work|root" + ")/")


def test_no_file_names_a_place_of_one_machine() -> None:
    named = {}
    for path in all_files():
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue  # a picture
        if hits := PLACES.findall(text):
            named[path.relative_to(ROOT).as_posix()] = hits
    assert named == {}


@pytest.mark.parametrize(
    ("text", "caught"),
    [
        (f"see ..{'/shared'}/notes", True),
        (f'open("/{"tmp"}/x")', True),
        (f"/{'root'}/.cache", True),
        ("frame/work/unit", False),
        ("out/tmp/", False),
    ],
)
def test_places_are_recognised(text: str, caught: bool) -> None:
    assert bool(PLACES.search(text)) == caught
