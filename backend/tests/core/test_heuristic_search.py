"""Heuristic search finds plans that replay, breadth-first search the shortest ones, and estimates are what they say."""

from __future__ import annotations

import json
import time

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import BOOLEAN
from sequence_planner.model.efa_document import read_plain
from sequence_planner.planning.efa_planner import plan_transitions
from sequence_planner.planning.heuristic.relaxed_task import Estimator, RelaxedTask
from sequence_planner.planning.heuristic.search import HeuristicSearch, ShortestSearch
from sequence_planner.planning.heuristic.shorten import Elimination
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Contract, Goal, Plan, PlanTick, goals_of
from sequence_planner.planning.single.derived import for_planning
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget
from support import automata
from support.examples import TIMED, examples

from .breadth_first import Shortest, shortest
from .choices import Choices, made_by
from .random_problems import Problem, problem

LONGEST = 6
FREE = Supervisor(StateSet((), ()), {})


def any_problem(choices: Choices) -> Problem:
    """With formulas, offline resources and states to avoid now and then, and with unknown values."""
    return problem(choices, unknown=choices.chance(3), demanding=choices.chance(2))


def task_of(given_: Problem, longest: int = LONGEST) -> PlanningTask:
    goals = missing(given_.goals, given_.state)
    return PlanningTask(given_.state, goals, given_.circumstances, Contract.FAST, longest)


def replays(given_: Problem, ticks: tuple[PlanTick, ...]) -> bool:
    """On the reference tick, and within the circumstances."""
    return Acceptance(given_.automaton, given_.supervisor).accepts(
        task_of(given_, longest=60), Plan(ticks, False, False)
    )


def budget() -> Budget:
    return Budget.seconds(60)


@examples(150)
@given(made_by(any_problem))
def test_every_plan_replays_and_is_found_where_there_is_a_short_one(given_: Problem) -> None:
    task = task_of(given_, longest=60)
    plan = HeuristicSearch(given_.automaton, given_.supervisor).solve(task, budget()).plan
    best = shortest(
        given_.automaton, given_.supervisor, given_.state, task.goals, LONGEST, circumstances=given_.circumstances
    )
    assert plan is not None or best is None
    if plan is None:
        return
    assert replays(given_, plan.ticks)
    if best is not None:
        assert len(plan.ticks) >= best.ticks
        if plan.minimal_ticks:
            assert len(plan.ticks) == best.ticks


@examples(100)
@given(made_by(any_problem))
def test_no_start_of_a_plan_is_needless(given_: Problem) -> None:
    """None can be left out while all else stays in its tick."""
    plan = HeuristicSearch(given_.automaton, given_.supervisor).solve(task_of(given_, longest=60), budget()).plan
    for number, tick in enumerate(() if plan is None else plan.ticks):
        for index in range(len(tick.starts)):
            without = PlanTick(tick.effects, tick.starts[:index] + tick.starts[index + 1 :])
            assert plan is not None
            assert not replays(given_, (*plan.ticks[:number], without, *plan.ticks[number + 1 :]))


@examples(100)
@given(made_by(any_problem))
def test_breadth_first_search_finds_the_fewest_ticks_and_then_the_fewest_starts(given_: Problem) -> None:
    task = task_of(given_)
    finding = ShortestSearch(given_.automaton, given_.supervisor).solve(task, budget())
    best = shortest(
        given_.automaton, given_.supervisor, given_.state, task.goals, LONGEST, circumstances=given_.circumstances
    )
    if best is None:
        assert finding.plan is None
        assert finding.searched == LONGEST
        return
    assert finding.plan is not None
    assert Shortest(len(finding.plan.ticks), len(finding.plan.starts)) == best
    assert (finding.plan.minimal_ticks, finding.plan.minimal_starts) == (True, True)
    assert replays(given_, finding.plan.ticks)


@examples(100)
@given(made_by(lambda choices: problem(choices, unknown=choices.chance(3))))
def test_estimates_are_nothing_exactly_at_goals_and_never_endless_where_there_is_a_plan(given_: Problem) -> None:
    relaxed = RelaxedTask(given_.automaton, given_.supervisor)
    nodes = [relaxed.reaching(goal.predicate) for goal in given_.goals]
    estimator = Estimator(relaxed.graph, frozenset())
    for goal, node in zip(given_.goals, nodes, strict=True):
        met = holds(goal.predicate, given_.state)
        estimate = estimator.estimate(given_.state, [node])
        assert (estimate is not None and estimate.cost == 0) == met
        assert (estimator.least(given_.state, [node]) == 0) == met
        assert (estimate is None) == (estimator.least(given_.state, [node]) is None)
        best = shortest(given_.automaton, given_.supervisor, given_.state, (goal,), LONGEST)
        assert best is None or estimate is not None


