"""Data models: what is written as JSON and read again, and messages on what pydantic has found wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, ValidationError


class DataModel(BaseModel):
    """Base of data models: immutable, and nothing beside what is declared. The validator of one is built when it is
    first used: a process has use for few of all that it imports. (Bodies of requests are none: FastAPI builds theirs
    at once.)
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


# What was expected, by pydantic's name for the error or by the first word of it.
_EXPECTED: Final = {
    "bool": "true or false",
    "bytes": "a text",
    "date": "a date",
    "datetime": "a date and a time",
    "dict": "an object with named members",
    "finite": "a finite number",
    "float": "a number",
    "frozen": "a list",
    "int": "an integer",
    "is": "a text",
    "list": "a list",
    "mapping": "an object with named members",
    "model": "an object with named members",
    "none": "null",
    "set": "a list",
    "string": "a text",
    "string_unicode": "a text that UTF-8 can write, without half of a surrogate pair",
    "tuple": "a list",
    "url": "an address",
    "uuid": "a UUID",
}


def expectation(details: Mapping[str, Any], others: Mapping[str, str] | None = None) -> str:
    """What was expected where pydantic found an error, as in `a text`; `others` say some of it in other words."""
    limits, kind = details.get("ctx", {}), details["type"]
    match kind:
        case "literal_error" | "enum":
            return str(limits["expected"]).replace("'", "`")
        case "union_tag_invalid":
            return f"{limits['discriminator']} to be one of {limits['expected_tags']}".replace("'", "`")
        case "greater_than":
            return f"a number greater than {limits['gt']:g}"
        case "greater_than_equal":
            return f"a number of at least {limits['ge']:g}"
        case "less_than":
            return f"a number less than {limits['lt']:g}"
        case "less_than_equal":
            return f"a number of at most {limits['le']:g}"
        case "string_too_short":
            return f"a text of at least {_counted(limits['min_length'], 'character', 'characters')}"
        case "string_too_long":
            return f"a text of at most {_counted(limits['max_length'], 'character', 'characters')}"
        case "string_pattern_mismatch":
            return f"a text like `{limits['pattern']}`"
        case "too_short":
            least = limits["min_length"]
            return "at least one entry" if least == 1 else f"at least {least} entries"
        case "too_long":
            return f"at most {_counted(limits['max_length'], 'entry', 'entries')}"
    first = kind.partition("_")[0]
    found = (words.get(key) for key in (kind, first) for words in (others or {}, _EXPECTED))
    return next((words for words in found if words is not None), details["msg"])


def complained(details: Mapping[str, Any]) -> str:
    """What one of pydantic's errors says, as in its `ErrorDetails`: what our own validators say without the name of the
    exception that pydantic writes before it, and of others what was expected.
    """
    match details["type"]:
        case "value_error" | "assertion_error":
            return str(details["msg"]).partition(", ")[2]
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


def _counted(number: int, one: str, several: str) -> str:
    return f"{number} {one if number == 1 else several}"
