"""What the next start waits for, in the model's own words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sequence_planner.automaton.structure import Ability, State
from sequence_planner.automaton.tick import reverts, start
from sequence_planner.control.execution import Execution
from sequence_planner.control.view import Mode, Production
from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import Expression, conjunction, conjuncts, variables
from sequence_planner.synthesis.guards import Guard


def waits_for(execution: Execution, name: str, feeds: Mapping[str, str], guard: Guard | None = None) -> list[str]:
    """Everything that keeps the ability from starting now; empty when it starts in the next tick.

    `feeds` names the topic behind each measured variable, `guard` is what the supervisor adds to the written ones.
    """
    if execution.production is not Production.STARTED:
        return ["production to be started"]
    if execution.mode is Mode.PAUSED:
        return ["automatic mode: the station is paused"]
    if execution.obstacles:
        return list(execution.obstacles)
    ability = execution.automaton.abilities[name]
    return list(dict.fromkeys(_reasons(execution, ability, feeds, guard)))


def _reasons(execution: Execution, ability: Ability, feeds: Mapping[str, str], guard: Guard | None) -> Iterator[str]:
    state = execution.state
    written = False
    for part in (*conjuncts(ability.enabled), *conjuncts(ability.start_guard)):
        truth = evaluate(part, state)
        if truth is True:
            continue
        written = True
        unknown = sorted({feeds[v] for v in _read(execution, part) if v in feeds and state[v] is None})
        yield f"a message on {', '.join(unknown)}" if truth is None and unknown else print_expression(part)
    if written:
        return
    after = start(execution.automaton, state, ability)
    if after is None:
        yield "values that are unknown"
    elif taken := reverts(execution.automaton, execution.published, state, after):
        yield f"{', '.join(sorted(taken))} to be published first"
    elif not execution.supervisor.safe.includes(state):
        yield "the station to be back in a safe state"
    elif not execution.supervisor.safe.includes(after):
        yield _unsafe(execution, after, guard)
    elif not execution.may_go_on(ability.name):
        yield "the right moment: started now, the rest of the plan would not reach its goals"


def _unsafe(execution: Execution, after: State, guard: Guard | None) -> str:
    """What the supervisor's guard lacks, and which specification the start would break, at once or later."""
    if guard is not None and guard.expression is not None:
        lacking = [part for part in conjuncts(guard.expression) if evaluate(part, execution.state) is not True]
        if lacking:
            causes = [execution.automaton.specifications[name].title for name in guard.specifications]
            causes += ["coming to rest again"] if guard.rest else []
            return f"{print_expression(conjunction(*lacking))}, for the sake of: {', '.join(causes)}"
    for specification in execution.automaton.specifications.values():
        if holds(specification.forbidden, after):
            return f"a safe start: {specification.title} ({specification.name})"
    return "a safe start: started now, a specification could be broken later"


def _read(execution: Execution, expression: Expression) -> Iterator[str]:
    for name in variables(expression):
        predicate = execution.automaton.flag_predicates.get(name)
        if predicate is None:
            yield name
        else:
            yield from _read(execution, predicate)
