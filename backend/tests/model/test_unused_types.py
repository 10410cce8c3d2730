"""Types that no instance has: what is told of names in them, and what depends on arguments and so is not."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.reader import read_yaml
from sequence_planner.station import read_station
from support.places import MODELS, STATIONS

from .breaking import findings, replace, write
from .test_types import FoldedResource

ROBOTS = MODELS / "robots_with_buffer"
EXAMPLES = [
    station
    for folder in (MODELS, STATIONS)
    for station in sorted(folder.glob("*/"))
    if (station / "station.yaml").exists()
]
LAMP = "types/lamp.yaml"
TYPE = """\
parameters:
  {topic: text, places: enumeration, first: {kind: value, of: places}, most: number, other: resource}
topics:
  "{topic}": {type: buffer_msgs/msg/RobotState, direction: in}
  "/{topic}/state": {type: buffer_msgs/msg/RobotState, direction: in, pipeline: [{rename: {at_buffer: is_there}}]}
measured: {at: {type: places, initial: first}}
estimated: {seen: {for: {where: places}, type: bool}, count: {type: "0..{most}"}}
output: {busy: {type: bool}}
abilities:
  go:
    parameters: {where: places}
    enabled: at == first and not other.close_gripper and part_in_gripper and count < most and near(at, first)
    start: {when: "all each in places where each != where: seen[each]", do: [busy := true]}
    until: at in {first, where} and at in places and not robot_1.close_gripper
    finish: {when: is_busy, do: [busy := false, "all each in places: seen[each] := each == first"]}
    effects:
      arrives: {when: busy and at != where, do: [at := where]}
  stop:
    enabled: go(first).executing and parts_on_buffer > 0 and at != buffer
relations:
  near: {between: [places, places], pairs: [[first, first]]}
predicates:
  is_busy: busy and not stop.enabled
  is_seen: {parameters: {it: places}, when: "seen[it]"}
alarms:
  slow: {when: is_seen(first) and busy, title: It is slow}
