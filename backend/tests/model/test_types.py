"""Types of resources: what is made of instances, and what is said where something is wrong with them."""

from __future__ import annotations

import json
import pickle
import shutil
from pathlib import Path
from typing import Any

import pytest

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.model.loader import ReadBefore, load_station
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.reader import read_yaml
from sequence_planner.station import read_station
from support.places import MODELS, STATIONS

from .breaking import copy_of_cell, findings, replace, write

ROBOTS = MODELS / "robots_with_buffer"
TYPE, ONE, TWO = "types/robot.yaml", "resources/robot_1.yaml", "resources/robot_2.yaml"
BOTH = "in robot_1 (‹:2:7) and robot_2: "
TYPES_ARE = "a type is a file types/<name>.yaml, or package.name"
NEEDS, INTO = "`robot` needs the argument", ": write it into `arguments`"
PATHS_ARE = (
    "write names with dots between, [0] for the first entry of a list, and quotes around a name with dots or brackets, "
    'as in topics."/a.b".type'
)
NOTHING = "the type has nothing to remove here:"
WRITTEN_OUT = [
    station
    for folder in (MODELS, STATIONS)
    for station in sorted(folder.glob("*/"))
    if (station / "station.yaml").exists() and station != ROBOTS
]


def automaton(station: Path) -> Automaton:
    return read_station(station).automaton


@pytest.fixture
def robots(tmp_path: Path) -> Path:
    """A copy of the station of two robots of one type."""
    return Path(shutil.copytree(ROBOTS, tmp_path / "robots"))


# What is made of instances.


def test_the_robots_are_what_they_were_when_they_were_written_out(robots: Path) -> None:
    """So a journal of before is replayed, and a station goes on from it."""
    for written in (Path(__file__).parent / "written_out").glob("*.yaml"):
        shutil.copy(written, robots / "resources")
    shutil.rmtree(robots / "types")
    assert automaton(robots) == automaton(ROBOTS)
    assert model_digest(automaton(robots)) == model_digest(automaton(ROBOTS))


class FoldedResource:
    """A resource as a type with as many parameters as can be, and an instance with the arguments that it had."""

    def __init__(self, content: dict[str, Any], enumerations: dict[str, list[str]]) -> None:
        self.parameters: dict[str, Any] = {"scope": "text"}
        self.arguments: dict[str, Any] = {"scope": "of_it"}
        self._enumerations = enumerations
        self.type = dict(content)
        for section in ("measured", "output", "estimated"):
            self.type[section] = {name: self._variable(each) for name, each in content.get(section, {}).items()}
        self.type["abilities"] = {name: self._ability(each) for name, each in content.get("abilities", {}).items()}
        # A topic is called as it was: its name from the second letter on is given.
        for section in ("topics", "services", "actions"):
            self.type[section] = {
                f"{name[:1]}{{{self._given('text', name[1:])}}}": each
                for name, each in content.get(section, {}).items()
            }
        for flow in self.type.get("flows", {}).values():
            if isinstance(flow["from"], str) and flow["from"].startswith("/"):
                flow["from"] = f"/{{{self._given('text', flow['from'][1:])}}}"

    def _given(self, kind: object, argument: object) -> str:
        name = f"given_{len(self.parameters)}"
        self.parameters[name] = kind
        self.arguments[name] = argument
        return name

    def _variable(self, written: dict[str, Any]) -> dict[str, Any]:
        made = dict(written)
        if written.get("type") in self._enumerations:
            made["type"] = self._given("enumeration", written["type"])
            if written.get("initial") in self._enumerations[written["type"]]:
                made["initial"] = self._given({"kind": "value", "of": made["type"]}, written["initial"])
        elif str(written.get("type")).startswith("0.."):
            made["type"] = f"0..{{{self._given('number', int(written['type'][3:]))}}}"
        return made

    def _ability(self, written: dict[str, Any]) -> dict[str, Any]:
        made = dict(written)
        if "parameters" in written:
            made["parameters"] = {name: self._given("enumeration", of) for name, of in written["parameters"].items()}
        if "effects" in written:
            made["effects"] = {name: self._effect(each) for name, each in written["effects"].items()}
        return made

    def _effect(self, written: dict[str, Any]) -> dict[str, Any]:
        takes = written.get("takes", 0.5)
        made = (
            [self._given("number", each) for each in takes] if isinstance(takes, list) else self._given("number", takes)
        )
        return {**written, "takes": made}


