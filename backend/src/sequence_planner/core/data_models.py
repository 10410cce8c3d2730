"""Data models: what is written as JSON and read again, and messages on what pydantic has found wrong with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError


class DataModel(BaseModel):
    """Base of data models: immutable, and nothing beside what is declared. The validator of one is built when it is
    first used: a process has use for few of all that it imports. (Bodies of requests are none: FastAPI builds theirs
    at once.)
    """

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


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
