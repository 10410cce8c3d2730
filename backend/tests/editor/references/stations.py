"""Stations for these tests: those of the repository and of its documentation, and a cell with a bit of everything."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

from sequence_planner.core.immutable import replace
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import ReadyStation, prepare_station

REPOSITORY = Path(__file__).parents[4]
_BLOCK = re.compile(r"^```(?:yaml|text) (\S+)\n((?:.*\n)*?)```$", re.MULTILINE)
_SET = re.compile(r"frozenset\(\{(.*?)\}\)")


def of_folder(folder: Path) -> dict[str, str]:
    """All files of a station's folder, definitions of messages included."""
    paths = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def of_page(name: str) -> dict[str, str]:
    """The files of the station that a page of the documentation shows."""
    return dict(_BLOCK.findall((REPOSITORY / "docs" / name).read_text(encoding="utf-8")))


def write(files: Mapping[str, str | None], folder: Path) -> None:
    """Put files into a folder; what is None is taken away."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if text is None:
            path.unlink()
        else:
            path.write_text(text, encoding="utf-8")


def changed(files: Mapping[str, str], changes: Mapping[str, str | None]) -> dict[str, str]:
    """Files with changes made to them."""
    return {name: text for name, text in {**files, **changes}.items() if text is not None}


def messages_of(folder: Path) -> MessageRegistry:
    """The types of messages that a station's folder defines, and the standard ones."""
    return MessageRegistry.from_folder(folder / "messages" if (folder / "messages").is_dir() else None)


def described(folder: Path, without: str) -> str:
    """All that the station in a folder means: its automaton, what comes in and goes out, and that its examples hold.

    What of names is to be left out is.
    """
    station: ReadyStation = prepare_station(folder)
    assert [found for example in station.examples for found in example.failures()] == []
    pipelines = station.pipelines
    sides = [
        {name: sorted(each.variables) for name, each in part.items()}
        for part in (pipelines.incoming, pipelines.outgoing, pipelines.flows)
    ]
    # Variables that nobody declares are in the order of the stages that give them.
    variables, others = station.automaton.variables, replace(station.automaton, variables={})
    texts = (others, *variables.values(), sides, list(pipelines.services), list(pipelines.actions))
    said = sorted(repr(each).replace(f"/{without}", "").replace(without, "") for each in texts)
    return _SET.sub(lambda found: str(sorted(found[1].split(", "))), "\n".join(said))


