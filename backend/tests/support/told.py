"""Texts as readers of other languages are told them."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from pydantic import TypeAdapter

from sequence_planner.texts.message import PLACE, Argument, Message

PAGE = Path(__file__).parents[3] / "frontend" / "src" / "lib" / "text"
FILES = ("front", "messages", "findings")


@cache
def texts(language: str) -> Mapping[str, str]:
    """The texts of the page in a language."""
    found: dict[str, str] = {}
    for name in FILES:
        found |= json.loads((PAGE / language / f"{name}.json").read_text(encoding="utf-8"))
    return found


def made_of(argument: Argument) -> Iterator[Message]:
    """A message, and those that stand in it."""
    if isinstance(argument, Message):
        yield argument
        for each in argument.arguments.values():
            yield from made_of(each)
    elif isinstance(argument, list | tuple):
        for each in argument:
            yield from made_of(each)


def as_message(said: str) -> Message:
    """What is said, which has to be a message that the page has in Swedish, with all that it is made of, and that reads
    in another process as here.
    """
    assert isinstance(said, Message), said
    for each in made_of(said):
        swedish = texts("sv")[each.id]
        assert {place[1] for place in PLACE.finditer(swedish)} <= each.arguments.keys(), each.id
    kept = TypeAdapter(Message)
    assert kept.validate_json(kept.dump_json(said)) == said
    return said