@pytest.mark.parametrize("station", WRITTEN_OUT, ids=lambda each: each.name)
def test_a_resource_is_the_same_as_an_instance_of_a_type_made_of_it(tmp_path: Path, station: Path) -> None:
    folded = Path(shutil.copytree(station, tmp_path / "station"))
    enumerations = plain(read_yaml(folded / "station.yaml", "it").content).get("enumerations", {})
    (folded / "types").mkdir()
    for file in (folded / "resources").glob("*.yaml"):
        made = FoldedResource(plain(read_yaml(file, "it").content), enumerations)
        (folded / "types" / file.name).write_text(json.dumps({"parameters": made.parameters, **made.type}))
        file.write_text(json.dumps({"type": file.stem, "arguments": made.arguments}))
    assert model_digest(automaton(folded)) == model_digest(automaton(station))


def test_parameters_stand_in_conditions_by_their_names_and_nowhere_else(tmp_path: Path) -> None:
    """Neither as a part of a name nor in a longer word, and `{…}` in a condition is a set of values."""
    station = copy_of_cell(tmp_path)
    write(
        station,
        "types/lamp.yaml",
        "parameters: {of: resource, at: {kind: value, of: pose}, most: number, pose_type: enumeration, text: text}\n"
        "title: Lamp at {at}, {text}, {unit}\n"
        "estimated:\n"
        "  lit: {type: bool}\n"
        "  seen: {type: pose_type, initial: at}\n"
        "  count: {type: '0..{most}'}\n"
        "abilities:\n"
        "  light:\n"
        "    title: Light {where} at {at}\n"
        "    parameters: {where: pose_type}\n"
        "    enabled: not lit and of.pose == at and not of.move(out).executing and seen in {at, out}\n"
        "    start: {when: count < most, do: [lit := true, seen := at, count := count + 1 if count < most]}\n"
        "measured: {}\n",
    )
    write(
        station,
        "resources/lamp.yaml",
        "type: lamp\narguments: {of: arm, at: home, most: 3, pose_type: pose, text: 'a {at}', unit: 1}\n",
    )
    assert findings(station) == [f"{station}/resources/lamp.yaml:2:74: `lamp` has no parameter `unit`"]
    replace(station, "resources/lamp.yaml", ", unit: 1", "")
    assert findings(station) == [
        f"{station}/types/lamp.yaml:2:31: in lamp ({station}/resources/lamp.yaml:1:7): unknown parameter `unit`"
    ]
    replace(station, "types/lamp.yaml", ", {unit}", "")
    found = automaton(station)
    assert found.resources["lamp"] == "Lamp at home, a {at}"
    light = found.abilities["lamp.light(out)"]
    assert light.title == "Light out at home"
    written = load_station(station).resources["lamp"].abilities
    enabled = next(iter(written.values())).enabled
    assert enabled == "not lit and arm.pose == home and not arm.move(out).executing and seen in {home, out}"
    assert pickle.loads(pickle.dumps(enabled)).at.__self__ == enabled


def test_an_argument_that_is_wrong_wherever_the_type_uses_it_is_told_once_at_the_argument(robots: Path) -> None:
    replace(robots, TYPE, "namespace: text", "namespace: text\n  travel: {kind: number, default: 1}")
    replace(robots, TYPE, "takes: [1, 2]", "takes: travel")
    replace(robots, TYPE, "react: 2,", "react: travel,")
    [first] = replace(robots, ONE, "{namespace: robot_1", "{travel: ‹-1, namespace: robot_1")
    used = f"{robots / TYPE}:23:23"
    message = "expected a number of at least 0, found `-1`"
    assert findings(robots) == [f"{first}: {message}: {used} and another place use it"]
    replace(robots, TYPE, "takes: [0.2, 0.4]", "takes: travel")
    [second] = replace(robots, TWO, "{namespace: robot_2", "{travel: ‹-2, namespace: robot_2")
    assert findings(robots) == [
        f"{first}: {message}: {used} and 2 other places use it",
        f"{second}: {message.replace('1', '2')}: {used} and 2 other places use it",
    ]


# Robots of a type that uses what it declares: one waits with its part until the other is away.
_LIFT = {
    "station.yaml": "name: lifts\nenumerations:\n  level: [down, up]\n",
    "types/lift.yaml": """\
parameters: {other: resource}
output:
  target: {type: level, initial: down}
estimated:
  at: {type: level, initial: down}
predicates:
  rests: target == at
abilities:
  rise:
    enabled: target == down and rests
    start:
      do: [target := up]
    executing: target == up
    finish:
      when: target == up
      do: [at := up]
  lower:
    enabled: not rise.executing and at == up
    start:
      do: [at := down]
""",
    "resources/lift_l.yaml": "type: lift\narguments: {other: lift_r}\n",
    "resources/lift_r.yaml": "type: lift\narguments: {other: lift_l}\n",
}


