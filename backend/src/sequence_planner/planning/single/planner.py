"""Planner for plain automata (one start at a time): plan reuse by regression, repair, and engines."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property
from heapq import heappop, heappush, nsmallest
from itertools import count
from operator import itemgetter
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.plain_answer import PlainAnswer
from sequence_planner.planning.plan_cache import NAME as RECOLLECTION
from sequence_planner.planning.planner import PlannerError, PlanningAttempt
from sequence_planner.planning.portfolio.engine import Engine, Finding, PlanningTask
from sequence_planner.planning.portfolio.engines import (
    FACTORIES,
    EngineMaker,
    EngineReport,
    Engines,
    Factory,
    Lane,
)
from sequence_planner.planning.problem import Contract, Goal, Plan, Verdict, one_by_one, starts_of
from sequence_planner.planning.repair import NAME as REPAIR
from sequence_planner.planning.single.derived import with_flags, without_flags
from sequence_planner.planning.single.neighbourhood import Stepping, shortened
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget

# Who looks for plans of starts that are taken one at a time, and who proves that there are none.

LANE = Lane(
    "single",
    {
        Contract.MINIMAL: ("pairs", "bmc", "sums", "relaxation", "pdr", "a-star", "search"),
        Contract.FAST: ("pairs", "sums", "search", "relaxation", "pdr", "bmc", "a-star"),
    },
    first_turns={"pairs": 0.06, "sums": 0.02, "bmc": 1.0, "search": 0.3, "relaxation": 1.0, "pdr": 0.2},
    fast_first_turns={"search": 1.0, "bmc": 0.2},
)


PROVING = frozenset(("pairs", "sums", "relaxation", "pdr"))  # engines that have nothing to say where there is a plan


class Separately:
    """An engine for such automata, made of one for those that take several starts in a tick."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    @property
    def name(self) -> str:
        """That of the engine."""
        return self._engine.name

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """Return what the engine finds, the starts of each tick one after the other; each could have had its own."""
        finding = self._engine.solve(task, budget)
        plan = None if finding.plan is None else one_by_one(name for _, name in starts_of(finding.plan.ticks))
        if plan is not None and len(plan.ticks) > task.longest:
            plan = None
        return Finding(plan, finding.proof)


class _Several:
    """Makes an engine for automata that take several starts in a tick."""

    def __init__(self, make: Factory) -> None:
        self._make = make

    def __call__(self, automaton: Automaton, supervisor: Supervisor) -> Engine:
        """A new engine."""
        return Separately(self._make(replace(automaton, one_at_a_time=False), supervisor))


def _proving(automaton: Automaton, supervisor: Supervisor) -> Engine:
    """The engine that proves, for which any order of starts will do: each could be in a tick of its own."""
    from sequence_planner.planning.pdr.ic3 import Reachability  # noqa: PLC0415

    flagged = with_flags(automaton)
    engine = Reachability(flagged, supervisor, tuple(flagged.abilities.values()))
    return _WithFlags(engine, flagged.flag_predicates)


class _WithFlags(Separately):
    """The same for an engine that asks for flags, which are all true."""

    def __init__(self, engine: Engine, flags: Iterable[str]) -> None:
        super().__init__(engine)
        self._flags = dict.fromkeys(flags, True)

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """Return what the engine finds in the state with its flags."""
        return super().solve(replace(task, state={**task.state, **self._flags}), budget)


def factories(starts: Starts) -> Mapping[str, Factory]:
    """Those of all engines, for an automaton with these `starts`."""
    return {
        "bmc": EngineMaker("sat.single_bmc", "SingleStarts", (starts,)),
        "a-star": EngineMaker("heuristic.shorten", "FewestStarts"),
        "search": _Several(FACTORIES["search"]),
        "relaxation": FACTORIES["relaxation"],
        "pairs": EngineMaker("single.pairs", "PairProver", (starts,)),
        "sums": EngineMaker("single.sums", "Sums", (starts,)),
        "pdr": _proving,
    }


# Plans given before, and what they ask of a state: the rest of one leads to the goals from more states than its own.
#
# What the rest of a plan reads before it writes it decides all that it does. From every state that has the same values
# there it leads to the goals as well (regression, as in Fritz and McIlraith 2007).

_MOST_PLANS = 8  # plans that are kept

Values = tuple[Value | None, ...]


class Rest(NamedTuple):
    """The rest of a plan; `minimal` if no plan from there has fewer starts."""

    order: tuple[str, ...]
    minimal: bool


