"""The tool that matches colours, which is a script and no module of a package."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from typing import Any

__all__ = ["RECIPES", "TOOL"]


def _load() -> Any:
    path = Path(__file__).resolve().parents[2] / "tools" / "fit_colours.py"
    spec = importlib.util.spec_from_file_location("fit_colours", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["fit_colours"] = module  # its dataclasses look themselves up there
    spec.loader.exec_module(module)
    return module


TOOL: Any = _load()
RECIPES: Path = TOOL.RECIPES
