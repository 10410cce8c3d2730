"""Folds of actions that are taken for each value of a set: one `all …: …` in place of an action for each value."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from sequence_planner.core.immutable import replace
from sequence_planner.editor.draft import Edit, RemoveEntry, SetEntry
from sequence_planner.editor.folds.conditions.quantifiers import words_for
from sequence_planner.editor.folds.proposal import NAME, FoldProposal, WrittenPlace, place_between
from sequence_planner.editor.folds.texts import FoldableStation, FoldableText, with_word, words_of
from sequence_planner.editor.language.field import FieldKind
from sequence_planner.editor.schemas.draft import FoldKind
from sequence_planner.language.parser import parse_assignment
from sequence_planner.language.printer import print_assignment
from sequence_planner.language.syntax import Assignment, Name
from sequence_planner.model.yaml.reader import EntryPath


def action_proposals(station: FoldableStation) -> Iterator[FoldProposal]:
    """A proposal for each row of actions that are the same but for a value, all of a set."""
    lists: dict[tuple[str, EntryPath], list[FoldableText]] = defaultdict(list)
    for text in station.texts:
        if text.field.kind is FieldKind.ACTION:
            lists[text.file, text.path[:-1]].append(text)
    for texts in lists.values():
        first = 0
        while first < len(texts):
            last, proposal = _longest(station, texts, first)
            if proposal is not None:
                yield proposal
            first = last + 1


def _longest(station: FoldableStation, texts: list[FoldableText], first: int) -> tuple[int, FoldProposal | None]:
    """The proposal for the actions from `first` on, with the last of these."""
    action = parse_assignment(texts[first].text)
    for word in sorted(_words(action) & station.every_value):
        body, values = _with_word(action, word, NAME), [word]
        for text in texts[first + 1 :]:
            other = parse_assignment(text.text)
            fitting = (each for each in sorted(_words(other)) if _with_word(other, each, NAME) == body)
            value = next(fitting, None)
            if value is None or value in values:
                break
            values.append(value)
        for length in range(len(values), 1, -1):
            for domain in station.with_values(values[:length]):
                if (found := _proposal(station, texts[first : first + length], body, domain)) is not None:
                    return first + length - 1, found
    return first, None


def _proposal(
    station: FoldableStation, texts: list[FoldableText], body: Assignment, domain: str
) -> FoldProposal | None:
    head, *others = texts
    for word in dict.fromkeys(words_for(station, body.target, domain)):
        now = f"all {word} in {domain}: {print_assignment(_with_word(body, NAME, word))}"
        if word in station.every_value or not station.is_right(head, now):
            continue
        place = place_between(head.file, head.text, head.text, str(head.text), now)
        edits: list[tuple[Edit, WrittenPlace]] = [
            (SetEntry(file=head.file, path=list(head.path), was=str(head.text), value=now), place)
        ]
        for each in reversed(others):
            removal = RemoveEntry(file=each.file, path=list(each.path), was=str(each.text))
            edits.append((removal, place_between(each.file, each.text, each.text, str(each.text), "")))
        return FoldProposal(FoldKind.QUANTIFIER, f"Write `{now}`", entries=tuple(edits))
    return None


def _words(action: Assignment) -> set[str]:
    """The words in the target of an action that could be values."""
    return words_of(action.target)


def _with_word(action: Assignment, word: str, other: str) -> Assignment:
    """An action with `other` wherever it has the value `word`."""
    target = with_word(action.target, word, other)
    assert isinstance(target, Name)
    condition = None if action.condition is None else with_word(action.condition, word, other)
    return replace(action, target=target, value=with_word(action.value, word, other), condition=condition)
