"""What the relaxation says that a supervisor never allows, it never allows."""

from __future__ import annotations

import pytest
from hypothesis import assume, given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange
from sequence_planner.planning.heuristic.unreachable import Relaxing
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import goals_of
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import Supervision, relevant, supervisor, synthesise
from sequence_planner.synthesis.transition_relation import Plant
from support.automata import Does, automaton
from support.examples import examples

from .breadth_first import shortest
from .choices import Choices, made_by

OFF = (BOOLEAN, False)
PLACE = EnumerationType(("home", "work"))

COUNTS = automaton(
    {"go": Does(start=("a := true", "x := x + 1"), when="not a and x == 0")},
    estimated={"a": OFF, "x": (IntegerRange(0, 1), 0)},
    forbidden={"none": "a and x == 0"},
    goals={"a": "a"},
)
COPIES = automaton(
    {"go": Does(start=("a := true", "pose := aim"), when="not a")},
    estimated={"a": OFF, "pose": (PLACE, "home")},
    output={"aim": (PLACE, "work")},
    forbidden={"there": "a and pose == home"},
    goals={"a": "a"},
)


@pytest.mark.parametrize("station", [COUNTS, COPIES])
def test_what_depends_on_the_state_may_be_written(station: Automaton) -> None:
    task = PlanningTask(initial_state(station), goals_of(station, station.operations))
    assert Relaxing(station, synthesise(station)).solve(task, Budget.seconds(60)).proof is None


def counting(choices: Choices) -> Automaton:
    """A few abilities that count, copy and set, under a specification."""

    def start() -> str:
        return choices.pick(("x := x + 1", "x := y", "y := x", "y := 2", "x := 0", "a := true", "a := x == y"))

    def asked() -> str:
        return "x < 2 and " + choices.pick(("true", "x == y", "not a", "a", "y == 0", "x != y"))

    abilities = {
        f"go_{number}": Does(start=tuple({(each := start()).split()[0]: each for _ in range(2)}.values()), when=asked())
        for number in range(choices.number(1, 4))
    }
    number = IntegerRange(0, 2)
    kept = choices.pick(("a and x == 0", "x == 2 and y == 0", "a and x == y", "y == 2 and not a and x == 1"))
    return automaton(
        abilities,
        estimated={"a": OFF, "x": (number, choices.number(0, 1)), "y": (number, choices.number(0, 1))},
        forbidden={"kept": kept},
        goals={"there": choices.pick(("a", "x == 2", "y == 2 and a", "x == y and a"))},
    )


@examples(200)
@given(made_by(counting))
def test_nothing_is_proven_where_there_is_a_plan(station: Automaton) -> None:
    state = initial_state(station)
    supervision = Supervision(Plant(station, relevant(station)))
    assume(supervision.possible)
    known, goals = supervisor(supervision), goals_of(station, station.operations)
    assume(shortest(station, known, state, goals, 6) is not None)
    assert Relaxing(station, known).solve(PlanningTask(state, goals), Budget.seconds(60)).proof is None
