"""When it is worth while to wait for more."""

from __future__ import annotations

from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.types import IntegerRange
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Contract, PlanRequest, Verdict, goals_of
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton


def test_by_the_minimal_contract_too_a_plan_is_found_that_is_longer_than_what_is_proven() -> None:
    """And an impossible goal beside it does not take its plan away."""
    station = automaton(
        {"count": Does(start=("n := n + 1",), when="n < 90")},
        estimated={"n": (IntegerRange(0, 90), 0)},
        goals={"far": "n == 75", "never": "n == 3 and n == 4"},
    )
    planner = Planner(station, synthesise(station))
    for names in (("far",), ("far", "never")):
        goals = goals_of(station, names)
        answer = planner.answer(PlanRequest(initial_state(station), goals, 8.0, contract=Contract.MINIMAL))
        assert answer.verdict is Verdict.FOUND
        assert answer.goals == ("far",)
        assert answer.plan is not None
        assert len(answer.plan.ticks) == 76
