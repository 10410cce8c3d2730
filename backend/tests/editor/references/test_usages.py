"""Where parts are used: every way to spell a name, and every place in which there can be one."""

from __future__ import annotations

import pytest

from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import Usage, dependants, usages
from sequence_planner.model.paths import EditError
from sequence_planner.ros.types.messages import MessageRegistry

from .stations import CELL, messages_of, write


def places(found: tuple[Usage, ...]) -> list[str]:
    """Each place as `file: what uses it`, of those that do not declare."""
    return [f"{each.file.removesuffix('.yaml')}: {each.used_by}" for each in found if not each.declares]


@pytest.fixture(scope="module")
def messages(tmp_path_factory: pytest.TempPathFactory) -> MessageRegistry:
    folder = tmp_path_factory.mktemp("cell")
    write(CELL, folder)
    return messages_of(folder)


ROBOT, OTHER = "resources/robot", "resources/other"
STATE, COMMAND = f"{ROBOT}: topic /robot/state", f"{ROBOT}: topic /robot/command"
MOVE, LOAD = f"{ROBOT}: ability robot.move", f"{ROBOT}: ability robot.load"


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        (
            "enumeration:side",
            [
                "operations: operation bring: parameters.where",
                f"{ROBOT}: variable robot.gate: for.where",
                f"{LOAD}: parameters.where",
                "specifications: specification first: parameters.where",
                "station: variable slots: for.where",
            ],
        ),
        ("enumeration:load", ["station: variable slots: type"]),
        (
            "value:load.none",
            [
                "operations: operation bring: precondition",
                f"{LOAD}: enabled",
                "station: variable slots: initial",
                "station: station: rest",
                "work_masters: work master job: brings[0]",
            ],
        ),
        (
            "resource:other",
            ["specifications: specification apart: zone.other", "specifications: specification never: while"],
        ),
        (
            "variable:robot.target",
            [
                f"{OTHER}: ability other.go_there: start.do[1]",
                f"{COMMAND}: pipeline[0].map.variable",
                f"{COMMAND}: pipeline[1].table.fields[0]",
                f"{COMMAND}: examples[0].given.target",
                f"{MOVE}: enabled",
                f"{MOVE}: start.do[0]",
                f"{MOVE}: executing",
                f"{MOVE}: effects.arrives.when",
                f"{MOVE}: effects.arrives.do[0]",
            ],
        ),
        ("variable:count", [*[f"{MOVE}: finish.do[0]"] * 3, "station: alarm crowded: when"]),
        (
            "variable:robot.busy",
            [
                "operations: operation bring: local",
                f"{STATE}: pipeline[3].expression.is_out",
                f"{STATE}: examples[0].gives.busy",
                f"{ROBOT}: alarm robot.seen_busy: when",
                f"{LOAD}: executing",
                "station: station: rest",
            ],
        ),
        (
            "variable:robot.is_seen",
            [
                f"{OTHER}: flow other.far: pipeline[0].expression.far_seen",
                f"{ROBOT}: flow robot.watched: pipeline[0].expression.is_seen",
                f"{ROBOT}: flow robot.again: pipeline[0].rename.is_seen",
                f"{ROBOT}: alarm robot.seen_busy: when",
                f"{LOAD}: human.acknowledgement",
            ],
        ),
        (
            "variable:other.seen",
            [
                f"{OTHER}: service /other/look: response[0].rename.success",
                f"{OTHER}: flow other.looked: pipeline[0].rename.seen",
                f"{OTHER}: ability other.go_there: enabled",
            ],
        ),
        (
            "variable:other.go",
            [
                f"{OTHER}: action /other/go: when",
                f"{OTHER}: ability other.go_there: enabled",
                f"{OTHER}: ability other.go_there: start.do[0]",
                f"{OTHER}: ability other.go_there: finish.do[0]",
            ],
        ),
        (
            "ability:robot.move",
            [
                f"{LOAD}: executing",
                "specifications: specification one: exclusive[0]",
                "specifications: specification never: never",
            ],
        ),
        ("effect:robot.move.arrives", []),
        (
            "operation:bring",
            [
                f"{LOAD}: enabled",
                "work_masters: work master job: operations.bring(left)",
                "work_masters: work master job: operations.bring(right)",
                "work_masters: work master job: operations.bring(right).after[0]",
            ],
        ),
        ("specification:first", []),
        ("work_master:job", []),
        (
            "parameter:robot.load.where",
            [
                f"{LOAD}: title",
                f"{LOAD}: human.task",
                f"{LOAD}: enabled",
                f"{LOAD}: enabled",
                f"{LOAD}: start.do[0]",
                f"{LOAD}: executing",
            ],
        ),
        (
            "parameter:specification:first.where",
            [
                "specifications: specification first: title",
                "specifications: specification first: order[0]",
                "specifications: specification first: order[1]",
            ],
        ),
        ("parameter:slots.where", []),
        ("topic:/robot/state", [f"{ROBOT}: flow robot.watched: from.robot"]),
        ("flow:robot.watched", [f"{OTHER}: flow other.far: from[0]", f"{ROBOT}: flow robot.again: from"]),
        ("service:/other/look", [f"{OTHER}: flow other.looked: from"]),
        ("action:/other/go", []),
    ],
)
def test_where_a_part_is_used(part: str, expected: list[str], messages: MessageRegistry) -> None:
    assert places(usages(CELL, parse_part(part), messages).found) == expected


