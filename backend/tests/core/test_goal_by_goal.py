"""Plans for several goals, made one after the other and taken beside each other."""

from __future__ import annotations

from collections import Counter
from random import Random

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state, start
from sequence_planner.language.types import BOOLEAN, EnumerationType
from sequence_planner.planning.heuristic.projection import CausalOrder, GoalByGoal
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Contract, Plan, PlanTick, goals_of
from sequence_planner.planning.sat.bmc import BoundedModelChecking
from sequence_planner.planning.validation.replay import Replay
from sequence_planner.process.budget import Budget
from support.automata import Does, automaton
from support.examples import examples

from .choices import Choices, made_by
from .random_problems import Problem, problem
from .test_bounded import open_goals, valid

EVERYTHING = Supervisor(StateSet((), ()), {})
OFF = (BOOLEAN, False)


def shop(jobs: list[int]) -> Automaton:
    """Machines that one vehicle serves; each then has so many steps to do with its part, whatever the others do."""
    places = EnumerationType(("store", *(f"machine_{n}" for n in range(len(jobs)))))
    abilities = {
        "go_store": Does(start=("target := store",), enabled="at == target and at != store and not loaded"),
        "load": Does(start=("loaded := true",), enabled="at == store and target == store and not loaded"),
    }
    effects = {
        f"arrives_{place}": (f"target == {place} and at != {place}", (f"at := {place}",)) for place in places.values
    }
    for n, steps in enumerate(jobs):
        abilities[f"go_{n}"] = Does(
            start=(f"target := machine_{n}",), enabled="at == store and target == store and loaded"
        )
        there = f"at == machine_{n} and loaded and not has_{n}"
        abilities[f"unload_{n}"] = Does(start=("loaded := false", f"has_{n} := true"), enabled=there)
        for step in range(steps):
            before = f"has_{n}" if step == 0 else f"done_{n}_{step - 1}"
            abilities[f"do_{n}_{step}"] = Does(
                start=(f"run_{n}_{step} := true",), enabled=f"{before} and not run_{n}_{step}"
            )
            effects[f"does_{n}_{step}"] = (f"run_{n}_{step} and not done_{n}_{step}", (f"done_{n}_{step} := true",))
    steps_of = [(n, step) for n, steps in enumerate(jobs) for step in range(steps)]
    return automaton(
        abilities,
        measured={"at": (places, "store")} | {f"done_{n}_{step}": OFF for n, step in steps_of},
        output={"target": (places, "store")} | {f"run_{n}_{step}": OFF for n, step in steps_of},
        estimated={"loaded": OFF} | {f"has_{n}": OFF for n in range(len(jobs))},
        effects=effects,
        goals={f"part_{n}": f"done_{n}_{steps - 1}" for n, steps in enumerate(jobs)},
    )


def task_of(station: Automaton, contract: Contract = Contract.FAST) -> PlanningTask:
    goals = goals_of(station, station.operations)
    return PlanningTask(initial_state(station), goals, contract=contract)


def ask(station: Automaton, contract: Contract = Contract.FAST) -> Finding:
    return GoalByGoal(station, EVERYTHING).solve(task_of(station, contract), Budget.seconds(30))


def with_less(plan: Plan) -> list[tuple[PlanTick, ...]]:
    """`plan` without one of its starts, while all else stays in its tick."""
    found: list[tuple[PlanTick, ...]] = []
    for number, tick in enumerate(plan.ticks):
        for index in range(len(tick.starts)):
            less = PlanTick(tick.effects, tick.starts[:index] + tick.starts[index + 1 :])
            found.append((*plan.ticks[:number], less, *plan.ticks[number + 1 :]))
    return found


@examples(12)
@given(made_by(lambda choices: [choices.number(6, 9) for _ in range(choices.number(2, 3))]))
def test_what_shares_a_vehicle_is_planned_nearly_as_short_as_can_be(jobs: list[int]) -> None:
    station = shop(jobs)
    plan, task = ask(station).plan, task_of(station, Contract.MINIMAL)
    assert plan is not None
    replay = Replay(station, EVERYTHING)
    assert replay.exactly(task.state, task.state, task.goals, (), plan.ticks)
    assert not any(replay.exactly(task.state, task.state, task.goals, (), each) for each in with_less(plan))
    best = BoundedModelChecking(station, EVERYTHING).solve(task, Budget.seconds(60)).plan
    assert best is not None
    assert len(plan.ticks) <= 1.15 * len(best.ticks)


def test_random_goals() -> None:
    """What it finds is a plan, wherever it finds one, and some of these have formulas or circumstances."""
    met = Counter[str]()
    for number in range(400):
        choices = Choices(Random(f"goal by goal.{number}").randrange)
        given_ = problem(choices, unknown=choices.chance(4), demanding=choices.chance(2))
        if not (goals := open_goals(given_)):
            continue
        task = PlanningTask(given_.state, goals, given_.circumstances, Contract.FAST, longest=12)
        finding = GoalByGoal(given_.automaton, given_.supervisor).solve(task, Budget.seconds(30))
        assert (finding.proof, finding.searched) == (None, 0)
        if finding.plan is not None:
            met["plans"] += 1
            assert not finding.plan.minimal_ticks
            assert valid(given_, finding.plan)
    assert met["plans"] > 5, met


def test_goals_that_need_the_same_are_left_to_others() -> None:
    """Of one step each, most of which is the vehicle's."""
    assert ask(shop([1, 1])) == Finding()


def test_a_single_goal_and_minimal_plans_are_left_to_others() -> None:
    assert ask(shop([8])) == Finding()
    assert ask(shop([8, 8]), Contract.MINIMAL) == Finding()


def test_it_goes_on_where_the_budget_was_spent() -> None:
    station = shop([8, 8])
    task, engine = task_of(station), GoalByGoal(station, EVERYTHING)
    called_off = Budget.seconds(20)
    called_off.call_off()
    assert engine.solve(task, called_off) == Finding()
    assert engine.solve(task, Budget.seconds(20)) == ask(station)


def started(given_: Problem, state: State, names: list[str]) -> State | None:
    """After these starts, one after the other; None if not all can be."""
    for name in names:
        after = start(given_.automaton, state, given_.automaton.abilities[name])
        if after is None:
            return None
        state = after
    return state


@examples(200)
@given(made_by(lambda choices: (problem(choices), [choices.number(0, 1000) for _ in range(8)])))
def test_neighbours_that_do_not_wait_for_each_other_can_change_places(drawn: tuple[Problem, list[int]]) -> None:
    given_, numbers = drawn
    abilities, state, names = list(given_.automaton.abilities.values()), given_.state, list[str]()
    order = CausalOrder(given_.automaton)
    for number in numbers:
        ability = abilities[number % len(abilities)]
        after = start(given_.automaton, state, ability)
        if after is not None:
            order.starts(ability, state)
            names.append(ability.name)
            state = after
    for later in range(1, len(names)):
        if later - 1 not in order.events[later].after:
            exchanged = [*names[: later - 1], names[later], names[later - 1], *names[later + 1 :]]
            assert started(given_, given_.state, exchanged) == state