# A cell with every kind of part, and names in every place where there can be some. The comments and quotes are there to
# be kept.
CELL = {
    "station.yaml": """\
# The cell.
name: cell
enumerations:
  pose: [nowhere, home, "out"] # where it is
  goal: [home, out]
  side: ['left', right]
  load: [none, part]
estimated:
  slots: {for: {where: side}, type: load, initial: none}
  count: {type: 0..3}
alarms:
  crowded: {when: count == 3, title: {en: Crowded, sv: "Trångt"}} # the last place
rest: >-
  robot.pose == home and
  not robot.busy and slots[left] == none
""",
    "resources/robot.yaml": """\
title: Robot
topics:
  /robot/state:
    type: cell_msgs/msg/RobotState
    direction: in
    pipeline:
      - map: {field: place, variable: pose, values: {1: home, 2: out}, otherwise: nowhere}
      - remember: {variable: last, of: pose, except: [nowhere]}
      - expression: {"gate[left]": "switches[0]", "gate[right]": "switches[1]"}
      - expression: {is_out: "pose != home and not busy", may_go: "pose in {home, 'out'}"}
    examples:
      - name: at home
        given: {place: 1, busy: true}
        gives: {pose: home, last: home, busy: true, may_go: true}
  /robot/command:
    type: cell_msgs/msg/RobotCommand
    direction: out
    pipeline:
      - map: {variable: target, field: place, values: {home: 1, out: 2}}
      - table:
          fields: [target, pose]
          variables: [speed]
          rows: [{when: [home, any], gives: [1]}, {when: [any, home], gives: [2]}]
          otherwise: [3]
    examples:
      - {name: out, given: {target: out, pose: nowhere}, gives: {place: 2, speed: 3}}
flows:
  watched:
    from: {robot: /robot/state}
    pipeline:
      - expression: {is_seen: robot.pose == home and robot.is_out}
  again:
    from: watched
    pipeline:
      - rename: {is_seen: is_seen_again}
measured:
  pose: {type: pose, initial: home}
  last: {type: goal, initial: home}
  gate: {for: {where: side}, type: bool}
  may_go: {type: bool}
  is_seen: {type: bool}
  is_seen_again: {type: bool}
output:
  target: {type: goal}
alarms:
  seen_busy: {when: 'is_seen and busy and not load(left).executing', delay: 2} # own names
abilities:
  move:
    title: "Move to {to}"
    parameters: {to: goal}
    enabled: target == pose and pose != to and gate[left] # and this stays
    start:
      when: 'not load(left).executing and may_go'
      do: [target := to]
    executing: robot.target == to and pose != to
    finish: {when: executing and pose == to, do: [count := count + 1 if count < 3]}
    effects:
      arrives: {kind: executing, when: target != pose, do: [pose := target]}
  load:
    title: Load {where}
    parameters: {where: side}
    human: {task: "Load {where}, please", acknowledgement: is_seen}
    enabled: slots[where] == none and pose == home and not operation.bring(where).active
    start: {do: ["slots[where] := part"]}
    executing: slots[where] == part and not move(home).executing and not busy
""",
    "operations.yaml": """\
bring:
  title: Bring {where}
  parameters: {where: side}
  precondition: slots[where] == none
  goal: slots[where] == part
  local: not robot.busy U robot.load(where).finished
""",
    "specifications.yaml": """\
one: {exclusive: [robot.move, robot.load(left)]}
apart: {zone: {robot: pose == out, other: at == out}}
first:
  title: "{where} first"
  parameters: {where: side}
  order: ["slots[where] == part", "robot.gate[where]"]
never: {never: robot.move(out).executing, while: other.at == home}
""",
    "work_masters.yaml": """\
job:
  brings: ["slots[left] := none"]
  operations:
    bring(left):
    bring(right): {after: [bring(left)]}
""",
    "resources/other.yaml": """\
services:
  /other/look: {type: std_srvs/srv/Trigger, when: look, ignore: [message], response: [{rename: {success: seen}}]}
actions:
  /other/go:
    type: cell_msgs/action/Go
    when: go
    status: going
    goal: [{map: {variable: at, field: place, values: {home: 1, out: 2}}}]
flows:
  looked: {from: /other/look response, pipeline: [{rename: {seen: seen_again}}]}
  far: {from: [robot.watched], pipeline: [{expression: {far_seen: is_seen}}]}
measured:
  seen_again: {type: bool}
  far_seen: {type: bool}
estimated:
  at: {type: goal}
abilities:
  go_there:
    enabled: not go and going == idle and not seen
    start: {do: [go := true, at := robot.target]}
    finish: {when: going == succeeded, do: [go := false, look := true]}
""",
    "messages/cell_msgs/msg/RobotState.msg": "uint8 place\nbool busy\nbool[2] switches\n",
    "messages/cell_msgs/msg/RobotCommand.msg": "uint8 place\nuint8 speed\nstring note\n",
    "messages/cell_msgs/action/Go.action": "uint8 place\n---\n---\n",
}

IN_SEQUENCE = {
    **CELL,
    "operations.yaml": CELL["operations.yaml"]
    + """\
both:
  for: {where: side}
  arbitrary: "bring(where)"
whole:
  sequence: {alternative: [both]} # the one way that there is
""",
    "work_masters.yaml": CELL["work_masters.yaml"]
    + """\
other_job:
  sequence: [whole]
third_job: {parallel: {for: {which: side}, sequence: bring(which)}}
""",
}