@pytest.mark.parametrize(
    ("removed", "first", "others"),
    [
        ("output.target", "7:10", " and 4 other places use it: remove these as well, or keep it"),
        ("predicates.rests", "10:33", " uses it: remove that as well, or keep it"),
        ("abilities.rise", "18:18", " uses it: remove that as well, or keep it"),
    ],
)
def test_what_a_type_uses_and_an_instance_removes_is_told_once_where_it_is_removed(
    tmp_path: Path, removed: str, first: str, others: str
) -> None:
    for file, text in _LIFT.items():
        write(tmp_path, file, text)
    assert automaton(tmp_path).abilities
    [place] = write(tmp_path, "resources/lift_r.yaml", f"{_LIFT['resources/lift_r.yaml']}remove: [‹{removed}]\n")
    word = removed.rpartition(".")[2]
    used = f"{tmp_path / 'types' / 'lift.yaml'}:{first}"
    assert findings(tmp_path) == [f"{place}: `{word}` is removed here, and {used}{others}"]


def test_what_is_removed_is_told_elsewhere_without_proposing_what_another_resource_has(tmp_path: Path) -> None:
    for file, text in _LIFT.items():
        write(tmp_path, file, text)
    [entry] = write(tmp_path, "resources/lift_r.yaml", f"{_LIFT['resources/lift_r.yaml']}remove: [‹abilities.lower]\n")
    [place, second] = write(
        tmp_path,
        "specifications.yaml",
        "one: {forbidden: '‹lift_r.lower.executing'}\ntwo: {exclusive: [lift_l.lower, ‹lift_r.lower]}\n",
    )
    assert findings(tmp_path) == [
        f"{place}: `lower` is removed at {entry}: keep it there, or write something else here",
        f"{second}: there is no ability `lift_r.lower`: it is removed at {entry}",
    ]


def test_an_instance_changes_adds_and_removes(robots: Path) -> None:
    write(
        robots,
        TWO,
        "type: robot\n"
        "arguments: {namespace: robot_2, stops: outfeed_side, conveyor: outfeed}\n"
        "remove: [abilities.open_gripper, abilities.move_to.timeouts.react]\n"
        "estimated: {parts: {type: 0..1}}\n"
        "abilities:\n"
        "  before: {enabled: false}\n"
        "  move_to:\n"
        "    duration: 7\n"
        "    effects: {arrives: {takes: 3}}\n"
        "  behind: {enabled: false}\n",
    )
    (robots / "operations.yaml").unlink()
    (robots / "specifications.yaml").unlink()
    replace(robots, "station.yaml", "  and robot_2.at == outfeed", "  and robot_2.target == outfeed")
    found = automaton(robots)
    names = [name for name in found.abilities if name.startswith("robot_2.")]
    assert names == [f"robot_2.{each}" for each in ("before", "move_to(buffer)", "move_to(outfeed)", "behind")]
    moving = found.abilities["robot_2.move_to(buffer)"]
    assert (moving.duration, moving.timeouts.react, moving.timeouts.finish) == ((7, 7), None, 15)
    takes = {effect.name: (effect.shortest, effect.longest) for effect in found.effects if effect.resource == "robot_2"}
    assert takes == {"robot_2.move_to(buffer).leaves": (0.2, 0.4), "robot_2.move_to(buffer).arrives": (3, 3)}


def test_a_type_of_a_type(robots: Path) -> None:
    write(
        robots,
        "types/feeder.yaml",
        "type: robot\n"
        "parameters: {name: text, side: enumeration, home: {kind: value, of: side}}\n"
        "arguments: {namespace: '{name}', stops: side, conveyor: home}\n",
    )
    replace(
        robots,
        ONE,
        "type: robot\narguments: {namespace: robot_1, stops: infeed_side, conveyor: infeed}",
        "type: feeder\narguments: {name: robot_1, side: infeed_side, home: infeed}",
    )
    assert automaton(robots) == automaton(ROBOTS)


