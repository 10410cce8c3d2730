"""Explanation of a blocked start: unmet conditions, the variables behind them, and possible changers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import product
from math import inf, prod
from typing import Protocol

from sequence_planner.automaton.automaton import Ability, Automaton, Kind, Operation, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.lifting.wording import expansion, phrase, untrue, wording_of
from sequence_planner.automaton.tick import effect_writes, reverts, start, supervised_start, synchronise
from sequence_planner.controller.views.details import ChangerView, ConditionView, InvolvedView
from sequence_planner.controller.views.station import BeliefView
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import OperatorPlan
from sequence_planner.execution.vocabulary import Mode, Production, ServiceKind
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import (
    TRUE,
    Assignment,
    Constant,
    Expression,
    Not,
    Variable,
    conjunction,
    variables,
)
from sequence_planner.language.types import Value
from sequence_planner.planning.recovery.proposals import all_equal
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.texts.message import Item, Message, Sentence, as_it_was, message, quoted, waits_in_one

# All that keeps an ability from starting now, each piece with what it takes to be over.


class HindranceKind(StrEnum):
    """The kind of thing that keeps an ability from starting, or an operation or a goal from coming true."""

    STATION = "station"  # how the station executes: its mode, production, steps, obstacles
    SERVICE = "service"  # it does not take part: offline, out of service, forced, or for restart mode only
    WRITTEN = "written"  # a condition of the model
    UNPUBLISHED = "unpublished"  # a command has to leave first
    SUPERVISOR = "supervisor"  # the guard that synthesis has added
    PLAN = "plan"  # nothing wants it, or not yet
    ORDER = "order"  # no job asks for it, or not yet


@dataclass(frozen=True)
class BlockingCondition:
    """One of them: `text` names what is waited for, `expression` says the same where the model can. `expanded` is that
    where `text` has names for it.
    """

    kind: HindranceKind
    text: Message
    expression: Expression | None = None
    expanded: str | None = None


def of_station(execution: Executor) -> Iterator[BlockingCondition]:
    """Yield what keeps every ability from starting."""
    conduct = execution.conduct
    texts: list[Message] = []
    if conduct.production is not Production.STARTED:
        texts.append(message("waits.production"))
    if conduct.operator_plan is None and conduct.mode is not Mode.AUTOMATIC:
        texts.append(message(f"waits.{conduct.mode}"))
    if conduct.stepping and not conduct.steps:
        texts.append(message("waits.step"))
    for text in (*texts, *obstacles(execution)):
        yield BlockingCondition(HindranceKind.STATION, text)


def obstacles(execution: Executor) -> Iterator[Message]:
    """Yield what keeps everything from starting, which is written down as strings."""
    yield from (as_it_was(each, "waits.", "graph.rival") for each in execution.obstacles)


def of_ability(
    execution: Executor, ability: Ability, feeds: Mapping[str, str], guard: SupervisorGuard | None
) -> Iterator[BlockingCondition]:
    """Yield what keeps this ability from starting. `feeds` names the topic behind each measured variable, `guard` is
    what the supervisor adds to the written ones.
    """
    barred = [BlockingCondition(HindranceKind.SERVICE, text) for text in _out_of_service(execution, ability, feeds)]
    written = list(_written(execution, ability, feeds))
    yield from barred
    yield from written
    if not written:
        yield from _unwritten(execution, ability, guard)


def _out_of_service(execution: Executor, ability: Ability, feeds: Mapping[str, str]) -> Iterator[Message]:
    conduct, resource = execution.conduct, ability.resource
    title = execution.automaton.resources.get(resource, resource)
    if resource in conduct.silent:
        variables_of = [v.name for v in execution.automaton.variables.values() if v.resource == resource]
        topics = sorted({feeds[v] for v in variables_of if v in feeds and execution.state[v] is None})
        if topics:
            yield message("waits.heard-on", resource=title, topics=", ".join(topics))
        else:
            yield message("waits.heard", resource=title)
    if resource in conduct.out_of(ServiceKind.RESOURCE):
        yield message("waits.service", title=title)
    if ability.name in conduct.out_of(ServiceKind.ABILITY):
        yield message("waits.service", title=ability.title)
    elif ability.name in execution.circumstances.barred:
        yield message("waits.release")
    if ability.restart and not execution.circumstances.restart:
        yield message("waits.restart-way")


def _written(execution: Executor, ability: Ability, feeds: Mapping[str, str]) -> Iterator[BlockingCondition]:
    for condition in (ability.enabled, ability.start_guard):
        yield from lacking(execution, condition, feeds)


def lacking(execution: Executor, condition: Expression, feeds: Mapping[str, str]) -> Iterator[BlockingCondition]:
    """Yield the parts of a condition of the model that do not hold, in its words."""
    for part in wording_of(execution.automaton).lacking(condition, execution.state):
        unknown = evaluate(part.condition, execution.state) is None
        topics = awaited(execution, part.condition, feeds) if unknown else []
        if topics:
            text = message("waits.message", topics=", ".join(topics))
        else:
            said = sentences_of(execution.automaton).tell_missing(part.condition, execution.state, phrase(part))
            text = message("waits.condition", condition=said)
        yield BlockingCondition(HindranceKind.WRITTEN, text, part.condition, expansion([part], execution.state))


def goal_holds(execution: Executor, goal: Expression) -> BlockingCondition:
    """Say that a goal holds, where it must not."""
    undone, words = Not(goal), wording_of(execution.automaton)
    said = sentences_of(execution.automaton).tell_so([undone], words.in_words(undone))
    text = message("blocked.goal-holds", condition=said)
    return BlockingCondition(HindranceKind.WRITTEN, text, undone, expansion(words.told_parts(undone), execution.state))


def out_of_turn(execution: Executor, operation: Operation) -> Iterator[BlockingCondition]:
    """Yield the sequences in which it is not an operation's turn."""
    operations, state = execution.automaton.operations, execution.state
    for name, turn in operation.turns.items():
        undone = untrue(turn.condition, state)
        if not undone:
            continue
        before = [each for each in turn.after if evaluate(operations[each].goal, state) is not True]
        kind, others = ("behind", before) if before else ("beside", turn.beside)
        titles = quoted(dict.fromkeys(operations[each].title for each in others))
        text = message(f"waits.sequence-{kind}", sequence=name, operations=titles)
        condition = conjunction(*undone)
        yield BlockingCondition(HindranceKind.WRITTEN, text, condition, in_words(execution, condition))


