"""Checks whether starts and operations are possible, with the supervisor and without it.

Each answer is about reachable states; a trace leads to where it can be seen.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from sequence_planner.analysis.checks.reachability import ReachabilityQuery
from sequence_planner.analysis.checks.relaxed_reachability import Growth
from sequence_planner.analysis.checks.warning import quoted, turn_in_words
from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Operation, target
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.syntax import Comparison, Constant, Expression, Variable, conjunction
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.reachability import Tracer
from sequence_planner.synthesis.traces import Trace
from sequence_planner.texts.message import Message, message

UNKNOWN = "too-many-states"  # the kind of a finding that says that nothing is known


@dataclass(frozen=True)
class Subject:
    """Something that should be possible: the start of an ability, an event of a plain automaton, or an operation."""

    name: str
    keys: tuple[str, ...]  # of its place
    abilities: tuple[Ability, ...] = ()
    operation: Operation | None = None

    @property
    def expressions(self) -> list[Expression]:
        """The expressions that are asked about it."""
        if self.operation is not None:
            return [self.operation.precondition, self.operation.goal]
        return [condition for ability in self.abilities for condition in (ability.enabled, ability.start_guard)]


@dataclass(frozen=True)
class FeasibilityFinding:
    """A statement about a subject; instances of which the same is said are named together.

    What is `relative` is said only if it is so for all instances or for few: parameters choose which instances there
    are. `cause` names the start, or what else happens, that the supervisor prevents; a `consequence` need not be said
    where another finding has the same cause.
    """

    kind: str
    subject: Subject
    message: str
    trace: Trace | None = None
    relative: bool = False
    cause: tuple[str, ...] = ()
    consequence: bool = False


class Possibility:
    """The things that are possible where nothing leaves the states that are safe, as an inquiry answers."""

    def __init__(self, automaton: Automaton, inquiry: ReachabilityQuery) -> None:
        self._automaton = automaton
        self._inquiry = inquiry
        self._growth = Growth(automaton, any_measurement=False)

    def findings(self, subject: Subject) -> Iterator[FeasibilityFinding]:
        """Yield what is not possible of `subject`. Raises `TooMuchError`."""
        if subject.operation is None:
            yield from self._start(subject)
        else:
            yield from self._operation(subject, subject.operation)

    def _start(self, subject: Subject) -> Iterator[FeasibilityFinding]:
        inquiry = self._inquiry
        if any(inquiry.reached(inquiry.allowed(e), goal=self._begun(e)).satisfiable() for e in subject.abilities):
            return
        if (known := self._with_guards(subject.abilities, supervised=True)) is not None:
            yield self._never_allowed(subject, *known)
        elif (beyond := self._with_guards(subject.abilities, supervised=False)) is not None:
            trace = inquiry.way(beyond[1], supervised=False)
            said = message("found.start-beyond", after=self._after(trace))
            cause = self._cause(trace)
            yield FeasibilityFinding("never-allowed", subject, said, trace, cause=cause, consequence=True)
        elif self._is_news(*(conjunction(each.enabled, each.start_guard) for each in subject.abilities)):
            first = subject.abilities[0]
            guard = simplify(conjunction(first.enabled, first.start_guard))
            why = _never(self._automaton, guard)
            yield FeasibilityFinding("never-starts", subject, message("found.never-starts", why=why), relative=True)

    def _begun(self, ability: Ability) -> Expression:
        """What its start brings about."""
        types = self._automaton.types
        return conjunction(
            *(
                Comparison("==", Variable(target(each), types[target(each)]), each.value)
                for each in ability.start_actions
                if each.condition is None and isinstance(each.value, Constant)
            )
        )

    def _with_guards(self, members: Sequence[Ability], supervised: bool) -> tuple[Ability, Function] | None:
        """One of `members` whose guards hold in some of the states that are reached, and those."""
        inquiry = self._inquiry
        for ability in members:
            if (where := inquiry.reached(inquiry.may_start(ability), supervised=supervised)).satisfiable():
                return ability, where
        return None

    def _is_news(self, *conditions: Expression) -> bool:
        """Return whether none of these ever holds, by any means, and no other check says so: they look at words and
        values.
        """
        said = not all(map(self._may_by_its_words, conditions))
        return not said and not any(self._inquiry.may_ever(each) for each in conditions)

    def _may_by_its_words(self, condition: Expression) -> bool:
        if self._automaton.one_at_a_time:
            return True  # no other check looks at it
        return self._growth.may(condition) and self._inquiry.plant.where(condition).satisfiable()

    def _never_allowed(self, subject: Subject, ability: Ability, where: Function) -> FeasibilityFinding:
        """The way to a state in which only the supervisor keeps it from starting, the start, and what may follow."""
        inquiry = self._inquiry
        trace = inquiry.way(where)
        if trace is not None:
            trace = Tracer(inquiry.plant).started(trace, ability.name)
            broken = inquiry.diagrams.disjunction(inquiry.forbidden().values())
            trace = Tracer(inquiry.plant, starts=False).onward(trace, broken) or trace
        after = [step.after(where & inquiry.safe) for step in inquiry.plant.starts[ability.name]]
        said = message("found.never-allowed", what=self._consequence(inquiry.diagrams.disjunction(after)))
        return FeasibilityFinding("never-allowed", subject, said, trace, cause=_causes([ability.name]))

    def _consequence(self, states: Function) -> str:
        """Say what comes of `states`, in some of them one thing and in others another."""
        broken, restless = self._inquiry.broken_unasked(states), self._inquiry.unbroken_unasked(states)
        parts = [message("found.leads-to.broken", specifications=_quoted(broken))] if broken else []
        parts += [message("found.leads-to.restless")] if restless else []
        return message("found.leads-to.either", one=parts[0], other=parts[1]) if len(parts) > 1 else "".join(parts)

    def _after(self, trace: Trace | None) -> Message:
        """Say where a trace leaves the safe states."""
        number = self._leaving(trace)
        if trace is None or number is None:
            return message("found.after")
        step = trace.steps[number - 1]
        if step.forbidden_by:
            return message("found.after.breaks", step=number, specifications=_quoted(step.forbidden_by))
        if broken := self._inquiry.broken_unasked(self._inquiry.diagrams.states(step.state)):
            return message("found.after.could-break", step=number, specifications=_quoted(broken))
        return message("found.after.restless", step=number)

    def _cause(self, trace: Trace | None) -> tuple[str, ...]:
        """Return what leaves the safe states on it."""
        number = self._leaving(trace)
        return () if trace is None or number is None else _causes(trace.steps[number - 1].names)

    def _leaving(self, trace: Trace | None) -> int | None:
        """The number of the step that leaves the safe states."""
        for number, step in enumerate(() if trace is None else trace.steps, start=1):
            if not (self._inquiry.diagrams.states(step.state) & self._inquiry.safe).satisfiable():
                return number
        return None

    def _operation(self, subject: Subject, operation: Operation) -> Iterator[FeasibilityFinding]:
        inquiry = self._inquiry
        active = inquiry.plant.where(operation.precondition)
        if inquiry.reached(active, goal=operation.precondition).satisfiable():
            yield from self._goal(subject, operation, active)
        elif (beyond := inquiry.reached(active, supervised=False)).satisfiable():
            trace = inquiry.way(beyond, supervised=False)
            said = message("found.active-beyond", after=self._after(trace))
            cause = self._cause(trace)
            yield FeasibilityFinding("never-active", subject, said, trace, cause=cause, consequence=True)
        elif self._is_news(operation.precondition):
            name, why = self._out_of_turn(operation), _never(self._automaton, operation.precondition)
            if name is None:
                said = message("found.never-active", why=why)
                yield FeasibilityFinding("never-active", subject, said, relative=True)
            else:
                turn = turn_in_words(operation.turns[name])
                said = message("found.never-active.sequence", sequence=name, turn=turn, why=why)
                subject = replace(subject, keys=(f"operation.{operation.name}.sequence.{name}", *subject.keys))
                yield FeasibilityFinding("never-active", subject, said)

    def _out_of_turn(self, operation: Operation) -> str | None:
        """The sequence that keeps the operation from ever becoming active; None where its own precondition does."""
        written = operation.precondition if operation.written is None else operation.written
        if not operation.turns or not self._inquiry.may_ever(written):
            return None
        together = {name: conjunction(written, turn.condition) for name, turn in operation.turns.items()}
        return next((name for name, each in together.items() if not self._inquiry.may_ever(each)), min(together))

    def _goal(self, subject: Subject, operation: Operation, active: Function) -> Iterator[FeasibilityFinding]:
        inquiry, plain = self._inquiry, self._automaton.one_at_a_time
        goal = inquiry.plant.where(operation.goal)
        if inquiry.reached(goal, faults=False, goal=operation.goal).satisfiable():
            if plain:
                return  # a goal of the automaton, which nobody undertakes again in each state
        elif (lost := inquiry.reached(goal, supervised=False, faults=False)).satisfiable():
            trace = inquiry.way(lost, supervised=False, faults=False)
            said = message("found.goal-lost.plain" if plain else "found.goal-lost", after=self._after(trace))
            yield FeasibilityFinding("goal-lost", subject, said, trace, cause=self._cause(trace))
            return
        elif plain:
            yield FeasibilityFinding("goal-out-of-reach", subject, message("found.goal-out-of-reach.plain"))
            return
        elif not self._may_by_its_words(operation.goal):
            return
        bad = inquiry.stuck(active, goal)
        if bad.satisfiable():
            yield self._out_of_reach(subject, goal, bad)

    def _out_of_reach(self, subject: Subject, goal: Function, bad: Function) -> FeasibilityFinding:
        inquiry = self._inquiry
        trace = inquiry.way(bad)
        fault = self._last_fault(trace)
        if fault is not None and (without := inquiry.way(bad, faults=False)) is not None:
            trace, fault = without, None
        leads = inquiry.leads(bad if trace is None else inquiry.diagrams.states(trace.last), goal)
        if leads is None:
            cause = message("found.cause.allowed")
        else:
            cause = message("found.cause.forbidden" if leads else "found.cause.nothing")
        if fault is not None:
            return FeasibilityFinding("goal-out-of-reach", subject, self._after_a_fault(fault, cause), trace)
        initially = trace is not None and not trace.steps
        said = message(f"found.goal-out-of-reach.{'initial' if initially else 'later'}", cause=cause)
        return FeasibilityFinding("goal-out-of-reach", subject, said, trace)

    def _last_fault(self, trace: Trace | None) -> Effect | None:
        """The last thing on it that nobody counts on."""
        faults = {effect.name: effect for effect in self._automaton.effects if effect.fault}
        steps = () if trace is None else reversed(trace.steps)
        return next((faults[name] for step in steps for name in step.names if name in faults), None)

    def _after_a_fault(self, fault: Effect, cause: Message) -> Message:
        """Return what is said where no way without a fault leads there: a person may have meant it."""
        abilities = [each for each in self._automaton.abilities.values() if each.resource == fault.resource]
        by_person = bool(abilities) and all(each.human is not None for each in abilities)
        of = "person" if by_person else "fault"
        return message(f"found.goal-out-of-reach.{of}", fault=fault.name, cause=cause)


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)


def _causes(names: Iterable[str]) -> tuple[str, ...]:
    """Return what happens, for all instances."""
    return tuple(without_arguments(event_of(name)) for name in names)


def _never(automaton: Automaton, condition: Expression) -> Message:
    return message("found.never-reached", condition=quoted(automaton, condition))
