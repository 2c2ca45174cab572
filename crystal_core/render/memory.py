"""The C library's habit of handing memory back, turned off while rendering."""

from __future__ import annotations

import ctypes
from functools import lru_cache

__all__ = ["keep_freed_memory"]

M_TRIM_THRESHOLD, M_TOP_PAD, M_MMAP_THRESHOLD = -1, -2, -3
KEPT_BYTES = 256 * 1024 * 1024


@lru_cache(maxsize=1)
def keep_freed_memory() -> bool:
    """Ask glibc to keep freed arrays for the next ones; return whether it could be asked.

    The arrays of a batch are of the size at which glibc returns every freed one to the system and has the next one
    faulted in page by page: that costs three times as much as the arithmetic on it. Other C libraries are left alone.
    """
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError):
        return False
    settings = (M_TRIM_THRESHOLD, M_TOP_PAD, M_MMAP_THRESHOLD)
    return all(mallopt(setting, KEPT_BYTES if setting != M_TOP_PAD else KEPT_BYTES // 4) == 1 for setting in settings)
