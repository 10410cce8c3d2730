"""Plans for far goals, made of plans for the operations on the way there."""

from __future__ import annotations

from collections import Counter
from random import Random

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state
from sequence_planner.core.immutable import replace
from sequence_planner.language.types import BOOLEAN, EnumerationType
from sequence_planner.planning.heuristic.relaxation import reachable
from sequence_planner.planning.operation_decomposition import OperationByOperation, OperationTask
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import DEPTH, Circumstances, Contract, PlanRequest, Verdict, goals_of
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.planning.validation.replay import missing
from sequence_planner.process.budget import Budget
from support.automata import Does, automaton

from .choices import Choices
from .random_problems import problem
from .test_bounded import open_goals

EVERYTHING = Supervisor(StateSet((), ()), {})


def line(stages: int) -> Automaton:
    """A part is brought from each machine to the next, which has to be opened, worked at and closed.

    The last operation is written first, as nothing says in which order they are to be written.
    """
    places = EnumerationType(("store", *(f"machine_{n}" for n in range(stages))))
    abilities, effects, goals = dict[str, Does](), dict[str, tuple[str, tuple[str, ...]]](), dict[str, str]()
    for n in range(stages):
        before = "store" if n == 0 else f"machine_{n - 1}"
        ready = "" if n == 0 else f" and done_{n - 1}"
        abilities[f"carry_{n}"] = Does(
            start=(f"target := machine_{n}",), enabled=f"at == {before} and target == at and open_{n}{ready}"
        )
        effects[f"arrives_{n}"] = (f"target == machine_{n} and at != target", (f"at := machine_{n}",))
        abilities[f"open_{n}"] = Does(start=(f"open_{n} := true",), enabled=f"not open_{n}")
        abilities[f"close_{n}"] = Does(start=(f"open_{n} := false",), enabled=f"open_{n}")
        abilities[f"work_{n}"] = Does(
            start=(f"run_{n} := true",), enabled=f"at == machine_{n} and not open_{n} and not run_{n}"
        )
        effects[f"works_{n}"] = (f"run_{n} and not done_{n}", (f"done_{n} := true",))
        goals[f"stage_{n}"] = f"done_{n} and open_{n}"
    off = (BOOLEAN, False)
    station = automaton(
        abilities,
        measured={"at": (places, "store")} | {f"done_{n}": off for n in range(stages)},
        output={"target": (places, "store")} | {f"run_{n}": off for n in range(stages)},
        estimated={f"open_{n}": off for n in range(stages)},
        effects=effects,
        goals=dict(reversed(goals.items())),
    )
    operations = {
        name: replace(each, precondition=station.operations[f"stage_{number - 1}"].goal) if number else each
        for name, each in station.operations.items()
        for number in [int(name.removeprefix("stage_"))]
    }
    return replace(station, operations=operations)


def only(station: Automaton, *names: str) -> PlanningTask:
    return PlanningTask(initial_state(station), goals_of(station, names), contract=Contract.FAST)


def ask(station: Automaton, task: PlanningTask) -> Finding:
    return OperationByOperation(station, EVERYTHING).solve(task, Budget.seconds(60))


def towards(station: Automaton, state: State, goal: str, offline: str = "") -> tuple[str, ...] | None:
    """Which operations seem to lead to the predicate `goal`."""
    possible = reachable(station, state, Circumstances(frozenset({offline}))).possible
    predicate = station.read_condition(goal)
    return OperationTask(station).towards(state, [predicate], possible)


def test_the_last_of_many_stages_is_reached_by_way_of_all_of_them() -> None:
    station = line(32)
    task = only(station, "stage_31")
    finding = ask(station, task)
    assert finding.plan is not None
    assert Acceptance.of(station, EVERYTHING).accepts(task, finding.plan)
    assert len(finding.plan.ticks) > DEPTH
    # Only the last one need be open in the end; how many others are left open depends on the time there is.
    assert 32 * 4 + 1 <= len(finding.plan.starts) <= 32 * 5
    assert (finding.proof, finding.searched) == (None, 0)


