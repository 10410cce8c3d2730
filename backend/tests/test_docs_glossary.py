"""The glossary has every word once, in order, with a sentence and a source that is listed."""

from __future__ import annotations

import re

from support.places import DOCS

PAGE = DOCS / "glossary.md"
TERMS, SOURCES = (
    [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines() if line.startswith("| ")]
    for part in PAGE.read_text(encoding="utf-8").split("## Sources")
)
FIELDS = {"control", "planning", "robotics", "manufacturing", "web"}


def test_each_word_is_there_once_in_order() -> None:
    words = [term.casefold() for term, *_ in TERMS[1:]]
    assert words == sorted(set(words))
    assert len(words) >= 120


def test_each_is_said_in_one_sentence_and_has_a_source() -> None:
    listed = {name for name, _ in SOURCES[1:]}
    assert TERMS[0] == ["term", "field", "meaning", "here", "source"]
    for term, field, meaning, _, source in TERMS[1:]:
        assert field in FIELDS, term
        assert re.fullmatch(r"[A-Z][^.]*\.", meaning), term
        assert source in listed, term


def test_each_source_is_listed_once_in_order_and_used() -> None:
    names = [name for name, _ in SOURCES[1:]]
    assert [name.casefold() for name in names] == sorted({name.casefold() for name in names})
    assert set(names) == {source for *_, source in TERMS[1:]}
