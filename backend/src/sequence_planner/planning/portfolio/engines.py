"""The engines there are, where each of them works, and how several take turns in one thread."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from importlib import import_module
from math import inf

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.immutable import Immutable
from sequence_planner.planning import problem
from sequence_planner.planning.portfolio.engine import Engine, Finding, PlanningTask
from sequence_planner.planning.problem import Contract
from sequence_planner.process.budget import Budget

# Seconds of this process's work, however long others hold it up; each further turn is twice as long, so that no engine
# costs another much more than its own time.
FIRST_TURN = 0.1
LONG_FIRST_TURNS = {
    "first sight": 1.0,
    "partial sight": 2.0,
    "goal by goal": 0.2,
    "projection": 0.2,
    "search": 0.5,
    "operation by operation": 1.0,
    "bmc": 1.5,
    "relaxation": 2.0,
}

AS_USUAL: Mapping[str, float] = {}  # no proxy: lanes are sent to processes

Factory = Callable[[Automaton, Supervisor], Engine]


class EngineReport(Immutable):
    """The finding of an engine in one turn; with `trouble` it failed at that, and found nothing."""

    engine: str
    finding: Finding
    trouble: str = ""


class Lane(Immutable):
    """Engines that share a process, in the order of their turns, for each contract."""

    name: str
    engines: Mapping[Contract, tuple[str, ...]]
    niceness: int = 5  # ticks are not held up by planning
    first_turns: Mapping[str, float] = LONG_FIRST_TURNS  # of those whose first turn is not `FIRST_TURN`
    fast_first_turns: Mapping[str, float] = AS_USUAL  # where it is another one then

    def first_turn(self, engine: str, contract: Contract) -> float:
        """The seconds of its first turn."""
        usual = self.first_turns.get(engine, FIRST_TURN)
        return self.fast_first_turns.get(engine, usual) if contract is Contract.FAST else usual

    @property
    def all_engines(self) -> tuple[str, ...]:
        """Every engine of the lane."""
        return tuple(dict.fromkeys(name for names in self.engines.values() for name in names))


class EngineMaker(Immutable):
    """Makes engines of a class that is imported only when one is made: a command needs few of them.

    What they have in common with others is made before, and is `shared`.
    """

    module: str
    kind: str
    shared: tuple[object, ...] = ()

    def __call__(self, automaton: Automaton, supervisor: Supervisor) -> Engine:
        """A new engine."""
        engine: Engine = getattr(import_module(f"sequence_planner.planning.{self.module}"), self.kind)(
            automaton, supervisor, *self.shared
        )
        return engine


FACTORIES: Mapping[str, Factory] = {
    "bmc": EngineMaker("sat.bmc", "BoundedModelChecking"),
    "partial sight": EngineMaker("sat.bmc", "PartialSight"),
    "goal by goal": EngineMaker("heuristic.projection", "GoalByGoal"),
    "projection": EngineMaker("heuristic.projection", "Projection"),
    "search": EngineMaker("heuristic.search", "HeuristicSearch"),
    "operation by operation": EngineMaker("operation_decomposition", "OperationByOperation"),
    "breadth-first": EngineMaker("heuristic.search", "ShortestSearch"),
    "relaxation": EngineMaker("heuristic.unreachable", "Relaxing"),
    "pdr": EngineMaker("pdr.ic3", "Reachability"),
    "first sight": EngineMaker("pdr.quick_proof", "QuickProof"),
}

# Racing, in processes of their own.
LANES = (
    Lane("sat", {Contract.MINIMAL: ("partial sight", "bmc"), Contract.FAST: ("goal by goal", "projection", "bmc")}),
    Lane(
        "search",
        {
            Contract.MINIMAL: ("projection", "breadth-first", "search", "operation by operation"),
            Contract.FAST: ("operation by operation", "search"),
        },
    ),
    Lane("proof", dict.fromkeys(Contract, ("relaxation", "pdr")), niceness=10),
)

# Taking turns, where a process of its own for each would cost more than it brings.
ALONE = Lane(
    "alone",
    {
        Contract.MINIMAL: (
            "first sight",
            "partial sight",
            "bmc",
            "projection",
            "relaxation",
            "pdr",
            "breadth-first",
            "search",
            "operation by operation",
        ),
        Contract.FAST: (
            "first sight",
            "goal by goal",
            "projection",
            "operation by operation",
            "search",
            "relaxation",
            "bmc",
            "pdr",
        ),
    },
    fast_first_turns={"goal by goal": 0.12, "projection": 0.05},  # what they find soon they find by then
)


class Engines:
    """The engines of one lane, each made when it is first needed and warm from then on."""

    def __init__(
        self, automaton: Automaton, supervisor: Supervisor, lane: Lane, factories: Mapping[str, Factory] = FACTORIES
    ) -> None:
        self._model = (automaton, supervisor)
        self._lane = lane
        self._factories = factories
        self._made: dict[str, Engine] = {}

    def prepare(self) -> None:
        """Make all of them now; one that cannot be made is tried again when it is needed."""
        for name in self._lane.all_engines:
            try:
                self._engine(name)
            except Exception:
                problem.log("the engine %s cannot be made", name, trace=True)

    def work(
        self,
        task: PlanningTask,
        budget: Budget,
        patience: Callable[[], float] = lambda: inf,
        without: Set[str] = frozenset(),
    ) -> Iterator[EngineReport]:
        """Yield what they find, turn by turn, until each but those `without` has given up or the budget is spent.

        No turn is longer than `patience` has seconds when it begins. An engine that fails is made anew for the next
        task: what it has learnt could be wrong.
        """
        waiting: Sequence[str] = [name for name in self._lane.engines[task.contract] if name not in without]
        longer = 1
        while waiting and not budget.spent:
            going_on: list[str] = []
            for name in waiting:
                turn = longer * self._lane.first_turn(name, task.contract) if len(waiting) > 1 else inf
                most = patience()
                own = budget.working(turn) if turn <= most else budget.seconds_of_work(most)
                report = self._turn(name, task, own)
                yield report
                if own.spent and not report.trouble:
                    going_on.append(name)  # one that ends before its time has nothing more to say
                if budget.spent:
                    return
            waiting, longer = going_on, 2 * longer

    def _turn(self, name: str, task: PlanningTask, budget: Budget) -> EngineReport:
        try:
            return EngineReport(name, self._engine(name).solve(task, budget))
        except Exception as error:
            problem.log("the engine %s failed", name, trace=True)
            self._made.pop(name, None)
            return EngineReport(name, Finding(), f"{type(error).__name__}: {error}")

    def _engine(self, name: str) -> Engine:
        if name not in self._made:
            self._made[name] = self._factories[name](*self._model)
        return self._made[name]