def crane(boxes: int) -> Automaton:
    """It carries boxes, one at a time, all from the left to the right."""
    names = [f"box{number}" for number in range(boxes)]
    transitions = [
        {"event": f"to_{place}", "controllable": True, "guard": f"at != {place}", "set": {"at": place}}
        for place in ("left", "right")
    ]
    for name in names:
        for place in ("left", "right"):
            lifts = f"not full and at == {place} and {name} == {place}"
            lift = {"event": f"lift_{name}_{place}", "guard": lifts, "set": {name: "lifted", "full": True}}
            lowers = f"{name} == lifted and at == {place}"
            lower = {"event": f"lower_{name}_{place}", "guard": lowers, "set": {name: place, "full": False}}
            transitions += [{"controllable": True, **lift}, {"controllable": True, **lower}]
    document = {
        "name": "crane",
        "variables": {name: ["left", "right", "lifted"] for name in names} | {"at": ["left", "right"], "full": "bool"},
        "initial": " and ".join([*(f"{name} == left" for name in names), "at == left", "not full"]),
        "transitions": transitions,
        "goal": [f"F ({' and '.join(f'{name} == right' for name in names)})"],
    }
    return plain_automaton(read_plain(json.dumps(document), "crane.efa.json"))


def test_a_hundred_transitions_are_found_soon_and_none_is_needless() -> None:
    automaton = crane(25)
    began = time.process_time()
    answer = plan_transitions(automaton, FREE, goals_of(automaton, ("goal_1",)), contract=Contract.FAST)
    assert len(answer.transitions) == 4 * 25 - 1
    assert answer.engine == "search"
    assert not TIMED or time.process_time() - began < 2


def test_detours_are_left_out_of_long_orders() -> None:
    """Also those of several transitions, each of which the next one needs."""
    automaton = for_planning(crane(2))
    needed = ("lift_box0_left", "to_right", "lower_box0_right", "to_left")
    detour = ("lift_box1_left", "to_right", "to_left", "lower_box1_left", "to_right", "to_left")
    last = ("lift_box1_left", "to_right", "lower_box1_right")
    state = {name: automaton.initial_valuation[name] for name in automaton.variables}
    elimination = Elimination(automaton, FREE, PlanningTask(state, goals_of(automaton, ("goal_1",))))
    order = (*needed, *detour, *last)
    assert elimination.suits(order)
    assert elimination.eliminated(order, budget()) == (*needed, *last)


def test_goals_one_by_one_are_reached_like_goals_together() -> None:
    """A goal that has been reached may be lost again on the way to the next."""
    automaton = crane(3)
    there, back = (Goal(name, _at(automaton, name)) for name in ("right", "left"))
    state = {**automaton.initial_valuation, "at": "right"}
    answer = plan_transitions(automaton, FREE, (there, back), state)
    assert (answer.transitions, answer.minimal) == (("to_left",), True)
    whole, *_ = goals_of(automaton, ("goal_1",))
    answer = plan_transitions(automaton, FREE, (whole, back), state)
    assert len(answer.transitions) == 1 + 4 * 3 - 1
    assert answer.minimal


def _at(automaton: Automaton, place: str) -> Expression:
    return automaton.read_condition(f"at == {place}")


def test_what_is_needless_only_where_a_device_tarries_stays() -> None:
    """A part that nobody holds slips away soon, and would have to wait until it is drilled."""
    off = (BOOLEAN, False)
    station = automata.automaton(
        {
            "hold": automata.Does(start=("held := true",), enabled="not held"),
            "drill": automata.Does(start=("drilling := true",), enabled="not drilling"),
        },
        measured={"there": (BOOLEAN, True), "turning": off, "deep": off},
        output={"held": off, "drilling": off},
        effects={
            "slips": ("drilling and not held and there", ("there := false",)),
            "turns": ("drilling and not turning", ("turning := true",)),
            "drills": ("turning and there and not deep", ("deep := true",)),
        },
        goals={"drilled": "deep"},
    )
    task = PlanningTask(initial_state(station), goals_of(station, ("drilled",)), contract=Contract.FAST)
    plan = HeuristicSearch(station, FREE).solve(task, budget()).plan
    assert plan is not None
    assert sorted(name for _, name in plan.starts) == ["drill", "hold"]
    tarrying = (PlanTick((), ("drill",)), PlanTick(("turns",), ()), PlanTick(("drills",), ()))
    assert Acceptance(station, FREE).accepts(task, Plan(tarrying, False, False))
