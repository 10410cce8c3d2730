"""Offers where something is still under way, or where what has finished is taken in by the next tick."""

from __future__ import annotations

from sequence_planner.automaton.tick import apply_effects, finish, initial_state, supervised_start, synchronise
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Contract, PlanRequest, goals_of
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.manual_plans import stalled_effects, stalling, stalls
from sequence_planner.planning.recovery.proposals import OfferKind
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.places import TRUCK_ENGINE_STATION

from .carrying_out import Stopped, carried_out


def test_restart_abilities_may_still_be_under_way_where_the_goals_are_reached() -> None:
    """A belt that is jogged until something passes the sensor, and that only somebody stops."""
    station = automaton(
        {
            "jog": Does(start=("belt := true",), enabled="not belt", executing="belt", restart=True),
            "stop": Does(start=("belt := false",), enabled="belt"),
        },
        output={"belt": (BOOLEAN, False)},
        measured={"seen": (BOOLEAN, False)},
        effects={"passes": ("belt", ("seen := true",))},
        goals={"part": "seen"},
    )
    supervisor, state, goals = synthesise(station), initial_state(station), goals_of(station, ["part"])
    advice = Advisor(station, supervisor).advise(AdviceRequest(state, goals, deadline=60))
    for offer in advice.offers:
        carried_out(Stopped(station, supervisor, state, goals, AdviceRequest(state, goals).circumstances), offer)
    jogged = [offer.operator_plan for offer in advice.offers if offer.kind is OfferKind.RESTART]
    assert [operator_plan is not None and operator_plan.starts for operator_plan in jogged] == [((1, "jog"),)]


def test_a_torque_that_is_reached_and_not_told_is_told_first_although_only_the_next_tick_is_safe() -> None:
    """With the bolts tight and not known to be so a specification is violated, until the tick that hears of it."""
    station = prepare_station(TRUCK_ENGINE_STATION).automaton
    supervisor, goals = synthesise(station), goals_of(station, ["tighten_bolt_pair(AtBoltPair1TCPPose)"])
    state, effects = initial_state(station), {each.name: each for each in station.effects}
    awaited = "nutrunner.run_nut.torque_is_reached"
    plan = Planner(station, supervisor).answer(PlanRequest(state, goals, 60, contract=Contract.FAST)).plan
    assert plan is not None
    for tick in plan.ticks:
        if awaited in tick.effects:
            break
        published, sensed = state, apply_effects(state, [effects[name] for name in tick.effects])
        assert sensed is not None
        state = synchronise(station, finish(station, sensed).state)
        for name in tick.starts:
            started = supervised_start(station, supervisor, published, state, station.abilities[name])
            assert started is not None
            state = started
    stalled = stalled_effects(station, state, ["nutrunner"])
    assert stalled == {awaited}
    request = AdviceRequest(state, goals, deadline=60, stalled=stalled)
    advice = Advisor(station, supervisor).advise(request)
    real = stalling(station, stalls(station, state, stalled))
    for offer in advice.offers:
        carried_out(Stopped(real, supervisor, state, goals, request.circumstances), offer)
    first = advice.offers[0]
    assert first.kind is OfferKind.PHYSICAL
    told = {"nutrunner.programmed_torque_reached": True}
    assert {change.name: change.new for change in first.physical} == told
    assert not supervisor.safe.includes(synchronise(station, {**state, **told}))
