"""Corrections: what is shown before, what is refused, what is made, and taken back."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AskCorrection
from sequence_planner.controller.commands.recovery import ConfirmEstimates, UndoCorrection
from sequence_planner.controller.views.details import CorrectionPreview
from sequence_planner.core.immutable import replace
from sequence_planner.execution.state import OperatorPlan, OperatorPlanKind
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Plan, PlanAnswer, PlanRequest
from sequence_planner.texts.message import Sentence
from support.people import ADAM, EVA

from .corrected import WHY, Station, what_is_never_together

BOLT = "bolts[bolt_pair_2]"


def preview(station: Station, then: str = "placed") -> CorrectionPreview:
    return asyncio.run(station.corrections.preview(AskCorrection(values={BOLT: then})))


def in_restart(station: Station) -> Station:
    station.execution.start_production()
    station.execution.change_mode(Mode.RESTART, "Eva", station.now)
    return station


def undo(station: Station) -> None:
    """Adam takes the last correction back."""
    last = station.corrections.last
    assert last is not None
    command = UndoCorrection(actor=ADAM, revision=last.revision, reason="that was another one")
    carry_out(station.corrections, command, station.now)


def refusal(act: Callable[[], object]) -> str:
    with pytest.raises(CommandRefused) as refused:
        act()
    return refused.value.slug


def test_a_preview_says_what_follows_and_changes_nothing() -> None:
    station = Station()
    before = station.execution.state
    shown = preview(station)
    assert station.execution.state == before
    assert shown.revision == station.execution.revision
    [change] = shown.changes
    assert (change.name, change.now, change.then) == (BOLT, "empty", "placed")
    assert change.belief.writer == "the model"
    place = change.related.index("robot.pose == home")
    said = change.related_messages[place].arguments["condition"]
    assert isinstance(said, Sentence)
    assert said.words["en"] == "the robot is at home"
    assert shown.safe
    assert shown.safe_now
    assert "nutrunner.run_nut" in shown.startable
    assert "operator.place_bolt_pair(bolt_pair_2)" in shown.no_longer_startable
    assert shown.obstacle is None
    assert shown.plan is not None
    assert shown.goals


def test_what_a_preview_says_is_what_comes() -> None:
    station = in_restart(Station())
    shown = preview(station)
    before = {name for name in station.automaton.abilities if station.execution.startable(name) is not None}
    station.correct({BOLT: "placed"}, shown.revision)
    after = {name for name in station.automaton.abilities if station.execution.startable(name) is not None}
    assert set(shown.startable) == after - before
    assert set(shown.no_longer_startable) == before - after
    active = station.execution.active
    station.tick()
    assert set(shown.activated) == station.execution.active - active
    assert set(shown.completed) == active - station.execution.active


def test_what_a_correction_would_violate_is_shown() -> None:
    station = Station()
    station.tick(robot__pose="bolt_pair_2")
    shown = preview(station)
    assert not shown.safe
    assert shown.violates


def test_a_contradiction_comes_and_goes_with_a_correction() -> None:
    station = Station(what_is_never_together())
    station.execution.start_production()
    request = {"operator.requested_pair": "bolt_pair_2"}
    station.execution.state = station.execution.corrected(request)
    shown = preview(station)
    [text] = shown.contradictions_new
    assert f"“{BOLT} == placed”" in text
    assert not shown.contradictions_gone
    station.execution.state = station.execution.corrected({BOLT: "placed"})
    shown = preview(station, then="empty")
    assert shown.contradictions_gone == [text]


def test_a_plan_that_nobody_can_make_now_leaves_the_rest() -> None:
    station = Station()

    async def is_away(request: PlanRequest, deadline: float) -> PlanAnswer:
        raise CommandRefused("advisor-unavailable", "It is started again.", 503)

    station.corrections._plan = is_away
    shown = preview(station)
    assert shown.plan is None
    assert "It is started again." in shown.reason
    assert shown.startable


def test_a_correction_is_made_with_its_reason_and_counts_as_evidence() -> None:
    station = in_restart(Station())
    station.correct({BOLT: "placed", "bolts[bolt_pair_1]": "tightened"})
    assert station.execution.state[BOLT] == "placed"
    assert station.beliefs.of(BOLT).writer == "Eva"
    last = station.corrections.last
    assert last is not None
    assert last.values == {BOLT: "placed", "bolts[bolt_pair_1]": "tightened"}
    assert last.before == {BOLT: "empty", "bolts[bolt_pair_1]": "empty"}
    assert (last.by, last.why, last.undoable) == ("Eva", WHY, True)


def test_one_step_of_undo() -> None:
    station = in_restart(Station())
    before = station.execution.state
    station.correct({BOLT: "placed"})
    shown = station.corrections.last
    assert shown is not None
    undo = UndoCorrection(actor=ADAM, revision=shown.revision, reason="that was another one")
    carry_out(station.corrections, undo, station.now)
    assert station.execution.state == before
    assert station.beliefs.of(BOLT).writer == "Adam"
    assert station.corrections.last is None
    again = UndoCorrection(actor=ADAM, revision=shown.revision, reason="once more")
    assert refusal(lambda: carry_out(station.corrections, again, station.now)) == "nothing-to-undo"


def test_an_undo_takes_the_answer_back_and_is_none_itself() -> None:
    """Whoever takes a correction back has not looked at the station."""
    other = "bolts[bolt_pair_1]"
    station = in_restart(Station())
    carry_out(station.corrections, ConfirmEstimates(actor=EVA, values={other: "empty"}, reason=WHY), station.now)
    station.correct({BOLT: "placed", other: "tightened"})
    assert station.execution.conduct.answers == {BOLT: "placed", other: "tightened"}
    undo(station)
    assert station.execution.conduct.answers == {other: "empty"}, "what was said before counts again"
    assert station.beliefs.of(BOLT).unconfirmed_since == station.now.epoch
    assert station.beliefs.of(other).unconfirmed_since is None


def test_an_undo_brings_no_answer_back_that_counts_no_more() -> None:
    station = in_restart(Station())
    carry_out(station.corrections, ConfirmEstimates(actor=EVA, values={BOLT: "empty"}, reason=WHY), station.now)
    station.correct({BOLT: "placed"})
    station.execution.conduct = replace(station.execution.conduct, answers={})  # as work went on with it
    undo(station)
    assert not station.execution.conduct.answers


def test_no_undo_of_another_correction_than_the_one_that_was_seen() -> None:
    station = in_restart(Station())
    station.correct({BOLT: "placed"})
    seen = station.corrections.last
    assert seen is not None
    station.correct({BOLT: "tightened"})
    undo = UndoCorrection(actor=ADAM, revision=seen.revision, reason="it is not placed")
    assert refusal(lambda: carry_out(station.corrections, undo, station.now)) == "stale-revision"
    assert station.execution.state[BOLT] == "tightened"


def test_no_undo_over_what_has_happened_since() -> None:
    station = in_restart(Station())
    station.correct({BOLT: "placed"})
    station.execution.correct({BOLT: "tightened"}, "Adam", "it is tight", station.now)
    assert station.corrections.last is not None
    assert not station.corrections.last.undoable
    undo = UndoCorrection(actor=EVA, revision=station.corrections.last.revision, reason="not so")
    assert refusal(lambda: carry_out(station.corrections, undo, station.now)) == "stale-revision"
    assert station.execution.state[BOLT] == "tightened"
    station.execution.correct({BOLT: "placed"}, "Adam", "another one is placed", station.now)
    assert not station.corrections.last.undoable
    assert refusal(lambda: carry_out(station.corrections, undo, station.now)) == "stale-revision"
    assert station.execution.state[BOLT] == "placed", "that is not what was corrected, though it looks the same"


@pytest.mark.parametrize(
    ("values", "slug"),
    [
        ({"bolt": "placed"}, "unknown-variable"),
        ({"robot.pose": "home"}, "not-estimated"),
        ({"robot.target_pose": "home"}, "not-estimated"),
        ({BOLT: "loose"}, "not-in-domain"),
        ({BOLT: True}, "not-in-domain"),
        ({BOLT: "placed", "bolts[bolt_pair_1]": 1}, "not-in-domain"),
    ],
)
def test_what_cannot_be_corrected(values: dict[str, Value], slug: str) -> None:
    station = in_restart(Station())
    before = station.execution.state
    assert refusal(lambda: station.correct(values)) == slug
    assert refusal(lambda: asyncio.run(station.corrections.preview(AskCorrection(values=values)))) == slug
    assert station.execution.state == before


def test_a_correction_of_what_has_moved_is_refused() -> None:
    station = in_restart(Station())
    seen = preview(station).revision
    station.tick(robot__pose="unknown")
    assert refusal(lambda: station.correct({BOLT: "placed"}, seen)) == "stale-revision"
    assert station.execution.state[BOLT] == "empty"


@pytest.mark.parametrize("mode", [Mode.AUTOMATIC, Mode.PAUSED, Mode.HOLD])
def test_corrections_are_for_restart_mode_once_production_is_started(mode: Mode) -> None:
    station = Station()
    station.execution.change_mode(mode, "Eva", station.now)
    station.correct({BOLT: "placed"})
    station.execution.start_production()
    assert refusal(lambda: station.correct({BOLT: "empty"})) == "not-in-restart"
    obstacle = preview(station, then="empty").obstacle
    assert obstacle is not None
    assert "restart mode" in obstacle
    assert station.corrections.last is not None
    assert not station.corrections.last.undoable


def test_nothing_is_corrected_under_an_errand() -> None:
    station = in_restart(Station())
    station.execution.start_operator_plan(
        OperatorPlan(OperatorPlanKind.GOAL, "go home", Plan((), True, True)), station.now
    )
    assert refusal(lambda: station.correct({BOLT: "placed"})) == "plan-running"


def test_confirming_is_for_what_was_seen() -> None:
    station = Station()
    wrong = ConfirmEstimates(actor=EVA, reason=WHY, values={BOLT: "placed"})
    assert refusal(lambda: carry_out(station.corrections, wrong, station.now)) == "stale-revision"
    right = ConfirmEstimates(actor=EVA, reason=WHY, values={BOLT: "empty"})
    carry_out(station.corrections, right, station.now)
    assert station.beliefs.of(BOLT).writer == "Eva"
    for name in station.automaton.names(Kind.ESTIMATED):
        if name != BOLT:
            assert station.beliefs.of(name).writer == "the model"
