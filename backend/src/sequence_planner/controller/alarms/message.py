"""A text for people as what it says and with which arguments, so that each reader gets it in their language."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Final

from typing_extensions import TypeAliasType

from sequence_planner.controller.alarms.texts import TEXTS

# `{name}`, or `{name|waits|wait}` for what is said of one and of several.
PLACE: Final = re.compile(r"\{(\w+)(?:\|([^|}]*)\|([^|}]*))?\}")
_NAMED = 3  # of a list so many are named, and the others counted

Item = TypeAliasType("Item", "str | int | float | Message | Wording")
Argument = TypeAliasType("Argument", "Item | Sequence[Item]")


@dataclass(frozen=True)
class Message:
    """The text `id` of the catalogue, with `arguments` in its places. As a string it is in English."""

    id: str
    arguments: Mapping[str, Argument] = field(default_factory=dict)

    def __str__(self) -> str:
        """Return it in English."""
        return PLACE.sub(self._at, TEXTS[self.id])

    def _at(self, place: re.Match[str]) -> str:
        name, one, several = place.groups()
        argument = self.arguments[name]
        if one is None:
            return in_english(argument)
        assert isinstance(argument, int | float | Sequence) and not isinstance(argument, str)
        return one if (argument if isinstance(argument, int | float) else len(argument)) == 1 else several


@dataclass(frozen=True)
class Wording:
    """A text in the words of who has written the model, by language."""

    words: Mapping[str, str]

    def __str__(self) -> str:
        """Return it in English, or in the first language that there is."""
        return self.words.get("en") or next(iter(self.words.values()), "")


@cache
def places(id: str, /) -> tuple[str, ...]:
    """The names of the arguments that a text of the catalogue has a place for."""
    return tuple(dict.fromkeys(place[1] for place in PLACE.finditer(TEXTS[id])))


def message(id: str, /, **arguments: Argument) -> Message:
    """A text of the catalogue, with what stands in its places."""
    return Message(id, arguments)


def in_english(argument: Argument) -> str:
    """An argument in English."""
    if isinstance(argument, float):
        return f"{argument:g}"
    if isinstance(argument, Sequence) and not isinstance(argument, str):
        return listed(argument)
    return str(argument)


def listed(items: Collection[Item]) -> str:
    """As in `a, b and c`, or with how many others there are; in English."""
    every = [in_english(item) for item in items]
    if len(every) > _NAMED + 1:
        every = [*every[:_NAMED], str(message("list.more", count=len(every) - _NAMED))]
    return str(message("list.and", most=", ".join(every[:-1]), last=every[-1])) if len(every) > 1 else "".join(every)


def quoted(titles: Collection[str]) -> list[Item]:
    """Titles, each in the quotes of the language."""
    return [message("quoted", title=title) for title in titles]


def as_it_was(said: Message | str) -> Message:
    """A text of a record, which programs of before wrote in English alone."""
    return said if isinstance(said, Message) else message("as-it-was", text=said)
