"""The station that comes with the repository, as its documents mean it."""

from __future__ import annotations

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.tick import initial_state
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.station import prepare_station
from support.places import BOLT_TIGHTENING

STATION = prepare_station(BOLT_TIGHTENING)
PAIRS = ("bolt_pair_1", "bolt_pair_2", "bolt_pair_3")


def test_names_of_what_there_is() -> None:
    automaton = STATION.automaton
    assert automaton.title == "Bolt tightening station"
    assert list(automaton.resources) == ["engine", "nutrunner", "operator", "robot"]
    assert automaton.names(Kind.ESTIMATED) == tuple(f"bolts[{pair}]" for pair in PAIRS)
    assert {f"robot.move_to_position({pose})" for pose in ("home", "above_engine", *PAIRS)} < automaton.abilities.keys()
    assert {f"{name}({pair})" for name in ("place_bolt_pair", "tighten_bolt_pair") for pair in PAIRS} < set(
        automaton.operations
    )
    assert list(automaton.specifications) == [f"no_standing_tool_on_placed_bolts({pair})" for pair in PAIRS]


def test_parameters_are_replaced_by_their_values() -> None:
    move = STATION.automaton.abilities["robot.move_to_position(bolt_pair_2)"]
    assert move.title == "Move to bolt pair 2"
    assert print_expression(move.executing) == "robot.target_pose == bolt_pair_2 and robot.pose != bolt_pair_2"
    assert [print_assignment(action) for action in move.start_actions] == ["robot.target_pose := bolt_pair_2"]
    assert print_expression(move.enabled) == (
        "robot.target_pose == robot.pose and robot.pose != bolt_pair_2 and robot.pose == above_engine"
    )
    place = STATION.automaton.abilities["operator.place_bolt_pair(bolt_pair_1)"]
    assert place.human is not None
    assert (place.human.text, place.human.acknowledgement) == (
        "Place bolt pair 1 on the cover plate.",
        "operator.acknowledged",
    )


def test_it_begins_at_rest_with_nothing_executing() -> None:
    state = initial_state(STATION.automaton)
    assert None not in state.values()
    assert not [name for name, value in state.items() if name.endswith(".executing") and value]
    assert state["nutrunner.run_nut.enabled"] is False
    assert state["operator.place_bolt_pair(bolt_pair_3).enabled"] is True


def test_an_effect_that_does_not_depend_on_the_parameter_is_there_once() -> None:
    names = [effect.name for effect in STATION.automaton.effects]
    assert names.count("robot.move_to_position(home).robot_leaves") == 1
    assert len([name for name in names if name.endswith("robot_leaves")]) == 1


def test_every_measured_variable_but_the_watch_is_fed_and_every_output_leaves() -> None:
    automaton, pipelines = STATION.automaton, STATION.pipelines
    assert set(automaton.names(Kind.MEASURED)) - set(pipelines.feeds) == {"operator.acknowledged"}
    leaving = {name for pipeline in pipelines.outgoing.values() for name in pipeline.variables}
    assert leaving == automaton.outputs
