"""How long the minerals take to load: in a fresh process each time, without a cache and with one.

``python -m benchmarks.minerals``
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from statistics import median

RUNS = 9

PROGRAM = """
import time
start = time.perf_counter()
import minerals_db
imported = time.perf_counter()
import numpy, pydantic
from pydantic import BaseModel, RootModel
libraries = time.perf_counter()
import minerals_db.library
modules = time.perf_counter()
count = len(minerals_db.minerals())
loaded = time.perf_counter()
print(imported - start, libraries - imported, modules - libraries, loaded - modules, count)
"""

PARTS = (
    "import minerals_db",
    "import NumPy and pydantic (a service has them already)",
    "import the models",
    "load the entries",
)


def main() -> None:
    """Print the median time of each part, ms."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "XDG_CACHE_HOME": cache}
        for kind in ("the first time, from YAML", "from the cache"):
            runs = []
            for _ in range(1 if "first" in kind else RUNS):
                done = subprocess.run(
                    [sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True, check=True
                )
                runs.append([float(number) for number in done.stdout.split()])
            print(f"{int(runs[0][-1])} minerals, {kind}")
            for place, part in enumerate(PARTS):
                print(f"  {1e3 * median(run[place] for run in runs):7.1f} ms  {part}")


if __name__ == "__main__":
    main()
