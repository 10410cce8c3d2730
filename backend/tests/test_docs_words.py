"""The words of the documentation and of the page's English texts: plain ones, in sentences that are read once."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from support.places import DOCS, REPOSITORY

PAGES = [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", *sorted(DOCS.glob("*.md"))]
TEXTS = sorted((REPOSITORY / "frontend" / "src" / "lib" / "text" / "en").glob("*.ts"))
# What nobody says in this field any more, and what they say.
INSTEAD = {
    "adviser": "advisor",
    "anew": "again",
    "came of": "led to",
    "come of": "follow from",
    "comes of": "follows from",
    "manner": "kind",
    "whoever": "anyone who, or who it is",
}
MOST_WORDS = 60  # in a sentence, or what stands between two colons or semicolons


def prose(page: Path) -> str:
    """A page without its code, addresses and tables."""
    text = re.sub(r"^ *```.*?^ *```$", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "`code`", re.sub(r"\]\([^)]*\)", "]", text))


def strings(file: Path) -> str:
    """What stands in quotes in a file of texts."""
    code = re.sub(r"/\*.*?\*/|^\s*//.*?$", "", file.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    quoted = re.findall(r"'((?:[^'\\\n]|\\.)*)'|\"((?:[^\"\\\n]|\\.)*)\"|`((?:[^`\\]|\\.)*)`", code)
    return "\n".join("".join(each) for each in quoted)


def found(text: str) -> dict[str, str]:
    """The words that are not said, each with what is."""
    return {word: said for word, said in INSTEAD.items() if re.search(rf"\b{word}\b", text, re.IGNORECASE)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_pages_have_plain_words(page: Path) -> None:
    assert not found(prose(page))


@pytest.mark.parametrize("file", TEXTS, ids=lambda file: file.name)
def test_texts_of_the_page_have_plain_words(file: Path) -> None:
    assert strings(file)
    assert not found(strings(file))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_sentences_are_read_once(page: Path) -> None:
    without_tables = re.sub(r"^ *\|.*$", "", prose(page), flags=re.MULTILINE)
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[-*#]|\d+\.) )", without_tables):
        for sentence in re.split(r"(?<=[.!?:;])\s+", paragraph):
            assert len(sentence.split()) <= MOST_WORDS, sentence
