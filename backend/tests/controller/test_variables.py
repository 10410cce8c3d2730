"""Variables as people see them: what they and their values are called, and who commanded an output."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.automaton.automaton import Kind, target
from sequence_planner.controller.commands.queries import AboutNames
from sequence_planner.controller.features.variables import Beliefs, Variables
from sequence_planner.controller.views.details import NamesView
from sequence_planner.core.clock import Timestamp
from sequence_planner.station import prepare_station
from support.places import MODELS
from support.simulated import Rig

STATIONS = sorted(path.parent for path in MODELS.glob("*/station.yaml"))


def names_of(station: str) -> NamesView:
    """What the variables of one of our stations are called."""
    rig = Rig(folder=MODELS / station)
    variables = Variables(rig.execution, {"robot.pose": "/robot/state"}, Beliefs(rig.execution))
    return variables.spoken_names(AboutNames())


def test_names_are_the_titles_of_the_model_in_each_language() -> None:
    names = names_of("bolt_tightening")
    pair, pose = names.variables["bolts[bolt_pair_1]"], names.variables["robot.pose"]
    assert pair.title == {"en": "Bolt pair 1", "sv": "Skruvpar 1"}
    assert pair.values is not None
    assert names.values[pair.values]["tightened"] == {"en": "tight", "sv": "åtdragna"}
    assert (pair.topic, pose.topic) == (None, "/robot/state")
    assert names.variables["robot.moving"].values is None, "yes and no are words of the page"


def test_parts_are_called_by_their_titles_in_each_language() -> None:
    names = names_of("bolt_tightening")
    assert names.station == {"en": "Bolt tightening station", "sv": "Station för skruvdragning"}
    assert names.resources["operator"] == {"en": "Operator", "sv": "Operatören"}
    assert names.resources["robot"] == {"en": "Robot UR10", "sv": "Roboten UR10"}
    assert "robot" not in names_of("single_bolt").resources, "it is called the same in all languages"
    assert names.operations["tighten_bolt_pair(bolt_pair_1)"] == {
        "en": "Tighten bolt pair 1",
        "sv": "Dra åt skruvpar 1",
    }
    assert names.work_masters["truck_engine"]["sv"] == "Lastbilsmotor"
    task = names.tasks["operator.place_bolt_pair(bolt_pair_2)"]
    assert task == {"en": "Place bolt pair 2 on the cover plate.", "sv": "Sätt i skruvpar 2 i täcklocket."}
    assert all(each["sv"].startswith("Mutterdragaren ska rotera") for each in names.specifications.values())


@pytest.mark.parametrize("path", STATIONS, ids=lambda path: path.name)
def test_the_english_of_a_title_is_what_the_station_sends(path: Path) -> None:
    """By it and by the name a page knows what to tell in another language."""
    automaton, names = prepare_station(path).automaton, names_of(path.name)
    sent = {
        "resources": dict(automaton.resources),
        "abilities": {name: each.title for name, each in automaton.abilities.items()},
        "operations": {name: each.title for name, each in automaton.operations.items()},
        "specifications": {name: each.title for name, each in automaton.specifications.items()},
        "work_masters": {name: each.title for name, each in automaton.work_masters.items()},
    }
    for kind, titles in sent.items():
        assert all(words["en"] == titles[name] for name, words in getattr(names, kind).items())


@pytest.mark.parametrize("path", STATIONS, ids=lambda path: path.name)
def test_no_two_values_of_a_variable_have_the_same_words(path: Path) -> None:
    station = prepare_station(path)
    rig = Rig(folder=path)
    names = Variables(rig.execution, {}, Beliefs(rig.execution)).spoken_names(AboutNames())
    for name, variable in station.automaton.variables.items():
        if variable.kind is Kind.ACTIVITY:
            assert name not in names.variables
            continue
        called = names.variables[name]
        assert all(title[0] == title[0].upper() for title in called.title.values())
        if called.values is None:
            continue
        words = names.values[called.values]
        assert list(words) == [str(v).lower() if isinstance(v, bool) else str(v) for v in variable.type.domain]
        for language in ("en", "sv"):
            assert len({each[language] for each in words.values()}) == len(words)


def test_an_output_says_which_ability_has_commanded_it() -> None:
    rig = Rig()
    variables = Variables(rig.execution, {}, Beliefs(rig.execution))
    rig.start_production()
    outputs = set(rig.station.automaton.names(Kind.OUTPUT))
    seen = 0
    for _ in range(600):
        before = dict(rig.execution.state)
        rig.now += rig.step
        rig.devices.advance(rig.now)
        rig.tick()
        outcome, moment = rig.ticks[-1], Timestamp(rig.now, rig.now)
        variables.after_tick(outcome, moment)
        views = variables.view_part(moment)["variables"]
        assert isinstance(views, dict)
        assert all(view.commanded_by is None or name in outputs for name, view in views.items())
        for ability in outcome.started:
            for changed in map(target, rig.station.automaton.abilities[ability].start_actions):
                if changed in outputs and before[changed] != rig.execution.state[changed]:
                    assert views[changed].commanded_by == ability
                    seen += 1
    assert seen > 3
