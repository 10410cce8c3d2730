"""Who looks for plans of starts that are taken one at a time, and who proves that there are none."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.immutable import replace
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.demands import Starts
from sequence_planner.planning.engine import Engine, Finding, Task
from sequence_planner.planning.engines import FACTORIES, Factory, Lane, Maker
from sequence_planner.planning.plan import Contract, one_by_one, starts_of
from sequence_planner.planning.single.derived import with_flags

LANE = Lane(
    "single",
    {
        Contract.MINIMAL: ("pairs", "bmc", "sums", "relaxation", "pdr", "a-star", "search"),
        Contract.FAST: ("pairs", "sums", "search", "relaxation", "pdr", "bmc", "a-star"),
    },
    first_turns={"pairs": 0.06, "sums": 0.02, "bmc": 1.0, "search": 0.3, "relaxation": 1.0, "pdr": 0.2},
    fast_first_turns={"search": 1.0, "bmc": 0.2},
    by_work=True,
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

    def solve(self, task: Task, budget: Budget) -> Finding:
        """What the engine finds, the starts of each tick one after the other; each could have had its own."""
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
    from sequence_planner.planning.pdr.engine import Reachability  # noqa: PLC0415

    flagged = with_flags(automaton)
    engine = Reachability(flagged, supervisor, tuple(flagged.abilities.values()))
    return _WithFlags(engine, flagged.flag_predicates)


class _WithFlags(Separately):
    """The same for an engine that asks for flags, which are all true."""

    def __init__(self, engine: Engine, flags: Iterable[str]) -> None:
        super().__init__(engine)
        self._flags = dict.fromkeys(flags, True)

    def solve(self, task: Task, budget: Budget) -> Finding:
        """What the engine finds in the state with its flags."""
        return super().solve(replace(task, state={**task.state, **self._flags}), budget)


def factories(starts: Starts) -> Mapping[str, Factory]:
    """Those of all engines, for an automaton with these `starts`."""
    return {
        "bmc": Maker("sat.single_starts", "SingleStarts", (starts,)),
        "a-star": Maker("heuristic.fewest", "FewestStarts"),
        "search": _Several(FACTORIES["search"]),
        "relaxation": FACTORIES["relaxation"],
        "pairs": Maker("single.pairs", "Pairs", (starts,)),
        "sums": Maker("single.sums", "Sums", (starts,)),
        "pdr": _proving,
    }
