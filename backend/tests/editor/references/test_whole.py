"""The model as a whole: its ties are the uses that are found of each part, and each thing is on its layer."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequence_planner.editor.model_graph import ModelGraph, Standing, graph
from sequence_planner.editor.symbols.index import ModelPart, parse_part
from sequence_planner.editor.symbols.rename import renamed, usages
from sequence_planner.model.paths import EditError
from support.examples import SHARE

from .stations import CELL, REPOSITORY, messages_of, of_folder, of_page, write

MODELS = sorted(path.parent.name for path in (REPOSITORY / "models").glob("*/station.yaml"))
STATIONS = {
    **{name: of_folder(REPOSITORY / "models" / name) for name in MODELS},
    "model page": of_page("model.md"),
    "pipelines page": of_page("pipelines.md"),
    "cell": CELL,
}


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> ModelGraph:
    folder = tmp_path_factory.mktemp("cell")
    write(CELL, folder)
    return graph(CELL, messages_of(folder))


@pytest.mark.parametrize("name", STATIONS)
def test_the_ties_are_what_is_found_of_each_thing(name: str, tmp_path: Path) -> None:
    files = STATIONS[name]
    write(files, tmp_path)
    messages = messages_of(tmp_path)
    whole = graph(files, messages)
    assert {tie.part for tie in whole.ties} <= {thing.part for thing in whole.things}
    assert {tie.by for tie in whole.ties} <= {None, *(thing.part for thing in whole.things)}
    assert len({thing.part for thing in whole.things}) == len(whole.things) > 10
    for thing in whole.things[:: 1 if SHARE >= 1 else 3]:
        found = usages(files, thing.part, messages)
        own = [tie for tie in whole.ties if tie.part == thing.part]
        # The picture and the scenarios name values and variables, and nothing in the station rests on that.
        apart = ("mimic.yaml", "tests/")
        named = [each for each in found.found if each.part == thing.part and not each.file.startswith(apart)]
        assert {(tie.file, tie.line, tie.column) for tie in own if tie.written} == {
            (each.file, each.line, each.column) for each in named if not each.declares
        }, thing.part.id
        assert {(tie.file, tie.line, tie.column) for tie in own if not tie.written} == {
            (each.file, each.line, each.column) for each in found.unwritten
        }, thing.part.id
        declared = [each for each in found.found if each.part == thing.part and each.declares]
        assert bool(declared) is (thing.standing is Standing.DECLARED), thing.part.id


@pytest.mark.parametrize("name", MODELS)
def test_all_of_a_sound_model_is_there_or_follows_from_its_messages(name: str, tmp_path: Path) -> None:
    write(STATIONS[name], tmp_path)
    whole = graph(STATIONS[name], messages_of(tmp_path))
    assert [each.part.id for each in whole.things if each.standing is Standing.MISSING] == []
    assert (whole.skipped, whole.unread) == ((), ())


@pytest.mark.parametrize(
    ("part", "layer", "resource"),
    [
        ("work_master:job", 3, None),
        ("operation:bring", 2, None),
        ("specification:apart", 2, None),
        ("parameter:operation:bring.where", 2, None),
        ("ability:robot.move", 1, "robot"),
        ("effect:robot.move.arrives", 1, "robot"),
        ("variable:other.at", 1, "other"),  # estimated
        ("variable:slots", 1, None),
        ("variable:robot.pose", 0, "robot"),
        ("variable:robot.busy", 0, "robot"),  # nobody declares it
        ("alarm:robot.seen_busy", 1, "robot"),
        ("alarm:crowded", 1, None),
        ("topic:/robot/state", 0, "robot"),
        ("service:/other/look", 0, "other"),
        ("action:/other/go", 0, "other"),
        ("flow:robot.watched", 0, "robot"),
        ("enumeration:side", 0, None),
        ("message:cell_msgs/msg/RobotState", 0, None),
    ],
)
def test_each_thing_is_on_its_layer(cell: ModelGraph, part: str, layer: int, resource: str | None) -> None:
    thing = next(each for each in cell.things if each.part.id == part)
    assert (thing.layer, thing.resource) == (layer, resource)


def ties(whole: ModelGraph, part: str) -> set[str]:
    """What uses a part, and how."""
    return {f"{tie.by.id if tie.by else 'station'} {tie.manner}" for tie in whole.ties if tie.part.id == part}


@pytest.mark.parametrize(
    ("part", "expected"),
    [
        ("operation:bring", {"work_master:job runs", "work_master:job after", "ability:robot.load guard"}),
        (
            "variable:slots",
            {
                "work_master:job brings",
                "operation:bring goal",
                "operation:bring precondition",
                "specification:first orders",
                "station rest",
                "ability:robot.load guard",
                "ability:robot.load writes",
                "ability:robot.load progress",
            },
        ),
        (
            "variable:robot.target",
            {
                "ability:robot.move commands",
                "ability:robot.move guard",
                "ability:robot.move progress",
                "ability:robot.move expects",
                "ability:robot.move reads",
                "ability:other.go_there reads",
                "topic:/robot/command sends",
                "topic:/robot/command example",
            },
        ),
        ("ability:robot.load", {"specification:one excludes", "operation:bring formula", "ability:robot.move guard"}
         | {"alarm:robot.seen_busy alarms"}),
        (
            "variable:robot.busy",
            {
                "topic:/robot/state feeds",
                "topic:/robot/state reads",
                "topic:/robot/state example",
                "alarm:robot.seen_busy alarms",
                "ability:robot.load progress",
                "operation:bring formula",
                "station rest",
            },
        ),
        ("variable:robot.is_seen", {"flow:robot.watched feeds", "flow:robot.again reads", "flow:other.far reads"}
         | {"ability:robot.load acknowledgement", "alarm:robot.seen_busy alarms"}),
        ("variable:other.go", {"action:/other/go sends", "ability:other.go_there guard"}
         | {"ability:other.go_there commands"}),
        ("variable:other.at", {"action:/other/go sends", "ability:other.go_there writes"}
         | {"specification:apart zone", "specification:never forbids"}),
        ("variable:other.going", {"action:/other/go feeds", "ability:other.go_there guard"}
         | {"ability:other.go_there progress"}),
        ("topic:/robot/state", {"flow:robot.watched source"}),
        ("flow:robot.watched", {"flow:robot.again source", "flow:other.far source"}),
        ("message:cell_msgs/action/Go", {"action:/other/go carries"}),
        ("message:std_srvs/srv/Trigger", {"service:/other/look carries"}),
        ("enumeration:side", {"variable:slots ranges", "variable:robot.gate ranges", "ability:robot.load ranges"}
         | {"operation:bring ranges", "specification:first ranges"}),
        ("value:pose.home", {"variable:robot.pose names", "topic:/robot/state names", "flow:robot.watched names"}
         | {"topic:/robot/command names", "ability:robot.load names", "station names"}),
    ],
)  # fmt: skip
def test_each_use_is_said_as_it_is(cell: ModelGraph, part: str, expected: set[str]) -> None:
    assert ties(cell, part) == expected


def test_a_message_within_another_is_found(tmp_path: Path) -> None:
    definition = "# What it carries.\nRobotState[] states # some\ncell_msgs/RobotState first\nstd_msgs/Header header\n"
    files = {**CELL, "messages/cell_msgs/msg/All.msg": definition}
    write(files, tmp_path)
    found = usages(files, parse_part("message:cell_msgs/msg/RobotState"), messages_of(tmp_path)).found
    assert [(each.file, each.line, each.column, each.written) for each in found if "messages/" in each.file] == [
        ("messages/cell_msgs/msg/All.msg", 2, 1, "RobotState"),
        ("messages/cell_msgs/msg/All.msg", 3, 1, "cell_msgs/RobotState"),
        ("messages/cell_msgs/msg/RobotState.msg", 1, 1, "cell_msgs/msg/RobotState"),
    ]
    with pytest.raises(EditError, match="known to all nodes by this name"):
        renamed(files, parse_part("message:cell_msgs/msg/All"), "Everything")


def test_what_is_named_and_not_there_is_told_from_what_messages_imply(tmp_path: Path) -> None:
    broken = CELL["operations.yaml"].replace("slots[where] == part\n", "slotz[where] == part and robot.posse == home\n")
    files = {**CELL, "operations.yaml": broken, "specifications.yaml": "one: {never: robot.pose ==}\n"}
    write(files, tmp_path)
    whole = graph(files, messages_of(tmp_path))
    standing = {each.part.id: each.standing for each in whole.things}
    assert standing["variable:robot.posse"] is Standing.MISSING
    assert standing["variable:robot.busy"] is Standing.IMPLIED
    assert standing["variable:robot.pose"] is Standing.DECLARED
    assert standing["message:std_srvs/srv/Trigger"] is Standing.IMPLIED
    assert [each.place.file for each in whole.unread] == ["specifications.yaml"]


def test_a_file_that_is_no_yaml_hides_nothing_else() -> None:
    whole = graph({**CELL, "resources/other.yaml": "title: [\n"})
    assert [each.place.file for each in whole.skipped] == ["resources/other.yaml"]
    assert ModelPart("ability", "robot", "move") in {each.part for each in whole.things}
