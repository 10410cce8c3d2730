"""The differences between two models in what they do: what there is in each, guards, and the plans of operations."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Iterator, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Operation, Specification
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
from sequence_planner.model.files import Files
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
        path: _unified(path, old.get(path, ""), new.get(path, ""))
        for path in sorted(old.keys() | new.keys())
        if old.get(path) != new.get(path)
    }


def _unified(path: str, old: str, new: str) -> str:
    lines = difflib.unified_diff(_lines(old), _lines(new), f"a/{path}", f"b/{path}")
    return "".join(line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n" for line in lines)


def _lines(text: str) -> list[str]:
    """The lines as YAML and `diff` have them: nothing but a new line ends one."""
    *ended, last = text.split("\n")
    return [*(f"{line}\n" for line in ended), *([last] if last else [])]


def differences(old: Meant, new: Meant) -> list[PartDifference]:
    """All parts that are others, new or gone."""
    return [
        *_compared("variable", _variables(old.automaton), _variables(new.automaton)),
        *_compared("ability", _abilities(old), _abilities(new)),
        *_compared("effect", _effects(old.automaton), _effects(new.automaton)),
        *_compared("operation", _operations(old.automaton), _operations(new.automaton)),
        *_compared("specification", _specifications(old.automaton), _specifications(new.automaton)),
        *_compared("station", {"rest": _rest(old.automaton)}, {"rest": _rest(new.automaton)}),
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


def _compared(
    kind: str, old: Mapping[str, Mapping[str, str]], new: Mapping[str, Mapping[str, str]]
) -> Iterator[PartDifference]:
    for name in dict.fromkeys((*old, *new)):
        before, after = old.get(name), new.get(name)
        if before == after:
            continue
        state = Difference.GONE if after is None else Difference.NEW if before is None else Difference.CHANGED
        parts = [
            Changed(part=part, before=(before or {}).get(part), after=(after or {}).get(part))
            for part in dict.fromkeys((*(before or {}), *(after or {})))
            if (before or {}).get(part) != (after or {}).get(part)
        ]
        yield PartDifference(kind=kind, name=name, state=state, parts=parts)


def _variables(automaton: Automaton) -> dict[str, dict[str, str]]:
    return {
        name: {"kind": str(each.kind), "values": str(each.type), "initial": str(each.initial)}
        for name, each in automaton.variables.items()
    }


def _abilities(meant: Meant) -> dict[str, dict[str, str]]:
    return {name: dict(_ability(each, meant.guards.get(name))) for name, each in meant.automaton.abilities.items()}


def _ability(ability: Ability, guard: SupervisorGuard | None) -> Iterator[tuple[str, str]]:
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
        yield "held back by the supervisor, among others", "; ".join(map(_said, guard.blocked))
    if ability.restart:
        yield "restart", "yes"
    if ability.human is not None:
        yield "task", ability.human.text


def _effects(automaton: Automaton) -> dict[str, dict[str, str]]:
    def said(effect: Effect) -> dict[str, str]:
        return {
            "when": _said(effect.guard),
            "does": _done(effect.actions),
            "takes": f"{effect.shortest:g} to {effect.longest:g} s",
        }

    return {effect.name: said(effect) for effect in automaton.effects}


def _operations(automaton: Automaton) -> dict[str, dict[str, str]]:
    def said(operation: Operation) -> dict[str, str]:
        local = {} if operation.local is None else {"local": _said(operation.local)}
        return {
            "precondition": _said(operation.precondition),
            "goal": _said(operation.goal),
            **local,
            "priority": str(operation.priority),
        }

    return {name: said(operation) for name, operation in automaton.operations.items()}


def _specifications(automaton: Automaton) -> dict[str, dict[str, str]]:
    def said(specification: Specification) -> dict[str, str]:
        return {"forbidden": _said(specification.forbidden)}

    return {name: said(specification) for name, specification in automaton.specifications.items()}


def _rest(automaton: Automaton) -> dict[str, str]:
    return {} if automaton.rest is None else {"states of rest": _said(automaton.rest)}


def _said(expression: Expression) -> str:
    return print_expression(expression)


def _done(actions: Iterable[Assignment]) -> str:
    return "; ".join(map(print_assignment, actions))
