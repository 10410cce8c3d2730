"""What a model checker finds in the exported module is a plan: the module, read back, against the reference tick."""

from __future__ import annotations

from hypothesis import assume, given

from sequence_planner.automaton.tick import initial_state
from sequence_planner.export.sequential import sequential
from sequence_planner.export.smv import smv_text
from sequence_planner.language.syntax import Variable
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.problem import Goal
from support.examples import examples

from .breadth_first import shortest
from .choices import made_by
from .random_problems import Problem, problem
from .smv_reader import Module
from .test_exporting_pddl import FREE, contended, two_lamps

TICK = "finishing"


def compare(asked: Problem, goals: Goals) -> None:
    assume(asked.supervisor.safe.includes(asked.state))
    text = smv_text(sequential(asked.automaton, asked.supervisor, asked.state, goals, asked.circumstances))
    best = shortest(asked.automaton, asked.supervisor, asked.state, goals, 1000, asked.circumstances)
    found = Module(text).cheapest(TICK)
    assert (found is None) == (best is None)
    if best is not None and TICK in Module(text).actions:
        assert found == best.ticks


@examples(60)
@given(made_by(problem))
def test_the_shortest_counterexample_has_as_many_ticks_as_the_shortest_plan(asked: Problem) -> None:
    compare(asked, asked.goals)


@examples(40)
@given(made_by(contended))
def test_effects_that_read_what_others_write_still_see_the_state_before_the_tick(asked: Problem) -> None:
    compare(asked, asked.goals)


def test_names_are_none_of_the_language() -> None:
    station = two_lamps()
    text = smv_text(sequential(station, FREE, initial_state(station), (Goal("next", Variable("lit", BOOLEAN)),)))
    module = Module(text)
    assert {"start_Left", "start_left", "effect_light", "reach_next"} <= set(module.actions)
    assert module.cheapest(TICK) == 2
