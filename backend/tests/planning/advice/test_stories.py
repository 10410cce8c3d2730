"""What the advisor says of a station that has stopped in ways that people know, in this process and in its own."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator

import pytest

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.controller.views.wording import offer_title, told
from sequence_planner.core.immutable import replace
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import FALSE
from sequence_planner.language.types import Value
from sequence_planner.planning.diagnoser import DiagnosisModel
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import Circumstances, Goal, PlanAnswer, PlanRequest, goals_of
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.consultation import Answer, Request
from sequence_planner.planning.recovery.manual_plans import stalled_effects, stalling, stalls
from sequence_planner.planning.recovery.proposals import Advice, OfferKind, RecoveryProposal, ValueChange
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest
from sequence_planner.planning.recovery.worker import advising
from sequence_planner.process.budget import Budget
from sequence_planner.process.worker import Worker, WorkerLoop
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import FewerSpecifications, synthesise
from support.automata import predicate_of
from support.places import BOLT_TIGHTENING

from .carrying_out import Stopped, carried_out

TIGHTEN = "tighten_bolt_pair(bolt_pair_1)"
UNDER_WAY: dict[str, Value | None] = {
    "robot.pose": "unknown",
    "robot.previous_pose": "above_engine",
    "robot.target_pose": "bolt_pair_1",
    "nutrunner.run_tool_forward": True,
    "nutrunner.set_tool_idle": False,
    "nutrunner.tool_is_running_forward": True,
    "nutrunner.tool_is_idle": False,
}
NO_TOOL = Circumstances(barred=frozenset({"nutrunner.run_nut"}))


@pytest.fixture(scope="module")
def station() -> Automaton:
    return prepare_station(BOLT_TIGHTENING).automaton


@pytest.fixture(scope="module")
def supervisor(station: Automaton) -> Supervisor:
    return synthesise(station)


@pytest.fixture(scope="module")
def advisor(station: Automaton, supervisor: Supervisor) -> Advisor:
    return Advisor(station, supervisor)


def state_of(station: Automaton, changes: dict[str, Value | None]) -> State:
    """The initial state, the tool attached and the first bolts placed, with changes."""
    begun: dict[str, Value | None] = {
        "robot.attach_tool": True,
        "robot.tool_is_attached": True,
        "bolts[bolt_pair_1]": "placed",
    }
    return synchronise(station, {**initial_state(station), **begun, **changes})


def tightening(station: Automaton, changes: dict[str, Value | None]) -> AdviceRequest:
    """How to get back to tightening the first bolts."""
    return AdviceRequest(state_of(station, changes), goals_of(station, [TIGHTEN]), deadline=60)


def advised(station: Automaton, advisor: Advisor, request: AdviceRequest) -> dict[OfferKind, list[RecoveryProposal]]:
    """Offers by kind, each of which can be carried out."""
    advice = advisor.advise(request)
    assert advice.complete
    found: dict[OfferKind, list[RecoveryProposal]] = {}
    real = stalling(station, stalls(station, request.state, request.stalled))
    for offer in advice.offers:
        carried_out(Stopped(real, synthesise(station), request.state, request.goals, request.circumstances), offer)
        found.setdefault(offer.kind, []).append(offer)
    return found


def starts(offer: RecoveryProposal) -> list[str]:
    assert offer.operator_plan is not None
    return [name for _, name in offer.operator_plan.starts]


def test_a_robot_under_way_is_waited_for(station: Automaton, advisor: Advisor) -> None:
    offers = advised(station, advisor, tightening(station, UNDER_WAY))
    assert [offer.then is not None and offer.then.starts for offer in offers[OfferKind.REPLAN]] == [()]
    assert OfferKind.PHYSICAL not in offers
    assert OfferKind.CORRECTION not in offers


def test_one_that_stands_still_is_sent_back_or_moved_by_hand(station: Automaton, advisor: Advisor) -> None:
    request = tightening(station, UNDER_WAY)
    request = replace(request, stalled=stalled_effects(station, request.state, ["robot"]))
    offers = advised(station, advisor, request)
    assert OfferKind.REPLAN not in offers
    back = offers[OfferKind.RESTART][0]
    assert starts(back) == ["robot.move_to_previous"]
    assert print_expression(back.goal) == "robot.target_pose == above_engine and not robot.move_to_previous.executing"
    assert (back.restart, back.unsupervised, back.left_out) == (True, False, ())
    by_hand = offers[OfferKind.PHYSICAL][0]
    assert ValueChange("robot.pose", "unknown", "bolt_pair_1") in by_hand.physical
    assert ValueChange("robot.previous_pose", "above_engine", "bolt_pair_1") in by_hand.physical
    title = offer_title(station, by_hand)
    assert "robot.pose is bolt_pair_1" in title
    assert "previous_pose" not in title
    assert all({c.name for c in o.physical} & {"robot.pose"} for o in offers[OfferKind.PHYSICAL])
    said = [offer for offer in offers[OfferKind.CORRECTION] if offer.only_if_checked]
    assert [offer.corrections for offer in said] == [(ValueChange("bolts[bolt_pair_1]", "placed", "tightened"),)]


def test_a_tool_that_was_helped_is_counted_on_for_the_other_bolts_too(station: Automaton, advisor: Advisor) -> None:
    pairs = [name for name in station.names(Kind.ESTIMATED) if name.startswith("bolts[")]
    told: dict[str, Value | None] = {"nutrunner.run_tool_forward": True, "nutrunner.set_tool_idle": False}
    request = replace(
        tightening(station, {**told, **dict.fromkeys(pairs, "placed")}),
        goals=goals_of(
            station, [f"tighten_{name.replace('bolts[', 'bolt_pair(').replace(']', ')')}" for name in pairs]
        ),
        stalled=frozenset({"nutrunner.run_nut.tool_starts"}),
        deadline=60,
    )
    offers = [offer for offer in advisor.advise(request).offers if offer.kind is OfferKind.PHYSICAL]
    assert not offers[0].left_out
    assert ValueChange("nutrunner.tool_is_running_forward", False, True) in offers[0].physical


def test_who_does_what_makes_the_station_believe_bolts_to_be_tight_is_told_so(
    station: Automaton, advisor: Advisor
) -> None:
    at_the_pair = dict.fromkeys(("robot.pose", "robot.previous_pose", "robot.target_pose"), "bolt_pair_1")
    request = tightening(station, {**UNDER_WAY, **at_the_pair})
    request = replace(request, stalled=stalled_effects(station, request.state, ["nutrunner"]))
    (offer,) = (offer for offer in advisor.advise(request).offers if offer.physical)
    assert offer.records == (ValueChange("bolts[bolt_pair_1]", "placed", "tightened"),)
    assert offer_title(station, offer).startswith(
        "See to it that nutrunner.programmed_torque_reached is true, so that bolts[bolt_pair_1] is tightened"
    )


def test_a_robot_that_is_away_is_brought_back(station: Automaton, advisor: Advisor) -> None:
    own = [n for n in station.names(Kind.MEASURED) if station.variables[n].resource == "robot"]
    request = replace(
        tightening(station, {**UNDER_WAY, **dict.fromkeys(own)}),
        circumstances=Circumstances(offline=frozenset({"robot"})),
        last={name: value for name in own if (value := state_of(station, UNDER_WAY)[name]) is not None},
    )
    (offer,) = advised(station, advisor, request)[OfferKind.PHYSICAL]
    assert (offer.online, offer.physical) == (("robot",), ())
    assert ValueChange("robot.pose", None, "unknown") in offer.assumed


def test_nothing_is_started_blindly_where_bringing_a_robot_back_is_enough(station: Automaton, advisor: Advisor) -> None:
    """With the robot away, a tool that runs would make certain that the station is safe, once the bolts are there."""
    around: dict[str, Value | None] = {
        "bolts[bolt_pair_1]": "empty",
        "bolts[bolt_pair_2]": "tightened",
        "bolts[bolt_pair_3]": "tightened",
        "operator.requested_pair": "bolt_pair_1",
        "robot.target_pose": "bolt_pair_3",
    }
    heard: dict[str, Value | None] = {**around, **dict.fromkeys(("robot.pose", "robot.previous_pose"), "bolt_pair_3")}
    own = [n for n in station.names(Kind.MEASURED) if station.variables[n].resource == "robot"]
    request = AdviceRequest(
        state_of(station, {**around, **dict.fromkeys(own)}),
        goals_of(station, ["place_bolt_pair(bolt_pair_1)"]),
        circumstances=Circumstances(offline=frozenset({"robot"})),
        last={name: value for name in own if (value := state_of(station, heard)[name]) is not None},
        deadline=60,
    )
    assert [(offer.kind, offer.online) for offer in advisor.advise(request).offers] == [
        (OfferKind.PHYSICAL, ("robot",)),
        (OfferKind.WAY_BACK, ()),
    ]


def test_outside_the_safe_states_written_guards_lead_back(station: Automaton, advisor: Advisor) -> None:
    there: dict[str, Value | None] = dict.fromkeys(
        ("robot.pose", "robot.previous_pose", "robot.target_pose"), "bolt_pair_1"
    )
    offers = advised(station, advisor, tightening(station, there))
    assert OfferKind.REPLAN not in offers
    way = offers[OfferKind.WAY_BACK][0]
    assert (starts(way), way.unsupervised) == (["nutrunner.run_nut"], True)
    assert offers[OfferKind.CORRECTION][0].corrections == (ValueChange("bolts[bolt_pair_1]", "placed", "empty"),)


def test_what_was_given_up_is_put_back_and_corrections_contradict_nothing(station: Automaton, advisor: Advisor) -> None:
    request = replace(tightening(station, {}), circumstances=NO_TOOL)
    offers = advised(station, advisor, request)
    assert [offer.in_service for offer in offers[OfferKind.PHYSICAL]] == [("nutrunner.run_nut",)]
    assert len(offers[OfferKind.CORRECTION]) == 1
    never = frozenset({("bolts[bolt_pair_1]", "tightened", "robot.pose", "home")})
    fixed = frozenset({"bolts[bolt_pair_1]"})
    for less in (replace(request, impossible=never), replace(request, fixed=fixed)):
        assert OfferKind.CORRECTION not in advised(station, advisor, less)


def test_an_operation_whose_formula_was_violated_is_reached_only_after_its_reset(
    station: Automaton, advisor: Advisor
) -> None:
    request = replace(tightening(station, {}), goals=(), violated=goals_of(station, [TIGHTEN]))
    offers = advisor.advise(request).offers
    (reset,) = [offer for offer in offers if offer.kind is OfferKind.RESET]
    assert (reset.operation, reset.goals, reset.left_out) == (TIGHTEN, (TIGHTEN,), ())
    for offer in offers:
        if offer is not reset:
            assert TIGHTEN in offer.left_out


def test_plans_that_are_asked_for(station: Automaton, advisor: Advisor) -> None:
    goals = goals_of(station, [TIGHTEN])
    assert station.rest is not None
    to_rest = GoalPlanRequest(
        state_of(station, UNDER_WAY), goals, station.rest, circumstances=Circumstances(restart=True), deadline=60
    )
    (offer,) = advisor.goal_plan(to_rest).offers
    assert (offer.kind, offer.at_rest, offer.left_out) == (OfferKind.GOAL, True, ())
    assert offer.then is not None
    again = GoalPlanRequest(
        state_of(station, {"bolts[bolt_pair_1]": "empty"}), goals, station.operations[TIGHTEN].precondition, TIGHTEN
    )
    (offer,) = advisor.goal_plan(replace(again, deadline=60)).offers
    assert (offer.kind, offer.operation, starts(offer)) == (
        OfferKind.RESET,
        TIGHTEN,
        ["operator.place_bolt_pair(bolt_pair_1)"],
    )
    never = replace(to_rest, target=predicate_of(station, "robot.pose == home and robot.pose == above_engine"))
    assert advisor.goal_plan(never).offers == ()


class Asked:
    """The advisor's process."""

    def __init__(self, model: DiagnosisModel) -> None:
        self.loop = WorkerLoop()
        self.worker: Worker[Request, Answer] = Worker(advising, model, "advice")

    def answer(self, request: Request) -> Answer:
        return self.loop.submit(self.worker.ask(request, request.deadline)).result(120)


