"""What is asked of a person when belief and measurement do not go together."""

from __future__ import annotations

from hypothesis import given

from core.choices import made_by
from core.random_stations import automaton as random_station
from sequence_planner.analysis.mutual_exclusion import MOST_BITS, NeverTogether, never_together
from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.tick import initial_state
from sequence_planner.controller.recovery.consistency import contradictions, questions
from sequence_planner.language.types import Value
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import SynthesisError, synthesise
from support.examples import examples
from support.simulated import truck_engine

PATIENCE = 60.0


def known(automaton: Automaton, most_bits: int = MOST_BITS) -> NeverTogether | None:
    try:
        return never_together(automaton, synthesise(automaton), Budget.seconds(PATIENCE), most_bits)
    except SynthesisError:
        return None


@given(made_by(random_station), made_by(lambda choices: choices.number(0, 1)))
@examples(40)
def test_no_state_that_is_reached_is_contradictory(automaton: Automaton, coarse: int) -> None:
    exact = known(automaton)
    if exact is None or exact.fits is None:
        return
    pairs = known(automaton, most_bits=0) if coarse else exact
    assert pairs is not None
    measured = automaton.names(Kind.MEASURED)
    for state in exact.fits.members():
        assert contradictions(automaton, exact, state).because == ()
        assert contradictions(automaton, pairs, state).because == ()
        assert contradictions(automaton, exact, {**state, **dict.fromkeys(measured)}).because == ()


@given(made_by(random_station))
@examples(40)
def test_by_each_hypothesis_all_fits_and_none_has_needless_changes(automaton: Automaton) -> None:
    found = known(automaton)
    if found is None or found.fits is None or not automaton.names(Kind.ESTIMATED):
        return
    members = [dict(member) for member in found.fits.members()]
    estimates = automaton.names(Kind.ESTIMATED)
    for state in members:
        for name in estimates:
            for value in automaton.types[name].domain:
                wrong: State = {**state, name: value}
                said = contradictions(automaton, found, wrong)
                if not said.because:
                    assert not said.hypotheses
                    continue
                assert said.hypotheses
                assert all({**wrong, **hypothesis} in members for hypothesis in said.hypotheses)
                fewest = min(sum(m[e] != wrong[e] for e in estimates) for m in fitting(members, wrong, estimates))
                assert {len(hypothesis) for hypothesis in said.hypotheses} == {fewest}
                first = questions(automaton, said, wrong)[0]
                assert first.believed == wrong[first.variable]
                assert set(first.possible) - {first.believed}


def fitting(members: list[dict[str, Value]], state: State, estimates: tuple[str, ...]) -> list[dict[str, Value]]:
    return [m for m in members if all(m[name] == state[name] for name in m if name not in estimates)]


def bolt_station() -> tuple[Automaton, State]:
    automaton = truck_engine()[0].automaton
    return automaton, initial_state(automaton)


def test_a_bolt_that_is_asked_for_is_not_there_yet() -> None:
    automaton, state = bolt_station()
    found = known(automaton)
    assert found is not None
    wrong = {**state, "operator.requested_pair": "bolt_pair_2", "bolts[bolt_pair_2]": "placed"}
    said = contradictions(automaton, found, wrong)
    assert said.because == (
        "“bolts[bolt_pair_2] == placed” does not fit what is measured: operator.requested_pair == bolt_pair_2",
    )
    [question] = questions(automaton, said, wrong)
    assert (question.variable, question.believed, question.possible) == ("bolts[bolt_pair_2]", "placed", ["empty"])
    assert contradictions(automaton, NeverTogether(found.pairs, None), wrong).hypotheses == said.hypotheses


def test_a_measurement_that_never_comes_without_a_fault_says_nothing_of_beliefs() -> None:
    automaton, state = bolt_station()
    found = known(automaton)
    assert found is not None
    impossible = {**state, "nutrunner.tool_is_idle": True, "nutrunner.tool_is_running_forward": True}
    assert contradictions(automaton, found, impossible).because == ()


def test_the_question_that_separates_most_comes_first() -> None:
    automaton, state = bolt_station()
    found = known(automaton)
    assert found is not None
    # The tool has reached its torque at a bolt, and no bolt at all is believed to be there.
    wrong = {
        **state,
        "nutrunner.tool_is_idle": False,
        "nutrunner.set_tool_idle": False,
        "nutrunner.run_tool_forward": True,
        "nutrunner.tool_is_running_forward": True,
    }
    said = contradictions(automaton, found, wrong)
    hypotheses = [dict(hypothesis) for hypothesis in said.hypotheses]
    assert sorted(hypotheses, key=str) == [{f"bolts[bolt_pair_{n}]": "placed"} for n in (1, 2, 3)]
    asked = questions(automaton, said, wrong)
    assert {question.variable for question in asked} == {f"bolts[bolt_pair_{n}]" for n in (1, 2, 3)}
    assert all(question.possible == ["empty", "placed"] for question in asked)


def test_what_is_wrong_whatever_else_is_so_comes_first() -> None:
    automaton, state = bolt_station()
    found = known(automaton)
    assert found is not None
    # The tool turns, at the bolts of which one pair, which has just been asked for, is believed to be there.
    wrong = {
        **state,
        "operator.requested_pair": "bolt_pair_2",
        "bolts[bolt_pair_2]": "placed",
        "nutrunner.tool_is_idle": False,
        "nutrunner.set_tool_idle": False,
        "nutrunner.run_tool_forward": True,
        "nutrunner.tool_is_running_forward": True,
    }
    first, *others = questions(automaton, contradictions(automaton, found, wrong), wrong)
    assert (first.variable, first.possible) == ("bolts[bolt_pair_2]", ["empty"])
    assert {question.variable for question in others} == {"bolts[bolt_pair_1]", "bolts[bolt_pair_3]"}
