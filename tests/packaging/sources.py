"""The files of the checkout, found without git: a tarball of the sources is tested in the same way."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("crystal_core", "minerals_db", "service")
FOLDERS = (*PACKAGES, "web", "tests", "docs", "tools", "benchmarks", "requirements", ".ci")
TOP_FILES = (
    ".dockerignore",
    ".gitignore",
    "CHANGELOG.md",
    "Dockerfile",
    "LICENSE",
    "Makefile",
    "README.md",
    "pyproject.toml",
)


def source_files(*folders: str) -> Iterator[Path]:
    """Yield the files of folders of the checkout, caches left out, in a fixed order."""
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                yield path


def all_files() -> list[Path]:
    """Return every file of the sources."""
    return [*(ROOT / name for name in TOP_FILES), *source_files(*FOLDERS)]


def pins(lock: str) -> dict[str, str]:
    """Return version by name of the requirements of a lock in ``requirements/``."""
    lines = (ROOT / "requirements" / lock).read_text(encoding="utf-8").splitlines()
    found = {}
    for line in lines:
        if line[:1].isalnum():
            name, version = line.split(" \\")[0].split(";")[0].strip().split("==")
            found[name.lower()] = version
    return found
