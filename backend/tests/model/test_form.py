"""The form of the documents: YAML, keys, and the kinds of their values."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.model.stages.registry import KINDS
from sequence_planner.model.yaml.reader import MOST_ENTRIES, MOST_REPEATED
from sequence_planner.station import prepare_station

from .breaking import assert_found, copy_of_cell, findings, replace, write

ARM, STATION, OPERATIONS, SPECIFICATIONS = (
    "resources/arm.yaml",
    "station.yaml",
    "operations.yaml",
    "specifications.yaml",
)
NAMES = "names with their definitions"
STAGE = f"a stage is exactly one of {', '.join(KINDS)}"
TITLE = "expected a text, or one for each language: `{en: …, sv: …}`"
NOT_YAML = "this is not YAML:"
INDENTATION = "this does not belong to what is above it: look at the indentation and the quotes"
NO_NAME = "a `name:` stands here where none may: look at the indentation, and quote a text that has `: `"
DURATION = "expected seconds, or the fewest and the most as in `[0.5, 1.5]`"


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        # keys
        (ARM, "    enabled:", "    ‹enabeld:", "`enabeld` is not known here; did you mean `enabled`?"),
        (
            ARM,
            "    executing: goto",
            "    ‹when: goto",
            "`when` is not known here; does it belong to `start`? Then indent it further",
        ),
        # characters that are written with an escape, and that no answer and no database could hold
        (ARM, "title: Arm", 'title: ‹"A\\ud800rm"', "this would hold the character 0xd800, which no text does"),
        (ARM, "title: Arm", 'title: ‹"A\\0rm"', "this would hold the character 0x0000, which no text does"),
        # qualities of service
        (
            ARM,
            "    every: 1.0\n",
            "    every: 1.0\n    quality: {deadline: ‹0.0001}\n",
            "expected a number of at least 0.001, found `0.0001`",
        ),
        (
            ARM,
            "      - constant: {speed: 0.5}",
            "      - override: {name: a, fields: {speed: {‹between: [1]}}, expires: 9}",
            "an entry is missing here",
        ),
        # indentation
        (
            ARM,
            "    executing: goto",
            "      ‹executing: goto",
            "`executing` is not known here; does it belong to `move`? Then indent it less",
        ),
        (ARM, "title: Arm", "‹titel: Arm", "`titel` is not known here; did you mean `title`?"),
        (STATION, "rest:", "‹rests:", "`rests` is not known here; did you mean `rest`?"),
        (STATION, "{for: {", "{‹each: {", "`each` is not known here"),
        (ARM, "except: [", "‹ignored: [", "`ignored` is not known here"),
        (OPERATIONS, "fetch:\n", "‹fetch:\n  {goal: true}\nother:\n", "`precondition` is missing here"),
        (
            ARM,
            "  /arm/command:\n    type: cell_msgs/msg/ArmCommand\n    direction: out\n",
            "  ‹/arm/command:\n    type: cell_msgs/msg/ArmCommand\n",
            "`direction` is missing here",
        ),
        (STATION, "name: cell\n", "‹", "`name` is missing here"),
        (
            ARM,
            "  /arm/command:\n    type: cell_msgs/msg/ArmCommand\n    direction: out\n    every: 1.0",
            "  ‹/arm/command:\n    type: cell_msgs/msg/ArmCommand\n    direction: out\n    deadline: 1.0",
            "`deadline` is for incoming topics; an outgoing one is repeated with `every`",
        ),
        # values of another kind
        (ARM, "title: Arm", "title: ‹5", f"{TITLE}, found `5`"),
        (ARM, "title: Arm", "title: {‹position}", "`position` is not known here"),
        (
            ARM,
            "enabled: goto == pose and pose != position",
            "enabled: ‹7",
            "expected a text or true or false, found `7`",
        ),
        (ARM, "do: [goto := position]", "do: ‹goto := position", "expected a list, found `goto := position`"),
        (ARM, "do: [pose := unknown, moving := true]", "do: ‹[]", "expected at least one entry, found an empty list"),
        (ARM, "direction: in", "direction: ‹inn", "expected `in` or `out`, found `inn`"),
        (ARM, "kind: starting", "kind: ‹begin", "expected `starting`, `executing` or `finishing`, found `begin`"),
        (ARM, "initial: false", "initial: ‹1.5", "expected true or false or an integer or a text, found `1.5`"),
        (ARM, "deadline: 1.0", "deadline: ‹soon", "expected a number, found `soon`"),
        (ARM, "deadline: 1.0", "deadline: ‹0", "expected a number greater than 0, found `0`"),
        (ARM, "deadline: 1.0", "deadline: ‹.inf", "expected a finite number, found `inf`"),
        (ARM, "deadline: 1.0", "deadline: ‹1e999", "expected a finite number, found `inf`"),
        (ARM, "tolerance: 0.1", "tolerance: ‹.nan", "expected a finite number, found `nan`"),
        (ARM, "home: [0.0, 0.0]", "home: [0.0, ‹x]", "expected a number, found `x`"),
        (ARM, "takes: 1", "takes: ‹[1]", DURATION),
        (ARM, "takes: 1", "takes: ‹[1, 2, 3]", DURATION),
        (ARM, "takes: 1", "takes: ‹soon", DURATION),
        (ARM, "takes: 1", "takes: ‹true", DURATION),
        (ARM, "takes: 1", "takes: [1, ‹-2]", "expected a number of at least 0, found `-2`"),
        (ARM, "takes: 1", "takes: ‹[2, 1]", "from 2 to 1 seconds is no duration: write the fewest first"),
        (ARM, "takes: 1", "takes: ‹1000000", "expected a number of at most 86400, found `1000000`"),
        (OPERATIONS, "fetch:\n", "‹empty:\nfetch:\n", f"expected {NAMES}, found nothing"),
        (OPERATIONS, "fetch:\n", "empty: ‹x\nfetch:\n", f"expected {NAMES}, found `x`"),
        (ARM, "abilities:\n", "estimated: ‹[]\nabilities:\n", f"expected {NAMES}, found an empty list"),
        (ARM, "      - constant: {speed: 0.5}", "      - ‹{}", STAGE),
        (
            ARM,
            "      - constant: {speed: 0.5}",
            "      - ‹constant: {speed: 0.5}\n        rename: {speed: speed}",
            STAGE,
        ),
        # YAML
        (ARM, "title: Arm", "title: ‹\tArm", f"{NOT_YAML} a tab stands where only spaces may"),
        (ARM, "title: Arm", "title: ‹'Arm", f"{NOT_YAML} a quote is opened here and never closed"),
        (ARM, "title: Arm", "title: ‹*nobody", f"{NOT_YAML} found undefined alias 'nobody'"),
        (ARM, "title: Arm", "title: A‹\x07rm", f"{NOT_YAML} the character 0x0007 is not allowed"),
        (
            ARM,
            "title: Arm",
            "title: Arm\n‹title: Leg",
            "duplicate name `title`, first used in line 1: rename one of them, or leave one out",
        ),
        (
            ARM,
            "title: Arm",
            "title: Arm\n‹title: Arm",
            "duplicate name `title`, first used in line 1: it says the same here: leave one of them out",
        ),
        (
            ARM,
            "  moving: {",
            "  ‹pose: {",
            "duplicate name `pose`, first used in line 25: rename one of them, or leave one out",
        ),
        (ARM, "title: Arm", "title: Arm\n‹<<: {title: Leg}", "`<<` is not known here: write the entries out"),
        (ARM, "title: Arm", "title: Arm\n? ‹[a, b]\n: c", "a list or mapping cannot be a name"),
        (OPERATIONS, "fetch:", "  priority: 9\n‹fetch:", f"{NOT_YAML} {INDENTATION}"),
        (ARM, "    enabled:", "   ‹enabled:", f"{NOT_YAML} {INDENTATION}"),
        (ARM, "title: Arm", "title: Arm\n topics‹: {}", f"{NOT_YAML} {NO_NAME}"),
        (
            OPERATIONS,
            "  precondition: parts",
            f"  priority: ‹{'9' * 5000}\n  precondition: parts",
            "`999999999999999999999999999...` is no number that can be used",
        ),
    ],
)
def test_form(tmp_path: Path, file: str, old: str, new: str, message: str) -> None:
    assert_found(tmp_path, file, old, new, message)


def test_a_misspelt_key_that_is_needed_is_also_missing(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    needed, misspelt = replace(
        station,
        ARM,
        "      arrives:\n        kind: executing\n        when: goto != pose and pose == unknown\n        do:",
        "      ‹arrives:\n        kind: executing\n        when: goto != pose and pose == unknown\n        ‹doo:",
    )
    assert findings(station) == [
        f"{needed}: `do` is missing here",
        f"{misspelt}: `doo` is not known here; did you mean `do`?",
    ]


@pytest.mark.parametrize("number", ["010", "0x1F", "0o17", "1_000", "+5"])
def test_integers_in_every_notation_of_yaml(tmp_path: Path, number: str) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, OPERATIONS, "fetch:", f"fetch:\n  priority: {number}")
    expected = {"010": 10, "0x1F": 31, "0o17": 15, "1_000": 1000, "+5": 5}[number]
    assert {operation.priority for operation in prepare_station(station).automaton.operations.values()} == {expected}


@pytest.mark.parametrize("file", [ARM, STATION, OPERATIONS, SPECIFICATIONS])
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"name: \xff\xfe", "cannot be read: it is not UTF-8 text"),
        ("title: Ärm".encode("latin-1"), "cannot be read: it is not UTF-8 text"),
        (b"[" * 5000, "cannot be read: it is nested too deeply"),
        (b"- a\n- b\n", f"expected {NAMES}, found a list"),
        (b"just words", f"expected {NAMES}, found `just words`"),
    ],
)
def test_a_file_of_another_kind(tmp_path: Path, file: str, content: bytes, message: str) -> None:
    station = copy_of_cell(tmp_path)
    (station / file).write_bytes(content)
    assert findings(station) == [f"{station / file}:1:1: {message}"]


def test_an_alias_of_itself_is_refused(tmp_path: Path) -> None:
    assert_found(
        tmp_path,
        ARM,
        "do: [goto := position]",
        "do: ‹&again [goto := position, *again]",
        "this contains itself, by an alias of its own anchor",
    )


def test_aliases_that_multiply_are_refused_and_soon(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    levels = "".join(f"l{n}: &l{n} [{', '.join([f'*l{n - 1}'] * 9)}]\n" for n in range(1, 12))
    write(station, ARM, f"l0: &l0 [x, x]\n{levels}")
    [line] = findings(station)
    assert f"too large: its aliases stand for more than {MOST_REPEATED} entries" in line


def test_a_text_that_has_too_many_entries_is_refused(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, ARM, f"l0: [{'x, ' * MOST_ENTRIES}]\n")
    [line] = findings(station)
    assert f"too large: it has more than {MOST_ENTRIES} entries" in line


def test_anchors_and_aliases_mean_what_they_repeat(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    replace(station, ARM, "kind: starting\n        when: goto", "kind: starting\n        when: &away goto")
    replace(station, ARM, "when: goto != pose and pose == unknown", "when: *away")
    replace(station, ARM, "takes: [0.1, 0.3]", "takes: &twice [0.1, 0.3]")
    replace(station, ARM, "takes: 1", "takes: &twice 1")
    leaves, arrives = prepare_station(station).automaton.effects
    assert leaves.guard == arrives.guard
    assert (leaves.shortest, leaves.longest, arrives.longest) == (0.1, 0.3, 1)


def test_a_byte_order_mark_and_foreign_line_ends_are_no_trouble(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    for file in (ARM, STATION, OPERATIONS, SPECIFICATIONS):
        text = (station / file).read_text(encoding="utf-8")
        (station / file).write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert len(prepare_station(station).automaton.abilities) == 2
    (station / STATION).write_bytes(b"\xef\xbb\xbfname: cell\r\nrest: of\r\n")
    assert f"{station / STATION}:2:7: unknown variable `of`" in findings(station)


def test_several_errors_in_several_files_are_all_reported(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    places = [
        *replace(station, OPERATIONS, "fetch:\n", "fetch:\n  ‹titel: Fetch\n  priority: ‹high\n"),
        *replace(station, ARM, "takes: 1", "takes: ‹soon"),
        *replace(station, SPECIFICATIONS, "never:\n", "never:\n  ‹forbid: true\n"),
    ]
    write(station, "resources/other.yaml", "title: [")
    lines = findings(station)
    assert [line.split(": ")[0] for line in lines if "other.yaml" not in line] == sorted(places)
    assert sum("other.yaml:1:9: this is not YAML" in line for line in lines) == 1


def test_files_that_would_be_left_out_are_named(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    write(station, "operation.yml", "")
    write(station, "resources/leg.yml", "")
    assert findings(station) == [
        f"{station}/operation.yml:1:1: rename it to operation.yaml: this is not read",
        f"{station}/resources/leg.yml:1:1: rename it to leg.yaml: this is not read",
    ]


def test_a_folder_in_place_of_a_file(tmp_path: Path) -> None:
    station = copy_of_cell(tmp_path)
    (station / "resources" / "leg.yaml").mkdir()
    assert findings(station) == [f"{station}/resources/leg.yaml:1:1: cannot be read: Is a directory"]
