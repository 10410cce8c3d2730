"""Every engine of the planner beside exhaustive search, on one random problem."""

from __future__ import annotations

from collections import Counter
from random import Random

from sequence_planner.planning.heuristic.projection import GoalByGoal, Projection
from sequence_planner.planning.heuristic.search import HeuristicSearch, ShortestSearch
from sequence_planner.planning.pdr.ic3 import Reachability
from sequence_planner.planning.portfolio.engine import Engine, Finding, PlanningTask
from sequence_planner.planning.problem import Contract
from sequence_planner.planning.sat.bmc import BoundedModelChecking, PartialSight
from sequence_planner.planning.validation.replay import Replay, missing
from sequence_planner.process.budget import Budget

from .breadth_first import Shortest, shortest
from .choices import Choices
from .random_problems import Problem, problem

_LONGEST = 40  # ticks; the random stations have far fewer states
_SECONDS = 60.0


def compare_engines(seed: str) -> Counter[str]:
    """Ask all engines about the problem that `seed` makes; what has been met. Raises `AssertionError`."""
    choices = Choices(Random(seed).randrange)
    unknown, demanding = choices.chance(4), choices.chance(2)
    given = problem(choices, unknown, demanding)
    left = missing(given.goals, given.state)
    met = Counter(problems=1)
    met["with unknown values"] = unknown
    met["with formulas or circumstances"] = demanding
    if not left:
        return met + Counter({"goals met already": 1})
    best = shortest(given.automaton, given.supervisor, given.state, left, _LONGEST, given.circumstances)
    met["without a plan" if best is None else "with a plan"] += 1
    for engine in engines(given):
        for contract in Contract:
            task = PlanningTask(given.state, left, given.circumstances, contract, _LONGEST)
            met += _judged(engine, task, given, best)
    return met


def engines(given: Problem) -> tuple[Engine, ...]:
    """All of them, for one problem."""
    return (
        BoundedModelChecking(given.automaton, given.supervisor),
        PartialSight(given.automaton, given.supervisor, most=1.0),
        Projection(given.automaton, given.supervisor),
        GoalByGoal(given.automaton, given.supervisor),
        HeuristicSearch(given.automaton, given.supervisor),
        ShortestSearch(given.automaton, given.supervisor),
        Reachability(given.automaton, given.supervisor),
    )


def _judged(engine: Engine, task: PlanningTask, given: Problem, best: Shortest | None) -> Counter[str]:
    finding = engine.solve(task, Budget.seconds(_SECONDS))
    what = f"{engine.name}, {task.contract.value}: "
    assert finding.plan is None or finding.proof is None
    if best is None:
        assert finding.plan is None, f"{what}a plan where there is none"
        return Counter({f"{what}proofs": finding.proof is not None})
    assert finding.proof is None, f"{what}a proof that there is no plan, and there is one"
    assert finding.searched <= best.ticks, f"{what}{finding.searched} ticks are said to be too few"
    if finding.plan is None:
        return Counter()
    _judge_plan(what, finding, task, given, best)
    return Counter({f"{what}plans": 1})


def _judge_plan(what: str, finding: Finding, task: PlanningTask, given: Problem, best: Shortest) -> None:
    assert finding.plan is not None
    plan = finding.plan
    replay = Replay(given.automaton, given.supervisor, task.circumstances)
    assert replay.exactly(task.state, task.state, task.goals, (), plan.ticks), f"{what}does not replay"
    if plan.minimal_ticks:
        assert len(plan.ticks) == best.ticks, f"{what}{len(plan.ticks)} ticks, {best.ticks} suffice"
        if plan.minimal_starts:
            assert len(plan.starts) == best.starts, f"{what}{len(plan.starts)} starts, {best.starts} suffice"
