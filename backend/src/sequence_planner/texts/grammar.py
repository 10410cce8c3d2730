"""How sentences are put together, in English and in Swedish: of one and of several, lists, and negation."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

from sequence_planner.texts.message import Title

MOST_LISTED: Final = 4  # of a longer list one fewer is named, and the others are counted
_SHORTEST_RANGE: Final = 3
_NUMBER: Final = re.compile(r"(?<![^\W_])\d+(?![^\W_])")


class Clause(NamedTuple):
    """A statement in three parts: `pair 4`, `is`, `placed`. One of which no verb is known is all `subject`."""

    subject: str
    verb: str = ""
    tail: str = ""

    def __str__(self) -> str:
        return " ".join(part for part in self if part)


@dataclass(frozen=True)
class Grammar:
    """The words of a language that sentences need. `verbs` are those that can be denied with `denial` behind them, each
    with what it is of several; `endings` make a word mean several.
    """

    language: str
    verbs: Mapping[str, str]
    denial: str
    ceasing: str
    be: str
    conjunction: str
    disjunction: str
    either: str
    one_of: str
    to: str
    more: str
    holds: tuple[str, str]
    quoted: str
    of: str
    if_: str
    always: str
    never: str
    words: Mapping[str, str]
    endings: tuple[tuple[str, str], ...] = ()
    articles: tuple[str, ...] = ()

    def bare(self, text: str) -> str:
        """A name as it stands in a table: `the ladder frame` → `ladder frame`."""
        article, _, rest = text.partition(" ")
        return rest if rest and article.lower() in self.articles else text

    def clause(self, text: str, before: str = "") -> Clause:
        """A statement in its parts, divided at its first known verb; where the word `before` is not its first one, at
        a verb that stands before it.
        """
        words = text.split(" ")
        end = next((at for at, word in enumerate(words) if at and before and before in word), len(words))
        at = next((at for at, word in enumerate(words[:end]) if at and word in self.verbs), None)
        if at is None or at + 1 == len(words):
            return Clause(text)
        return Clause(" ".join(words[:at]), words[at], " ".join(words[at + 1 :]))

    def denied(self, clause: Clause) -> Clause | None:
        """The contrary of a statement; None where no verb of it is known."""
        return clause._replace(tail=f"{self.denial} {clause.tail}") if clause.verb else None

    def all_together(self, clauses: Sequence[Clause], *, is_all: bool) -> list[Clause]:
        """Statements, those that say the same of several as one: `pairs 1 to 3 are tight`."""
        subjects: dict[tuple[str, str], list[str]] = {}
        found: dict[tuple[str, str], Clause] = {}
        for clause in dict.fromkeys(clauses):
            key = (clause.verb, clause.tail) if clause.verb else ("", clause.subject)
            subjects.setdefault(key, []).append(clause.subject)
            found.setdefault(key, clause)
        return [
            one if len(subjects[key]) == 1 else self._of_several(one, subjects[key], is_all=is_all)
            for key, one in found.items()
        ]

    def _of_several(self, clause: Clause, subjects: Sequence[str], *, is_all: bool) -> Clause:
        if not is_all:
            return clause._replace(subject=self.one(subjects))
        return clause._replace(subject=self.every(subjects), verb=self.verbs[clause.verb])

    def every(self, texts: Sequence[str]) -> str:
        """All of them: `pairs 1 to 3 and the filter`."""
        return self.listed(self._numbered(texts, self.conjunction), self.conjunction)

    def one(self, texts: Sequence[str]) -> str:
        """One of them: `pair 1 or 2`, `one of pairs 1 to 6`, `the kit or the engine`."""
        told = self._numbered(texts, self.disjunction)
        if len(told) == 1 < len(texts) and f" {self.to} " in told[0]:
            return f"{self.one_of} {self._numbered(texts, self.conjunction)[0]}"
        if len(told) == 1 < len(texts):
            return self._numbered(texts, self.disjunction, plural=False)[0]
        return self.listed(told, self.disjunction)

    def _numbered(self, texts: Sequence[str], last: str, *, plural: bool = True) -> list[str]:
        """The texts, those that differ in one number as one."""
        groups: dict[tuple[str, str], dict[int, str]] = {}
        for text in dict.fromkeys(texts):
            numbers = list(_NUMBER.finditer(text))
            # One that begins with a zero is a name: 01 is not 1.
            if len(numbers) == 1 and (numbers[0][0] == "0" or numbers[0][0][0] != "0"):
                (number,) = numbers
                groups.setdefault((text[: number.start()], text[number.end() :]), {})[int(number[0])] = text
            else:
                groups[text, ""] = {}
        found = []
        for (before, behind), values in groups.items():
            if len(values) < 2:
                found.append(next(iter(values.values()), before))
            else:
                noun = self._plural(before) if plural else before
                found.append(f"{noun}{self.listed(self._ranges(values), last)}{behind}")
        return found

    def _ranges(self, values: Iterable[int]) -> list[str]:
        runs: list[list[int]] = []
        for value in sorted(set(values)):
            if runs and runs[-1][-1] == value - 1:
                runs[-1].append(value)
            else:
                runs.append([value])
        return [
            text
            for run in runs
            for text in (
                [f"{run[0]} {self.to} {run[-1]}"] if len(run) >= _SHORTEST_RANGE else [str(value) for value in run]
            )
        ]

    def _plural(self, before: str) -> str:
        """What stands before several numbers: `bolt pairs `."""
        noun = before.rstrip()
        if not noun or not noun[-1].isalpha() or not noun[-1].islower():
            return before
        for ending, several in self.endings:
            if noun.endswith(ending):
                return f"{noun.removesuffix(ending)}{several}{before[len(noun) :]}"
        return before

    def listed(self, texts: Sequence[str], last: str) -> str:
        """As in `a, b and c`, or with how many others there are."""
        return self._strung(texts, f" {last} ")

    def apart(self, texts: Sequence[str], last: str) -> str:
        """As in `a and b, or c`: the same of what has lists in it itself."""
        return self._strung(texts, f", {last} ")

    def _strung(self, texts: Sequence[str], between: str) -> str:
        every = list(texts)
        if len(every) > MOST_LISTED:
            every = [*every[: MOST_LISTED - 1], self.more.format(count=len(every) - MOST_LISTED + 1)]
        return f"{', '.join(every[:-1])}{between}{every[-1]}" if len(every) > 1 else "".join(every)


ENGLISH: Final = Grammar(
    language="en",
    verbs={"is": "are", "are": "are", "was": "were", "can": "can", "must": "must", "will": "will", "may": "may"},
    denial="not",
    ceasing="no longer",
    be="is",
    conjunction="and",
    disjunction="or",
    either="either ",
    one_of="one of",
    to="to",
    more="{count} more",
    holds=("false", "true"),
    quoted="“{title}”",
    of="{part} of {whole}",
    if_="{then} if {condition}",
    always="nothing is needed",
    never="what can never be is so",
    words={
        "==": "the same as",
        "<": "less than",
        ">": "more than",
        "<=": "at most",
        ">=": "at least",
        "+": "plus",
        "-": "minus",
        "range": "from {first} to {last}",
        "enabled": "ready",
        "executing": "under way",
        "finished": "finished",
        "active": "active",
        "X": "next {formula}",
        "N": "next, if anything follows, {formula}",
        "F": "at some time {formula}",
        "G": "always {formula}",
        "U": "{left} until {right}",
        "W": "{left} for as long as it is not so that {right}",
        "R": "{right} up to when {left}",
        "not": "it is not so that {formula}",
    },
    endings=(("ch", "ches"), ("sh", "shes"), ("s", "ses"), ("x", "xes"), ("ty", "ties"), ("ry", "ries"), ("", "s")),
    articles=("the", "a", "an"),
)

SWEDISH: Final = Grammar(
    language="sv",
    verbs={
        each: each
        for each in [
            "är",
            "var",
            "kan",
            "ska",
            "måste",
            "får",
            "har",
            "står",
            "ligger",
            "håller",
            "hålls",
            "går",
            "sitter",
        ]
    },
    denial="inte",
    ceasing="inte längre",
    be="är",
    conjunction="och",
    disjunction="eller",
    either="antingen ",
    one_of="minst en av",
    to="till",
    more="{count} till",
    holds=("falskt", "sant"),
    quoted="”{title}”",
    of="{part} hos {whole}",
    if_="{then} om {condition}",
    always="inget behövs",
    never="det som aldrig kan vara är så",
    words={
        "==": "samma som",
        "<": "mindre än",
        ">": "mer än",
        "<=": "högst",
        ">=": "minst",
        "+": "plus",
        "-": "minus",
        "range": "från {first} till {last}",
        "enabled": "redo",
        "executing": "i gång",
        "finished": "klar",
        "active": "aktiv",
        "X": "härnäst {formula}",
        "N": "härnäst, om något följer, {formula}",
        "F": "någon gång {formula}",
        "G": "alltid {formula}",
        "U": "{left} tills {right}",
        "W": "{left} så länge det inte är så att {right}",
        "R": "{right} fram till att {left}",
        "not": "det är inte så att {formula}",
    },
)

GRAMMARS: Final = (ENGLISH, SWEDISH)
OF_WHAT_IS_SO: Final = tuple(replace(grammar, denial=grammar.ceasing) for grammar in GRAMMARS)
"""As they deny what is so now, and is to end."""


def folded(titles: Iterable[str]) -> list[str]:
    """Titles, those that differ in one number alone as one in the place of the first: `Place pairs 2 to 6`."""
    groups: dict[object, list[str]] = {}
    for title in dict.fromkeys(titles):
        words = title.words if isinstance(title, Title) else {ENGLISH.language: title}
        shapes = {language: _NUMBER.split(text) for language, text in words.items()}
        numbers = {number for text in words.values() for number in _NUMBER.findall(text)}
        # One that begins with a zero is a name: 01 is not 1.
        one = (
            len(numbers) == 1
            and all(each == str(int(each)) for each in numbers)
            and all(len(each) == 2 for each in shapes.values())
        )
        groups.setdefault(str(shapes) if one else title, []).append(title)
    return [alike[0] if len(alike) == 1 else _as_one(alike) for alike in groups.values()]


def _as_one(titles: Sequence[str]) -> str:
    first = titles[0]
    if not isinstance(first, Title):
        return ENGLISH.every(titles)
    grammars = {each.language: each for each in GRAMMARS}
    words = {
        language: grammars.get(language, ENGLISH).every(
            [each.words[language] for each in titles if isinstance(each, Title)]
        )
        for language in first.words
    }
    said = next((language for language, text in first.words.items() if text == str(first)), next(iter(words)))
    return Title(words[said], words)