class Way:
    """A plan, the states that it leads through, and the goals missing in each; `minimal` if none has fewer starts."""

    def __init__(
        self,
        order: Sequence[str],
        states: Sequence[State],
        missing: Sequence[Goals],
        minimal: bool,
        starts: Starts,
    ) -> None:
        self.order = tuple(order)
        self.states = states
        self.missing = missing
        self.minimal = minimal
        self._starts = starts

    def far(self, number: int, state: State) -> int:
        """Return how many other values the rest of the plan, from so many starts on, asks for.

        With none it leads from `state` to the goals that are missing there on the way.
        """
        return sum(state[name] != value for name, value in self._asked[number])

    @cached_property
    def _asked(self) -> list[list[tuple[str, Value | None]]]:
        """For each state on the way, the values there on which depends what comes then."""
        goals = self.missing[0]
        seen = frozenset[str]().union(*(variables(goal.predicate) for goal in goals))
        names: frozenset[str] = seen
        found: list[frozenset[str]] = []
        for name in reversed(self.order):
            start = self._starts[name]
            names = (names - start.surely_written) | start.reads | self._starts.guarded(name)
            if len(goals) > 1:  # each can hold at a moment of its own
                names |= seen
            found.append(names)
        return [
            [(name, state[name]) for name in each]
            for state, each in zip(self.states[:-1], reversed(found), strict=True)
        ]


class Ways:
    """The last plans of one automaton under one supervisor, with these `starts`."""

    def __init__(self, starts: Starts) -> None:
        self._starts = starts
        self._ways: deque[Way] = deque(maxlen=_MOST_PLANS)  # the last one first

    def __iter__(self) -> Iterator[Way]:
        return iter(self._ways)

    def keep(self, order: Sequence[str], states: Sequence[State], missing: Sequence[Goals], minimal: bool) -> None:
        """Note a plan that has been taken step by step; the shorter of two from one state replaces the other."""
        way = Way(order, states, missing, minimal, self._starts)
        for known in tuple(self._ways):
            if known.missing[0] == way.missing[0] and known.states[0] == way.states[0]:
                self._ways.remove(known)
        self._ways.appendleft(way)

    def known(self, state: State, goals: Goals) -> Rest | None:
        """The rest of a plan from a state on its way, proven to be minimal if possible."""
        best: Rest | None = None
        for way in self._ways:
            for number, (there, left) in enumerate(zip(way.states, way.missing, strict=True)):
                if left == goals and there == state:
                    rest = Rest(way.order[number:], way.minimal)
                    if best is None or (rest.minimal, -len(rest.order)) > (best.minimal, -len(best.order)):
                        best = rest
        return best

    def nearest(self, state: State, goals: Goals, most: int) -> list[tuple[int, Way, int]]:
        """Plans that reach `goals`, each from so many starts on, whose rests ask the fewest values to be others."""
        wanted = set(goals)
        found = [
            (way.far(number, state), number - len(way.order), age, way, number)
            for age, way in enumerate(self._ways)
            for number in range(len(way.order))
            if wanted.issubset(way.missing[number])
        ]
        return [(far, way, number) for far, _, _, way, number in nsmallest(most, found, key=itemgetter(0, 1, 2))]


# Ways back: a few starts after which the rest of a plan given before leads to the goals.

_MOST_STATES = 120  # states that are looked at
_NEAREST = 4  # rests of plans that a way is looked for to


class Detours:
    """Looks for ways back to `ways`: greedily, where the fewest values differ that the rest of a plan asks for."""

    def __init__(self, stepping: Stepping, ways: Ways) -> None:
        self._stepping = stepping
        self._ways = ways

    def found(self, state: State, goals: Goals, budget: Budget) -> tuple[str, ...] | None:
        """The starts of a plan that soon comes to the rest of another; the rest itself if it leads from `state`."""
        nearest = self._ways.nearest(state, goals, _NEAREST)
        if not nearest:
            return None
        if nearest[0][0] == 0:
            return min((way.order[number:] for far, way, number in nearest if far == 0), key=len)
        targets = [(way, number) for _, way, number in nearest]
        begin = self._stepping.begin(state)
        seen = {tuple(begin.values.values())}
        ages = count()
        queue: list[tuple[int, int, CompiledRun, tuple[str, ...]]] = [(0, next(ages), begin, ())]
        while queue and len(seen) < _MOST_STATES and not budget.spent:
            _, _, run, order = heappop(queue)
            for name, after in self._stepping.following(run):
                key = tuple(after.values.values())
                if key in seen:
                    continue
                seen.add(key)
                further = (*order, name)
                far, way, number = min(
                    ((way.far(number, after.values), way, number) for way, number in targets), key=_distance
                )
                if far == 0:
                    return (*further, *way.order[number:])
                heappush(queue, (2 * far + len(further), next(ages), after, further))
        return None


def _distance(target: tuple[int, Way, int]) -> tuple[int, int]:
    far, _, number = target
    return far, -number


# The planner of automata whose starts are taken one at a time: plans are known, mended, or found by engines.

# Of the time that it took to find a plan, and in seconds of the processor: what it may cost to shorten it.
_SHARE, _LEAST, _MOST = 0.5, 0.02, 0.5
_AGAIN = 2  # times that each of its starts is taken, on average


class _Taken(Immutable):
    """The states that a plan leads through, and the goals missing in each."""

    states: tuple[State, ...]
    missing: tuple[Goals, ...]


