"""Parameters of a question in texts: an address's query string or a command's options, all faults at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from crystal_core.errors import Fault, InputError
from service.probes.faults import faults_of

__all__ = ["openapi_parameters", "option", "query_parameter", "read_parameters", "single_values"]

Asked = TypeVar("Asked", bound=BaseModel)


def option(name: str) -> str:
    """Return the option that a field has at the command line."""
    return f"--{name.replace('_', '-')}"


def query_parameter(name: str) -> str:
    """Return how a problem points to a parameter of an address."""
    return f"query/{name}"


def read_parameters(model: type[Asked], given: Mapping[str, object], call: Callable[[str], str]) -> Asked:
    """Return what texts ask for.

    Parameters
    ----------
    model : type of model
        What may be asked.
    given : mapping of str to object
        Values by the names of the model's fields.
    call : callable
        From the name of a field to what its reader calls it: `option` or `query_parameter`.

    Raises
    ------
    InputError
        Every fault, with the parameter's name as its pointer.
    """
    try:
        return model.model_validate(given)
    except ValidationError as error:
        raise InputError(_renamed(fault, model, call) for fault in faults_of(error)) from None


def single_values(items: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Return the values of a query string by name.

    Raises
    ------
    InputError
        A name stands there more than once.
    """
    found: dict[str, str] = {}
    repeated: dict[str, None] = {}
    for name, value in items:
        if name in found:
            repeated[name] = None
        found[name] = value
    if repeated:
        raise InputError(Fault(query_parameter(name), "is given more than once") for name in repeated)
    return found


def openapi_parameters(model: type[BaseModel]) -> list[dict[str, Any]]:
    """Return the OpenAPI description of a query string that `read_parameters` reads."""
    return [
        _described(name, schema, model.model_fields[name].is_required())
        for name, schema in model.model_json_schema()["properties"].items()
    ]


def _described(name: str, schema: Mapping[str, Any], required: bool) -> dict[str, Any]:
    schema = {key: value for key, value in schema.items() if key != "title"}
    described = {"name": name, "in": "query", "required": required, "description": schema.pop("description", "")}
    # What is not given is null inside; an address cannot say null.
    if "anyOf" in schema:
        alternatives = [part for part in schema.pop("anyOf") if part.get("type") != "null"]
        schema.pop("default", None)
        schema |= alternatives[0] if len(alternatives) == 1 else {"anyOf": alternatives}
    if schema.get("type") == "array":
        described |= {"style": "form", "explode": False}
    return {**described, "schema": schema}


def _renamed(fault: Fault, model: type[BaseModel], call: Callable[[str], str]) -> Fault:
    name, *place = fault.pointer.removeprefix("/").split("/")
    if name not in model.model_fields:
        name = "/".join((name, *place)).replace("~1", "/").replace("~0", "~")
        return Fault(call(name), f"unknown; there are {', '.join(model.model_fields)}")
    return Fault("/".join((call(name), *place)) if call is query_parameter else call(name), fault.message)