# What is said where something is wrong.


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("type: robot", "type: ‹robt", f"unknown type `robt`: {TYPES_ARE}; did you mean `robot`?"),
        ("type: robot", "type: ‹7", "expected a text, found `7`"),
        ("type: robot", "type: robot\n‹abilites: {}", "`abilites` is not known here; did you mean `abilities`?"),
        (
            "robot\narguments: {namespace: robot_1, stops: infeed_side, conveyor: infeed}",
            "‹robot",
            f"{NEEDS} `namespace`, a text{INTO}",
        ),
        (
            "type: robot\narguments: {namespace: robot_1, ",
            "type: ‹robot\narguments: {",
            f"{NEEDS} `namespace`, a text{INTO}",
        ),
        ("namespace: robot_1", "namespace: ‹1", "expected a text for `namespace`, found `1`: put it into quotes"),
        ("namespace: robot_1", "namespace: ‹[a]", "expected a text or an integer or a number, found a list"),
        ("stops: infeed_side", "stops: ‹infeed_sid", "unknown enumeration `infeed_sid`; did you mean `infeed_side`?"),
        ("stops: infeed_side", "stops: ‹2", "expected an enumeration for `stops`, found `2`"),
        (
            "conveyor: infeed",
            "conveyor: ‹infed",
            "`infed` is no value of `infeed_side`, and `conveyor` is one; did you mean `infeed`?",
        ),
        ("conveyor: infeed", "conveyor: ‹1.5", "expected a value of `stops` for `conveyor`, found `1.5`"),
        ("arguments: {", "arguments: {‹stop: infeed, ", "`robot` has no parameter `stop`; did you mean `stops`?"),
        (
            "title: Robot 1",
            "remove: [‹abilities.opn_gripper]",
            f"{NOTHING} `abilities` has no entry `opn_gripper`; did you mean `open_gripper`?",
        ),
        ("title: Robot 1", "remove: [‹title.en]", f"{NOTHING} the document has no entry `title`"),
        ("title: Robot 1", "remove: [‹abilities..x]", f"`abilities..x` is no path, from `..x` on: {PATHS_ARE}"),
    ],
)
def test_what_is_wrong_in_an_instance(robots: Path, old: str, new: str, message: str) -> None:
    [place] = replace(robots, ONE, old, new)
    lines = findings(robots)
    assert f"{place}: {message}" in lines
    assert all(line.startswith(f"{place}: ") for line in lines)


PARAMETERS = "parameters:\n"
PLACES = "{between, infeed, buffer, outfeed}"
STARTS_WRITE = "a start writes output or estimated variables"
HIDES = "rename one of them"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "namespace: text",
            "namespace: ‹txt",
            "expected `text`, `number`, `enumeration`, `value` or `resource`, found `txt`",
        ),
        (
            "{kind: value, of: stops}",
            "‹{kind: value}",
            "`of` belongs to `kind: value`, and says which enumeration the value is of",
        ),
        ("of: stops", "of: ‹stps", "unknown enumeration `stps`; did you mean `stops`?"),
        ("of: stops", "of: ‹namespace", "`namespace` is a text, and no enumeration"),
        (PARAMETERS, f"{PARAMETERS}  ‹at: text\n", f"the parameter `at` hides the variable `at`: {HIDES}"),
        (PARAMETERS, f"{PARAMETERS}  ‹stop: text\n", f"the parameter `stop` hides the parameter `stop`: {HIDES}"),
        (
            PARAMETERS,
            f"{PARAMETERS}  ‹move_to: text\n",
            f"the parameter `move_to` hides the ability `move_to`: {HIDES}",
        ),
        (
            PARAMETERS,
            f"{PARAMETERS}  ‹parts_on_buffer: text\n",
            f"the parameter `parts_on_buffer` hides the variable `parts_on_buffer`: {HIDES}",
        ),
        (
            PARAMETERS,
            f"{PARAMETERS}  ‹buffer: text\n",
            f"the parameter `buffer` hides the value `buffer` of `place`: {HIDES}",
        ),
        (
            PARAMETERS,
            f"{PARAMETERS}  ‹enabled: text\n",
            "`enabled` is a flag of every ability: take another name",
        ),
        (
            PARAMETERS,
            f"{PARAMETERS}  ‹in: text\n",
            "`in` is a word of the language: take another name",
        ),
        (PARAMETERS, "‹paramters:\n", "`paramters` is not known here; did you mean `parameters`?"),
        (PARAMETERS, f"type: ‹robot\n{PARAMETERS}", "`robot` is a type of itself: robot → robot"),
        # what is wrong for all instances is told once
        ("    title: Move", "    ‹titel: Move", f"{BOTH}`titel` is not known here; did you mean `title`?"),
        ("takes: [0.2, 0.4]", "takes: [0.2, ‹soon]", f"{BOTH}expected a number, found `soon`"),
        ("kind: starting", "kind: ‹begin", f"{BOTH}expected `starting`, `executing` or `finishing`, found `begin`"),
        (
            "  /{namespace}/state",
            "  /{‹namspace}/state",
            f"{BOTH}unknown parameter `namspace`; did you mean `namespace`?",
        ),
        (
            "initial: conveyor}\n\nout",
            "initial: ‹covneyor}\n\nout",
            f"{BOTH}`covneyor` is no initial value of `robot_1.at`, which ranges over {PLACES}",
        ),
        (
            "executing and at == stop",
            "executing and ‹ta == stop",
            f"{BOTH}unknown variable or value `ta`; did you mean `target`?",
        ),
        (
            "do: [close_gripper := false]",
            "do: [‹part_in_gripper := false]",
            f"{BOTH}{STARTS_WRITE}, and `part_in_gripper` is a measured variable",
        ),
        # and what is wrong for one of them names that one
        (
            "target == stop and at != stop",
            "target == ‹infeed and at != stop",
            "in robot_2 (¤:2:7): unknown variable or value `infeed`; did you mean `outfeed`?",
        ),
    ],
)
def test_what_is_wrong_in_a_type(robots: Path, old: str, new: str, message: str) -> None:
    [place] = replace(robots, TYPE, old, new)
    said = message.replace("‹", str(robots / ONE)).replace("¤", str(robots / TWO))
    assert findings(robots) == [f"{place}: {said}"]


