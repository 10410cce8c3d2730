"""Bodies of requests that may be large: each is read by the process that does what it asks for.

To read a body of some megabytes takes its reader longer than a stop may wait.
"""

from __future__ import annotations

import json
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

Asked = TypeVar("Asked", bound=BaseModel)


class BodyError(Exception):
    """A body that is not as expected; `errors` are those of a `ValidationError`, with `body` before each place."""

    def __init__(self, errors: list[dict[str, Any]]) -> None:
        super().__init__(errors)
        self.errors = errors


def read_body(model: type[Asked], body: bytes) -> Asked:
    """What a body asks for. Raises `BodyError`."""
    if not body:
        raise BodyError([{"type": "missing", "loc": ("body",), "msg": "Field required"}])
    try:
        content = json.loads(body)
    except json.JSONDecodeError as error:
        raise _not_json(error.msg, error.pos) from None
    except UnicodeDecodeError as error:
        raise _not_json("this is not UTF-8", error.start) from None
    except RecursionError:
        raise _not_json("it is nested too deeply", 0) from None
    try:
        return model.model_validate(content)
    except ValidationError as error:
        found = error.errors(include_url=False, include_context=False, include_input=False)
        raise BodyError([{**each, "loc": ("body", *each["loc"])} for each in found]) from None


def _not_json(why: str, position: int) -> BodyError:
    return BodyError(
        [{"type": "json_invalid", "loc": ("body", position), "msg": "JSON decode error", "ctx": {"error": why}}]
    )
