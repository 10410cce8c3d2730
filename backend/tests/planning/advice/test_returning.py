"""A device that is away is the reason why a station stands, so its return is offered, whatever else would help too."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.core.immutable import replace
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Circumstances, goals_of
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.proposals import OfferKind
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.places import TRUCK_ENGINE_STATION

from .carrying_out import Stopped, carried_out


def test_a_robot_in_whose_place_somebody_works_comes_back_for_what_only_it_can_do() -> None:
    """It was pushed home meanwhile, where it had been told to be, and did not say so."""
    station = prepare_station(TRUCK_ENGINE_STATION).automaton
    supervisor = synthesise(station)
    own = [name for name in station.names(Kind.MEASURED) if station.variables[name].resource == "robot"]
    bolts = [name for name in station.names(Kind.ESTIMATED) if name.startswith("bolts[")]
    state: dict[str, Value | None] = {
        **initial_state(station),
        **dict.fromkeys(own),
        **dict.fromkeys(bolts, "tightened"),
        "ladder_frame": "on_engine",
        "engine.engine_in_place": True,
        "engine.tag_is_read": True,
        "nutrunner.activate_lift": False,
        "nutrunner.lift_state": "floats",
        "scene.attached": "ATLASTOOL",
        "scene.wanted": "ATLASTOOL",
        "operator.takes_over": True,
    }
    goals = goals_of(station, ["take_filter_tool"])
    away = Circumstances(offline=frozenset({"robot"}))
    request = AdviceRequest(
        synchronise(station, state),
        goals,
        away,
        last={"robot.pose": "AtBoltPair1TCPPose", "robot.previous_pose": "AtBoltPair1TCPPose", "robot.moving": False},
        deadline=60,
    )
    offers = Advisor(station, supervisor).advise(request).offers
    for offer in offers:
        carried_out(Stopped(station, supervisor, request.state, goals, away), offer)
    back = [offer for offer in offers if offer.kind is OfferKind.PHYSICAL and offer.online == ("robot",)]
    assert [(change.name, change.new) for change in back[0].physical] == [("operator.takes_over", False)]
    assert {change.name: change.new for change in back[0].assumed} == {
        "robot.pose": "HomeJOINTPose",
        "robot.previous_pose": "HomeJOINTPose",
        "robot.moving": False,
    }


def test_where_no_operation_is_active_because_values_are_unknown_their_resource_comes_back() -> None:
    """A tight pair was loosened and the planning scene is away: whether it can be tightened is not known."""
    station = prepare_station(TRUCK_ENGINE_STATION).automaton
    supervisor = synthesise(station)
    bolts = [name for name in station.names(Kind.ESTIMATED) if name.startswith("bolts[")]
    state: dict[str, Value | None] = {
        **initial_state(station),
        **dict.fromkeys(bolts, "tightened"),
        "bolts[AtBoltPair1TCPPose]": "placed",
        "ladder_frame": "on_engine",
        "engine.engine_in_place": True,
        "engine.tag_is_read": True,
        "end_effector.tool": "ATLASTOOL",
        "end_effector.rsp_is_locked": True,
        "nutrunner.activate_lift": False,
        "nutrunner.lift_state": "floats",
        "scene.attached": None,
        "scene.wanted": "ATLASTOOL",
    }
    away = Circumstances(offline=frozenset({"scene"}))
    request = AdviceRequest(
        synchronise(station, state),
        (),
        away,
        last={"scene.attached": "ATLASTOOL"},
        waiting=goals_of(station, sorted(station.operations)),
        deadline=60,
    )
    (offer,) = Advisor(station, supervisor).advise(request).offers
    assert (offer.kind, offer.online, offer.corrections) == (OfferKind.PHYSICAL, ("scene",), ())
    assert offer.goals == ("tighten_bolt_pair(AtBoltPair1TCPPose)",)
    goals = goals_of(station, offer.goals)
    carried_out(Stopped(station, supervisor, request.state, goals, away), offer)
    alone = replace(request, circumstances=Circumstances(), state=synchronise(station, {**state, **request.last}))
    assert [offer.kind for offer in Advisor(station, supervisor).advise(replace(alone, waiting=())).offers] == [
        OfferKind.REPLAN
    ]


def test_what_is_wrong_is_repaired_before_somebody_takes_over() -> None:
    """The tool is to be left at its place: nobody hears of the planning scene, or the tool is not let go of."""
    station = prepare_station(TRUCK_ENGINE_STATION).automaton
    advisor = Advisor(station, synthesise(station))
    bolts = [name for name in station.names(Kind.ESTIMATED) if name.startswith("bolts[")]
    poses = ("robot.pose", "robot.previous_pose", "robot.target_pose")
    state: dict[str, Value | None] = {
        **initial_state(station),
        **dict.fromkeys(bolts, "placed"),
        **dict.fromkeys(poses, "AttachLFToolTCPPose"),
        "ladder_frame": "on_engine",
        "engine.tag_is_read": True,
        "end_effector.tool": "LFTOOL",
        "nutrunner.activate_lift": False,
        "nutrunner.lift_state": "floats",
    }
    goals = goals_of(station, ["take_nutrunner"])
    unheard = AdviceRequest(
        synchronise(station, {**state, "scene.attached": None}),
        goals,
        Circumstances(offline=frozenset({"scene"})),
        last={"scene.attached": "LFTOOL"},
        deadline=10,
    )
    first, *others = advisor.advise(unheard).offers
    assert first.online == ("scene",)
    assert any(each.physical for each in others)
    held = {**state, "end_effector.rsp_is_locked": True, "scene.attached": "LFTOOL", "scene.wanted": "LFTOOL"}
    given_up = Circumstances(barred=frozenset({"end_effector.unlock"}))
    first, *others = advisor.advise(AdviceRequest(synchronise(station, held), goals, given_up, deadline=10)).offers
    assert [(change.name, change.new) for change in first.physical] == [("end_effector.rsp_is_locked", False)]
    assert any(change.name == "operator.takes_over" for each in others for change in each.physical)


def test_bolts_that_a_person_has_said_are_missing_are_put_in_by_hand_also_where_the_robot_stands_at_them() -> None:
    """The kit has gone: nothing that devices do brings them back."""
    station = prepare_station(TRUCK_ENGINE_STATION).automaton
    supervisor = synthesise(station)
    pair = "AtBoltPair6TCPPose"
    bolts = [name for name in station.names(Kind.ESTIMATED) if name.startswith("bolts[")]
    state: dict[str, Value | None] = {
        **initial_state(station),
        **dict.fromkeys(bolts, "tightened"),
        f"bolts[{pair}]": "empty",
        "ladder_frame": "on_engine",
        "agv.act_pos": "kitting",
        "agv.ref_pos": "kitting",
        "end_effector.tool": "ATLASTOOL",
        "end_effector.gripper_is_closed": True,
        "end_effector.rsp_is_locked": True,
        "engine.engine_in_place": True,
        "engine.tag_is_read": True,
        "nutrunner.positioned_at_home_station": False,
        "nutrunner.activate_lift": False,
        "nutrunner.lift_state": "floats",
        "robot.pose": pair,
        "robot.previous_pose": pair,
        "robot.target_pose": pair,
        "scene.attached": "ATLASTOOL",
        "scene.wanted": "ATLASTOOL",
    }
    said = frozenset({f"bolts[{pair}]"})
    goals = goals_of(station, [f"place_bolt_pair({pair})", f"tighten_bolt_pair({pair})"])
    request = AdviceRequest(synchronise(station, state), goals, fixed=said, deadline=10)
    advisor = Advisor(station, supervisor)
    for offer in advisor.advise(request).offers:
        assert said.isdisjoint(change.name for change in offer.corrections), "it says otherwise than the person"
    by_hand = [offer for offer in advisor.advise(replace(request, answered=said)).offers if offer.by_hand]
    assert by_hand
    placed = [offer for offer in by_hand if [change.new for change in offer.corrections] == ["placed"]]
    assert [offer.operator_plan is not None for offer in placed] == [True], "the robot is taken away from them besides"
    for offer in by_hand:
        assert offer.only_if_checked
        carried_out(Stopped(station, supervisor, request.state, goals, Circumstances()), offer)
