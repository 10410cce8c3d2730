"""Names of a model in plain words, where it gives no title."""

from __future__ import annotations

import re
from typing import Final

_WORD: Final = re.compile(r"[A-Z]+(?![a-z])\d*|[A-Z]?[a-z]+|\d+|[^\W\d_]+")
_LONGEST_ACRONYM: Final = 3  # letters: `TCP` and `AGV` stay as they are, `UNKNOWN` is a word


def in_words(name: str) -> str:
    """`AtBoltPair4TCPPose` → `at bolt pair 4 TCP pose`, `engine_in_place` → `engine in place`."""
    return " ".join(_word(each) for each in _WORD.findall(name)) or name


def within_sentence(text: str) -> str:
    """A title as it stands within a sentence: `Robot UR10` → `robot UR10`, `AGV` and `UR10` as they are."""
    first = text.partition(" ")[0]
    return text if first[1:] != first[1:].lower() or any(map(str.isdigit, first)) else text[:1].lower() + text[1:]


def _word(written: str) -> str:
    letters = written.rstrip("0123456789")
    if letters.isupper() and len(letters) <= _LONGEST_ACRONYM:
        return written
    return f"{letters.lower()} {written[len(letters) :]}".strip() if letters else written
