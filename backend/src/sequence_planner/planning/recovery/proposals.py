"""Recovery proposals: possible operator acts, changed values, effort, and claims of finished work."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from functools import lru_cache
from itertools import combinations

from sequence_planner.automaton.automaton import Automaton, Effect, Flag, Kind, Operation, State, target
from sequence_planner.automaton.dependencies import tasks_for
from sequence_planner.automaton.tick import effect_writes, writes
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate, holds
from sequence_planner.language.syntax import (
    TRUE,
    Comparison,
    Constant,
    Expression,
    Not,
    Variable,
    conjunction,
    conjuncts,
)
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Plan
from sequence_planner.planning.recovery.request import Pairing, RecoverySituation
from sequence_planner.planning.sat.flag_dependencies import FollowingFlags
from sequence_planner.planning.validation.replay import missing

# What corrections claim: that work is done, or nearer to its end, although nobody has done anything.
#
# Only somebody who has looked knows whether that is so. Believed without being so it is a false record of the product.


def claimed(automaton: Automaton, goals: Goals, before: State, after: State) -> tuple[str, ...]:
    """The goals that a correction from `before` to `after` claims, by the names of their operations.

    Of `goals`, those of active operations, each of which some part holds then and did not before. Of all others each
    that holds then and did not before, unless work is undone with it, which the station then does once more: that the
    bolts are only placed brings the goal of placing them about too, and claims nothing.
    """
    asked = {goal.name for goal in goals}
    nearer = [goal.name for goal in goals if any(_begins(part, before, after) for part in conjuncts(goal.predicate))]
    others = [name for name, each in automaton.operations.items() if name not in asked]
    done = [name for name in others if _begins(automaton.operations[name].goal, before, after)]
    if done and any(holds(each.precondition, after) for each in _undone(automaton, before, after)):
        done = []
    return (*nearer, *done)


def _undone(automaton: Automaton, before: State, after: State) -> Iterator[Operation]:
    return (each for each in automaton.operations.values() if _begins(each.goal, after, before))


def _begins(predicate: Expression, before: State, after: State) -> bool:
    return holds(predicate, after) and not holds(predicate, before)


# Values written down as a predicate.


def all_equal(automaton: Automaton, values: Iterable[tuple[str, Value]]) -> Expression:
    """Return the condition that all of these variables and flags have these values."""
    return conjunction(*(_equals(Variable(name, automaton.types[name]), value) for name, value in values))


def _equals(variable: Variable, value: Value) -> Expression:
    if isinstance(value, bool):
        return variable if value else Not(variable)
    return Comparison("==", variable, Constant(value))


# What an advisor offers: what a person changes, what is done in restart mode, and what production does then.

# What each counts for, in seconds: the effort of an offer is the time it takes, and these beside it.
WEIGHTS = {
    "changes": 30.0,  # an estimate that a person looks up at the station and corrects
    "physical": 60.0,  # something that a person does at a device
    "returns": 90.0,  # a resource that a person brings back, or an ability put back into service
    "starts": 2.0,  # a start in restart mode, which a person has confirmed and watches
    "unsupervised": 60.0,  # starts outside the safe states
    "unseen": 60.0,  # these, while something that is measured is not known
    "breaks": 300.0,  # a specification that is violated on the way
    "left_out": 600.0,  # a goal that is given up
}

# Of these, what people take time for; the others only weigh.
PEOPLE_TAKE = ("changes", "physical", "returns", "starts")


class OfferKind(StrEnum):
    """The things an offer asks for, besides what production does then."""

    REPLAN = "replan"  # nothing: production goes on as it is
    RESTART = "restart"  # a manual plan in restart mode
    RESET = "reset"  # a manual plan to the precondition of an operation
    CORRECTION = "correction"  # other values of estimates
    PHYSICAL = "physical"  # what only a person can do: at a device, or a resource or an ability back in service
    COMBINED = "combined"  # changes of both kinds, or changes and then a manual plan
    WAY_BACK = "way-back"  # a manual plan that begins outside the safe states
    GOAL = "goal"  # a manual plan that was asked for


class ValueChange(Immutable):
    """A variable has the value `new` instead of `old`, which is None where it is not known."""

    name: str
    old: Value | None
    new: Value


class ProposalEffort(Immutable):
    """The cost of an offer. `seconds` is how long its manual plan and then its plan are estimated to take."""

    changes: int = 0
    physical: int = 0  # what a person does at devices; one such act can change several measured variables
    elsewhere: int = 0  # of these acts, where another device is to be helped, or to come back
    returns: int = 0
    starts: int = 0  # of the manual plan
    seconds: float = 0.0
    left_out: int = 0
    breaks: int = 0
    unsupervised: bool = False
    unseen: bool = False

    @property
    def time(self) -> float:
        """The seconds that devices and people are estimated to take."""
        return self.seconds + sum(WEIGHTS[name] * float(getattr(self, name)) for name in PEOPLE_TAKE)

    @property
    def cost(self) -> float:
        """All of it, in seconds; see `WEIGHTS`."""
        return self.seconds + sum(weight * float(getattr(self, name)) for name, weight in WEIGHTS.items())


class RecoveryProposal(Immutable):
    """A proven way back to work.

    First a person makes the `corrections` of estimates, brings the `physical` changes of measured variables about,
    and brings resources `online` and abilities `in_service`; of those resources it is `assumed` that they say what
    they last said; that is how it is at the `start`. Then `operator_plan` is carried out in restart mode, by
    written guards alone as long as the state is outside the safe states if it is `unsupervised`, until its `goal`
    holds; `end` is the state then. From there `then` is a plan without restart abilities for `goals`; it is None
    only where that was not proven for a manual plan that was asked for. `breaks` are specifications that the manual
    plan violates on its way although they were not violated before; `at_rest` says that it ends in one of the
    station's safe rest states, with devices that are where they were told to be. The corrections alone would have
    the goals that it `claims` reached, or nearer: that is for somebody to say who has checked it. What is done at
    devices can be what abilities wait for; what these note then it `records`. One `into_safe` begins outside the
    safe states, and is not at its end before it is inside. What is corrected of `by_hand` is so only once a person
    has done the task for it.
    """

    kind: OfferKind
    start: State
    end: State
    effort: ProposalEffort
    corrections: tuple[ValueChange, ...] = ()
    physical: tuple[ValueChange, ...] = ()
    online: tuple[str, ...] = ()
    in_service: tuple[str, ...] = ()
    assumed: tuple[ValueChange, ...] = ()
    operator_plan: Plan | None = None
    goal: Expression = TRUE
    operation: str | None = None
    restart: bool = False
    unsupervised: bool = False
    at_rest: bool = False
    breaks: tuple[str, ...] = ()
    then: Plan | None = None
    goals: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    claims: tuple[str, ...] = ()
    records: tuple[ValueChange, ...] = ()
    into_safe: bool = False
    by_hand: tuple[str, ...] = ()

    @property
    def only_if_checked(self) -> bool:
        """True if it says that work is done which nobody has done."""
        return bool(self.claims)

    @property
    def rank(self) -> tuple[bool, int, bool, float]:
        """The rank, least first: what is done before what is only said, done where something is wrong before elsewhere,
        then what takes less.

        What says that work is done comes last, whatever it takes.
        """
        acts = bool(self.operator_plan or self.physical or self.online or self.in_service)
        said = 0 if not self.corrections else 1 if acts else 2
        return self.only_if_checked, said, self.effort.elsewhere > 0, self.effort.cost


class Advice(Immutable):
    """Offers, in the order of their rank; `reasons` where there is none but what somebody has to have checked.

    Where it is `complete`, nothing of what is looked for was left undecided for want of time.
    """

    offers: tuple[RecoveryProposal, ...]
    reasons: Diagnosis | None
    complete: bool
    seconds: float


def changes_between(automaton: Automaton, before: State, after: State, kind: Kind) -> tuple[ValueChange, ...]:
    """The variables of a kind that have another value afterwards."""
    pairs = ((name, before[name], after[name]) for name in automaton.names(kind))
    return tuple(ValueChange(name, old, new) for name, old, new in pairs if new is not None and new != old)


# What a person could change: estimates that are wrong, what stands at a device, and what is out of service.
#
# The more plausible an act is, the lower its `rank`: most of all, what a device should have done by itself, or that it
# is back; then what the model names as a fault, such as a person who takes over; and least of all, what would not stay:
# that a robot is on its way is nothing to see to, as it arrives by itself then.

_HAPPENS, _EXPECTED, _FAULT, _INITIAL, _CAN_BE, _ESTIMATED, _UNLIKELY, PASSING = range(8)
LIKELY = _FAULT  # acts of this rank, or a lower one, are tried before anything that takes long


class ActKind(StrEnum):
    """The place where something is changed."""

    ESTIMATE = "estimate"  # in what is believed
    TASK = "task"  # in the product, as a person does a task, who says so then
    DEVICE = "device"  # measured variables, at a device
    RETURN = "return"  # a resource is back online, and says what it last said
    SERVICE = "service"  # an ability is back in service


class Act(Immutable):
    """One thing that a person does; `name` is the variable, resource or ability that it is about."""

    kind: ActKind
    name: str
    values: tuple[tuple[str, Value], ...]
    rank: int


class Options:
    """The acts that make sense at one station."""

    def __init__(self, automaton: Automaton, effects: tuple[Effect, ...]) -> None:
        """`effects` are all that devices are known to do, also what nobody counts on."""
        self._automaton = automaton
        self._tasks = tasks_for(automaton)
        self._effects = [(effect, frozenset(map(target, effect.actions))) for effect in effects]

    def acts(
        self,
        here: RecoverySituation,
        last: Mapping[str, Value],
        fixed: frozenset[str],
        aside: frozenset[str] = frozenset(),
        answered: frozenset[str] = frozenset(),
    ) -> list[Act]:
        """All of them, the most plausible first, but those at devices that change nothing but variables `aside`.

        Of what is unknown only a resource that comes back says more.
        """
        acts = [
            *self._corrections(here.state, fixed, answered),
            *self._physical(here, fixed),
            *self._back(here, last, fixed),
        ]
        different: dict[object, Act] = {}
        for act in sorted(acts, key=lambda act: act.rank):
            same = act.values if act.kind is ActKind.DEVICE else act.name  # other variables may ask for the same
            if act.kind is not ActKind.DEVICE or not aside.issuperset(name for name, _ in act.values):
                different.setdefault((act.kind, same, act.values), act)
        return list(different.values())

    def _corrections(self, state: State, fixed: frozenset[str], answered: frozenset[str]) -> Iterator[Act]:
        for name in self._automaton.names(Kind.ESTIMATED):
            for value in self._others(state, name) if name not in fixed or name in answered else ():
                # What people do they do, and then it is so, as where they see that it is done.
                if (name, value) in self._tasks:
                    yield Act(ActKind.TASK, name, ((name, value),), _EXPECTED if name in answered else _ESTIMATED)
                elif name not in fixed:
                    yield Act(ActKind.ESTIMATE, name, ((name, value),), _ESTIMATED)

    def _physical(self, here: RecoverySituation, fixed: frozenset[str]) -> Iterator[Act]:
        """For each value of a measured variable what effects would do with it too, and then that alone."""
        offline = here.circumstances.offline
        given_up = {ability.partition("(")[0] for ability in here.circumstances.barred}
        for name in self._automaton.names(Kind.MEASURED):
            declared = self._automaton.variables[name]
            if name in fixed or declared.resource in offline:
                continue
            for value in self._others(here.state, name):
                together: dict[frozenset[tuple[str, Value]], int] = {}
                for effect, changed in self._effects:
                    if name in changed and changed.isdisjoint(fixed) and not self._touches(changed, offline):
                        awaited = effect.name.rpartition(".")[0] in given_up
                        self._add(together, effect, name, value, here.state, awaited=awaited)
                alone = frozenset({(name, value)})
                together.setdefault(alone, _INITIAL if value == declared.initial and not together else _UNLIKELY)
                for values, rank in together.items():
                    rank = PASSING if self._passes(dict(values), here.state) else rank
                    yield Act(ActKind.DEVICE, name, tuple(sorted(values, key=str)), rank)

    def _passes(self, values: dict[str, Value], state: State) -> bool:
        """Return whether devices change one of the values by themselves then."""
        after = {**state, **values}
        for effect, changed in self._effects:
            if not effect.fault and not changed.isdisjoint(values):
                written = effect_writes(effect, after) or {}
                if any(written.get(name, value) != value for name, value in values.items()):
                    return True
        return False

    def _touches(self, names: frozenset[str], resources: frozenset[str]) -> bool:
        return any(self._automaton.variables[name].resource in resources for name in names)

    def _add(
        self,
        together: dict[frozenset[tuple[str, Value]], int],
        effect: Effect,
        name: str,
        value: Value,
        state: State,
        *,
        awaited: bool,
    ) -> None:
        """Add what `effect` writes where it gives `name` this value, be it enabled or not. One that is `awaited` has
        not come for so long that its ability was given up.
        """
        written = effect_writes(effect, state)
        if written is not None and written.get(name) == value:
            rank = _HAPPENS
        else:
            written = self._shaped(effect, name, value, state)
            expected = {target(action): action.value for action in effect.actions}[name]
            follows = isinstance(expected, Variable) and state[expected.name] == value
            rank = _EXPECTED if follows or awaited else _CAN_BE
        if effect.fault:
            rank = max(rank, _FAULT)
        if written is not None:
            changed = frozenset((n, v) for n, v in written.items() if state[n] is not None and state[n] != v)
            if (name, value) in changed:
                together[changed] = min(rank, together.get(changed, rank))

    def _shaped(self, effect: Effect, name: str, value: Value, state: State) -> dict[str, Value] | None:
        """All that the effect would write if it wrote this; None if it never does."""
        if any(action.condition is not None for action in effect.actions):
            return None
        source = {target(action): action.value for action in effect.actions}[name]
        assumed = dict(state)
        match source:
            case Constant(constant) if constant == value:
                pass
            case Variable(other) if value in self._automaton.types[other].domain:
                assumed[other] = value
            case _:
                return None
        written: dict[str, Value] = {}
        for action in effect.actions:
            result = evaluate(action.value, assumed)
            if result is None or result not in self._automaton.variables[target(action)].type.domain:
                return None
            written[target(action)] = result
        return written

    def _back(self, here: RecoverySituation, last: Mapping[str, Value], fixed: frozenset[str]) -> Iterator[Act]:
        automaton, state = self._automaton, here.state
        for resource in automaton.resources:
            unknown = [n for n in automaton.names(Kind.MEASURED) if state[n] is None and self._is_of(n, resource)]
            known = tuple((name, last[name]) for name in unknown if name in last and name not in fixed)
            if resource in here.circumstances.offline or known:
                yield Act(ActKind.RETURN, resource, known, _EXPECTED)
                for values, rank in self._meanwhile({**state, **dict(known)}, frozenset(unknown) - fixed):
                    yield Act(ActKind.RETURN, resource, tuple({**dict(known), **values}.items()), rank)
        for ability in sorted(here.circumstances.barred):
            yield Act(ActKind.SERVICE, ability, (), _EXPECTED)

    def _meanwhile(self, state: State, names: frozenset[str]) -> Iterator[tuple[dict[str, Value], int]]:
        """Yield what an effect on nothing but `names`, or a hand, may have brought about while nobody heard of it."""
        for effect, changed in self._effects:
            written = writes(effect.actions, state) if changed <= names else None
            if written is None or not all(self._can_be(name, value) for name, value in written.items()):
                continue  # its guard, of which nobody knows whether it held, would have excluded that
            if any(state[name] != value for name, value in written.items()):
                follows = any(isinstance(action.value, Variable) for action in effect.actions)
                yield written, _EXPECTED if follows else _CAN_BE

    def _can_be(self, name: str, value: Value) -> bool:
        return contains(self._automaton.variables[name].type, value)

    def _is_of(self, name: str, resource: str) -> bool:
        return self._automaton.variables[name].resource == resource

    def _others(self, state: State, name: str) -> Iterator[Value]:
        if state[name] is not None:
            yield from (value for value in self._automaton.variables[name].type.domain if value != state[name])


# The fewest acts of a person after which production goes on.

MOST_ACTS = 2

Acts = tuple[Act, ...]


class Changes:
    """The situations that acts lead to at one station."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._flags = FollowingFlags(automaton)
        self._following = lru_cache(1000)(self._flags_of)

    def applied(self, here: RecoverySituation, acts: Iterable[Act]) -> RecoverySituation:
        """The situation after the acts; that before was synchronised."""
        values: dict[str, Value] = {}
        circumstances = here.circumstances
        for act in acts:
            values |= dict(act.values)
            if act.kind is ActKind.RETURN:
                circumstances = replace(circumstances, offline=circumstances.offline - {act.name})
            elif act.kind is ActKind.SERVICE:
                circumstances = replace(circumstances, barred=circumstances.barred - {act.name})
        state = {**here.state, **values}
        for flag in self._following(frozenset(values)):
            truth = evaluate(flag.predicate, state)
            if truth is not None:
                state[flag.name] = truth
        return replace(here, state=state, goals=missing(here.goals, state), circumstances=circumstances)

    def _flags_of(self, names: frozenset[str]) -> tuple[Flag, ...]:
        return tuple(self._flags.flags(names))


