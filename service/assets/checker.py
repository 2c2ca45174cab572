"""A process that reads one asset and ends: whatever is in the file, it can take neither memory nor time beyond limits.

``python -m service.assets.checker SUFFIX`` reads the file from stdin and writes one line of JSON: ``{"kind", "facts",
"notes"}``, or ``{"refused": reason}``.
"""

from __future__ import annotations

import json
import resource
import sys

__all__ = ["CPU_S", "MEMORY_BYTES", "main"]

MEMORY_BYTES = 2 * 1024**3
CPU_S = 30


def main() -> None:
    """Check what comes on stdin."""
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY_BYTES, MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_S, CPU_S))
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))  # it has nothing to write
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    from crystal_core.errors import InputError
    from service.assets.facts import read_facts

    answer: dict[str, object]
    try:
        found = read_facts(sys.stdin.buffer.read(), sys.argv[1])
    except InputError as error:
        answer = {"refused": "; ".join(fault.message for fault in error.faults)}
    except MemoryError:
        answer = {"refused": f"reading it takes more than {MEMORY_BYTES // 1024**2} MiB of memory"}
    else:
        answer = {"kind": found.kind, "facts": found.facts, "notes": list(found.notes)}
    print(json.dumps(answer, allow_nan=False))


if __name__ == "__main__":
    main()