"""


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """The station of two robots, and a type that none of its resources is of."""
    robots = Path(shutil.copytree(ROBOTS, tmp_path / "robots"))
    write(robots, LAMP, TYPE)
    return robots


def test_what_depends_on_arguments_or_follows_from_messages_is_not_told(station: Path) -> None:
    read_station(station)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("at == first and", "at == ‹frst and", "unknown variable or value `frst`; did you mean `first`?"),
        (
            "and part_in_gripper",
            "and ‹part_in_griper",
            "unknown variable `part_in_griper`; did you mean `part_in_gripper`?",
        ),
        ("count < most", "count < ‹mst", "unknown variable or value `mst`; did you mean `most`?"),
        ("near(at, first)", "‹neer(at, first)", "unknown variable `neer(at, first)`; did you mean `near`?"),
        ("near(at, first)", "near(at, ‹firs)", "unknown variable or value `firs`; did you mean `first`?"),
        ("each != where:", "‹eech != where:", "unknown variable or value `eech`; did you mean `each`?"),
        ("[busy := true]", "[‹bsy := true]", "unknown variable `bsy`; did you mean `busy`?"),
        (
            "at in places and",
            "at in ‹place_s and",
            "there is no set `place_s`: `in` needs values in braces, an enumeration or a named set; "
            "did you mean `places`?",
        ),
        ("at in {first,", "at in {‹fist,", "unknown variable or value `fist`; did you mean `first`?"),
        (
            "robot_1.close",
            "‹robot_1.close_gripr and not robot_1.close",
            "unknown variable `robot_1.close_gripr`; did you mean `robot_1.close_gripper`?",
        ),
        ("is_busy, do", "‹is_bsy, do", "unknown variable `is_bsy`; did you mean `is_busy`?"),
        (
            "seen[each] := each == first",
            "seen[each] := each == ‹frst",
            "unknown variable or value `frst`; did you mean `first`?",
        ),
        (
            "go(first).executing",
            "‹go(first).executng",
            "unknown variable `go(first).executng`; did you mean `go.executing`?",
        ),
        (
            "parts_on_buffer > 0",
            "‹part_on_bufer > 0",
            "unknown variable or value `part_on_bufer`; did you mean `parts_on_buffer`?",
        ),
        ("at != buffer", "at != ‹bufer", "unknown variable or value `bufer`; did you mean `buffer`?"),
        ("is_busy: busy and", "is_busy: ‹True and busy and", "unknown variable `True`; write true"),
        ('"seen[it]"', '"seen[‹i]"', "unknown variable or value `i`; did you mean `it`?"),
        ("is_seen(first) and", "‹is_sen(first) and", "unknown variable `is_sen(first)`; did you mean `is_seen`?"),
        ("at != buffer", "at != ‹topic", "unknown variable or value `topic`"),
        (
            "not stop.enabled",
            "not ‹stop",
            "unknown variable `stop`; write stop.enabled or stop.executing or stop.finished",
        ),
    ],
)
def test_a_name_that_is_wrong_whatever_the_arguments_are_is_told_at_the_type(
    station: Path, old: str, new: str, message: str
) -> None:
    [place] = replace(station, LAMP, old, new)
    assert findings(station) == [f"{place}: {message}"]


def test_it_is_told_with_what_else_is_wrong(station: Path) -> None:
    [place] = replace(station, LAMP, "[busy := true]", "[‹bsy := true]")
    [other] = replace(station, "resources/robot_1.yaml", "executing: close", "executing: ‹clse_gripper and close")
    assert sorted(each.partition(": ")[0] for each in findings(station)) == sorted([place, other])


def test_a_type_of_which_another_one_is_is_told_as_that(station: Path) -> None:
    """What it uses may come from those that are of it."""
    replace(station, LAMP, "and part_in_gripper", "and part_in_gripper and is_lit")
    assert len(findings(station)) == 1
    write(
        station,
        "types/bright_lamp.yaml",
        "parameters: {name: text, what: {kind: value, of: place}}\n"
        "type: lamp\n"
        "arguments: {topic: '{name}', places: place, first: what, most: 3, other: robot_2}\n"
        "output: {is_lit: {type: bool}}\n"
        "predicates: {is_dark: not is_lit and at != what}\n",
    )
    read_station(station)
    [place] = replace(station, LAMP, "at == first and", "at == ‹frst and")
    assert findings(station) == [f"{place}: unknown variable or value `frst`"]


def test_names_that_arguments_make_are_not_told(station: Path) -> None:
    replace(station, LAMP, "busy: {type: bool}", '"{topic}_is_on": {type: bool}, busy: {type: bool}')
    replace(station, LAMP, "enabled: at == first", "enabled: lamp_is_on and at == first")
    read_station(station)


def test_a_type_of_messages_that_arguments_tell_may_have_any_variables(station: Path) -> None:
    told = '"{topic}": {type: "{topic}_msgs/msg/Lamp", direction: in}\n  /also: {type: buffer_msgs'
    replace(station, LAMP, '"{topic}": {type: buffer_msgs', told)
    replace(station, LAMP, "enabled: at == first", "enabled: whatever and at == first")
    read_station(station)


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda each: each.name)
def test_nothing_is_told_of_a_type_that_is_as_a_resource_is(tmp_path: Path, folder: Path) -> None:
    """Whatever parameters it has."""
    station = Path(shutil.copytree(folder, tmp_path / "station"))
    enumerations = plain(read_yaml(station / "station.yaml", "it").content).get("enumerations", {})
    (station / "types").mkdir(exist_ok=True)
    for file in (station / "resources").glob("*.yaml"):
        content = plain(read_yaml(file, "it").content)
        if "type" not in content:
            made = FoldedResource(content, enumerations)
            text = json.dumps({"parameters": made.parameters, **made.type})
            (station / "types" / f"unused_{file.name}").write_text(text)
    read_station(station)


_WORDS = re.compile(r"\b(?:at|busy|seen|is_busy|parts_on_buffer|first|most|go|near)\b")
# Where in the text a name stands that means something.
NAMES = [
    (line.start(1) + word.start(), word[0])
    for line in re.finditer(r"(?:enabled|when|until): *(.*)", TYPE)
    for word in _WORDS.finditer(line[1])
]


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(chosen=st.integers(0, len(NAMES) - 1))
def test_any_name_that_is_written_wrong_is_told_where_it_stands(station: Path, chosen: int) -> None:
    at, name = NAMES[chosen]
    above = TYPE[:at].split("\n")
    write(station, LAMP, f"{TYPE[:at]}{name}_qqq{TYPE[at + len(name) :]}")
    with pytest.raises(ModelError) as caught:
        read_station(station)
    place = f"{station / LAMP}:{len(above)}:{len(above[-1]) + 1}: "
    assert any(str(each).startswith(place) and f"{name}_qqq" in each.message for each in caught.value.findings)
    write(station, LAMP, TYPE)


# Types of packages: they are made for stations that have other names.

PACKAGE = """\
parameters: {places: enumeration, first: {kind: value, of: places}}
estimated: {at: {type: places, initial: first}}
abilities:
  leave:
    enabled: at == first and light_is_green and operator.is_away and at != somewhere
    start: {do: [at := elsewhere]}
"""


@pytest.fixture
def packaged(station: Path) -> Path:
    """The station with a package of which it uses nothing yet."""
    (station / LAMP).unlink()
    folder = station.parent / "lamps"
    write(folder, "package.yaml", 'name: lamps\nversion: "1.0"\n')
    write(folder, "types/lamp.yaml", PACKAGE)
    text = (station / "station.yaml").read_text()
    (station / "station.yaml").write_text(f"{text}\npackages:\n  lamps: {{path: ../lamps}}\n")
    return station


def fetched(station: Path) -> Path:
    from support.station import finished  # noqa: PLC0415

    assert finished("packages", "fetch", str(station)).returncode == 0
    return station


def test_what_a_package_expects_of_a_station_is_not_told_as_long_as_nothing_is_of_its_type(packaged: Path) -> None:
    read_station(fetched(packaged))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("light_is_green", "‹leave.enabld", "unknown variable `leave.enabld`; did you mean `leave.enabled`?"),
        ("light_is_green", "light_is_green ‹&& at == first", "`&&` has no meaning here; write and"),
        ("[at := elsewhere]", "[‹att := first]", "unknown variable `att`; did you mean `at`?"),
    ],
)
def test_what_is_misspelt_in_a_package_is_told(packaged: Path, old: str, new: str, message: str) -> None:
    [place] = replace(packaged.parent / "lamps", "types/lamp.yaml", old, new)
    station = fetched(packaged)
    told = place.replace(str(packaged.parent / "lamps"), str(station / "packages" / "lamps"))
    assert findings(station) == [f"{told}: {message}"]
