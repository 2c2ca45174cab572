"""A probe: what may be asked, what is answered, and how many questions are answered in one go."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from pydantic import BaseModel, ValidationError

from crystal_core.errors import Fault, InputError, IsogyreError
from service.probes.documents import BadDocument, Document
from service.probes.faults import faults_of

__all__ = ["Answer", "Probe", "UnanswerableError", "encode"]

Request = TypeVar("Request", bound=BaseModel)
Answer = dict[str, Any]
"""A JSON object."""


class UnanswerableError(IsogyreError):
    """Some of the documents cannot be answered, so that none is.

    Parameters
    ----------
    documents : sequence of BadDocument
        At least one.
    """

    def __init__(self, documents: Sequence[BadDocument]) -> None:
        self.documents = sorted(documents, key=lambda document: document.line)
        if not self.documents:
            raise ValueError("an UnanswerableError names at least one document")
        first = self.documents[0]
        super().__init__(f"line {first.line}: {first.error}")


@dataclass(frozen=True)
class Probe(Generic[Request]):
    """A question to the optics.

    Parameters
    ----------
    name : str
        Of the command and the route.
    request : type of model
        What may be asked.
    answer : type of model
        What is answered.
    compute : callable
        From requests to an answer each, or the error of a request that has none. No answer depends on the others.
    most_lines : int
        Most questions of one HTTP request.
    """

    name: str
    request: type[Request]
    answer: type[BaseModel]
    compute: Callable[[Sequence[Request]], list[Answer | IsogyreError]]
    most_lines: int

    def ask(self, value: object) -> Answer:
        """Answer one document.

        Raises
        ------
        InputError, NotSupportedError
            It cannot be answered.
        """
        (answer,) = self.compute([self._request(value)])
        if isinstance(answer, IsogyreError):
            raise answer
        return answer

    def ask_all(self, documents: Sequence[Document], bad: Sequence[BadDocument] = ()) -> list[Answer]:
        """Answer many documents, in their order.

        Parameters
        ----------
        documents : sequence of Document
            What is asked.
        bad : sequence of BadDocument
            What is known to be unanswerable already.

        Raises
        ------
        UnanswerableError
            If there is anything wrong with any of them.
        """
        unanswerable = list(bad)
        good: list[tuple[int, Request]] = []
        for document in documents:
            try:
                good.append((document.line, self._request(document.value)))
            except InputError as error:
                unanswerable.append(BadDocument(document.line, error))
        answers = []
        for (line, _), answer in zip(good, self.compute([request for _, request in good]), strict=True):
            if isinstance(answer, IsogyreError):
                unanswerable.append(BadDocument(line, answer))
            else:
                answers.append(answer)
        if unanswerable:
            raise UnanswerableError(unanswerable)
        return answers

    def _request(self, value: object) -> Request:
        if not isinstance(value, dict):
            raise InputError((Fault("", f"must be a JSON object, not {_kind(value)}"),))
        try:
            return self.request.model_validate(value)
        except ValidationError as error:
            raise InputError(faults_of(error)) from None


def encode(answer: Answer) -> str:
    """Return an answer as one line of JSON, every number with all its digits, without the line's end."""
    return json.dumps(answer, allow_nan=False, separators=(",", ":"))


def _kind(value: object) -> str:
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "a truth value"
    return "a list" if isinstance(value, list) else "a text" if isinstance(value, str) else "a number"
