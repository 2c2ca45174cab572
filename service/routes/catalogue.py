"""What there is to render."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter

from crystal_core import sequence

__all__ = ["router"]

router = APIRouter(prefix="/v1", tags=["catalogue"])


@router.get("/demonstrations", summary="What can be rendered", response_model=dict[str, Any])
def demonstrations() -> dict[str, Any]:
    """Return every demonstration with the JSON Schema of its parameters and their defaults."""
    return {
        "demonstrations": [
            {
                "name": demonstration.name,
                "title": demonstration.title,
                "summary": demonstration.summary,
                "parameters": demonstration.Parameters.model_json_schema(),
            }
            for demonstration in sequence.demonstrations().values()
        ]
    }
