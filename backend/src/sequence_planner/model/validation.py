"""What is wrong with the form of a document, said in its own words.

pydantic finds it; here its findings get their place in the file, and those about one entry become one.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from sequence_planner.complaints import complained
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.reading import Document, EntryPath
from sequence_planner.model.source import Finding

# What was expected, by the first word of pydantic's name for the error.
_EXPECTED = {
    "is": "a text",
    "string": "a text",
    "bool": "true or false",
    "int": "an integer",
    "float": "a number",
    "finite": "a finite number",
    "list": "a list",
    "tuple": "a list",
    "dict": "names with their definitions",
    "mapping": "names with their definitions",
    "model": "names with their definitions",
}


def findings_of(error: ValidationError, document: Document, at: EntryPath, kind: type[BaseModel]) -> list[Finding]:
    """The findings of `error`, which came of reading the entry of `document` at `at` as a `kind`."""
    findings: list[Finding] = []
    expected: dict[tuple[Place, str], dict[str, None]] = {}
    for details in error.errors():
        path = (*at, *map(_step, details["loc"]))
        if message := _said(details, kind):
            about_name = details["type"] in ("extra_forbidden", "missing")
            findings.append(Finding(document.place(path) if about_name else document.place_of_value(path), message))
        else:
            place = document.place_of_value(path)
            # Each branch of a union complains; together they say what would be right.
            expected.setdefault((place, shown(details["input"])), {})[_expectation(details)] = None
    merged = [
        Finding(place, f"expected {' or '.join(wants)}, found {found}") for (place, found), wants in expected.items()
    ]
    return [*findings, *merged]


def complaint(error: ValidationError, kind: type[BaseModel]) -> str:
    """What is wrong with something that was read as a `kind` and has no place in a file, in one line."""
    said: dict[str, None] = {}
    expected: dict[str, dict[str, None]] = {}
    for details in error.errors():
        if message := _said(details, kind):
            said[message] = None
        else:
            expected.setdefault(shown(details["input"]), {})[_expectation(details)] = None
    return "; ".join([*said, *(f"expected {' or '.join(wants)}, found {found}" for found, wants in expected.items())])


def _step(part: str | int) -> str | int:
    return str(part) if isinstance(part, str) else part


def _said(details: ErrorDetails, kind: type[BaseModel]) -> str | None:
    """The whole message for an error that is not about the type of a value."""
    name = str(details["loc"][-1]) if details["loc"] else ""
    match details["type"]:
        case "extra_forbidden":
            return f"`{name}` is not known here{suggestion(name, _fields_at(kind, details['loc'][:-1]))}"
        case "missing":
            return f"`{name}` is missing here"
        case "value_error" | "assertion_error":
            return complained(details)
    return None


def _expectation(details: ErrorDetails) -> str:
    limits = details.get("ctx", {})
    match details["type"]:
        case "literal_error":
            return str(limits["expected"]).replace("'", "`")
        case "greater_than":
            return f"a number greater than {limits['gt']:g}"
        case "greater_than_equal":
            return f"a number of at least {limits['ge']:g}"
        case "less_than_equal":
            return f"a number of at most {limits['le']:g}"
        case "too_short":
            least = limits["min_length"]
            return "at least one entry" if least == 1 else f"at least {least} entries"
        case "too_long":
            return f"at most {limits['max_length']} entries"
        case other:
            return _EXPECTED.get(other.partition("_")[0], details["msg"])


def shown(value: object) -> str:
    """What was found, in a few words."""
    match value:
        case None:
            return "nothing"
        case bool():
            return str(value).lower()
        case str() | int() | float():
            text = str(value)
            return f"`{text if len(text) <= 60 else text[:57] + '...'}`"
        case list():
            return "a list" if value else "an empty list"
    return "a mapping"


def _fields_at(kind: type[BaseModel], path: Iterable[str | int]) -> list[str]:
    """The names that the part of a document at `path` may have."""
    parts: list[Any] = [kind]
    for step in path:
        parts = [inner for part in parts for inner in _inner(part, step)]
    return [field.alias or name for part in parts for name, field in part.model_fields.items()]


def _inner(part: type[BaseModel], step: str | int) -> list[Any]:
    """The document parts to which one step from `part` can lead."""
    for name, field in part.model_fields.items():
        if step == (field.alias or name):
            return _parts_in(field.annotation)
    return [part]  # a key or an index of the container just stepped into


def _parts_in(annotation: object) -> list[Any]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for argument in getattr(annotation, "__args__", ()) for found in _parts_in(argument)]
