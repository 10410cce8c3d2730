"""Data models: what is written as JSON and read again, and messages on what pydantic has found wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, ValidationError

from sequence_planner.texts.message import Message, message


class DataModel(BaseModel):
    """Base of data models: immutable, and nothing beside what is declared. The validator of one is built when it is
    first used: a process has use for few of all that it imports. (Bodies of requests are none: FastAPI builds theirs
    at once.)
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


# What was expected, by pydantic's name for the error or by the first word of it.
_EXPECTED: Final = {
    "bool": "truth-value",
    "bytes": "text",
    "date": "date",
    "datetime": "moment",
    "dict": "object",
    "finite": "finite",
    "float": "number",
    "frozen": "list",
    "int": "integer",
    "is": "text",
    "list": "list",
    "mapping": "object",
    "model": "object",
    "none": "null",
    "set": "list",
    "string": "text",
    "string_unicode": "unicode",
    "tuple": "list",
    "url": "address",
    "uuid": "uuid",
}


def expectation(details: Mapping[str, Any], others: Mapping[str, str] | None = None) -> str:
    """What was expected where pydantic found an error, as in `a text`; `others` call some of it otherwise."""
    limits, kind = details.get("ctx", {}), details["type"]
    match kind:
        case "literal_error" | "enum":
            return _one_of(str(limits["expected"]).replace("'", "`"))
        case "union_tag_invalid":
            return f"{limits['discriminator']} to be one of {limits['expected_tags']}".replace("'", "`")
        case "greater_than":
            return message("expected.greater", than=f"{limits['gt']:g}")
        case "greater_than_equal":
            return message("expected.at-least", least=f"{limits['ge']:g}")
        case "less_than":
            return message("expected.less", than=f"{limits['lt']:g}")
        case "less_than_equal":
            return message("expected.at-most", most=f"{limits['le']:g}")
        case "string_too_short":
            return message("expected.longer", count=limits["min_length"])
        case "string_too_long":
            return message("expected.shorter", count=limits["max_length"])
        case "string_pattern_mismatch":
            return message("expected.like", pattern=limits["pattern"])
        case "too_short":
            least = limits["min_length"]
            return message("expected.an-entry") if least == 1 else message("expected.entries", least=least)
        case "too_long":
            return message("expected.most-entries", count=limits["max_length"])
    first = kind.partition("_")[0]
    found = (words.get(key) for key in (kind, first) for words in (others or {}, _EXPECTED))
    called = next((each for each in found if each is not None), None)
    return details["msg"] if called is None else message(f"expected.{called}")


def _one_of(written: str) -> str:
    """Values as pydantic lists them: `a`, `b` or `c`."""
    most, _, last = written.rpartition(" or ")
    return message("list.or", most=most, last=last) if most else written


def complained(details: Mapping[str, Any]) -> str:
    """What one of pydantic's errors says, as in its `ErrorDetails`: what our own validators say without the name of the
    exception that pydantic writes before it, and of others what was expected.
    """
    match details["type"]:
        case "value_error" | "assertion_error":
            said = next(iter(getattr(details.get("ctx", {}).get("error"), "args", ())), None)
            return said if isinstance(said, Message) else str(details["msg"]).partition(", ")[2]
        case "extra_forbidden":
            return "this is not known here"
        case "missing":
            return "this is missing"
        case "union_tag_not_found":
            return f"{details['ctx']['discriminator']} is missing".replace("'", "`")
    return f"expected {expectation(details)}"


def in_a_line(error: ValidationError) -> str:
    """The first few of the errors, each with its place."""
    found = error.errors(include_url=False, include_input=False)[:5]
    return "; ".join(f"{'.'.join(map(str, each['loc'])) or 'it'}: {complained(each)}" for each in found)
