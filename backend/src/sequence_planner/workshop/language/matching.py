"""How well a name fits what has been typed of it."""

from __future__ import annotations

import re

NO_MATCH = 9
_BEFORE = re.compile(r"[.(\[]")


def likeness(typed: str, name: str) -> int:
    """0 for names that begin with what is typed, more for those that merely contain it, `NO_MATCH` for others."""
    if name.startswith(typed):
        return 0
    low, lower = typed.lower(), name.lower()
    if lower.startswith(low):
        return 1
    at = lower.find(low)
    if at > 0:
        return 2 if lower[at - 1] in "._([" else 3
    if len(low) > 1 and "." not in low and any(_contains_in_order(low, part) for part in _BEFORE.split(lower)):
        return 4
    return NO_MATCH


def _contains_in_order(letters: str, text: str) -> bool:
    if text[:1] != letters[:1]:
        return False
    at = -1
    for letter in letters:
        at = text.find(letter, at + 1)
        if at < 0:
            return False
    return True
