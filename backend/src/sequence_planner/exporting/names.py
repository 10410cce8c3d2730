"""Names that other notations can have, each different from all others."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Hashable, Iterable
from typing import TypeVar

from sequence_planner.expressions.lexer import KEYWORDS

T = TypeVar("T", bound=Hashable)

_SIGNS = re.compile(r"[^A-Za-z0-9_]+")


def word(name: str) -> str:
    """A word of letters, digits and `_` that resembles `name`: `bolts[left]` becomes `bolts_left`."""
    text = _SIGNS.sub("_", name).strip("_") if _SIGNS.search(name) else name
    return text if re.match(r"[A-Za-z_]", text) else f"n_{text}"


def dotted(name: str) -> str:
    """Words joined by dots that resemble `name`, none of them a word of the expression language."""
    parts = map(word, re.split(r"\.(?![^(\[]*[)\]])", name))
    return ".".join(f"{part}_" if part in KEYWORDS else part for part in parts)


def different(names: Iterable[T], form: Callable[[T], str], taken: Collection[str] = ()) -> dict[T, str]:
    """For each name one of that form that neither another one nor `taken` has: a number behind it makes it so."""
    found: dict[T, str] = {}
    used = set(taken)
    for name in dict.fromkeys(names):
        wanted = free = form(name)
        number = 1
        while free in used:
            number += 1
            free = f"{wanted}_{number}"
        used.add(free)
        found[name] = free
    return found