def test_what_is_wrong_with_an_argument_in_a_text_names_the_argument(robots: Path) -> None:
    [place] = replace(robots, TYPE, "executing and at == stop", "executing and parts_on_buffer == ‹conveyor")
    one, two = findings(robots)
    assert one.startswith(f"{place}: in robot_1 ({robots / ONE}:3:63): unknown variable `infeed`")
    assert two.startswith(f"{place}: in robot_2 ({robots / TWO}:3:64): unknown variable `outfeed`")


@pytest.mark.parametrize(
    ("old", "new", "argument", "message"),
    [
        # a number, alone and in a list
        (
            "timeouts: {react: 2, finish: 15}",
            "timeouts: {react: 2, finish: ‹speed}",
            "-1",
            "expected a number of at least 0, found `-1`",
        ),
        ("takes: [1, 2]", "takes: ‹[1, speed]", "0.5", "from 1 to 0.5 seconds is no duration: write the fewest first"),
        (
            "executing and at == stop",
            "executing and at == stop and parts_on_buffer == ‹speed",
            "7",
            "cannot compare an integer in 0..2 with the integer 7",
        ),
        # a part of a type and of a name
        (
            "type: stops, initial: conveyor",
            "type: ‹'0..{speed}'",
            "-4",
            "the range 0..-4 is empty: write the smaller number first",
        ),
        (
            "  /{namespace}/command",
            "  ‹/{speed}/command",
            "8",
            "`/8/command` is not a topic name: write it absolute, as in /robot/state, of letters, digits and single "
            "underscores, no part beginning with a digit",
        ),
    ],
)
def test_what_is_wrong_with_an_argument_names_its_place(
    robots: Path, old: str, new: str, argument: str, message: str
) -> None:
    replace(robots, TYPE, "  namespace: text\n", "  namespace: text\n  speed: {kind: number, default: 2}\n")
    if "command" in old:
        replace(robots, TYPE, "speed: {kind: number, default: 2}", "speed: {kind: text, default: robot_2}")
        argument = f"'{argument}'"
    [given] = replace(robots, ONE, "conveyor: infeed}", f"conveyor: infeed, speed: ‹{argument}}}")
    [place] = replace(robots, TYPE, old, new)
    assert f"{place}: in robot_1 ({given}): {message}" in findings(robots)


def test_an_argument_that_a_name_of_the_resource_hides(robots: Path) -> None:
    replace(robots, ONE, "measured:\n", "measured:\n  infeed: {type: bool}\n")
    message = f"the variable `infeed` of the resource hides what is meant here: {HIDES}"
    assert f"{robots / ONE}:3:63: {message}" in findings(robots)


