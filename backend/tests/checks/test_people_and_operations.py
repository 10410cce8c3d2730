"""Tasks that share an acknowledgement, and local specifications that say nothing."""

from __future__ import annotations

from pathlib import Path

from checks.small import DEVICE, device, found, station

PERSON = """
measured: {done: {type: bool}}
output: {asked: {type: request}}
abilities:
  put:
    parameters: {where: side}
    human: {task: "Put it to the {where}.", acknowledgement: done}
    enabled: asked == none and not done
    start: {do: [asked := where]}
    executing: %s
    finish: {when: asked == where and done, do: [asked := none]}
    effects:
      answers: {kind: executing, when: asked != none and not done, do: [done := true]}
      is_free: {kind: finishing, when: asked == none and done, do: [done := false]}
"""
SIDES = "name: s\nenumerations: {side: [left, right], request: [none, left, right]}"


def test_two_tasks_that_one_answer_would_end(tmp_path: Path) -> None:
    assert found(station(tmp_path, {"person": PERSON % "asked != none and not done"}, station=SIDES)) == [
        "person.yaml:10:16: the tasks of `person.put(left)` and `person.put(right)` can be open at once (person.asked "
        "== left and person.done == false), and `person.done` acknowledges both: give each its own, or let `executing` "
        "tell which one is asked for [shared-acknowledgement]"
    ]


def test_tasks_of_which_one_is_open_at_a_time(tmp_path: Path) -> None:
    assert found(station(tmp_path, {"person": PERSON % "asked == where and not done"}, station=SIDES)) == []


def test_a_local_specification_that_reads_nothing(tmp_path: Path) -> None:
    operations = 'o: {precondition: not part, goal: part, local: "X true"}'
    assert found(device(tmp_path, operations=operations)) == [
        "operations.yaml:1:48: the local specification `X true` of `o` reads no variable, so it only says how long the "
        "run is: write what must hold on the way, or leave it out [empty-local-specification]",
    ]


def test_a_local_specification_about_the_run(tmp_path: Path) -> None:
    operations = 'o: {precondition: not part, goal: part, local: "F device.command"}'
    assert found(device(tmp_path, operations=operations)) == []


def test_an_alarm_that_is_always_or_never_there(tmp_path: Path) -> None:
    alarms = """
alarms:
  on: {when: true}
  part: {when: on or not on}
  never: {when: command and not command}
  good: {when: on}
"""
    assert found(station(tmp_path, {"device": DEVICE + alarms})) == [
        "device.yaml:19:3: the alarm `device.on` is always there, since `true` always holds: write when it is to be "
        "there [always-holds]",
        "device.yaml:20:16: the alarm `device.part` is always there, since `device.on or not device.on` always holds: "
        "write when it is to be there [always-holds]",
        "device.yaml:21:17: the alarm `device.never` is never there, since `device.command and not device.command` "
        "never holds: write when it is to be there [never-holds]",
    ]


def test_a_task_that_is_never_open(tmp_path: Path) -> None:
    assert found(station(tmp_path, {"person": PERSON % "false"}, station=SIDES)) == [
        f"person.yaml:5:3: the task of `person.put({side})` is never open: a task is open while its ability executes, "
        "and this one never does. Write `executing`, such as that the request is there and the acknowledgement is not "
        "[task-never-open]"
        for side in ("left", "right")
    ]


def test_a_specification_that_forbids_nothing(tmp_path: Path) -> None:
    nothing = "never: {forbidden: device.command and not device.command}"
    assert found(device(tmp_path, specifications=nothing)) == [
        "specifications.yaml:1:1: `never` forbids nothing: no state, reachable or not, is as it says (see `show`). An "
        "ability without `executing` never executes, so it excludes nothing either [forbids-nothing]"
    ]


def test_of_an_exclusion_some_pairs_may_exclude_each_other_anyway(tmp_path: Path) -> None:
    pairs = "one: {exclusive: [device.go, device.back]}"
    assert "forbids-nothing" in "".join(found(device(tmp_path, specifications=pairs)))
    three = "one: {exclusive: [device.go, device.back, lamp.shine]}"
    folder = tmp_path / "three"
    folder.mkdir()
    lamp = "output: {lit: {type: bool}}\nabilities: {shine: {executing: lit, start: {do: [lit := true]}}}"
    made = station(folder, {"device": DEVICE, "lamp": lamp}, specifications=three)
    assert "forbids-nothing" not in "".join(found(made))


def test_a_file_without_specifications(tmp_path: Path) -> None:
    assert found(device(tmp_path, specifications="# none")) == [
        "specifications.yaml:1:1: there is no specification here, so nothing is forbidden: write one, or delete the "
        "file [no-specification]"
    ]
