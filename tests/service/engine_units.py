"""Functions that worker processes import by name."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path


def add(a: int, b: int) -> int:
    return a + b


def fail(message: str) -> None:
    raise ValueError(message)


def wait_for(path: Path, result: str) -> str:
    deadline = time.monotonic() + 90
    while not path.exists():
        if time.monotonic() > deadline:
            raise TimeoutError(path)
        time.sleep(0.01)
    return result


def note(path: Path, word: str) -> str:
    with path.open("a", encoding="utf-8") as file:
        file.write(word + "\n")
    return word


def surroundings() -> dict[str, object]:
    return {
        "pid": os.getpid(),
        "nice": os.nice(0),
        "threads": os.environ.get("OPENBLAS_NUM_THREADS"),
        "omp": os.environ.get("OMP_NUM_THREADS"),
        "interrupt_blocked": signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, set()),
    }


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)
