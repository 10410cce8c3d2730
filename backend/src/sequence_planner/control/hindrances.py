"""All that keeps an ability from starting now, each piece with what it takes to be over."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.automaton.structure import Ability, State
from sequence_planner.automaton.tick import reverts, start, supervised_start, synchronise
from sequence_planner.control.execution import Execution
from sequence_planner.control.vocabulary import Mode, Production, ServiceKind
from sequence_planner.expressions.evaluation import evaluate, holds
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import TRUE, Expression, conjunction, conjuncts, variables
from sequence_planner.planning.advice.conjoining import all_equal
from sequence_planner.synthesis.guards import Guard

WAITS = {
    Mode.PAUSED: "automatic mode: the station is paused",
    Mode.HOLD: "automatic mode: the station holds",
    Mode.RESTART: "a way back to be taken: the station is in restart mode",
}


class HindranceKind(StrEnum):
    """What kind of thing keeps an ability from starting, or an operation or a goal from coming true."""

    STATION = "station"  # how the station executes: its mode, production, steps, obstacles
    SERVICE = "service"  # it does not take part: offline, out of service, forced, or for restart mode only
    WRITTEN = "written"  # a condition of the model
    UNPUBLISHED = "unpublished"  # a command has to leave first
    SUPERVISOR = "supervisor"  # the guard that synthesis has added
    PLAN = "plan"  # nothing wants it, or not yet
    ORDER = "order"  # no job asks for it, or not yet


@dataclass(frozen=True)
class Hindrance:
    """One of them: `text` names what is waited for, `expression` says the same where the model can."""

    kind: HindranceKind
    text: str
    expression: Expression | None = None


def of_station(execution: Execution) -> Iterator[Hindrance]:
    """What keeps every ability from starting."""
    conduct = execution.conduct
    texts: list[str] = []
    if conduct.production is not Production.STARTED:
        texts.append("production to be started")
    if conduct.errand is None and conduct.mode is not Mode.AUTOMATIC:
        texts.append(WAITS[conduct.mode])
    if conduct.stepping and not conduct.steps:
        texts.append("a step: the station goes step by step")
    for text in (*texts, *execution.obstacles):
        yield Hindrance(HindranceKind.STATION, text)


def of_ability(
    execution: Execution, ability: Ability, feeds: Mapping[str, str], guard: Guard | None
) -> Iterator[Hindrance]:
    """What keeps this ability from starting. `feeds` names the topic behind each measured variable, `guard` is what the
    supervisor adds to the written ones.
    """
    barred = [Hindrance(HindranceKind.SERVICE, text) for text in _out_of_service(execution, ability, feeds)]
    written = list(_written(execution, ability, feeds))
    yield from barred
    yield from written
    if not written:
        yield from _unwritten(execution, ability, guard)


def _out_of_service(execution: Execution, ability: Ability, feeds: Mapping[str, str]) -> Iterator[str]:
    conduct, resource = execution.conduct, ability.resource
    title = execution.automaton.resources.get(resource, resource)
    if resource in conduct.silent:
        variables_of = [v.name for v in execution.automaton.variables.values() if v.resource == resource]
        topics = sorted({feeds[v] for v in variables_of if v in feeds and execution.state[v] is None})
        on = f" on {', '.join(topics)}" if topics else ""
        yield f"{title} to be heard again{on}"
    if resource in conduct.out_of(ServiceKind.RESOURCE):
        yield f"{title} to be put back in service"
    if ability.name in conduct.out_of(ServiceKind.ABILITY):
        yield f"{ability.title} to be put back in service"
    elif ability.name in execution.circumstances.barred:
        yield "what is forced to be released"
    if ability.restart and not execution.circumstances.restart:
        yield "restart mode, and a way back that has it"


def _written(execution: Execution, ability: Ability, feeds: Mapping[str, str]) -> Iterator[Hindrance]:
    for part in (*conjuncts(ability.enabled), *conjuncts(ability.start_guard)):
        truth = evaluate(part, execution.state)
        if truth is not True:
            yield Hindrance(HindranceKind.WRITTEN, lacking_text(execution, part, truth is None, feeds), part)


def lacking_text(execution: Execution, part: Expression, unknown: bool, feeds: Mapping[str, str]) -> str:
    """What a part of a condition waits for, which does not hold or is `unknown`."""
    topics = awaited(execution, part, feeds) if unknown else []
    return f"a message on {', '.join(topics)}" if topics else print_expression(part)


def awaited(execution: Execution, part: Expression, feeds: Mapping[str, str]) -> list[str]:
    """The topics behind the unknown variables in it."""
    return sorted({feeds[v] for v in _read(execution, part) if v in feeds and execution.state[v] is None})


def _unwritten(execution: Execution, ability: Ability, guard: Guard | None) -> Iterator[Hindrance]:
    """What keeps it from starting where all that is written holds."""
    state = execution.state
    unsupervised = execution.errand is not None and execution.errand.unsupervised
    after = start(execution.automaton, state, ability)
    if after is None:
        yield Hindrance(HindranceKind.WRITTEN, "values that are unknown")
    elif taken := reverts(execution.automaton, execution.published, state, after):
        yield Hindrance(HindranceKind.UNPUBLISHED, f"{', '.join(sorted(taken))} to be published first")
    elif not execution.supervisor.safe.includes(state):
        if not unsupervised:
            yield Hindrance(HindranceKind.SUPERVISOR, "the station to be back in a safe state")
    elif not execution.supervisor.safe.includes(after):
        yield _unsafe(execution, ability, after, guard)


def _unsafe(execution: Execution, ability: Ability, after: State, guard: Guard | None) -> Hindrance:
    """What the supervisor's guard lacks, and which specification the start would break, at once or later."""
    kind = HindranceKind.SUPERVISOR
    if guard is not None:
        causes = [execution.automaton.specifications[name].title for name in guard.specifications]
        causes += ["coming to rest again"] if guard.rest else []
        sake = f"for the sake of: {', '.join(causes)}"
        said = TRUE if guard.expression is None else guard.expression
        lacking = [part for part in conjuncts(said) if evaluate(part, execution.state) is not True]
        if lacking:
            condition = conjunction(*lacking)
            return Hindrance(kind, f"{print_expression(condition)}, {sake}", condition)
        if guard.expression is None and (nearest := _nearest(execution, ability)) is not None:
            where = f"{print_expression(nearest)} (the nearest state in which it may start)"
            return Hindrance(kind, f"{where}, {sake}", nearest)
    for specification in execution.automaton.specifications.values():
        if holds(specification.forbidden, after):
            return Hindrance(kind, f"a safe start: {specification.title} ({specification.name})")
    return Hindrance(kind, "a safe start: started now, a specification could be broken later")


def _nearest(execution: Execution, ability: Ability) -> Expression | None:
    """What else has to be so for the start to be allowed, in as few variables as can be; None if that is not known."""
    automaton, supervisor = execution.automaton, execution.supervisor
    allowed = supervisor.guards.get(ability.name)
    changes = None if allowed is None else allowed.nearest(execution.state)
    if not changes:
        return None
    there = synchronise(automaton, {**execution.state, **changes})
    if supervised_start(automaton, supervisor, there, there, ability) is None:
        return None
    return all_equal(automaton, changes.items())


def _read(execution: Execution, expression: Expression) -> Iterator[str]:
    for name in variables(expression):
        predicate = execution.automaton.flag_predicates.get(name)
        if predicate is None:
            yield name
        else:
            yield from _read(execution, predicate)
