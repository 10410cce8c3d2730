"""What documents can say beyond guards and actions, and what each of it means in the automaton."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.automaton.automaton import Automaton, Kind, Timeouts
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.station import prepare_station

from .breaking import assert_found, copy_of_cell, findings, replace, write
from .test_sequences import in_a_circle

ARM, STATION, OPERATIONS, SPECIFICATIONS, MASTERS = (
    "resources/arm.yaml",
    "station.yaml",
    "operations.yaml",
    "specifications.yaml",
    "work_masters.yaml",
)
STATE, COMMAND = "messages/cell_msgs/msg/ArmState.msg", "messages/cell_msgs/msg/ArmCommand.msg"
FINISH = "      when: executing and pose == position\n"


def with_file(folder: Path, file: str, text: str) -> Automaton:
    """The automaton of the cell with a whole file written anew."""
    station = copy_of_cell(folder)
    write(station, file, text)
    return prepare_station(station).automaton


def with_change(folder: Path, file: str, old: str, new: str) -> Automaton:
    """The automaton of the cell with `new` in place of `old`."""
    station = copy_of_cell(folder)
    replace(station, file, old, new)
    return prepare_station(station).automaton


def forbidden(automaton: Automaton) -> dict[str, str]:
    return {name: print_expression(each.forbidden) for name, each in automaton.specifications.items()}


# Specifications: each shorthand is what it expands to.


def test_never_while(tmp_path: Path) -> None:
    automaton = with_file(
        tmp_path,
        SPECIFICATIONS,
        "full_arm:\n  parameters: {which: part}\n"
        "  never: parts[which] == full\n  while: arm.moving or arm.pose == out\n",
    )
    assert forbidden(automaton) == {
        "full_arm(left)": "parts[left] == full and (arm.moving or arm.pose == out)",
        "full_arm(right)": "parts[right] == full and (arm.moving or arm.pose == out)",
    }


def test_exclusive_abilities_never_execute_at_once(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(
        station,
        "resources/door.yaml",
        "abilities:\n  open: {executing: arm.moving}\n  close: {executing: arm.moving}\n",
    )
    write(station, SPECIFICATIONS, "one:\n  title: One at a time\n  exclusive: [door.open, arm.move, door.close]\n")
    automaton = prepare_station(station).automaton
    moving = "(arm.move(home).executing or arm.move(out).executing)"
    assert forbidden(automaton) == {
        "one: door.open and arm.move": f"door.open.executing and {moving}",
        "one: door.open and door.close": "door.open.executing and door.close.executing",
        "one: arm.move and door.close": f"{moving} and door.close.executing",
    }
    assert automaton.specifications["one: door.open and arm.move"].title == "One at a time: door.open and arm.move"


def test_exclusive_abilities_with_parameters(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "resources/door.yaml", "abilities:\n  open: {executing: arm.moving}\n")
    write(station, SPECIFICATIONS, "one:\n  parameters: {where: target}\n  exclusive: [arm.move(where), door.open]\n")
    assert forbidden(prepare_station(station).automaton)["one(out): arm.move(where) and door.open"] == (
        "arm.move(out).executing and door.open.executing"
    )


def test_a_zone_is_shared_one_at_a_time(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    for name in ("door", "lamp"):
        write(station, f"resources/{name}.yaml", "estimated: {inside: {type: bool}}\n")
    write(station, SPECIFICATIONS, "table:\n  zone: {arm: pose == out or goto == out, door: inside, lamp: inside}\n")
    assert forbidden(prepare_station(station).automaton) == {
        "table: arm and door": "(arm.pose == out or arm.goto == out) and door.inside",
        "table: arm and lamp": "(arm.pose == out or arm.goto == out) and lamp.inside",
        "table: door and lamp": "door.inside and lamp.inside",
    }


def test_an_order_of_conditions(tmp_path: Path) -> None:
    text = "steps:\n  order: [parts[left] == full, parts[right] == full, arm.moving]\n".replace(
        "[parts[left] == full, parts[right] == full, arm.moving]",
        '["parts[left] == full", "parts[right] == full", arm.moving]',
    )
    assert forbidden(with_file(tmp_path, SPECIFICATIONS, text)) == {
        "steps: parts[left] == full before parts[right] == full": "parts[right] == full and not parts[left] == full",
        "steps: parts[right] == full before arm.moving": "arm.moving and not parts[right] == full",
    }


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("‹a:\n  never: arm.moving\n", "`never` and `while` belong together: what must not be, and while what"),
        ("a: ‹{}\n", "a specification is exactly one of forbidden, never and while, exclusive, zone, order"),
        ("a:\n  exclusive: [arm.move, ‹arm.mov]\n", "there is no ability `arm.mov`; did you mean `arm.move`?"),
        (
            "a:\n  exclusive: [arm.move, ‹arm.move(hom)]\n",
            "there is no ability `arm.move(hom)`; did you mean `arm.move(home)`?",
        ),
        (
            "a:\n  order: [arm.moving, ‹arm.mov.executing]\n",
            "unknown variable `arm.mov.executing`; did you mean `arm.move(…).executing`, as in "
            "`arm.move(home).executing`?",
        ),
        (
            "a:\n  order: [arm.moving, ‹arm.move(xyz).executing]\n",
            "unknown variable `arm.move(xyz).executing`; did you mean `arm.move(…).executing`, as in "
            "`arm.move(home).executing`?",
        ),
        ("a:\n  exclusive: [arm.move, ‹not arm.move]\n", "expected the name of an ability, such as `robot.move`"),
        (
            "a:\n  exclusive: [arm.move, ‹arm.move(out)]\n",
            "`arm.move(out)` is in `arm.move` as well: no ability excludes itself",
        ),
        ("a:\n  exclusive: ‹[arm.move]\n", "expected at least 2 entries, found a list"),
        ("a:\n  zone: {arm: moving, ‹am: moving}\n", "there is no resource `am`; did you mean `arm`?"),
        (
            "a:\n  zone: {arm: moving and true == ‹pose, arm2: true}\n",
            "cannot compare a truth value with one of {unknown, home, out}",
        ),
        ("a:\n  zone: ‹{arm: moving}\n", "expected at least 2 entries, found a mapping"),
        ("a:\n  order: [arm.moving, ‹pose == out]\n", "unknown variable `pose`; did you mean `arm.pose`?"),
    ],
)
def test_what_is_wrong_with_a_specification(tmp_path: Path, text: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    [place] = write(station, SPECIFICATIONS, text)
    assert f"{place}: {message}" in findings(station)


# Abilities


def test_timeouts_durations_and_cancelling(tmp_path: Path) -> None:
    more = FINISH + "    timeouts: {react: 0.5, finish: 20}\n    duration: [2, 5]\n    cancel: {do: [goto := home]}\n"
    move = with_change(tmp_path, ARM, FINISH, more).abilities["arm.move(out)"]
    assert move.timeouts == Timeouts(react=0.5, finish=20)
    assert move.duration == (2, 5)
    assert [print_assignment(action) for action in move.cancel_actions] == ["arm.goto := home"]


def test_one_duration_is_the_shortest_and_the_longest(tmp_path: Path) -> None:
    move = with_change(tmp_path, ARM, FINISH, f"{FINISH}    duration: 3\n").abilities["arm.move(out)"]
    assert move.duration == (3, 3)
    assert move.timeouts == Timeouts()


def test_what_is_done_when_it_is_overdue(tmp_path: Path) -> None:
    more = f"{FINISH}    timeouts: {{finish: 20, then: replan, retries: 2}}\n"
    assert with_change(tmp_path, ARM, FINISH, more).abilities["arm.move(out)"].timeouts == Timeouts(
        finish=20, retries=2, replan=True
    )


def test_alone_an_alarm_is_raised_when_it_is_overdue(tmp_path: Path) -> None:
    more = f"{FINISH}    timeouts: {{finish: 20, then: alarm}}\n"
    assert with_change(tmp_path, ARM, FINISH, more).abilities["arm.move(out)"].timeouts == Timeouts(finish=20)


def test_what_it_means_that_it_is_late(tmp_path: Path) -> None:
    """With what the parameters are called, and variables by their full names; of other languages too."""
    more = """\
    timeouts: {react: 1, finish: 20}
    late:
      not_begun: The arm does not leave for {position}
      not_finished: {en: "It is at {pose}, not at {position}", sv: "Den är vid {arm.pose}"}
