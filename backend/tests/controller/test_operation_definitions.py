"""How an operation is defined, as a station that runs tells it: in words, with what of it holds now."""

from __future__ import annotations

import pytest

from controller.test_offers import made
from sequence_planner.automaton.tick import initial_state
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AskOperationDefinition
from sequence_planner.controller.features.jobs import JobHandler
from sequence_planner.controller.views.automaton_diagram import Drawing
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.station import prepare_station
from sequence_planner.texts.message import Sentence
from support.places import TRUCK_ENGINE_STATION


def test_it_is_told_in_the_state_of_the_station() -> None:
    execution = made()
    operation = execution.automaton.operations["deliver"]
    view = JobHandler(execution).operation(AskOperationDefinition(name="deliver"))
    assert (view.name, view.title, view.revision) == ("deliver", operation.title, execution.revision)
    assert view.goal.text == print_expression(operation.goal)
    assert view.goal.holds == evaluate(operation.goal, execution.state)
    assert all(part.sentence.id == "sentence.so" for part in view.goal.parts)


def test_what_sequences_add_stands_apart_from_what_is_written() -> None:
    automaton = prepare_station(TRUCK_ENGINE_STATION).automaton
    second = automaton.operations["tighten_bolt_pair(AtBoltPair2TCPPose)"]
    view = Drawing(automaton, initial_state(automaton), {}, None).of_operation(second, 3)
    assert [part.text for part in view.turns["tighten_bolts"].parts] == ["bolts[AtBoltPair1TCPPose] == tightened"]
    assert "AtBoltPair1TCPPose" not in view.precondition.text
    told = view.precondition.parts[0].sentence.arguments["condition"]
    assert isinstance(told, Sentence)
    assert (told.words["en"], told.words["sv"]) == ("pair 2 is placed", "skruvarna i par 2 är på plats")
    assert (view.precondition.parts[0].holds, view.goal.holds) == (False, False)


def test_one_that_the_station_does_not_have_is_refused() -> None:
    with pytest.raises(CommandRefused) as refusal:
        JobHandler(made()).operation(AskOperationDefinition(name="fly"))
    assert (refusal.value.slug, refusal.value.status) == ("unknown-operation", 404)