def in_words(execution: Executor, condition: Expression) -> str:
    """A condition as the model says it."""
    return wording_of(execution.automaton).in_words(condition)


def awaited(execution: Executor, part: Expression, feeds: Mapping[str, str]) -> list[str]:
    """The topics behind the unknown variables in it."""
    return sorted({feeds[v] for v in _read(execution, part) if v in feeds and execution.state[v] is None})


def _unwritten(execution: Executor, ability: Ability, guard: SupervisorGuard | None) -> Iterator[BlockingCondition]:
    """Yield what keeps it from starting where all that is written holds."""
    state = execution.state
    unsupervised = execution.operator_plan is not None and execution.operator_plan.unsupervised
    after = start(execution.automaton, state, ability)
    if after is None:
        yield BlockingCondition(HindranceKind.WRITTEN, message("waits.unknown"))
    elif taken := reverts(execution.automaton, execution.published, state, after):
        yield BlockingCondition(
            HindranceKind.UNPUBLISHED, message("waits.published", variables=", ".join(sorted(taken)))
        )
    elif not execution.supervisor.safe.includes(state):
        if not unsupervised:
            yield BlockingCondition(HindranceKind.SUPERVISOR, message("waits.safe"))
    elif not execution.supervisor.safe.includes(after):
        yield _unsafe(execution, ability, after, guard)


def _unsafe(execution: Executor, ability: Ability, after: State, guard: SupervisorGuard | None) -> BlockingCondition:
    """Return what the supervisor's guard lacks, and which specification the start would break, at once or later."""
    kind = HindranceKind.SUPERVISOR
    if guard is not None:
        titles = (execution.automaton.specifications[name].title for name in guard.specifications)
        causes: list[Item] = [*dict.fromkeys(titles)]  # those that one of the model was written out to have one title
        causes += [message("waits.rest")] if guard.rest else []
        said = TRUE if guard.expression is None else guard.expression
        if undone := list(wording_of(execution.automaton).lacking(said, execution.state)):
            condition = conjunction(*(part.condition for part in undone))
            lacks = sentences_of(execution.automaton).tell_missing(condition, execution.state, phrase(*undone))
            text = message("waits.sake", condition=lacks, causes=causes)
            return BlockingCondition(kind, text, condition, expansion(undone, execution.state))
        if guard.expression is None and (nearest := _nearest(execution, ability)) is not None:
            words = wording_of(execution.automaton).in_words(nearest)
            where = message("waits.nearest", condition=sentences_of(execution.automaton).tell_so([nearest], words))
            return BlockingCondition(kind, message("waits.sake", condition=where, causes=causes), nearest)
    for specification in execution.automaton.specifications.values():
        if holds(specification.forbidden, after):
            named = message("waits.safe-start", title=specification.title, name=specification.name)
            return BlockingCondition(kind, named)
    return BlockingCondition(kind, message("waits.safe-later"))