def kind_of(acts: Iterable[Act]) -> OfferKind:
    """Return what an offer of nothing but these acts is."""
    estimates = {act.kind in (ActKind.ESTIMATE, ActKind.TASK) for act in acts}
    if len(estimates) == 2:
        return OfferKind.COMBINED
    return OfferKind.CORRECTION if True in estimates else OfferKind.PHYSICAL


def returns(acts: Iterable[Act]) -> bool:
    """Return whether a resource comes back."""
    return any(act.kind is ActKind.RETURN for act in acts)


def sets(acts: Sequence[Act], size: int) -> Iterator[Acts]:
    """All sets of so many acts that do not get in each other's way, the most plausible first: those by which a resource
    comes back, since that one is known to be away.
    """

    def plausible(each: Acts) -> tuple[bool, int]:
        return not returns(each), sum(act.rank for act in each)

    chosen = combinations(acts, size)
    for each in sorted(chosen, key=plausible) if size > 1 else chosen:
        names = [name for act in each for name, _ in act.values]
        if len(set(names)) == len(names) and len({(act.kind, act.name) for act in each}) == size:
            yield each


def is_possible(here: RecoverySituation, after: RecoverySituation, impossible: frozenset[Pairing]) -> bool:
    """Return whether no pair of values comes together that never does, unless it is so already."""

    def together(situation: RecoverySituation) -> frozenset[Pairing]:
        state = situation.state
        return frozenset(p for p in impossible if state[p[0]] == p[1] and state[p[2]] == p[3])

    return not impossible or together(after) <= together(here)
