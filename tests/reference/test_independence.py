"""No package of ours rests on the tools that it is tested with: pyElli is under the GPL, prtLab is a yardstick."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
YARDSTICKS = {"elli", "pyelli", "prtlab", "mpmath", "hypothesis", "numba", "llvmlite", "tests"}


def imported(source: str) -> set[str]:
    """Return the top-level names that a module imports, by statement or by name through importlib or __import__."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.partition(".")[0])
        elif isinstance(node, ast.Call) and node.args and isinstance(node.args[0], ast.Constant):
            called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if called in ("import_module", "__import__", "find_spec", "importorskip"):
                names.add(str(node.args[0].value).partition(".")[0])
    return names


@pytest.mark.parametrize("package", ["crystal_core", "minerals_db", "service"])
def test_no_package_imports_a_yardstick(package: str) -> None:
    modules = sorted((ROOT / package).rglob("*.py"))
    assert len(modules) > 3
    for module in modules:
        assert not imported(module.read_text(encoding="utf-8")) & YARDSTICKS, module


def test_the_scan_sees_imports() -> None:
    """The scan would find them: it does in the tests, and in every way of writing an import."""
    found = set().union(*(imported(m.read_text(encoding="utf-8")) for m in (ROOT / "tests/reference").glob("*.py")))
    assert {"elli", "prtlab", "mpmath", "tests"} <= found
    for line in (
        "import elli.materials as e",
        "from elli.plot import x",
        "import_module('elli')",
        "__import__('elli')",
    ):
        assert imported(f"def f():\n    {line}") == {"elli"}


def test_who_installs_the_project_gets_none_of_them() -> None:
    lock = (ROOT / "requirements/runtime.txt").read_text(encoding="utf-8")
    installed = {name.lower() for name in re.findall(r"^([\w.-]+)==", lock, re.MULTILINE)}
    assert "numpy" in installed
    assert not installed & YARDSTICKS