def _nearest(execution: Executor, ability: Ability) -> Expression | None:
    """Return what else has to be so for the start to be allowed, in as few variables as can be; None if that is not
    known.
    """
    automaton, supervisor = execution.automaton, execution.supervisor
    allowed = supervisor.guards.get(ability.name)
    changes = None if allowed is None else allowed.nearest(execution.state)
    if not changes:
        return None
    there = synchronise(automaton, {**execution.state, **changes})
    if supervised_start(automaton, supervisor, there, there, ability) is None:
        return None
    return all_equal(automaton, changes.items())


def _read(execution: Executor, expression: Expression) -> Iterator[str]:
    for name in variables(expression):
        predicate = execution.automaton.flag_predicates.get(name)
        if predicate is None:
            yield name
        else:
            yield from _read(execution, predicate)


# Which variables keep a condition from being true, what they would have to be, and who could see to that.


class _Partly(dict[str, Value | None]):
    """The values of some variables, all others unknown, and the flags that follow from them."""

    def __init__(self, automaton: Automaton, values: Mapping[str, Value | None]) -> None:
        super().__init__(values)
        self._predicates = automaton.flag_predicates

    def __missing__(self, name: str) -> Value | None:
        predicate = self._predicates.get(name)
        self[name] = None if predicate is None else evaluate(predicate, self)
        return self[name]


def responsible(automaton: Automaton, condition: Expression, state: State) -> tuple[str, ...]:
    """Variables that alone keep `condition` from being true in `state`: whatever all others were, it would not be.

    None of them could be spared. Flags are followed to the variables behind them. Where the condition is open, the
    unknown variables that it reads; none where it is true.
    """
    read = [name for name in automaton.variables if name in read_variables(automaton, (condition,))]
    truth = evaluate(condition, _Partly(automaton, {name: state[name] for name in read}))
    if truth is True:
        return ()
    if truth is None:
        return tuple(name for name in read if state[name] is None)
    kept = {name: state[name] for name in read if state[name] is not None}
    for name in read:
        fewer = {other: value for other, value in kept.items() if other != name}
        if name in kept and evaluate(condition, _Partly(automaton, fewer)) is False:
            kept = fewer
    return tuple(kept)


def wanted(automaton: Automaton, condition: Expression, state: State, name: str) -> tuple[Value, ...]:
    """The values of a variable with which the condition would be true, all other variables as in `state`."""
    values = {each: state[each] for each in automaton.variables}
    domain = automaton.variables[name].type.domain
    return tuple(value for value in domain if evaluate(condition, _Partly(automaton, {**values, name: value})) is True)


MOST_TRIED = 2000  # combinations of values; where there are more, any other value counts as helpful


def helpful(
    automaton: Automaton, condition: Expression, state: State, name: str, decisive: Sequence[str]
) -> tuple[Value, ...]:
    """The values of a variable that bring what is missing: those that are `wanted`, or else those with which the
    condition could be true for some values of the other `decisive` variables, for which it cannot be with the present.
    """
    if values := wanted(automaton, condition, state, name):
        return values
    domain, others = automaton.variables[name].type.domain, [each for each in decisive if each != name]
    domains = [automaton.variables[each].type.domain for each in others]
    if len(domain) * prod(map(len, domains)) > MOST_TRIED:
        return tuple(value for value in domain if value != state[name])

    unknown = dict.fromkeys(automaton.variables)

    def may_hold(value: Value | None, beside: Mapping[str, Value]) -> bool:
        return evaluate(condition, _Partly(automaton, {**unknown, **beside, name: value})) is not False

    every = (dict(zip(others, combination, strict=True)) for combination in product(*domains))
    lacking = [beside for beside in every if not may_hold(state[name], beside)]
    return tuple(value for value in domain if any(may_hold(value, beside) for beside in lacking))


@dataclass(frozen=True)
class Changer:
    """An ability that can change a variable by its `start`, its `finish` or an `effect` of it."""

    how: str
    ability: Ability