def test_a_planner_answers_with_it_where_nobody_else_finds_one_so_long() -> None:
    station = line(32)
    request = PlanRequest(initial_state(station), goals_of(station, ("stage_31",)), 60, contract=Contract.FAST)
    answer = Planner(station, EVERYTHING).answer(request)
    assert answer.verdict is Verdict.FOUND
    assert answer.plan is not None
    assert len(answer.plan.ticks) > DEPTH


def test_no_plan_is_longer_than_it_may_be() -> None:
    station = line(6)
    assert ask(station, replace(only(station, "stage_5"), longest=10)).plan is None


def test_it_goes_on_where_the_time_ended() -> None:
    station = line(12)
    engine, task = OperationByOperation(station, EVERYTHING), only(station, "stage_11")
    turn = 0.01  # seconds; each is longer than the one before, as those of engines are
    while (plan := engine.solve(task, Budget.seconds(turn)).plan) is None:
        turn *= 1.1
        assert turn < 60
    assert Acceptance.of(station, EVERYTHING).accepts(task, plan)


def test_operations_come_in_the_order_in_which_they_can_be_pursued() -> None:
    station = line(4)
    state = initial_state(station)
    assert towards(station, state, "done_3 and open_3") == ("stage_0", "stage_1", "stage_2", "stage_3")
    assert towards(station, state, "done_1") == ("stage_0", "stage_1")
    assert towards(station, state, "at == machine_2") == ()  # no operation says so, but it may come about
    assert towards(station, state, "at == machine_2", offline="station") is None


def test_an_operation_does_not_bring_what_another_is_for() -> None:
    states = EnumerationType(("empty", "placed", "tight"))
    station = automaton(
        {"place": Does(start=("bolt := placed",)), "tighten": Does(start=("bolt := tight",), enabled="bolt == placed")},
        estimated={"bolt": (states, "empty")},
        goals={"placing": "bolt != empty", "tightening": "bolt == tight"},
    )
    operations = dict(station.operations)
    operations["tightening"] = replace(operations["tightening"], precondition=station.read_condition("bolt == placed"))
    station = replace(station, operations=operations)
    assert towards(station, initial_state(station), "bolt == tight") == ("placing", "tightening")
    assert towards(station, initial_state(station), "bolt != empty") == ("placing",)


def test_it_is_no_engine_where_no_operation_leads_to_the_goals() -> None:
    station = line(3)
    task = PlanningTask(initial_state(station), goals_of(station, ("stage_0",)), contract=Contract.FAST)
    bare = replace(station, operations={})
    assert ask(bare, task).plan is None


def test_what_it_finds_is_a_plan() -> None:
    """Of random stations, where each operation needs the goal of the one before; some goals have formulas."""
    met = Counter[str]()
    for number in range(300):
        choices = Choices(Random(f"operation by operation.{number}").randrange)
        given_ = problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))
        if not (goals := open_goals(given_)):
            continue
        names = list(given_.automaton.operations)
        chained = {
            name: each if place == 0 else replace(each, precondition=given_.automaton.operations[names[place - 1]].goal)
            for place, (name, each) in enumerate(given_.automaton.operations.items())
        }
        station = replace(given_.automaton, operations=chained)
        task = PlanningTask(given_.state, missing(goals, given_.state), given_.circumstances, Contract.FAST, longest=30)
        finding = OperationByOperation(station, given_.supervisor).solve(task, Budget.seconds(30))
        assert (finding.proof, finding.searched) == (None, 0)
        if finding.plan is not None:
            met["plans"] += 1
            met["long plans"] += len(finding.plan.ticks) > 3
            met["formulas"] += any(goal.local is not goals[0].local for goal in goals)
            assert Acceptance.of(station, given_.supervisor).accepts(task, finding.plan)
    assert met["plans"] > 15, met
    assert met["long plans"] > 1, met