class SinglePlanner:
    """Plans for one plain automaton under one supervisor, warm from question to question."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        bare = without_flags(automaton)
        self._supervisor = supervisor
        self._transitions = plain_transitions(automaton)
        starts = Starts(bare, supervisor)
        self._ways = Ways(starts)
        self._stepping = Stepping(bare, supervisor)
        self._detours = Detours(self._stepping, self._ways)
        self._engines = Engines(bare, supervisor, LANE, factories(starts))
        self._last: tuple[Plan, _Taken] | None = None

    def answer(
        self, goals: Sequence[Goal], state: State, contract: Contract, longest: int, budget: Budget
    ) -> PlainAnswer:
        """A way from the safe `state` on which each of `goals` holds in some state."""
        began = time.monotonic()
        left = missing(goals, state)
        if not left:
            return PlainAnswer(Verdict.FOUND, (), True, 0, time.monotonic() - began)
        known = self._ways.known(state, left)
        if known is not None and len(known.order) <= longest and (known.minimal or contract is Contract.FAST):
            length = len(known.order)
            searched = length if known.minimal else 1
            return PlainAnswer(
                Verdict.FOUND, known.order, known.minimal, searched, time.monotonic() - began, RECOLLECTION
            )
        task = PlanningTask(state, left, contract=contract, longest=longest + 1, depth=longest + 1)
        attempt = PlanningAttempt(task, lambda plan: self._accepts(task, plan), budget)
        mended = self._detours.found(state, left, budget)
        without: Set[str] = frozenset()
        if mended is not None and len(mended) <= longest:
            attempt.take(EngineReport(REPAIR, Finding(one_by_one(mended), searched=2)))  # some goal is missing
            # Only a shorter one is of use.
            task, without = replace(task, longest=len(mended), depth=len(mended)), PROVING
        for report in () if _enough(attempt) else self._engines.work(task, budget, lambda: attempt.patience, without):
            attempt.take(report)
            if report.finding.plan is not None:
                self._shorten(attempt, budget)
            if _enough(attempt) or not attempt.patience:
                break
        if attempt.troubles and not attempt.heard and not budget.spent:
            raise PlannerError("; ".join(attempt.troubles))
        return self._answered(attempt, longest, time.monotonic() - began)

    def _shorten(self, attempt: PlanningAttempt, budget: Budget) -> None:
        """Look for a shorter plan near one that does the same again and again, for some of the time that it took.

        Others are seldom much longer than needed.
        """
        plan, task = attempt.plan, attempt.task
        if plan is None or plan.minimal_ticks or len(plan.starts) < _AGAIN * len(set(_order(plan))):
            return
        seconds = min(max(_SHARE * attempt.took, _LEAST), _MOST)
        shorter = shortened(_order(plan), task.state, task.goals, self._stepping, budget.working(seconds))
        if shorter is not None:
            attempt.take(EngineReport(attempt.engine, Finding(one_by_one(shorter), searched=attempt.searched)))

    def _answered(self, attempt: PlanningAttempt, longest: int, seconds: float) -> PlainAnswer:
        plan, searched = attempt.plan, max(attempt.searched - 1, 0)
        if plan is not None:
            order = _order(plan)
            assert self._last is not None
            taken = self._last[1] if self._last[0] == plan else self._taken(attempt.task, order)
            assert taken is not None
            self._ways.keep(order, taken.states, taken.missing, plan.minimal_ticks)
            searched = len(order) if plan.minimal_ticks else max(searched, 1)
            return PlainAnswer(Verdict.FOUND, order, plan.minimal_ticks, searched, seconds, attempt.engine)
        if attempt.impossible:
            return PlainAnswer(Verdict.NONE_AT_ALL, (), False, 0, seconds, attempt.engine, attempt.proof)
        verdict = Verdict.NONE_UP_TO if searched >= longest else Verdict.LATE
        return PlainAnswer(verdict, (), False, searched, seconds, attempt.engine)

    def _accepts(self, task: PlanningTask, plan: Plan) -> bool:
        """Return whether the starts of `plan`, one by one, lead to the goals by the steps of the automaton."""
        taken = self._taken(task, _order(plan))
        if taken is None or len(plan.starts) > task.longest:
            return False
        self._last = plan, taken
        return True

    def _taken(self, task: PlanningTask, order: Sequence[str]) -> _Taken | None:
        states, left = [task.state], [task.goals]
        for name in order:
            transition = self._transitions[name]
            after = step(states[-1], transition)
            if after is None or (transition.controllable and not self._supervisor.allows(states[-1], after)):
                return None
            states.append(after)
            left.append(missing(left[-1], after))
        return None if left[-1] else _Taken(tuple(states), tuple(left))


def _enough(attempt: PlanningAttempt) -> bool:
    """Return whether what the contract asks for is known: of as many ticks there are as many starts."""
    plan = attempt.plan
    return attempt.answered or (plan is not None and plan.minimal_ticks)


def _order(plan: Plan) -> tuple[str, ...]:
    return tuple(name for _, name in starts_of(plan.ticks))