@pytest.fixture
def asked(station: Automaton, supervisor: Supervisor) -> Iterator[Asked]:
    process = Asked(DiagnosisModel(station, supervisor, FewerSpecifications(station, supervisor)))
    yield process
    process.loop.close(process.worker)


def test_the_process_answers_all_that_it_can_be_asked(station: Automaton, asked: Asked) -> None:
    state, goals = state_of(station, {}), goals_of(station, [TIGHTEN])
    advice = asked.answer(tightening(station, {}))
    assert isinstance(advice, Advice)
    assert advice.offers[0].kind is OfferKind.REPLAN
    plan = asked.answer(PlanRequest(state, goals))
    assert isinstance(plan, PlanAnswer)
    assert plan.plan is not None
    why = asked.answer(DiagnosisRequest(state, goals, NO_TOOL))
    assert isinstance(why, Diagnosis)
    assert why.reason is not None
    nothing = replace(
        tightening(station, {}),
        circumstances=Circumstances(offline=frozenset(station.resources)),
        fixed=frozenset(station.variables),
        goals=goals_of(station, station.operations),
        deadline=20,
    )
    advice = asked.answer(nothing)
    assert isinstance(advice, Advice)
    assert all(offer.left_out or offer.online for offer in advice.offers)


def test_advice_on_which_work_begins_late_takes_less_than_it_might(station: Automaton, supervisor: Supervisor) -> None:
    given: list[float] = []

    def explain(task: PlanningTask, budget: Budget) -> Diagnosis:
        given.append(budget.remaining)
        return Diagnosis(None, ())

    advisor = Advisor(station, supervisor, explain)
    hopeless = replace(tightening(station, {}), goals=(Goal("never", FALSE),), deadline=100.0)
    for until in (math.inf, time.monotonic() + 60.0, 0.0):
        assert not advisor.advise(replace(hopeless, until=until)).offers
    in_time, late, latest = given
    assert in_time > 60.0 >= late > 40.0 >= latest > 0.0


def test_what_one_act_of_a_device_brings_about_is_said_once(station: Automaton) -> None:
    """That the tool is not idle comes with that it turns, for which the model says what a person does."""
    turns = ValueChange("nutrunner.tool_is_running_forward", False, True)
    idle = ValueChange("nutrunner.tool_is_idle", True, False)
    assert told(station, [idle, turns]) == [turns]
    assert told(station, [idle]) == [idle]
