"""The differences between two models in what is written: their files line by line, and their parts."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Operation, Specification
from sequence_planner.automaton.declarations import OPERATION
from sequence_planner.automaton.lifting.index_folding import FoldedStatement, IndexFolding
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.lifting.wording import ModelWording, wording_of
from sequence_planner.editor.schemas.diff import Changed, Difference, PartDifference
from sequence_planner.editor.schemas.draft import OperationConditionView
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import Assignment, Expression, conjuncts
from sequence_planner.model.files import Files, is_binary
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.texts.message import Message, message


@dataclass(frozen=True)
class Written:
    """A model as it is written, and with what the supervisor adds to starts, where that is known."""

    automaton: Automaton
    guards: Mapping[str, SupervisorGuard] = field(default_factory=dict)


def text_differences(old: Files, new: Files) -> dict[str, str]:
    """The differences of the files as `diff -u` shows them, by path."""
    return {
        path: _binary(path, old, new) if is_binary(path) else _unified(path, old.get(path, ""), new.get(path, ""))
        for path in sorted(old.keys() | new.keys())
        if old.get(path) != new.get(path)
    }


def _binary(path: str, old: Files, new: Files) -> str:
    """Say as `diff` does that such a file is another one."""
    before, after = f"a/{path}" if path in old else "/dev/null", f"b/{path}" if path in new else "/dev/null"
    return f"Binary files {before} and {after} differ\n"


def _unified(path: str, old: str, new: str) -> str:
    lines = difflib.unified_diff(_lines(old), _lines(new), f"a/{path}", f"b/{path}")
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines)


def _lines(text: str) -> list[str]:
    """The lines as YAML and `diff` have them: nothing but a new line ends one."""
    *ended, last = text.split("\n")
    return [*(f"{line}\n" for line in ended), *([last] if last else [])]


def differences(old: Written, new: Written) -> list[PartDifference]:
    """All parts that are others, new or gone, each in the words of its model, and once for all instances of which the
    same is so.
    """
    models = old.automaton, new.automaton

    def compared(kind: str, properties: Callable[[Written], _Properties]) -> Iterator[PartDifference]:
        return _folded(kind, *models, list(_compared(kind, models, properties(old), properties(new))))

    return [
        *compared("variable", lambda model: _variables(model.automaton)),
        *compared("ability", _abilities),
        *compared("effect", lambda model: _effects(model.automaton)),
        *compared("operation", lambda model: _operations(model.automaton)),
        *compared("specification", lambda model: _specifications(model.automaton)),
        *compared("station", lambda model: {"rest": _rest(model.automaton)}),
    ]


class _Property(NamedTuple):
    """A property of a part: its text, a message where it is in words, and the conditions that it consists of."""

    text: str
    conditions: tuple[Expression, ...] = ()

    def words(self, wording: ModelWording) -> str:
        """The same in the words of a model."""
        return "; ".join(map(wording.in_words, self.conditions)) if self.conditions else self.text


_Properties = Mapping[str, Mapping[str, _Property]]


def _compared(
    kind: str, models: tuple[Automaton, Automaton], old: _Properties, new: _Properties
) -> Iterator[PartDifference]:
    for name in dict.fromkeys((*old, *new)):
        before, after = old.get(name), new.get(name)
        if before == after:
            continue
        state = Difference.GONE if after is None else Difference.NEW if before is None else Difference.CHANGED
        parts = [
            _changed(part, models, (before or {}).get(part), (after or {}).get(part))
            for part in dict.fromkeys((*(before or {}), *(after or {})))
            if (before or {}).get(part) != (after or {}).get(part)
        ]
        titles = [_title(kind, models[after is not None], name)]
        yield PartDifference(kind=kind, name=name, titles=titles, over=None, members=[name], state=state, parts=parts)


def _title(kind: str, automaton: Automaton, name: str) -> Message:
    """What people call a part."""
    if kind == "ability":
        return message("step.so", so=automaton.abilities[name].title)
    if kind == "operation":
        return message("step.so", so=automaton.operations[name].title)
    if kind == "specification":
        return message("step.so", so=automaton.specifications[name].title)
    if kind == "effect" and (of := automaton.abilities.get(name.rpartition(".")[0])) is not None:
        return message("compare.effect", ability=of.title, effect=name.rpartition(".")[2].replace("_", " "))
    return message("step.so", so=automaton.title if kind == "station" else name)


def _changed(
    part: str, models: tuple[Automaton, Automaton], before: _Property | None, after: _Property | None
) -> Changed:
    """What is told of a property that is another one: what the models have one name for is written out."""
    texts = [None if each is None else each.text for each in (before, after)]
    wordings = map(wording_of, models)
    told = [
        None if each is None else each.words(each_of) for each, each_of in zip((before, after), wordings, strict=True)
    ]
    if told[0] == told[1]:
        told = texts
    expanded = [None if said == text else text for said, text in zip(told, texts, strict=True)]
    messages = [text if isinstance(text, Message) else None for text in texts]
    return Changed(
        part=part,
        before=told[0],
        after=told[1],
        before_message=messages[0],
        after_message=messages[1],
        before_expanded=expanded[0],
        after_expanded=expanded[1],
        added=_parts_of(models[1], after, before),
        dropped=_parts_of(models[0], before, after),
    )


def _parts_of(automaton: Automaton, one: _Property | None, other: _Property | None) -> list[OperationConditionView]:
    """The parts of a condition that are not among those of another one; none where one of them is no condition."""
    if one is None or other is None or not (one.conditions and other.conditions):
        return []
    known = [part for condition in other.conditions for part in conjuncts(condition)]
    sentences = sentences_of(automaton)
    found: list[OperationConditionView] = []
    for part in (part for condition in one.conditions for part in conjuncts(condition)):
        if part not in known:
            written = wording_of(automaton).in_words(part)
            said = message("sentence.so", condition=sentences.tell_so((part,), written))
            found.append(OperationConditionView(text=written, sentence=said))
    return found


_INDEXED_AS = {"operation": f"{OPERATION}.", "specification": "specification."}


def _folded(kind: str, old: Automaton, new: Automaton, parts: Sequence[PartDifference]) -> Iterator[PartDifference]:
    """Differences of one kind, those of several instances of which the same is so as one."""
    by_name = {each.name: each for each in parts}
    found: list[FoldedStatement] = []
    for automaton, is_there in ((new, True), (old, False)):
        mine = [each for each in parts if (each.state is not Difference.GONE) is is_there]
        texts = {each.name: tuple(text for text in _texts(each) if text is not None) for each in mine}
        ways = {each.name: _way(each) for each in mine}
        found += IndexFolding(wording_of(automaton), _INDEXED_AS.get(kind, "")).folded_texts(texts, ways)
    order = list(by_name)
    for each in sorted(found, key=lambda one: order.index(one.members[0])):
        first, told = by_name[each.members[0]], iter(each.conditions)
        worded = [None if text is None else next(told) for text in _texts(first)]
        members, alone = list(each.members), len(each.members) == 1
        changed = [
            part.model_copy(
                update={
                    "before": before,
                    "after": after,
                    "before_expanded": before_expanded,
                    "after_expanded": expanded,
                    "added": part.added if alone else [],  # of the first alone, which would be told of all
                    "dropped": part.dropped if alone else [],
                }
            )
            for part, (before, after, before_expanded, expanded) in zip(first.parts, _by_part(worded), strict=True)
        ]
        titles = [title for name in members for title in by_name[name].titles]
        yield first.model_copy(
            update={"name": each.name, "titles": titles, "over": each.over, "members": members, "parts": changed}
        )


def _texts(difference: PartDifference) -> list[str | None]:
    return [
        text
        for part in difference.parts
        for text in (part.before, part.after, part.before_expanded, part.after_expanded)
    ]


def _by_part(texts: Sequence[str | None]) -> Iterator[Sequence[str | None]]:
    return (texts[start : start + 4] for start in range(0, len(texts), 4))


def _way(difference: PartDifference) -> object:
    """What has to be alike in differences that are told as one, beside their texts."""
    return difference.state, [part.part for part in difference.parts], [text is None for text in _texts(difference)]


def _variables(automaton: Automaton) -> dict[str, dict[str, _Property]]:
    return {
        name: {
            "kind": _Property(str(each.kind)),
            "values": _Property(str(each.type)),
            "initial": _Property(str(each.initial)),
        }
        for name, each in automaton.variables.items()
    }


def _abilities(meant: Written) -> dict[str, dict[str, _Property]]:
    return {name: dict(_ability(each, meant.guards.get(name))) for name, each in meant.automaton.abilities.items()}


def _ability(ability: Ability, guard: SupervisorGuard | None) -> Iterator[tuple[str, _Property]]:
    yield "enabled", _said(ability.enabled)
    yield "start", _said(ability.start_guard)
    yield "start actions", _done(ability.start_actions)
    yield "executing", _said(ability.executing)
    yield "finished", _said(ability.finished)
    if ability.finish_guard is not None:
        yield "finish", _said(ability.finish_guard)
        yield "finish actions", _done(ability.finish_actions)
    if ability.cancel_actions:
        yield "cancel", _done(ability.cancel_actions)
    if guard is not None and guard.expression is not None:
        yield "added by the supervisor", _said(guard.expression)
    elif guard is not None and guard.blocked:
        yield "held back by the supervisor, among others", _said(*guard.blocked)
    for name, seconds in (
        ("must react within", ability.timeouts.react),
        ("must finish within", ability.timeouts.finish),
    ):
        if seconds is not None:
            yield name, _Property(message("compare.seconds", seconds=_number(seconds)))
    if ability.timeouts.replan:
        yield "when it is late", _Property(message("compare.replan", retries=ability.timeouts.retries))
    if ability.duration is not None:
        yield "usually takes", _range(*ability.duration)
    if ability.restart:
        yield "restart", _Property(message("compare.yes"))
    if not ability.moves:
        yield "something moves", _Property(message("compare.no"))
    if ability.human is not None:
        yield "task", _Property(ability.human.text)


def _effects(automaton: Automaton) -> dict[str, dict[str, _Property]]:
    def said(effect: Effect) -> dict[str, _Property]:
        return {
            "when": _said(effect.guard),
            "does": _done(effect.actions),
            "takes": _range(effect.shortest, effect.longest),
        }

    return {effect.name: said(effect) for effect in automaton.effects}


def _operations(automaton: Automaton) -> dict[str, dict[str, _Property]]:
    def said(operation: Operation) -> dict[str, _Property]:
        local = {} if operation.local is None else {"local": _Property(print_expression(operation.local))}
        return {
            "precondition": _said(operation.precondition),
            "goal": _said(operation.goal),
            **local,
            "priority": _Property(str(operation.priority)),
        }

    return {name: said(operation) for name, operation in automaton.operations.items()}


def _specifications(automaton: Automaton) -> dict[str, dict[str, _Property]]:
    def said(specification: Specification) -> dict[str, _Property]:
        return {"forbidden": _said(specification.forbidden)}

    return {name: said(specification) for name, specification in automaton.specifications.items()}


def _rest(automaton: Automaton) -> dict[str, _Property]:
    return {} if automaton.rest is None else {"states of rest": _said(automaton.rest)}


def _said(*conditions: Expression) -> _Property:
    return _Property("; ".join(map(print_expression, conditions)), conditions)


def _done(actions: Iterable[Assignment]) -> _Property:
    return _Property("; ".join(map(print_assignment, actions)))


def _range(least: float, most: float) -> _Property:
    return _Property(message("compare.range", least=_number(least), most=_number(most)))


def _number(seconds: float) -> int | float:
    """The same, whole where it is."""
    return int(seconds) if seconds == int(seconds) else float(f"{seconds:g}")
