"""The faults of a model, gathered while it is grounded, and the parameters that grounding replaces by values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sequence_planner.language.shorthand.titles import NO_TITLES, Titles, in_language
from sequence_planner.language.syntax import Span
from sequence_planner.language.types import EnumerationType, Place
from sequence_planner.model.fields import Words, WordsDocument, by_language, main_text
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.texts.message import Title, message
from sequence_planner.texts.names import in_words

# What each parameter is: its value, and the enumeration it is of.
Binding = Mapping[str, tuple[str, EnumerationType]]


class Findings:
    """The findings so far."""

    def __init__(self) -> None:
        self.all: list[Finding] = []

    def add(self, where: SourceText | Place, message: str) -> None:
        """Note what is wrong at `where`."""
        self.all.append(Finding(where.place if isinstance(where, SourceText) else where, message))

    def add_within(self, text: SourceText, span: Span, message: str) -> None:
        """Note what is wrong at a part of `text`."""
        self.all.append(Finding(text.at(span), message))


@dataclass(frozen=True, order=True)
class UseOfRemoved(Finding):
    """Something in a type uses what an instance removes, by its entry at `removed`."""

    word: str
    removed: Place


def told_where_removed(findings: Iterable[Finding]) -> list[Finding]:
    """The same, with one for each entry that is removed and used in the type, at that entry."""
    others: list[Finding] = []
    uses: dict[tuple[Place, str], set[Place]] = {}
    for finding in findings:
        if isinstance(finding, UseOfRemoved):
            uses.setdefault((finding.removed, finding.word), set()).add(finding.place._replace(instance=""))
        else:
            others.append(finding)
    for (removed, word), places in uses.items():
        first, count = min(places), len(places) - 1
        said = (
            message("wrong.removed-and-used.several", name=word, place=str(first), count=count)
            if count
            else message("wrong.removed-and-used", name=word, place=str(first))
        )
        others.append(Finding(removed, said))
    return others


def instance_name(name: str, binding: Binding, indexed: bool = False) -> str:
    """The name of a ground instance: `move_to_position(home)`, or `bolts[bolt_pair_1]` for a variable."""
    return with_arguments(name, (value for value, _ in binding.values()), indexed)


def with_arguments(name: str, values: Iterable[str], indexed: bool = False) -> str:
    """`name` with its arguments behind it."""
    arguments = ", ".join(values)
    if not arguments:
        return name
    return f"{name}[{arguments}]" if indexed else f"{name}({arguments})"


def without_arguments(name: str) -> str:
    """The name of what a ground instance is one of."""
    return re.sub(r"[\[(][^\])]*[\])]", "", name) if "(" in name or "[" in name else name


def with_values(text: str, binding: Binding) -> str:
    """A text with the value of each `{parameter}` in its place."""
    for parameter, (value, _) in binding.items():
        text = text.replace(f"{{{parameter}}}", value)
    return str(text)


def title_of(text: Words | None, name: str, binding: Binding, titles: Titles = NO_TITLES, *, apart: bool = True) -> str:
    """The title of a part, or its name in plain words; with it what it is in other languages, where those are given.

    Of several parts in one whose title names none of the parameters, people are told the arguments behind it, unless a
    title is not to tell them `apart`.
    """
    told = readable(main_text(text), name, binding, titles)
    said = by_language(text)
    names_one = any(f"{{{each}}}" in words for words in said.values() for each in binding)
    if name and binding and not names_one and (apart or not said):
        spoken = {
            each: _spoken(said.get(each) or main_text(text) or in_words(name), binding, titles, each)
            for each in WordsDocument.model_fields
        }
        return Title(told, {"": told} | spoken)
    if not isinstance(text, WordsDocument):
        return told
    return Title(told, {language: readable(each, name, binding, titles, language) for language, each in said.items()})


def _spoken(title: str, binding: Binding, titles: Titles, language: str) -> str:
    """A title, or a name in plain words, of one of several with its arguments, which tell it from the others.

    What it ends with and an argument begins with is said once: `place_bolt_pair(bolt_pair_3)` is
    `Place bolt pair 3`, and `move_to_position(home)` is `Move to position: home`.
    """
    words = title.split()
    called = [
        in_language(titles.of_value(type_, value), language) or in_words(value) for value, type_ in binding.values()
    ]
    first, *others = called
    rest = first.split()
    shared = next((n for n in range(min(len(words), len(rest)), 0, -1) if words[-n:] == rest[:n]), 0)
    told = " ".join([*words, *rest[shared:]]) if shared else f"{' '.join(words)}: {first}"
    return ", ".join([told[:1].upper() + told[1:], *others])


def own_title(text: Words | None, name: str) -> str:
    """The title of what is there once, or its name as it is written."""
    return str(name) if text is None else title_of(text, name, {})


def followed_by(title: str, more: str) -> str:
    """A title with more behind it, if there is any."""
    if not more:
        return title
    if isinstance(title, Title):
        return Title(f"{title}: {more}", {language: f"{said}: {more}" for language, said in title.words.items()})
    return f"{title}: {more}"


def readable(
    title: SourceText | None, name: str, binding: Binding, titles: Titles = NO_TITLES, language: str = "en"
) -> str:
    """A title, or the name in plain words, with what each `{parameter}` is called in a `language` in its place.

    The digest of a model, by which its journals know it, has these: what has no title keeps the letters of its name.
    """
    text = str(title) if title is not None else name.replace("_", " ")
    for parameter, (value, type_) in binding.items():
        called = in_language(titles.of_value(type_, value), language) or value.replace("_", " ")
        text = text.replace(f"{{{parameter}}}", called)
    return text