_SPARE = """\
parameters:
  {name: text, topic: text, places: enumeration, first: {kind: value, of: places}, travel: number, other: resource}
topics:
  "{topic}": {type: buffer_msgs/msg/RobotState, direction: in}
  "/{name}/state": {type: buffer_msgs/msg/RobotState, direction: in}
measured: {at: {type: places, initial: first}}
output: {busy: {type: bool}}
abilities:
  go:
    enabled: at == first and not other.close_gripper
    start: {do: [busy := true]}
    until: at != first
    finish: {do: [busy := false]}
    effects:
      arrives: {do: [at := first], takes: [2, travel]}
predicates:
  is_busy: busy
alarms:
  slow: {when: busy, title: "{name} is slow", delay: travel}
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("    start: {do", "    ‹strt: {do", "`strt` is not known here; did you mean `start`?"),
        (
            "not other.close_gripper",
            "not other.close_gripper and‹",
            "expected a name, a value or `(`, found the end of the text",
        ),
        ("[busy := true]", "[busy ‹= true]", "`=` has no meaning here; write == (or := in an action)"),
        ("is_busy: busy", "is_busy: busy ‹&& at == first", "`&&` has no meaning here; write and"),
        ('"{name} is slow"', '"‹{nam} is slow"', "unknown parameter `nam`; did you mean `name`?"),
        ("takes: [2, travel]", "takes: ‹[3, 2]", "from 3 to 2 seconds is no duration: write the fewest first"),
    ],
)
def test_a_type_without_an_instance_is_checked_as_far_as_no_argument_is_needed(
    robots: Path, old: str, new: str, message: str
) -> None:
    write(robots, "types/spare.yaml", _SPARE)
    read_station(robots)
    [place] = replace(robots, "types/spare.yaml", old, new)
    [found] = findings(robots)
    assert found.endswith(f": {message}")
    assert found.startswith(place.rpartition(":")[0])


def test_arguments_without_a_type(robots: Path) -> None:
    replace(robots, ONE, "type: robot\n", "")
    message = "`type` is missing here: `arguments` and `remove` are those of an instance of a type"
    assert findings(robots) == [f"{robots / ONE}:2:1: {message}"]


def test_one_name_for_two_topics_of_one_type(robots: Path) -> None:
    replace(robots, TYPE, "  namespace: text", "  namespace: text\n  topic: {kind: text, default: state}")
    [place] = replace(robots, TYPE, "  /{namespace}/command", "  ‹/{namespace}/{topic}")
    both = BOTH.replace("‹", str(robots / ONE))
    assert findings(robots) == [f"{place}: {both}duplicate name `/robot_1/state`: other arguments make another one"]


def test_a_file_of_types_that_is_not_read_is_named(robots: Path) -> None:
    shutil.copy(robots / TYPE, robots / "types" / "arm.yml")
    (robots / "types" / "notes.txt").write_text("…")
    assert findings(robots) == [
        f"{robots / 'types/arm.yml'}:1:1: rename it to arm.yaml: this is not read",
        f"{robots / 'types/notes.txt'}:1:1: this is not read: each type is a file <name>.yaml in this folder",
    ]


# Read again and again while somebody edits it.


def test_what_has_not_changed_is_the_same_object(robots: Path) -> None:
    before = ReadBefore()
    first = load_station(robots, before).resources
    replace(robots, ONE, "title: Robot 1", "title: The first robot")
    second = load_station(robots, before).resources
    assert second["robot_2"] is first["robot_2"]
    assert second["robot_1"].title == "The first robot"
    replace(robots, TYPE, "title: Move to", "title: Go to")
    third = load_station(robots, before).resources
    assert {
        str(each.abilities[name].title) for each in third.values() for name in each.abilities if name == "move_to"
    } == {"Go to the {stop}"}


def test_an_enumeration_that_is_gone_is_noticed_though_the_instance_is_the_same(robots: Path) -> None:
    before = ReadBefore()
    load_station(robots, before)
    replace(robots, "station.yaml", "  infeed_side: [", "  feed_side: [")
    with pytest.raises(ModelError) as caught:
        load_station(robots, before)
    assert [finding.message for finding in caught.value.findings] == [
        "unknown enumeration `infeed_side`; did you mean `feed_side`?"
    ]


def test_what_an_instance_has_of_its_type_is_found_in_the_type(robots: Path) -> None:
    places = automaton(robots).places
    assert places["robot_1.move_to(buffer)"].file == places["robot_2.move_to(buffer)"].file == str(robots / TYPE)
    assert places["robot_1.pick"].file == str(robots / ONE)
