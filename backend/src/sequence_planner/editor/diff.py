"""The differences between two models in what they do: what there is in each, guards, and the plans of operations."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Operation, Specification
from sequence_planner.automaton.declarations import OPERATION
from sequence_planner.automaton.lifting.index_folding import FoldedStatement, IndexFolding
from sequence_planner.automaton.lifting.wording import ModelWording, wording_of
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.editor.schemas.diff import (
    BehaviourDifference,
    Changed,
    Difference,
    PartDifference,
    PlanDifference,
)
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import TRUE, Assignment, Expression, Not, conjunction, variables
from sequence_planner.model.files import Files, is_binary
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Goal, Plan, PlanRequest, goal_of
from sequence_planner.station import ReadyStation
from sequence_planner.synthesis.guards import SupervisorGuard

PLANNING = 2.0  # seconds for one plan


class Meant:
    """A model that can be used, with what synthesis has found of it."""

    def __init__(self, station: ReadyStation, supervisor: Supervisor, guards: Mapping[str, SupervisorGuard]) -> None:
        self.station = station
        self.automaton = automaton = station.automaton
        self.guards = {start: guard for guard in guards.values() for start in guard.starts}
        self.supervisor = supervisor
        self._planner = Planner(automaton, supervisor)

    def plan_of(self, operation: str) -> Plan | None:
        """The plan of an operation from the initial state; None without the operation, or a plan."""
        found = self.automaton.operations.get(operation)
        return None if found is None else self._plan(goal_of(found))

    def run_to(self, predicate: Expression) -> list[str] | None:
        """The starts that lead from the initial state to one that satisfies `predicate`; None where it is about what
        there is not here, or nothing leads there.
        """
        if not self.automaton.types.keys() >= set(variables(predicate)):
            return None
        if holds(predicate, initial_state(self.automaton)):
            return []
        return _starts(self._plan(Goal("there", predicate)))

    def may_start(self, ability: Ability) -> Expression:
        """Say when it may start, as far as guards for people say that."""
        guard = self.guards.get(ability.name)
        added = TRUE if guard is None or guard.expression is None else guard.expression
        return conjunction(ability.enabled, ability.start_guard, added)

    def _plan(self, goal: Goal) -> Plan | None:
        request = PlanRequest(dict(initial_state(self.automaton)), (goal,), deadline=PLANNING)
        return self._planner.answer(request).plan


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


def differences(old: Meant, new: Meant) -> list[PartDifference]:
    """All parts that are others, new or gone, each in the words of its model, and once for all instances of which the
    same is so.
    """

    def compared(kind: str, before: _Properties, after: _Properties) -> Iterator[PartDifference]:
        return _folded(kind, old.automaton, new.automaton, list(_compared(kind, words, before, after)))

    words = wording_of(old.automaton), wording_of(new.automaton)
    return [
        *compared("variable", _variables(old.automaton), _variables(new.automaton)),
        *compared("ability", _abilities(old), _abilities(new)),
        *compared("effect", _effects(old.automaton), _effects(new.automaton)),
        *compared("operation", _operations(old.automaton), _operations(new.automaton)),
        *compared("specification", _specifications(old.automaton), _specifications(new.automaton)),
        *compared("station", {"rest": _rest(old.automaton)}, {"rest": _rest(new.automaton)}),
    ]


def plan_differences(old: Meant, new: Meant) -> Iterator[PlanDifference]:
    """The operations that take longer or shorter plans from the initial state, or have one where there was none."""
    for name in dict.fromkeys((*old.automaton.operations, *new.automaton.operations)):
        before, after = old.plan_of(name), new.plan_of(name)
        if (before is None) != (after is None) or (
            before is not None and after is not None and _size(before) != _size(after)
        ):
            yield PlanDifference(operation=name, before=_starts(before), after=_starts(after))


def behaviour_differences(old: Meant, new: Meant) -> Iterator[BehaviourDifference]:
    """Of each ability that both have what it can do in one of them only, with a run that leads there."""
    for name, before in old.automaton.abilities.items():
        after = new.automaton.abilities.get(name)
        if after is None:
            continue
        could, can = old.may_start(before), new.may_start(after)
        if could != can:
            gained = new.run_to(conjunction(can, Not(could)))
            lost = old.run_to(conjunction(could, Not(can)))
            if gained is not None or lost is not None:
                yield BehaviourDifference(ability=name, gained=gained, lost=lost)


def _size(plan: Plan) -> tuple[int, int]:
    return len(plan.ticks), len(plan.starts)


def _starts(plan: Plan | None) -> list[str] | None:
    return None if plan is None else [name for _, name in plan.starts]


class _Property(NamedTuple):
    """A property of a part: its text, and the conditions that it consists of, if it does."""

    text: str
    conditions: tuple[Expression, ...] = ()

    def words(self, wording: ModelWording) -> str:
        """The same in the words of a model."""
        return "; ".join(map(wording.in_words, self.conditions)) if self.conditions else self.text


_Properties = Mapping[str, Mapping[str, _Property]]


def _compared(
    kind: str, words: tuple[ModelWording, ModelWording], old: _Properties, new: _Properties
) -> Iterator[PartDifference]:
    for name in dict.fromkeys((*old, *new)):
        before, after = old.get(name), new.get(name)
        if before == after:
            continue
        state = Difference.GONE if after is None else Difference.NEW if before is None else Difference.CHANGED
        parts = [
            _changed(part, words, (before or {}).get(part), (after or {}).get(part))
            for part in dict.fromkeys((*(before or {}), *(after or {})))
            if (before or {}).get(part) != (after or {}).get(part)
        ]
        yield PartDifference(kind=kind, name=name, over=None, members=[name], state=state, parts=parts)


def _changed(
    part: str, words: tuple[ModelWording, ModelWording], before: _Property | None, after: _Property | None
) -> Changed:
    """What is told of a property that is another one: what the models have one name for is written out."""
    texts = [None if each is None else each.text for each in (before, after)]
    told = [None if each is None else each.words(wording) for each, wording in zip((before, after), words, strict=True)]
    if told[0] == told[1]:
        told = texts
    expanded = [None if said == text else text for said, text in zip(told, texts, strict=True)]
    return Changed(part=part, before=told[0], after=told[1], before_expanded=expanded[0], after_expanded=expanded[1])


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
        changed = [
            Changed(
                part=part.part, before=before, after=after, before_expanded=before_expanded, after_expanded=expanded
            )
            for part, (before, after, before_expanded, expanded) in zip(first.parts, _by_part(worded), strict=True)
        ]
        members = list(each.members)
        yield PartDifference(
            kind=kind, name=each.name, over=each.over, members=members, state=first.state, parts=changed
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


def _abilities(meant: Meant) -> dict[str, dict[str, _Property]]:
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
    if ability.restart:
        yield "restart", _Property("yes")
    if ability.human is not None:
        yield "task", _Property(ability.human.text)


def _effects(automaton: Automaton) -> dict[str, dict[str, _Property]]:
    def said(effect: Effect) -> dict[str, _Property]:
        return {
            "when": _said(effect.guard),
            "does": _done(effect.actions),
            "takes": _Property(f"{effect.shortest:g} to {effect.longest:g} s"),
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
