"""Gets a worker process ready, so that the first picture that somebody waits for does not wait for it."""

from __future__ import annotations

from crystal_core import sequence

__all__ = ["warm_up"]


def warm_up() -> None:
    """Render a very small frame of every demonstration: modules, tables and the page's print are then at hand."""
    for name in sequence.demonstrations():
        request = sequence.parse_request({"demonstration": name, "size": [16, 16], "quality": "draft", "frames": 1})
        sequence.render_tile(request, 0, 0)