def changers(automaton: Automaton, state: State, name: str, values: Sequence[Value]) -> Iterator[Changer]:
    """The abilities that could give the variable one of the values, or bring it nearer to one step by step."""

    def is_written(actions: Sequence[Assignment]) -> bool:
        return any(target(action) == name and _leads(action.value, state, name, values) for action in actions)

    for ability in automaton.abilities.values():
        if is_written(ability.start_actions):
            yield Changer("start", ability)
        if is_written(ability.finish_actions):
            yield Changer("finish", ability)
    seen: set[str] = set()
    for effect in automaton.effects:
        owner = automaton.abilities.get(effect.name.rpartition(".")[0])
        if owner is None or effect.fault or owner.name in seen or not is_written(effect.actions):
            continue
        seen.add(owner.name)
        yield Changer("effect", owner)


def _leads(written: Expression, state: State, name: str, values: Sequence[Value]) -> bool:
    """Return whether what is written to a variable can be one of the values; of a step from its own value, whether it
    is one of them or nearer to them.
    """
    if isinstance(written, Constant):
        return written.value in values
    if name not in variables(written):
        return not isinstance(written, Variable) or any(value in written.type.domain for value in values)
    now, then = state[name], evaluate(written, state)
    return then is None or then in values or _distance(then, values) < _distance(now, values)


def _distance(value: Value | None, values: Sequence[Value]) -> float:
    """The steps from a number to the nearest of others."""
    numbers = (each for each in values if isinstance(each, int))
    return min((abs(value - each) for each in numbers), default=inf) if isinstance(value, int) else inf


# The variables that decide a condition, as they are now, and who could change them.

MOST_CHANGERS = 20  # abilities that are listed for a variable


class TellsBelief(Protocol):
    """The one who knows where an estimate comes from."""

    def of(self, name: str) -> BeliefView:
        """Of an estimated variable."""
        ...


@dataclass(frozen=True)
class ConditionContext:
    """Facts beside the execution: topics by measured variable, since when a variable has its value, beliefs, guards the
    supervisor has added, by ability, and the variables that time alone can change.
    """

    feeds: Mapping[str, str]
    since: Callable[[str], float | None]
    beliefs: TellsBelief
    guards: Callable[[], Mapping[str, SupervisorGuard]]
    timed: frozenset[str] = frozenset()


