"""Emulated devices behind any pipeline: what they say is read as they mean it, and what cannot be said is found."""

from __future__ import annotations

from pathlib import Path

from pipelines.station_writing import Heard, station_with, write_station
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.supported import emulation_findings
from support.commands import command

FIELDS = {"Scene": "string[] objects\nint32 code\n", "Arm": "float64 force\ngeometry_msgs/Pose pose\nstring state\n"}
RESOURCE = """
topics:
  /scene:
    type: tank_msgs/msg/Scene
    direction: in
    pipeline: [member: {field: objects, item: tool, variable: attached}]
  /arm:
    type: tank_msgs/msg/Arm
    direction: in
    pipeline:
      - discretise:
          field: pose.position.z
          variable: height
          ranges: {low: [null, 0.2], high: [0.8, null]}
          otherwise: middle
      - match: {field: state, variable: state, values: {ready: [IDLE, READY], busy: [RUNNING]}}
      - debounce: {fields: [height], seconds: 0.05}
flows:
  gripping:
    from: {scene: /scene, arm: /arm}
    pipeline: [map: {field: scene.code, variable: grip, values: {0: open, 1: closed}}]
measured:
  attached: {type: bool}
  height: {type: heights}
  state: {type: states}
  grip: {type: grips}
"""
ENUMERATIONS = "heights: [low, middle, high]\nstates: [ready, busy]\ngrips: [open, closed]"


def test_whatever_a_device_is_brought_to_is_read(tmp_path: Path) -> None:
    station = station_with(tmp_path, RESOURCE, FIELDS, ENUMERATIONS)
    assert emulation_findings(station) == []
    devices = EmulatedDevices(station.automaton, station.pipelines)
    heard = Heard(station)
    now = 0.0
    for name in ("attached", "height", "state", "grip"):
        for value in (*station.automaton.variables[f"tank.{name}"].type.domain,) * 2:
            devices.set_value(f"tank.{name}", value)
            for later in (1.0, 2.0):  # a new value has to be there for a while
                for topic in ("/scene", "/arm"):
                    heard.take(topic, now + later, **devices.report(topic))
            now += 10
            assert heard.known()[f"tank.{name}"] == value
            assert not heard.running.trouble("/arm")


ONE_OF_SEVERAL = """
topics:
  /scene:
    type: tank_msgs/msg/Scene
    direction: in
    pipeline: [member: {field: objects, variable: attached, if_none: nothing}]
  /hand:
    type: tank_msgs/msg/Hand
    direction: in
    pipeline:
      - one_of: {variable: told, fields: {open: was_told_to_open, closed: was_told_to_close}, otherwise: neither}
      - remember: {variable: grip, of: told, except: [neither]}
  /command:
    type: tank_msgs/msg/Command
    direction: out
    pipeline: [one_of: {variable: wanted, fields: {open: open, closed: close}}]
measured:
  attached: {type: things}
  grip: {type: grips}
output:
  wanted: {type: grips}
"""


def test_one_of_several_is_said_and_understood(tmp_path: Path) -> None:
    fields = {
        "Scene": "string[] objects\n",
        "Hand": "bool was_told_to_open\nbool was_told_to_close\n",
        "Command": "bool open\nbool close\n",
    }
    station = station_with(tmp_path, ONE_OF_SEVERAL, fields, "things: [nothing, cup, pot]\ngrips: [open, closed]")
    assert emulation_findings(station) == []
    devices = EmulatedDevices(station.automaton, station.pipelines)
    heard = Heard(station)
    for name, topic in (("attached", "/scene"), ("grip", "/hand")):
        for now, value in enumerate((*station.automaton.variables[f"tank.{name}"].type.domain,) * 2):
            devices.set_value(f"tank.{name}", value)
            assert heard.take(topic, float(now), **devices.report(topic))[f"tank.{name}"] == value
            assert not heard.running.trouble(topic)


def test_what_cannot_be_said_is_a_finding_of_emulate_and_of_check_where_devices_are_emulated(tmp_path: Path) -> None:
    resource = """
topics:
  /scene:
    type: tank_msgs/msg/Scene
    direction: in
    pipeline:
      - map: {field: code, variable: grip, values: {0: open}}
measured: {grip: {type: grips}}
"""
    station = write_station(tmp_path, resource, FIELDS, ENUMERATIONS)
    status, _, said = command("emulate", station)
    assert status == 2
    assert "tank.yaml:7:9: `/scene` → stage 1 `map` cannot be emulated: no value of `code` becomes" in said
    assert "closed" in said
    status, told, said = command("check", station)
    assert (status, said) == (1, "")
    assert "tank.yaml:7:9: warning: no message ever makes `tank.grip` `closed`" in told
    status, _, said = command("check", station, "--emulator")
    assert status == 2
    assert "tank.yaml:7:9: `/scene` → stage 1 `map` cannot be emulated: no value of `code` becomes" in said
