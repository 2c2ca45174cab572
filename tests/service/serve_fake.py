"""Serves the stand-in of the renderer: ``python serve_fake.py HOST PORT``, settings from the environment."""

from __future__ import annotations

import sys

import fake_sequence

from crystal_core import sequence
from service.serve import run
from service.settings import load_settings

if __name__ == "__main__":
    for name in fake_sequence.NAMES:
        setattr(sequence, name, getattr(fake_sequence, name))
    run(sys.argv[1], int(sys.argv[2]), load_settings())
