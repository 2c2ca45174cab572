"""Whether the service lives and works."""

from __future__ import annotations

from fastapi import APIRouter
from sqlalchemy.exc import SQLAlchemyError

from service.problems import ProblemError
from service.routes.common import TheWorkshop, problem_answers

__all__ = ["router"]

router = APIRouter(tags=["health"])


@router.get("/healthz", summary="Whether the process answers")
async def healthz() -> dict[str, str]:
    """Answer whatever else is the matter: a process that does not is to be started again."""
    return {"status": "ok"}


@router.get("/readyz", summary="Whether renders are accepted", responses=problem_answers(503))
def readyz(workshop: TheWorkshop) -> dict[str, str]:
    """Answer 200 while renders are accepted and worked on, 503 otherwise."""
    try:
        trouble = workshop.check()
    except SQLAlchemyError as error:
        trouble = f"The ledger cannot be read: {error}"
    if trouble is not None:
        raise ProblemError(503, "not-ready", trouble, headers={"Retry-After": "5"})
    return {"status": "ready"}
