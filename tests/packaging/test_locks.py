"""The locks pin every requirement with hashes and name no host."""

from __future__ import annotations

import re
import tomllib

import pytest

from tests.packaging.sources import ROOT, pins

LOCKS = ("runtime.txt", "build.txt", "test.txt", "benchmark.txt")


def declared() -> dict[str, list[str]]:
    """Return the names that pyproject.toml requires: of the runtime, the build, the tests, the benchmarks."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)
    requirements = {
        "runtime.txt": project["project"]["dependencies"],
        "build.txt": project["build-system"]["requires"],
        "test.txt": project["project"]["dependencies"] + project["project"]["optional-dependencies"]["test"],
        "benchmark.txt": project["project"]["optional-dependencies"]["benchmark"],
    }
    return {
        lock: [re.split(r"[^A-Za-z0-9._-]", line)[0].lower() for line in lines] for lock, lines in requirements.items()
    }


@pytest.mark.parametrize("lock", LOCKS)
def test_no_host(lock: str) -> None:
    text = (ROOT / "requirements" / lock).read_text(encoding="utf-8")
    assert not re.search(r"https?:|--(extra-)?index-url|--find-links|--trusted-host|@ ", text)


@pytest.mark.parametrize("lock", LOCKS)
def test_every_requirement_has_hashes(lock: str) -> None:
    text = (ROOT / "requirements" / lock).read_text(encoding="utf-8").replace("\\\n", " ")
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    assert lines
    assert not [line for line in lines if "==" not in line or "--hash=sha256:" not in line]


@pytest.mark.parametrize("lock", LOCKS)
def test_what_the_project_declares_is_locked(lock: str) -> None:
    assert not set(declared()[lock]) - set(pins(lock))


def test_tests_run_on_the_versions_that_are_shipped() -> None:
    runtime, test = pins("runtime.txt"), pins("test.txt")
    assert {name: test.get(name) for name in runtime} == runtime