"""
    late = with_change(tmp_path, ARM, FINISH, FINISH + more).abilities["arm.move(out)"].late
    assert late.not_begun == {"": "The arm does not leave for out"}
    assert late.not_finished == {"en": "It is at {arm.pose}, not at out", "sv": "Den är vid {arm.pose}"}


@pytest.mark.parametrize(
    ("late", "message"),
    [
        (
            '{not_finished: "It is at {‹poes}"}',
            "`{poes}` stands for no parameter and no variable; did you mean `pose`?",
        ),
        (
            '{not_finished: {en: "To {position}", sv: "Till {‹postion}"}}',
            "`{postion}` stands for no parameter and no variable; did you mean `position`?",
        ),
        ('{not_finished: "It {‹move.finished}"}', "`{move.finished}` stands for no parameter and no variable"),
    ],
)
def test_what_is_wrong_in_what_is_said_of_it(tmp_path: Path, late: str, message: str) -> None:
    """With the line and the column of the word."""
    station = copy_of_cell(tmp_path)
    line = f"    late: {late}"
    replace(station, ARM, FINISH, f"{FINISH}    timeouts: {{finish: 3}}\n{line.replace('‹', '')}\n")
    row = (station / ARM).read_text(encoding="utf-8").split("\n").index(line.replace("‹", "")) + 1
    found = [each.partition("resources/arm.yaml:")[2] for each in findings(station)]
    assert any(each.startswith(f"{row}:{line.index('‹') + 1}: {message}") for each in found), found


def test_what_is_never_late_has_no_words_for_it(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, FINISH, f"{FINISH}    timeouts: {{finish: 3}}\n    late: {{not_begun: It stays}}\n")
    wanted = "`late.not_begun` needs a `timeouts.react`: without one it is never late"
    assert any(each.endswith(wanted) for each in findings(station))


def test_an_operation_that_does_not_repeat(tmp_path: Path) -> None:
    operations = with_change(tmp_path, OPERATIONS, "fetch:", "fetch:\n  repeat: false").operations.values()
    assert {operation.repeat for operation in operations} == {False}


def test_operations_repeat_if_nothing_is_said(tmp_path: Path) -> None:
    operations = with_change(tmp_path, OPERATIONS, "fetch:", "fetch:\n  priority: 0").operations.values()
    assert {operation.repeat for operation in operations} == {True}


def test_a_cancel_writes_what_a_start_writes(tmp_path: Path) -> None:
    message = "a cancel writes output or estimated variables, and `pose` is a measured variable"
    assert_found(tmp_path, ARM, FINISH, f"{FINISH}    cancel: {{do: [‹pose := home]}}\n", message)


# Integers


COUNTER = "estimated:\n  count: {type: 0..3}\n  parts:"


def test_counting_is_allowed_where_it_fits(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATION, "estimated:\n  parts:", COUNTER)
    replace(station, ARM, FINISH, FINISH.rstrip() + " and count < 3\n      do: [count := count + 1]\n")
    move = prepare_station(station).automaton.abilities["arm.move(out)"]
    assert [print_assignment(action) for action in move.finish_actions] == ["count := count + 1"]


@pytest.mark.parametrize(
    ("action", "message"),
    [
        ("count := ‹count + 1", "`count := count + 1` may write 4 where count == 3"),
        ("count := ‹count - 1 if count < 3", "`count := count - 1 if count < 3` may write -1 where count == 0"),
        (
            "count := ‹count + 2 if count < 3 and pose == out",
            "`count := count + 2 if count < 3 and arm.pose == out` may write 4 where count == 2",
        ),
    ],
)
def test_counting_is_refused_where_it_may_not_fit(tmp_path: Path, action: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATION, "estimated:\n  parts:", COUNTER)
    [place] = replace(station, ARM, FINISH, f"{FINISH}      do: [{action}]\n")
    advice = "add a condition to the guard, or with `if` to the action, under which it fits"
    assert findings(station) == [f"{place}: {message}, which is not in 0..3: {advice}"]


# Operations


def test_a_local_formula(tmp_path: Path) -> None:
    text = "fetch:\n  precondition: true\n  goal: arm.pose == out\n  local: not arm.moving U arm.goto == out\n"
    operation = with_file(tmp_path, OPERATIONS, text).operations["fetch"]
    assert operation.local is not None
    assert print_expression(operation.local) == "not arm.moving U arm.goto == out"


def test_guards_can_ask_which_operations_are_active(tmp_path: Path) -> None:
    asks = "enabled: operation.fetch(left).active and goto == pose"
    automaton = with_change(tmp_path, ARM, "enabled: goto == pose", asks)
    name = "operation.fetch(left).active"
    assert automaton.variables[name].kind is Kind.ACTIVITY
    assert automaton.variables[name].type == BOOLEAN
    assert automaton.names(Kind.ACTIVITY) == (name,)  # the other is read by nobody
    assert print_expression(automaton.abilities["arm.move(out)"].enabled).startswith(name)


def test_nobody_writes_whether_an_operation_is_active(tmp_path: Path) -> None:
    message = (
        "a start writes output or estimated variables, and `operation.fetch(left).active` is "
        "the activity of an operation"
    )
    new = 'do: ["goto := position", ‹"operation.fetch(left).active := true"]'
    assert_found(tmp_path, ARM, "do: [goto := position]", new, message)


def test_no_resource_takes_the_name_of_the_operations(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    [place] = write(station, "resources/operation.yaml", "‹title: Operation\n")
    message = "`operation` stands for the operations in expressions: take another name"
    assert findings(station) == [f"{place}: {message}"]


# Work masters


MASTER = """
both:
  title: Both parts
  brings: ["parts[left] := empty", "parts[right] := empty"]
  operations:
    fetch(left):
    fetch(right): {after: [fetch(left)]}
