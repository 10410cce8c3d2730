"""What somebody has said of an estimate counts while the station stands; no proposal contradicts it."""

from __future__ import annotations

import json

from controller.test_ways_taken import NAME, standing
from controller.ways import Taken
from planning.advice.rules import station
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.controller.recovery.safe_state import SafeStateMonitor
from sequence_planner.controller.views.wording import diagnosis_view
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.recorder import RunRecorder
from sequence_planner.execution.state import InitialState
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.planning.diagnosis import CorrectedValue, Correction, Diagnosis, Member, MemberKind, Reason
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Plan, Proof
from sequence_planner.texts.message import Sentence

BOLTS = "bolts[bolt_pair_1]"
RULE = "no_standing_tool_on_placed_bolts(bolt_pair_1)"
NOW = Timestamp(0.0, 0.0)
NOTHING = Plan((), False, False)


def answers(taken: Taken) -> dict[str, object]:
    return dict(taken.execution.conduct.answers)


def test_what_was_confirmed_or_corrected_is_an_answer_until_it_is_another_or_corrected_again() -> None:
    taken = standing()
    taken.execution.confirm(frozenset({BOLTS}), "Eva", NOW)
    assert answers(taken) == {BOLTS: "placed"}
    taken.execution.correct({"bolts[bolt_pair_2]": "tightened"}, "Eva", "seen", NOW)
    taken.tick()
    assert answers(taken) == {BOLTS: "placed", "bolts[bolt_pair_2]": "tightened"}
    taken.execution.correct({BOLTS: "empty"}, "Eva", "seen", NOW)
    assert answers(taken)[BOLTS] == "empty"


def test_an_answer_ends_when_automatic_mode_goes_on_with_what_it_is_about() -> None:
    tried = station(NAME)
    execution = Executor(tried.automaton, tried.supervisor)
    execution.start_production()
    execution.state = execution.published = synchronise(tried.automaton, initial_state(tried.automaton))
    taken = Taken(execution, tried.automaton, frozenset())
    taken.tick()
    execution.confirm(frozenset({BOLTS, "bolts[bolt_pair_2]"}), "Eva", NOW)
    execution.change_mode(Mode.RESTART, "Eva", NOW)
    execution.change_mode(Mode.PAUSED, "Eva", NOW)
    execution.change_mode(Mode.AUTOMATIC, "Eva", NOW)
    taken.tick()
    assert answers(taken) == {BOLTS: "empty", "bolts[bolt_pair_2]": "empty"}
    request = execution.request(20)
    assert request is not None
    execution.adopt(request, Planner(tried.automaton, tried.supervisor).answer(request))
    started: list[str] = []
    while not any("place_bolt_pair" in name for name in started):
        kept = set(answers(taken))
        assert kept == {BOLTS, "bolts[bolt_pair_2]"}
        started += taken.tick(taken.possible())
        assert taken.execution.ticks < 50
    (asked,) = (name for name in started if "place_bolt_pair" in name)
    pair = asked.removeprefix("operator.place_bolt_pair(").removesuffix(")")
    assert set(answers(taken)) == kept - {f"bolts[{pair}]"}


def test_an_answer_survives_a_start_of_the_controller() -> None:
    """The journal says it, and a beginning from there has it."""
    taken, written = standing(), list[dict[str, object]]()

    def write(kind: str, epoch: float, content: str) -> int:
        written.append(json.loads(content))
        return len(written)

    RunRecorder(taken.execution, write, "digest")
    taken.execution.confirm(frozenset({BOLTS}), "Eva", NOW)
    assert written[-1]["answers"] == {BOLTS: "placed"}
    tried = station(NAME)
    known = InitialState({BOLTS: "placed"}, None, (), frozenset(), NOW, answers={BOLTS: "placed"})
    assert Executor(tried.automaton, tried.supervisor, known).conduct.answers == {BOLTS: "placed"}


def test_neither_the_nearest_safe_state_nor_what_would_help_contradicts_an_answer() -> None:
    taken = standing()
    outside = SafeStateMonitor(taken.execution)
    assert outside.situation is not None
    assert [each.name for each in outside.situation.differences] == [BOLTS]
    taken.execution.confirm(frozenset({BOLTS}), "Eva", NOW)
    assert outside.situation is not None
    assert outside.situation.differences
    assert BOLTS not in [each.name for each in outside.situation.differences]
    tight = Correction((CorrectedValue(BOLTS, "tightened"),), NOTHING)
    online = Correction((CorrectedValue("robot", None),), NOTHING)
    found = Diagnosis(None, (tight, online))
    said = f"{BOLTS} := tightened, only if you have checked that it is so"
    assert diagnosis_view(taken.execution.automaton, found, ()).corrections == ["robot online", said]
    assert diagnosis_view(taken.execution.automaton, found, (), taken.execution.conduct.answers).corrections == [
        "robot online"
    ]


def test_why_there_is_no_plan_is_told_in_titles_to_people_and_in_names_to_programs() -> None:
    """What is to be seen to comes first."""
    members = (
        Member(MemberKind.VALUE, BOLTS, "placed"),
        Member(MemberKind.VALUE, "robot.pose"),
        Member(MemberKind.SPECIFICATION, RULE),
        Member(MemberKind.OFFLINE, "robot"),
    )
    automaton = standing().execution.automaton
    proof = Proof("relaxation", ())
    view = diagnosis_view(automaton, Diagnosis(Reason(members, minimal=True, proof=proof), ()), ())
    assert view.members == [
        "robot is offline",
        "robot.pose is not known",
        f"{BOLTS} is placed",
        f"the specification “{RULE}”",
    ]
    said = [next(iter(message.arguments.values())) for message in view.member_messages]
    assert all(isinstance(each, Sentence) for each in said)
    assert [each.words["en"] for each in said if isinstance(each, Sentence)] == [
        "Robot UR10",
        "the pose of the robot",
        "bolt pair 1 is placed",
        "The nutrunner must turn before it meets placed bolts",
    ]
