"""Messages on what pydantic has found wrong with a value, as people are told it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

# What pydantic says of these is about Python.
_WORDS = {
    "model_attributes_type": "Input should be an object with named members",
    "string_unicode": "Input should be text that UTF-8 can write, without half of a surrogate pair",
}


def complained(details: Mapping[str, Any]) -> str:
    """The message of one of pydantic's errors, as in its `ErrorDetails`; without the name of the exception, which it
    writes before what our own validators say, and without words of Python.
    """
    message = _WORDS.get(details["type"], str(details["msg"]))
    return message.partition(", ")[2] if details["type"] in ("value_error", "assertion_error") else message


def in_a_line(error: ValidationError) -> str:
    """The first few of the errors, each with its place."""
    found = error.errors(include_url=False, include_input=False)[:5]
    return "; ".join(f"{'.'.join(map(str, each['loc'])) or 'it'}: {complained(each)}" for each in found)