"""


def test_a_work_master(tmp_path: Path) -> None:
    master = with_file(tmp_path, MASTERS, MASTER).work_masters["both"]
    assert master.title == "Both parts"
    assert master.operations == {"fetch(left)": frozenset(), "fetch(right)": frozenset({"fetch(left)"})}
    assert [print_assignment(action) for action in master.brings] == ["parts[left] := empty", "parts[right] := empty"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("    fetch(left):\n", "    ‹fetch(lft):\n", "there is no operation `fetch(lft)`; did you mean `fetch(left)`?"),
        ("[fetch(left)]", "[‹fetch(lef)]", "`fetch(lef)` is no operation of this job; did you mean `fetch(left)`?"),
        (
            "    fetch(left):\n",
            "    ‹fetch(left): {after: [fetch(right)]}\n",
            in_a_circle("fetch(left) → fetch(right) → fetch(left)"),
        ),
        (
            '["parts[left] := empty"',
            "[‹arm.goto := home",
            "a new product writes estimated variables, and `arm.goto` is an output variable",
        ),
        (
            '["parts[left] := empty"',
            '[‹"parts[left] := parts[right]"',
            "a new product brings certain values: write `variable := value`",
        ),
        ('"parts[right] := empty"]', '‹"parts[left] := full"]', "`parts[left]` is brought twice"),
    ],
)
def test_what_is_wrong_with_a_work_master(tmp_path: Path, old: str, new: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    assert MASTER.count(old) == 1
    [place] = write(station, MASTERS, MASTER.replace(old, new))
    assert f"{place}: {message}" in findings(station)


# Variables that follow from message types


def test_fields_are_variables_without_being_declared(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATE, "bool moving", "bool moving\nuint8 load\nbool ready\nfloat64 heat\nint32 hours")
    replace(station, COMMAND, "float64 speed", "float64 speed\nbool brake")
    variables = prepare_station(station).automaton.variables
    assert variables["arm.ready"].type == variables["arm.brake"].type == BOOLEAN
    assert variables["arm.load"].type == IntegerRange(0, 255)
    assert (variables["arm.ready"].kind, variables["arm.brake"].kind) == (Kind.MEASURED, Kind.OUTPUT)
    assert variables.keys().isdisjoint({"arm.heat", "arm.hours", "arm.speed", "arm.joints"})


def test_what_is_declared_refines_what_follows_from_the_message(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATE, "bool moving", "bool moving\nuint8 load")
    replace(station, ARM, "  moving: {type: bool, initial: false}", "  moving: {initial: true}\n  load: {type: 0..5}")
    variables = prepare_station(station).automaton.variables
    assert variables["arm.moving"].initial is True
    assert variables["arm.load"].type == IntegerRange(0, 5)


def test_a_field_can_have_another_name_or_be_ignored(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATE, "bool moving", "bool moving\nbool rdy\nbool spare")
    replace(
        station,
        ARM,
        "      - remember:",
        "      - rename: {rdy: ready}\n      - remember:",
    )
    replace(station, ARM, "    deadline: 1.0\n", "    deadline: 1.0\n    ignore: [spare]\n")
    names = prepare_station(station).automaton.variables.keys()
    assert "arm.ready" in names
    assert names.isdisjoint({"arm.rdy", "arm.spare"})


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "  moving: {type: bool, initial: false}",
            "  moving: {type: bool, initial: false}\n  ‹heat: {initial: 1}",
            "`heat` needs a type, and no field of a topic has one for `heat`: "
            "write type: bool, a range such as 0..3, or an enumeration",
        ),
        (
            "    deadline: 1.0\n",
            "    deadline: 1.0\n    ignore: [‹movin]\n",
            "the message has no field `movin`; did you mean `moving`?",
        ),
        (
            "    deadline: 1.0\n",
            "    deadline: 1.0\n    ignore: [‹joints]\n",
            "`joints` is used by a stage: it cannot be ignored as well",
        ),
    ],
)
def test_what_is_wrong_with_variables_of_messages(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert_found(tmp_path, ARM, old, new, message)


def test_a_file_that_is_never_read_is_said(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    [place] = write(station, "operation.yaml", "‹fetch: {}\n")
    message = "this file is not read; did you mean `operations.yaml`?"
    assert findings(station) == [f"{place}: {message}"]


@pytest.mark.parametrize(("parameter", "hidden"), [("moving", "arm.moving"), ("goto", "arm.goto"), ("count", "count")])
def test_a_parameter_must_not_hide_a_variable(tmp_path: Path, parameter: str, hidden: str) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATION, "estimated:\n  parts:", COUNTER)
    file = station / ARM
    text = file.read_text(encoding="utf-8").replace("position", parameter)
    [place] = write(station, ARM, text.replace(f"parameters: {{{parameter}:", f"parameters: {{‹{parameter}:"))
    assert f"{place}: the parameter `{parameter}` hides the variable `{hidden}`: rename one of them" in findings(
        station
    )


def test_a_parameter_must_not_hide_a_variable_of_the_station(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, STATION, "estimated:\n  parts:", COUNTER)
    [place] = write(station, SPECIFICATIONS, "s:\n  parameters: {‹count: part}\n  forbidden: arm.moving\n")
    assert findings(station) == [f"{place}: the parameter `count` hides the variable `count`: rename one of them"]


@pytest.mark.parametrize(
    ("parameter", "message"),
    [
        ("executing", "`executing` is a flag of every ability: take another name"),
        ("home", "the parameter `home` hides the value `home` of `target`: rename one of them"),
    ],
)
def test_a_parameter_must_not_hide_a_flag_or_a_value(tmp_path: Path, parameter: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    [place] = replace(station, ARM, "    parameters: {position: target}", f"    parameters: {{‹{parameter}: target}}")
    assert f"{place}: {message}" in findings(station)


def test_a_parameter_must_not_hide_a_variable_in_a_zone(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "resources/door.yaml", "estimated: {inside: {type: bool}}\n")
    zone = "s:\n  parameters: {‹goto: target}\n  zone: {arm: goto == out, door: inside}\n"
    [place] = write(station, SPECIFICATIONS, zone)
    message = "the parameter `goto` hides the variable `arm.goto`: rename one of them"
    assert findings(station) == [f"{place}: {message}"]


def test_reactions_of_different_devices_stay_apart(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    effect = "effects: {e: {kind: executing, when: moving, do: [moving := false], takes: %s}}"
    both = f"  a: {{{effect % '1'}}}\n  b: {{{effect % '[5, 9]'}}}\n"
    replace(station, ARM, "abilities:\n", f"abilities:\n{both}")
    effects = {effect.name: effect.longest for effect in prepare_station(station).automaton.effects}
    assert (effects["arm.a.e"], effects["arm.b.e"]) == (1, 9)


@pytest.mark.parametrize("key", ["finish", "human", "duration", "cancel", "title"])
def test_a_key_without_a_value_is_not_left_out(tmp_path: Path, key: str) -> None:
    station = copy_of_cell(tmp_path)
    [place] = replace(station, ARM, "    executing: goto", f"    ‹{key}:\n    executing: goto")
    if key == "finish":
        text = (station / ARM).read_text(encoding="utf-8")
        (station / ARM).write_text(text.replace("    finish:\n" + FINISH, ""), encoding="utf-8")
    assert f"{place}: there is nothing here: write a value, or leave the key out" in findings(station)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("    deadline: 1.0", "    deadline: true"),
        ("    deadline: 1.0", '    deadline: "1.0"'),
        ("        takes: 1\n", "        takes: 1\n        fault: 1\n"),
        ("{type: bool, initial: false}", "{type: bool, initial: 0.0}"),
    ],
)
def test_a_value_of_another_type_is_refused(tmp_path: Path, old: str, new: str) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, old, new)
    assert any("expected" in line for line in findings(station))


def test_timeouts_need_a_finish(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "resources/door.yaml", "abilities:\n  open:\n    timeouts: {finish: 3}\n")
    message = "`timeouts` need a `finish` or an `until`: without one the ability is done with its start"
    assert any(line.endswith(message) for line in findings(station))


@pytest.mark.parametrize(
    ("timeouts", "message"),
    [
        ("{then: replan}", "`then: replan` needs a `react` or a `finish`: after how many seconds"),
        ("{finish: 3, retries: 1}", "`retries` need `then: replan`: with an alarm alone it goes on running"),
        ("{finish: 3, then: replan, retries: -1}", "expected a number of at least 0, found `-1`"),
        ("{finish: 3, then: again}", "expected `alarm` or `replan`, found `again`"),
    ],
)
def test_what_is_wrong_with_timeouts(tmp_path: Path, timeouts: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, FINISH, f"{FINISH}    timeouts: {timeouts}\n")
    found = findings(station)
    assert any(message in line for line in found), found


@pytest.mark.parametrize(
    ("file", "message"),
    [
        ("resources/notes.txt", "this is not read: each resource is a file <name>.yaml in this folder"),
        ("messages/Foo.msg", "this is not read: message definitions are files messages/<package>/msg/<Name>.msg"),
        ("resource/door.yaml", "this folder is not read; did you mean `resources`?"),
    ],
)
def test_what_stands_in_the_wrong_place_is_said(tmp_path: Path, file: str, message: str) -> None:
    station = copy_of_cell(tmp_path)
    write(station, file, "bool x\n")
    assert any(line.endswith(f": {message}") for line in findings(station))


@pytest.mark.parametrize(
    ("file", "field", "clash"),
    [
        (STATE, "enabled", "that is a flag of every ability"),
        (STATE, "move", "an ability has that name"),
        (COMMAND, "moving_too", "a field of a topic in the other direction is one already"),
    ],
)
def test_a_field_that_clashes_can_be_left_out(tmp_path: Path, file: str, field: str, clash: str) -> None:
    station = copy_of_cell(tmp_path)
    (station / STATE).write_text((station / STATE).read_text(encoding="utf-8") + "bool moving_too\n", encoding="utf-8")
    text = (station / file).read_text(encoding="utf-8")
    (station / file).write_text(f"{text}bool {field}\n", encoding="utf-8")
    kind = Path(file).stem
    message = (
        f"the field `{field}` of `cell_msgs/msg/{kind}` would be a variable `{field}`, and {clash}: "
        f"leave it out with `ignore: [{field}]`, or `rename` it"
    )
    assert any(line.endswith(f": {message}") for line in findings(station))
