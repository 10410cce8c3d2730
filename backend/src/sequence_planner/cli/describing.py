"""An automaton as JSON. Expressions are texts of the language; a variable that is unknown is null."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from sequence_planner.analysis.document import GuardDocument
from sequence_planner.automaton.structure import Ability, Automaton, Effect
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.expressions.printing import print_assignment, print_expression
from sequence_planner.expressions.syntax import Assignment, Expression

Json = dict[str, object]


def described_automaton(
    automaton: Automaton, guards: Mapping[str, GuardDocument], chosen: Callable[[str], bool]
) -> Json:
    """Those parts whose names are chosen; `guards` are what the supervisor adds to the starts of abilities."""
    return {
        "name": automaton.name,
        "title": automaton.title,
        "one_at_a_time": automaton.one_at_a_time,
        "variables": {
            name: {
                "kind": variable.kind.value,
                "type": str(variable.type),
                "domain": list(variable.type.domain),
                "initial": variable.initial,
                "resource": variable.resource,
            }
            for name, variable in automaton.variables.items()
            if chosen(name)
        },
        "abilities": {
            name: _ability(ability, guards.get(name)) for name, ability in automaton.abilities.items() if chosen(name)
        },
        "effects": {effect.name: _effect(effect) for effect in automaton.effects if chosen(effect.name)},
        "operations": {
            name: {
                "title": operation.title,
                "precondition": print_expression(operation.precondition),
                "goal": print_expression(operation.goal),
                "local": _optional(operation.local),
                "priority": operation.priority,
                "repeat": operation.repeat,
            }
            for name, operation in automaton.operations.items()
            if chosen(name)
        },
        "specifications": {
            name: {"title": specification.title, "forbidden": print_expression(specification.forbidden)}
            for name, specification in automaton.specifications.items()
            if chosen(name)
        },
        "work_masters": {
            name: {
                "title": master.title,
                "operations": {step: sorted(before) for step, before in master.operations.items()},
                "brings": _actions(master.brings),
            }
            for name, master in automaton.work_masters.items()
            if chosen(name)
        },
        "rest": _optional(automaton.rest),
        "phases": {
            phase.value: [_transition(t) for t in transitions(automaton) if t.phase is phase and chosen(t.name)]
            for phase in Phase
        },
    }


def guard_lines(guard: GuardDocument) -> list[str]:
    """When the supervisor allows a start, for people."""
    if guard.guard is not None:
        return [guard.guard]
    if not guard.blocked:
        return ["see the states: no short condition says when"]
    return ["no short condition says when; not, among others, where", *(f"  {each}" for each in guard.blocked)]


def _ability(ability: Ability, guard: GuardDocument | None) -> Json:
    human = ability.human
    return {
        "title": ability.title,
        "resource": ability.resource,
        "enabled": print_expression(ability.enabled),
        "start": {"when": print_expression(ability.start_guard), "do": _actions(ability.start_actions)},
        "supervisor": None
        if guard is None
        else guard.model_dump(include={"specifications", "rest", "blocked"}) | {"when": guard.guard},
        "executing": print_expression(ability.executing),
        "finished": print_expression(ability.finished),
        "finish": None
        if ability.finish_guard is None
        else {"when": print_expression(ability.finish_guard), "do": _actions(ability.finish_actions)},
        "cancel": _actions(ability.cancel_actions),
        "restart": ability.restart,
        "human": None if human is None else {"task": human.text, "acknowledgement": human.acknowledgement},
        "timeouts": {
            "react": ability.timeouts.react,
            "finish": ability.timeouts.finish,
            "then": "replan" if ability.timeouts.replan else "alarm",
            "retries": ability.timeouts.retries,
        },
        "duration": ability.duration,
    }


def _effect(effect: Effect) -> Json:
    return {
        "resource": effect.resource,
        "kind": effect.kind,
        "when": print_expression(effect.guard),
        "do": _actions(effect.actions),
        "takes": [effect.shortest, effect.longest],
        "fault": effect.fault,
    }


def _transition(transition: Transition) -> Json:
    return {"name": transition.name, "reads": sorted(transition.reads), "writes": sorted(transition.writes)}


def _actions(actions: Iterable[Assignment]) -> list[str]:
    return [print_assignment(action) for action in actions]


def _optional(expression: Expression | None) -> str | None:
    return None if expression is None else print_expression(expression)