class Involving:
    """Shows conditions on `execution`."""

    def __init__(self, execution: Executor, surroundings: ConditionContext) -> None:
        self._execution = execution
        self._around = surroundings

    def condition(self, hindrance: BlockingCondition) -> ConditionView:
        """Return what has to be otherwise, and who could see to that."""
        condition, text = hindrance.expression, hindrance.text
        involved = [] if condition is None else list(self._involved_in(condition))
        return ConditionView(
            kind=str(hindrance.kind),
            text=text,
            text_message=text,
            expanded=hindrance.expanded,
            involved=involved,
            sentence=waits_in_one([text]),
        )

    def _involved_in(self, condition: Expression) -> Iterator[InvolvedView]:
        """Yield the variables of each part that does not hold."""
        execution, told = self._execution, set[str]()
        for part in untrue(condition, execution.state) or [condition]:
            decisive = responsible(execution.automaton, part, execution.state)
            for name in decisive:
                if name not in told:
                    told.add(name)
                    yield self._involved(name, part, decisive)

    def among(self, condition: Expression) -> list[InvolvedView]:
        """The variables that alone keep a condition from holding; where unknown ones leave it open, these."""
        decisive = responsible(self._execution.automaton, condition, self._execution.state)
        return [self._involved(name, condition, decisive) for name in decisive]

    def writers(self, name: str) -> list[ChangerView]:
        """The abilities that can give a variable another value than it has."""
        value = self._execution.state[name]
        domain = self._execution.automaton.variables[name].type.domain
        return self._abilities(name, tuple(each for each in domain if each != value))

    def _involved(self, name: str, condition: Expression, decisive: Sequence[str]) -> InvolvedView:
        automaton, state = self._execution.automaton, self._execution.state
        variable = automaton.variables[name]
        helping = () if state[name] is None else helpful(automaton, condition, state, name, decisive)
        belief = self._around.beliefs.of(name) if variable.kind is Kind.ESTIMATED else None
        return InvolvedView(
            name=name,
            kind=str(variable.kind),
            resource=variable.resource,
            value=state[name],
            wanted=list(wanted(automaton, condition, state, name)),
            since=self._around.since(name),
            topic=self._around.feeds.get(name),
            unconfirmed_since=None if belief is None else belief.unconfirmed_since,
            changers=[
                *([] if self._acknowledged(name) else self._abilities(name, helping)),
                *self._others(name, helping),
            ],
        )

    def _abilities(self, name: str, values: tuple[Value, ...]) -> list[ChangerView]:
        running = self._execution.running()
        found = [
            ChangerView(
                how=each.how, name=each.ability.name, title=each.ability.title, title_message=None, running=is_running
            )
            for each in changers(self._execution.automaton, self._execution.state, name, values)
            for is_running in (each.ability.name in running,)
        ]
        return sorted(found, key=lambda changer: not changer.running)[:MOST_CHANGERS]

    def _others(self, name: str, values: tuple[Value, ...]) -> list[ChangerView]:
        """Return what a person could do about it, and whether time can."""
        automaton = self._execution.automaton
        variable = automaton.variables[name]
        resource = variable.resource or ""
        title = automaton.resources.get(resource, automaton.title)
        match variable.kind:
            case Kind.ESTIMATED:
                return [_by_person("correction", name, message("changes.correction", name=name))]
            case Kind.OUTPUT:
                return [_by_person("force", name, message("changes.force", name=name))]
            case Kind.MEASURED if self._execution.state[name] is None:
                topic = self._around.feeds.get(name, name)
                return [_by_person("message", topic, message("changes.message", topic=topic))]
            case Kind.MEASURED if asked := self._acknowledged(name):
                return self._tasks(resource, title, asked) if True in values else []
            case Kind.MEASURED:
                clock = [_by_person("clock", name, message("changes.clock"))] if name in self._around.timed else []
                return [*clock, _by_person("device", resource, message("changes.device", title=title))]
            case Kind.ACTIVITY:
                return []

    def _acknowledged(self, name: str) -> list[Ability]:
        """The abilities of which a variable is the acknowledgement."""
        abilities = self._execution.automaton.abilities.values()
        return [each for each in abilities if each.human is not None and each.human.acknowledgement == name]

    def _tasks(self, resource: str, title: str, asked: Sequence[Ability]) -> list[ChangerView]:
        """The task that somebody has now; without one, any of those there are for them."""
        running = self._execution.running()
        now = [
            ChangerView(
                how="task",
                name=each.name,
                title=(said := message("changes.task", task=each.human.text, title=title)),
                title_message=said,
                running=True,
            )
            for each in asked
            if each.human is not None and each.name in running
        ]
        return now or [_by_person("task", resource, message("changes.tasks", title=title))]


def _by_person(how: str, name: str, title: Message) -> ChangerView:
    return ChangerView(how=how, name=name, title=title, title_message=title, running=False)


# What the next start waits for, in the model's own words.


def waits_for(
    execution: Executor, name: str, feeds: Mapping[str, str], guard: SupervisorGuard | None = None
) -> list[Message]:
    """Everything that keeps the ability from starting now; empty when it starts in the next tick.

    `feeds` names the topic behind each measured variable, `guard` is what the supervisor adds to the written ones.
    """
    if everything := list(of_station(execution)):
        return [each.text for each in everything]
    own = list(of_ability(execution, execution.automaton.abilities[name], feeds, guard))
    if own:
        return list(dict.fromkeys(each.text for each in own))
    if not execution.may_go_on(name):
        return [right_moment(execution)]
    return []


def right_moment(execution: Executor) -> Message:
    """Say what the next start waits for although it may start."""
    if execution.operator_plan is None:
        return message("waits.right-moment")
    if before := list(dict.fromkeys(_before(execution))):
        return message("waits.before", conditions=before)
    return message("waits.right-moment-taken")


def _before(execution: Executor) -> Iterator[Sentence]:
    """Yield what has still to happen, of what the plan has before its next start."""
    automaton, state, (_, ticks) = execution.automaton, execution.state, execution.plan.order.rest()
    effects = {effect.name: effect for effect in automaton.effects}
    for tick in ticks:
        for name in tick.effects:
            for variable, value in (effect_writes(effects[name], state) or {}).items():
                if state[variable] != value:
                    yield sentences_of(automaton).tell_value(variable, value)
        if tick.starts:
            return


def idle_since(execution: Executor, operator_plan: OperatorPlan) -> float | None:
    """Since when nothing of an operator plan is under way; None while something is."""
    taken = operator_plan.taken.monotonic
    own = [step for step in execution.plan.order.past if step.started and step.started.monotonic >= taken]
    ended = [step.ended.monotonic for step in own if step.ended is not None]
    return None if len(ended) < len(own) else max((taken, *ended))
