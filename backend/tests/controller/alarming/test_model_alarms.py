"""Alarms that engineers declare in a model: when they are raised and cleared, and what a station tells of them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import pytest
from pydantic import JsonValue

from controller.alarming.scene import Scene, Told, acknowledge, shelve
from controller.carrying_out import carry_out
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.controller.alarms.alarm import KIND, aside_from
from sequence_planner.controller.alarms.kinds import Cause
from sequence_planner.controller.alarms.model_conditions import ModelAlarms
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.station import AlarmState, AlarmView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.language.types import Value
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import ModelError
from sequence_planner.texts.message import Wording
from support.places import MODELS
from support.simulated import Rig, never


def station(folder: Path, alarm: str, of_station: str = "") -> Path:
    """A model with a tank, whose alarm `low` is this."""
    (folder / "resources").mkdir()
    (folder / "station.yaml").write_text(f"name: tanks\nestimated: {{full: {{type: bool}}}}\n{of_station}")
    (folder / "resources" / "tank.yaml").write_text(
        "estimated: {level: {type: 0..5, initial: 5}}\n"
        "abilities: {fill: {start: {do: ['level := 5']}}}\n"
        f"alarms:\n  low: {alarm}\n"
    )
    (folder / "operations.yaml").write_text("work: {precondition: tank.level == 0, goal: tank.level == 5}\n")
    return folder


def findings(folder: Path) -> list[str]:
    """What is wrong with a model, with the line and column of each."""
    with pytest.raises(ModelError) as wrong:
        ground(load_station(folder))
    return [f"{each.place.line}:{each.place.column} {each.message}" for each in wrong.value.findings]


class Tank:
    """The alarms of the model in a folder."""

    def __init__(self, folder: Path) -> None:
        self._execution = Executor(ground(load_station(folder)), Supervisor(StateSet((), ()), {}))
        self._alarms = ModelAlarms(self._execution)

    def causes(self, level: Value | None, seconds: float) -> list[Cause]:
        """Those that are there when the tank has this level."""
        self._execution.state = {**self._execution.state, "tank.level": level}
        return list(self._alarms.causes(Timestamp(seconds, seconds)))

    def keys(self, seconds: float, level: Value | None) -> list[str]:
        """Their keys."""
        return [cause.key for cause in self.causes(level, seconds)]


def test_it_is_raised_once_it_has_lasted_and_cleared_at_once(tmp_path: Path) -> None:
    alarms = Tank(station(tmp_path, "{when: level < 2, delay: 5}"))
    assert alarms.keys(0.0, level=5) == []
    assert alarms.keys(1.0, level=1) == alarms.keys(5.9, level=0) == []
    assert alarms.keys(6.0, level=1) == ["model:tank.low"]
    assert alarms.keys(6.1, level=2) == []
    assert alarms.keys(6.2, level=1) == alarms.keys(11.1, level=1) == []
    assert alarms.keys(11.3, level=1) == ["model:tank.low"]


def test_what_is_unknown_neither_raises_nor_clears_it(tmp_path: Path) -> None:
    alarms = Tank(station(tmp_path, "{when: level < 2}"))
    assert alarms.keys(0.0, level=None) == []
    assert alarms.keys(1.0, level=1) == ["model:tank.low"]
    assert alarms.keys(2.0, level=None) == ["model:tank.low"]
    assert alarms.keys(3.0, level=3) == []


def test_its_words_are_told_in_each_language(tmp_path: Path) -> None:
    words = (
        "{when: level < 2, priority: high, title: {en: Low, sv: Låg}, consequence: It runs dry., action: {sv: Fyll.}}"
    )
    (cause,) = Tank(station(tmp_path, words)).causes(0, 0.0)
    assert [str(each) for each in (cause.text, cause.consequence, cause.action)] == ["Low", "It runs dry.", "Fyll."]
    assert (cause.key, cause.priority, cause.resources) == ("model:tank.low", "high", ("tank",))


def test_an_alarm_of_the_station_has_a_bare_name_and_the_resources_that_it_reads(tmp_path: Path) -> None:
    folder = station(tmp_path, "{when: false}", "alarms: {too_low: {when: tank.level == 0}}\n")
    (cause,) = Tank(folder).causes(0, 0.0)
    assert (cause.key, str(cause.text), cause.resources) == ("model:too_low", "Too low", ("tank",))


@pytest.mark.parametrize(
    ("alarm", "said"),
    [
        ("{when: levl < 2}", "4:15 unknown variable `levl`; did you mean `level`?"),
        ("{when: level}", "4:15 expected a truth value, found an integer in 0..5"),
        ("{when: operation.work.active}", "4:15 an alarm reads variables and the flags of abilities"),
        ("{when: level < 2, priority: urgent}", "4:36 expected `high`, `medium` or `low`, found `urgent`"),
        ("{when: level < 2, priorty: low}", "4:26 `priorty` is not known here; did you mean `priority`?"),
        ("{when: level < 2, delay: -1}", "4:33 expected a number of at least 0, found `-1`"),
        ("{when: level < 2, title: {fi: Matala}}", "4:34 `fi` is not known here"),
        ("{when: level < 2, title: {}}", "4:33 say it in one language at least"),
        ("{priority: low}", "4:3 `when` is missing here"),
    ],
)
def test_what_is_wrong_with_one_is_said_at_its_place(tmp_path: Path, alarm: str, said: str) -> None:
    found = findings(station(tmp_path, alarm))
    assert [each for each in found if each.startswith(said)], found


def test_no_alarm_changes_what_the_station_does(tmp_path: Path) -> None:
    (tmp_path / "without").mkdir()
    (tmp_path / "with").mkdir()
    without = ground(load_station(station(tmp_path / "without", "{when: false}")))
    with_one = ground(load_station(station(tmp_path / "with", "{when: 'level < 2 and not fill.enabled'}")))
    assert with_one == without
    assert with_one.variables == without.variables
    assert with_one.flags == without.flags


class Watched:
    """A station in simulated time, whose devices do nothing by themselves, with its alarms."""

    def __init__(self, model: str, known: RestoredState | None = None) -> None:
        self.rig = Rig(acknowledges=never, folder=MODELS / model)
        self.told = Told()
        self.alarms = Scene(self.rig.execution, self.rig.station, self.told, known)

    def after(self, seconds: float, **measured: Value) -> Mapping[str, AlarmView]:
        """The alarms of the model so much later, where devices report these values all the while."""
        for name, value in measured.items():
            self.rig.devices.set_value(name.replace("__", "."), value)
        for _ in range(round(seconds * 10)):
            self.rig.now += 0.1
            self.rig.tick()
            shown = self.alarms.current(self.now)
        return {key: alarm for key, alarm in shown.items() if alarm.kind == "model"}

    @property
    def now(self) -> Timestamp:
        return Timestamp(self.rig.now, self.rig.now)

    def life(self, key: str) -> list[JsonValue]:
        """What the journal was told of an alarm."""
        return [event for alarm, event in self.told.events if alarm == key]


def test_the_battery_of_the_agv_is_low_and_is_charged() -> None:
    on, key = Watched("docking_agv"), "model:agv.battery_low"
    assert on.after(3) == {}
    assert on.after(1, agv__battery=1) == {}, "it is to last"
    alarm = on.after(2)[key]
    assert (alarm.text, alarm.priority, alarm.resources) == ("The battery of the AGV is low", "medium", ["agv"])
    assert alarm.messages.text.arguments["title"] == Wording(
        {"en": "The battery of the AGV is low", "sv": "AGV:ns batteri är lågt"}
    )
    assert on.after(1, agv__battery=4)[key].state is AlarmState.RETURNED
    carry_out(on.alarms.alarms, acknowledge(key, alarm.since), on.now)
    assert on.after(1) == {}
    assert on.life(key) == ["came", "returned", "acknowledged"]


def test_a_nutrunner_that_turns_unasked_is_told_and_cannot_be_shelved() -> None:
    on, key = Watched("bolt_tightening"), "model:nutrunner.turns_unasked"
    assert on.after(4, nutrunner__tool_is_running_forward=True) == {}
    assert on.after(2)[key].priority == "high"
    with pytest.raises(CommandRefused, match="as long as its cause lasts"):
        carry_out(on.alarms.alarms, shelve(key, 60), on.now)
    assert on.after(1, nutrunner__tool_is_running_forward=False)[key].state is AlarmState.RETURNED


def test_a_full_buffer_is_a_notice_that_goes_with_the_next_part() -> None:
    on, key = Watched("robots_with_buffer"), "model:buffer_full"
    on.rig.execution.correct({"parts_on_buffer": 2}, "Eva", "seen", on.now)
    assert on.after(9) == {}
    assert on.after(2)[key].state is AlarmState.ACKNOWLEDGED, "of a notice nobody has to take note"
    on.rig.execution.correct({"parts_on_buffer": 1}, "Eva", "seen", on.now)
    assert on.after(0.2) == {}


def test_what_is_shelved_stays_so_over_a_start_and_in_its_own_words() -> None:
    on, key = Watched("docking_agv"), "model:agv.battery_low"
    on.after(3, agv__battery=1)
    carry_out(on.alarms.alarms, shelve(key, 600), on.now)
    (kept,) = [content for kind, content in on.told.notes if kind == KIND]
    again = Watched("docking_agv", RestoredState(aside=aside_from(json.loads(json.dumps(kept)))))
    alarm = again.after(0.2)[key]
    assert (alarm.state, alarm.subject) == (AlarmState.SHELVED, "agv.battery_low")
    assert isinstance(alarm.messages.text.arguments["title"], Wording)


def test_a_journal_of_before_that_has_but_texts_puts_aside_what_it_did() -> None:
    said = {"priority": "medium", "text": "It is silent", "past": "It was silent", "consequence": "", "action": "Look"}
    kept: dict[str, JsonValue] = {"aside": {"silent:agv": {**said, "by": "Eva", "why": "known", "until": None}}}
    on = Watched("docking_agv", RestoredState(aside=aside_from(kept)))
    on.after(0.1)
    alarm = on.alarms.current(on.now)["silent:agv"]
    assert (alarm.kind, alarm.subject, alarm.text) == ("silent", "agv", "It was silent")
    assert alarm.state is AlarmState.OUT_OF_SERVICE