@pytest.mark.parametrize("part", ["value:goal.out", "value:pose.out"])
def test_values_that_are_compared_are_one(part: str) -> None:
    found = usages(CELL, parse_part(part)).found
    assert {each.part.id for each in found} == {"value:goal.out", "value:pose.out"}
    assert len(found) == 10


def test_a_usage_says_where_it_is_to_the_letter() -> None:
    for part in ("variable:robot.pose", "value:pose.out", "parameter:robot.move.to", "resource:robot"):
        for each in usages(CELL, parse_part(part)).found:
            line = CELL[each.file].split("\n")[each.line - 1]
            assert line[each.column - 1 :][: each.length] == (each.written if each.length else "")
    (place,) = usages(CELL, parse_part("work_master:job")).found
    assert (place.file, place.path, place.line, place.column, place.written) == (
        "work_masters.yaml",
        ("job",),
        1,
        1,
        "job",
    )


def test_names_without_their_declarations_too() -> None:
    files = {"resources/robot.yaml": "abilities: {go: {enabled: moving and robot.moving and other.there}}"}
    assert len(usages(files, parse_part("variable:robot.moving")).found) == 2
    files["resources/other.yaml"] = "title: Other"
    assert len(usages(files, parse_part("variable:other.there")).found) == 1


def test_a_parameter_stands_before_a_variable_and_a_flag_before_another_name() -> None:
    files = {
        "station.yaml": "enumerations: {side: [left, right]}\nestimated: {where: {type: side}}\n",
        "operations.yaml": "go: {parameters: {where: side}, precondition: where == left, goal: true}\n",
    }
    assert len(usages(files, parse_part("variable:where")).found) == 1
    assert len(usages(files, parse_part("parameter:operation:go.where")).found) == 2


def test_what_depends_on_a_part_that_is_deleted() -> None:
    assert places(dependants(CELL, parse_part("ability:robot.load")).found) == [
        "operations: operation bring: local",
        f"{ROBOT}: alarm robot.seen_busy: when",
        f"{MOVE}: start.when",
        "specifications: specification one: exclusive[1]",
    ]
    assert places(dependants(CELL, parse_part("resource:robot")).found) == [
        "operations: operation bring: local",
        "operations: operation bring: local",
        f"{OTHER}: flow other.far: from[0]",
        f"{OTHER}: flow other.far: pipeline[0].expression.far_seen",
        f"{OTHER}: ability other.go_there: start.do[1]",
        "specifications: specification one: exclusive[0]",
        "specifications: specification one: exclusive[1]",
        "specifications: specification apart: zone.robot",
        "specifications: specification apart: zone.robot",
        "specifications: specification first: order[1]",
        "specifications: specification never: never",
        "station: station: rest",
        "station: station: rest",
    ]
    assert "enumeration load" not in {each.used_by for each in dependants(CELL, parse_part("enumeration:load")).found}
    assert len(dependants(CELL, parse_part("enumeration:load")).found) == 10
    assert len(dependants(CELL, parse_part("parameter:robot.load.where")).found) == 6
    assert dependants(CELL, parse_part("effect:robot.move.arrives")).found == ()


def test_a_draft_that_is_broken_elsewhere() -> None:
    broken = {
        **CELL,
        "operations.yaml": CELL["operations.yaml"] + "\nworse: {goal: robot.pose ==, precondition: [3], local: 7}\n",
        "specifications.yaml": "one: {exclusive: [robot.move\n",
        "resources/third.yaml": "abilities: 3\nmeasured: [1]\ntopics: {/t: {pipeline: [{map: 3}, 4, {table: {}}]}}\n",
    }
    found = usages(broken, parse_part("ability:robot.move"))
    assert places(found.found) == [f"{LOAD}: executing"]
    assert [each.place.file for each in found.skipped] == ["specifications.yaml"]
    assert found.unread == ()
    (unread,) = usages(broken, parse_part("variable:robot.pose")).unread
    assert (unread.place.file, unread.place.line) == ("operations.yaml", 8)


@pytest.mark.parametrize("text", ["pose", "thing:robot", "variable:", ""])
def test_what_names_no_part(text: str) -> None:
    with pytest.raises(EditError, match="names no part"):
        parse_part(text)


def test_parts_and_their_texts() -> None:
    for text in ("variable:robot.pose", "value:pose.home", "parameter:robot.move.to", "topic:/a/b", "variable:bolts"):
        assert parse_part(text).id == text
    assert str(parse_part("parameter:operation:go.where")) == "the parameter `go.where`"
