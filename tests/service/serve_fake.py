"""Serves the stand-in of the renderer: ``python -m tests.service.serve_fake HOST PORT``; settings as ever."""

from __future__ import annotations

import sys

from crystal_core import sequence
from service import workshop
from service.serve import run
from service.settings import load_settings
from tests.service import fake_sequence

if __name__ == "__main__":
    for name in fake_sequence.NAMES:
        setattr(sequence, name, getattr(fake_sequence, name))
    workshop.warm_up = fake_sequence.stay_cold
    run(sys.argv[1], int(sys.argv[2]), load_settings())
