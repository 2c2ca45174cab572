"""Render the pictures of the docs by the commands that stand in them.

    python tools/make_pictures.py

runs the installed command `isogyre` and copies what it makes to docs/pictures.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PICTURES = ROOT / "docs" / "pictures"

RENDERED = {
    # The pictures of README.md, by the commands that stand there.
    "rotating-calcite.webp": ("rotating-calcite", "sequence.webp"),
    "tanzanite.webp": (
        "rotating-calcite --set mineral=tanzanite --set analyser_deg=0 --set first_angle_deg=45"
        " --frames 24 --size 320x320",
        "sequence.webp",
    ),
    "ruby.png": ("docs/scenes/ruby.yaml", "frame-0000.png"),
    "calcite-over-page.png": ("docs/scenes/calcite-over-page.yaml --size 400x400", "frame-0000.png"),
    # That of docs/tour.md: the same bits as the program's.
    "tour.png": ("rotating-calcite --set first_angle_deg=40 --frames 1 --size 320x320", "frame-0000.png"),
}
"""What follows ``isogyre render``, in the project's folder, and which of its files is the picture."""


def main() -> None:
    """Render and copy every picture."""
    command = Path(sys.executable).with_name("isogyre")
    for name, (arguments, file) in RENDERED.items():
        with tempfile.TemporaryDirectory() as out:
            subprocess.run([command, "render", *arguments.split(), "--out", out], check=True, cwd=ROOT)
            shutil.copyfile(Path(out) / file, PICTURES / name)


if __name__ == "__main__":
    main()
