"""Recordings of ROS 2 traffic, as the pipelines of a draft read them."""

from __future__ import annotations

import shutil
import sqlite3
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import cache
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal, NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.rosbag2 import CompressionMode

from sequence_planner.automaton.automaton import State
from sequence_planner.editor.recordings import bag as bags
from sequence_planner.editor.recordings.bag import Bag
from sequence_planner.editor.recordings.files import RecordingError, lay_out
from sequence_planner.editor.recordings.reading import RecordingReading, SaidValue, read_recording
from sequence_planner.editor.recordings.worker import RecordingService
from sequence_planner.editor.schemas.what_if import (
    RecordedOtherwise,
    RecordedStanding,
    RecordedStateView,
    RecordingEnd,
    transferred,
)
from sequence_planner.language.types import Value
from sequence_planner.model.files import read_files
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.process.budget import Budget
from sequence_planner.simulation.messages import spoken
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.texts.message import Message
from support.places import BOLT_TIGHTENING
from support.recordings import BEGAN, NS, STORAGES, Recorded, Storage, write_recording, zipped

ROBOT, TOOL, SCENE = "/ur10/state", "/smart_nutrunner/state", "/ur10/planning_scene/state"
COMMAND = "/ur10/command"
STRING = "std_msgs/msg/String"
PLENTY = 10_000_000  # bytes that may be unpacked
DEADLINE = 1.0  # seconds, of each topic of the station


@cache
def the_station() -> ReadyStation:
    return prepare_station(BOLT_TIGHTENING)


@pytest.fixture(scope="module")
def bolts() -> ReadyStation:
    return the_station()


def said(station: ReadyStation, topic: str, **values: Value | None) -> Recorded:
    """What the device behind a topic says at the beginning of the model, but for some values."""
    state: State = {**station.automaton.initial_valuation, **{_full(name): value for name, value in values.items()}}
    type_name = station.pipelines.incoming[topic].topic.type_name
    data = station.registry.encode(type_name, spoken(station.pipelines, topic, state, {}))
    return topic, type_name, BEGAN * NS, data


def commanded(station: ReadyStation, topic: str, **values: Value | None) -> Recorded:
    state: State = {**station.automaton.initial_valuation, **{_full(name): value for name, value in values.items()}}
    pipeline = station.pipelines.outgoing[topic]
    message = first_message(pipeline, state)
    assert message is not None
    type_name = pipeline.topic.type_name
    return topic, type_name, BEGAN * NS, station.registry.encode(type_name, message)


def _full(name: str) -> str:
    return name.replace("__", ".")


def at(seconds: float, recorded: Recorded) -> Recorded:
    topic, type_name, began, data = recorded
    return topic, type_name, began + round(seconds * NS), data


def spoilt(seconds: float, topic: str, type_name: str, data: bytes = b"\x00\x01\x00\x00") -> Recorded:
    return topic, type_name, BEGAN * NS + round(seconds * NS), data


def text(station: ReadyStation, seconds: float) -> Recorded:
    """A message of a topic that no draft has a use for."""
    return at(seconds, ("/talk", STRING, BEGAN * NS, station.registry.encode(STRING, {"data": "hm"})))


_numbers = count()


@contextmanager
def opened(source: Path, folder: Path, name: str = "drive.mcap", most: int = PLENTY) -> Iterator[Bag]:
    place = folder / f"laid-out-{next(_numbers)}"
    place.mkdir()
    lay_out(source, name, place, most)
    with Bag(place) as bag:
        yield bag


def reading_of(
    station: ReadyStation,
    folder: Path,
    *messages: Recorded,
    storage: Storage = "MCAP",
    budget: float = 60.0,
    most: int = 20_000,
) -> RecordingReading:
    made = folder / f"recorded-{next(_numbers)}"
    write_recording(made, station.registry, messages, storage)
    with opened(made, folder) as bag:
        return read_recording(bag, station, Budget.seconds(budget), most)


def drive(station: ReadyStation) -> list[Recorded]:
    """The robot comes to above the engine after 3 s; the nutrunner is heard for 2 s alone, the scene not at all."""
    home, above = said(station, ROBOT), said(station, ROBOT, robot__pose="above_engine")
    tool = said(station, TOOL, nutrunner__tool_is_idle=True)
    robots = [at(tenth / 10, home if tenth < 30 else above) for tenth in range(51)]
    return sorted([*robots, *(at(tenth / 10 + 0.05, tool) for tenth in range(20))], key=lambda each: each[2])


def test_where_the_station_was_is_what_devices_had_said_by_then(bolts: ReadyStation, tmp_path: Path) -> None:
    found = reading_of(bolts, tmp_path, *drive(bolts))
    assert (found.began, found.seconds, found.until, found.incomplete) == (float(BEGAN), 5.0, 5.0, None)
    assert (found.messages, found.counts) == (71, {ROBOT: 51, TOOL: 20})
    assert found.missing == (SCENE,)
    before, after = found.said_by(2.9), found.said_by(3.0)
    assert before["robot.pose"] == SaidValue("home", RecordedStanding.RECORDED)
    assert after["robot.pose"] == SaidValue("above_engine", RecordedStanding.RECORDED)
    # Its topic has a deadline of a second, and said nothing after 1.95 s.
    assert found.said_by(2.9)["nutrunner.tool_is_idle"] == SaidValue(True, RecordedStanding.RECORDED)
    assert found.said_by(3.0)["nutrunner.tool_is_idle"] == SaidValue(None, RecordedStanding.STALE)
    assert found.last_known(3.0)["nutrunner.tool_is_idle"] == (True, 0.05)
    # What no message gave is as the model begins, although a station that runs would know nothing of it.
    assert after["robot.tool_is_attached"] == SaidValue(False, RecordedStanding.NOT_RECORDED)
    assert after["operator.acknowledged"] == SaidValue(False, RecordedStanding.NOT_RECORDED)
    assert found.said_by(0.0)["nutrunner.tool_is_idle"].standing is RecordedStanding.NOT_RECORDED
    assert [round(each.at, 3) for each in found.moments] == [0.0, 0.05, 2.95, 3.0]
    assert not found.troubles


def test_what_if_begins_with_the_values_of_the_moment(bolts: ReadyStation, tmp_path: Path) -> None:
    messages = [*drive(bolts), at(3.05, commanded(bolts, COMMAND, robot__target_pose="bolt_pair_2"))]
    service, folder = RecordingService(tmp_path), tmp_path / "bag"
    folder.mkdir()
    source = write_recording(tmp_path / "drive", bolts.registry, messages)
    files: dict[str, str | None] = {**read_files(BOLT_TIGHTENING)}
    assert service.found_for((files, "lay_out", (source, "drive.mcap", folder, PLENTY))) is None
    kept = "1", "drive.mcap", 1000, folder
    state = service.found_for(({}, "recorded_state", (7, BOLT_TIGHTENING, kept, 4.0)))
    assert isinstance(state, RecordedStateView)
    assert state.values["robot.pose"] == "above_engine"
    assert state.values["robot.target_pose"] == "bolt_pair_2"  # as it was commanded
    assert state.values["nutrunner.tool_is_idle"] is None
    assert state.values["bolts[bolt_pair_1]"] == "empty"
    # The robot was on its way there, and so is its ability.
    assert transferred(bolts.automaton, state.values)["robot.move_to_position(bolt_pair_2).executing"] is True
    told = {each.name: each for each in state.variables}
    assert told["robot.target_pose"].commanded
    assert told["robot.target_pose"].topics == [COMMAND]
    assert (told["robot.pose"].since, told["robot.pose"].topics) == (3.0, [ROBOT])
    assert (told["nutrunner.tool_is_idle"].last, told["nutrunner.tool_is_idle"].standing) == (
        True,
        RecordedStanding.STALE,
    )
    with pytest.raises(RecordingError) as refused:
        service.found_for(({}, "recorded_state", (7, BOLT_TIGHTENING, kept, 6.0)))
    assert _id(refused.value) == "recording.not-in-it"


# However it is stored, it says the same.

Making = Callable[[Path, ReadyStation], Path]


def _folder(storage: Storage, packed: CompressionMode | None = None) -> Making:
    def make(folder: Path, station: ReadyStation) -> Path:
        write_recording(folder / "drive", station.registry, drive(station), storage, packed=packed)
        return folder / "drive"

    return make


def _file(storage: Storage) -> Making:
    def make(folder: Path, station: ReadyStation) -> Path:
        return write_recording(folder / "drive", station.registry, drive(station), storage)

    return make


def _zip(making: Making) -> Making:
    return lambda folder, station: zipped(making(folder, station), folder / "drive.zip")


FORMS: dict[str, Making] = {
    "mcap": _file("MCAP"),
    "db3": _file("SQLITE3"),
    "folder of mcap": _folder("MCAP"),
    "folder of db3": _folder("SQLITE3"),
    "zip of mcap": _zip(_folder("MCAP")),
    "zip of db3": _zip(_folder("SQLITE3")),
    "chunks packed": _folder("MCAP", CompressionMode.STORAGE),
    "file packed": _folder("SQLITE3", CompressionMode.FILE),
    "messages packed": _folder("SQLITE3", CompressionMode.MESSAGE),
    "zip of messages packed": _zip(_folder("SQLITE3", CompressionMode.MESSAGE)),
}


@pytest.mark.parametrize("form", FORMS)
def test_each_form_of_a_recording_says_the_same(form: str, bolts: ReadyStation, tmp_path: Path) -> None:
    expected = reading_of(bolts, tmp_path, *drive(bolts))
    with opened(FORMS[form](tmp_path, bolts), tmp_path) as bag:
        found = read_recording(bag, bolts, Budget.seconds(60.0))
    assert found == expected
    assert len(found.moments) == 4


def test_a_recording_in_several_files_is_read_in_the_order_of_time(bolts: ReadyStation, tmp_path: Path) -> None:
    """As `--max-bag-duration` makes it; whoever archives the files may leave the metadata out."""
    whole = drive(bolts)
    many = tmp_path / "many"
    many.mkdir()
    for name, part in (("a_1", whole[40:]), ("b_0", whole[:40])):
        shutil.copy(write_recording(tmp_path / name, bolts.registry, part), many / f"{name}.mcap")
    with opened(many, tmp_path) as bag:
        assert read_recording(bag, bolts, Budget.seconds(60.0)).moments == reading_of(bolts, tmp_path, *whole).moments


# The law: at each moment the state is what the messages until then give, and nothing else.


class Said(NamedTuple):
    """A message: after so many seconds, on a topic, with such values; none where it cannot be read."""

    after: float
    topic: str
    values: tuple[tuple[str, Value], ...] | None


POSES: tuple[Value, ...] = ("unknown", "home", "above_engine", "bolt_pair_1")
TRUTH: tuple[Value, ...] = (True, False)
TOLD: dict[str, dict[str, tuple[Value, ...]]] = {
    ROBOT: {"robot.pose": POSES, "robot.moving": TRUTH},
    TOOL: {
        "nutrunner.tool_is_idle": TRUTH,
        "nutrunner.tool_is_running_forward": TRUTH,
        "nutrunner.programmed_torque_reached": TRUTH,
    },
    SCENE: {"robot.tool_is_attached": TRUTH},
}


@st.composite
def messages(draw: st.DrawFn) -> Said:
    topic = draw(st.sampled_from(sorted(TOLD)))
    after = draw(st.sampled_from([0.0, 0.05, 0.3, 0.999, 1.0, 1.5]))
    if draw(st.integers(0, 7)) == 0:
        return Said(after, topic, None)
    drawn = tuple((name, draw(st.sampled_from(domain))) for name, domain in TOLD[topic].items())
    return Said(after, topic, drawn)


def recorded_of(station: ReadyStation, sequence: Sequence[Said]) -> list[Recorded]:
    now, made = 0.0, []
    for each in sequence:
        now += each.after
        if each.values is None:
            made.append(spoilt(now, each.topic, station.pipelines.incoming[each.topic].topic.type_name))
        else:
            given = {name.replace(".", "__"): value for name, value in each.values}
            made.append(at(now, said(station, each.topic, **given)))
    return made


def folded(station: ReadyStation, sequence: Sequence[Said], moment: float) -> dict[str, SaidValue]:
    """What the messages until a moment give, without the pipelines: the last of each topic, as long as it counts."""
    initial = station.automaton.initial_valuation
    last: dict[str, tuple[float, Said]] = {}
    now = 0.0
    for each in sequence:
        now += each.after
        if round(now * NS) <= round(moment * NS):
            last[each.topic] = now, each
    expected = {}
    for topic, names in TOLD.items():
        for name in names:
            if topic not in last:
                expected[name] = SaidValue(initial[name], RecordedStanding.NOT_RECORDED)
            elif moment - last[topic][0] > DEADLINE + 5e-7:
                expected[name] = SaidValue(None, RecordedStanding.STALE)
            else:
                values = last[topic][1].values
                expected[name] = SaidValue(None if values is None else dict(values)[name], RecordedStanding.RECORDED)
    return expected


LAW = settings(max_examples=60, deadline=None)


@LAW
@given(sequence=st.lists(messages(), min_size=1, max_size=12), storage=st.sampled_from(STORAGES))
def test_at_each_moment_the_state_is_a_fold_of_the_messages_until_then(
    sequence: list[Said], storage: Literal["MCAP", "SQLITE3"]
) -> None:
    bolts = the_station()
    sequence = [sequence[0]._replace(after=0.0), *sequence[1:]]  # a recording begins with its first message
    recorded = recorded_of(bolts, sequence)
    end = (recorded[-1][2] - BEGAN * NS) / NS + 2.5
    with TemporaryDirectory() as folder:
        found = reading_of(bolts, Path(folder), *recorded, text(bolts, end), storage=storage)
    assert found.messages == len(sequence)
    assert found.until == pytest.approx(end)
    end = found.until
    times = [each.at for each in found.moments]
    assert times == sorted(set(times))
    for moment in [*times, *(time + 0.5 for time in times), end]:
        if moment <= end:
            state, expected = found.said_by(moment), folded(bolts, sequence, moment)
            assert {name: state[name] for name in expected} == expected, moment
    # Each moment that is offered is one at which something became another.
    for each in found.moments:
        assert each.changes
        assert all(before != after for before, after in each.changes.values())


@LAW
@given(sequence=st.lists(messages(), min_size=1, max_size=10), data=st.data())
def test_what_comes_later_makes_no_difference_to_a_moment(sequence: list[Said], data: st.DataObject) -> None:
    """Stages that remember are in it, too: what a recording of the messages until then says in its end is the same."""
    bolts = the_station()
    recorded = recorded_of(bolts, sequence)
    number = data.draw(st.integers(1, len(recorded)))
    until = [each for each in recorded if each[2] <= recorded[number - 1][2]]
    with TemporaryDirectory() as folder:
        found, part = (reading_of(bolts, Path(folder), *each) for each in (recorded, until))
    assert part.said_by(part.until) == found.said_by(part.until)


# What a recording lacks, and what in it makes no sense.


def test_what_is_missing_or_recorded_otherwise_is_told(bolts: ReadyStation, tmp_path: Path) -> None:
    pose, state = said(bolts, ROBOT, robot__pose="home"), said(bolts, TOOL)
    other = text(bolts, 1.0)
    found = reading_of(
        bolts,
        tmp_path,
        pose,
        at(0.5, (TOOL, STRING, BEGAN * NS, other[3])),
        spoilt(0.6, ROBOT, pose[1]),
        spoilt(0.7, ROBOT, pose[1], b""),
        at(0.8, pose),
        other,
    )
    assert found.missing == (SCENE,)
    (tool,) = found.otherwise
    assert (tool.topic.name, tool.topic.type_name, tool.wanted, tool.difference) == (
        TOOL,
        STRING,
        state[1],
        RecordedOtherwise.TYPE,
    )
    assert [each.name for each in found.others] == ["/talk"]
    assert found.messages == 4
    assert [(each.topic, each.first, each.count) for each in found.troubles] == [(ROBOT, 0.6, 1), (ROBOT, 0.7, 1)]
    assert all("RobotState" in each.text for each in found.troubles)
    assert found.said_by(0.65)["robot.pose"] == SaidValue(None, RecordedStanding.RECORDED)
    assert found.said_by(0.8)["robot.pose"] == SaidValue("home", RecordedStanding.RECORDED)


@pytest.mark.parametrize("storage", STORAGES)
def test_a_type_that_had_another_definition_is_not_read(storage: Storage, bolts: ReadyStation, tmp_path: Path) -> None:
    """DDS goes by the name alone, and such messages would be garbled."""
    older = shutil.copytree(BOLT_TIGHTENING, tmp_path / "older")
    definition = older / "messages" / "truck_engine_msgs" / "msg" / "NutrunnerState.msg"
    definition.write_text("uint8 level\n" + definition.read_text())
    (older / "resources" / "nutrunner.yaml").write_text((older / "resources" / "nutrunner.yaml").read_text())
    before = prepare_station(older)
    folder = tmp_path / "drive"
    state = said(before, TOOL)
    write_recording(folder, before.registry, [said(before, ROBOT), at(0.5, state)], storage)
    with opened(folder, tmp_path) as bag:
        found = read_recording(bag, bolts, Budget.seconds(60.0))
    (tool,) = found.otherwise
    assert (tool.topic.name, tool.difference) == (TOOL, RecordedOtherwise.DEFINITION)
    assert found.said_by(0.5)["nutrunner.tool_is_idle"].standing is RecordedStanding.NOT_RECORDED
    assert found.counts == {ROBOT: 1}


def test_what_takes_too_long_or_has_too_many_moments_is_read_as_far_as_it_goes(
    bolts: ReadyStation, tmp_path: Path
) -> None:
    poses = [said(bolts, ROBOT, robot__pose=pose) for pose in ("home", "above_engine")]
    many = [at(number / 100, poses[number % 2]) for number in range(400)]
    few = reading_of(bolts, tmp_path, *many, most=50)
    assert (few.incomplete, len(few.moments), few.until) == (RecordingEnd.MOMENTS, 50, 0.49)
    twice = [each for number, one in enumerate(many) for each in (one, at(number / 100, said(bolts, TOOL)))]
    for most in (40, 41, 42):
        cut, whole = (reading_of(bolts, tmp_path, *twice, most=each) for each in (most, 20_000))
        assert cut.said_by(cut.until) == whole.said_by(cut.until)
    late = reading_of(bolts, tmp_path, *many, budget=0.0)
    assert late.incomplete is RecordingEnd.TIME
    assert late.messages < 100
    assert late.until < 1.0


# Recordings that cannot be used: each says which file, and what to do.


def _id(error: RecordingError) -> str:
    assert isinstance(error.why, Message)
    return error.why.id


def _written(name: str, content: bytes) -> Making:
    def make(folder: Path, station: ReadyStation) -> Path:
        (folder / name).write_bytes(content)
        return folder / name

    return make


def _zip_of(**members: bytes) -> Making:
    def make(folder: Path, station: ReadyStation) -> Path:
        with zipfile.ZipFile(folder / "drive.zip", "w", zipfile.ZIP_DEFLATED) as made:
            for number, (_, content) in enumerate(members.items()):
                made.writestr(NAMES[list(members)[number]], content)
        return folder / "drive.zip"

    return make


NAMES = {
    "outside": "../../outside.mcap",
    "absolute": "/etc/outside.mcap",
    "windows": "..\\outside.mcap",
    "one": "one/a.mcap",
    "other": "other/a.mcap",
    "note": "note.txt",
    "large": "rec/large.mcap",
    "metadata": "rec/metadata.yaml",
}
LARGE = bytes(2 * PLENTY)


def _cut(storage: Storage) -> Making:
    def make(folder: Path, station: ReadyStation) -> Path:
        file = write_recording(folder / "drive", station.registry, drive(station), storage)
        file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
        return file

    return make


def _garbled(folder: Path, station: ReadyStation) -> Path:
    file = write_recording(folder / "drive", station.registry, drive(station))
    data = bytearray(file.read_bytes())
    data[60:-8] = bytes(byte ^ 0x5A for byte in data[60:-8])
    file.write_bytes(data)
    return file


def _other_database(folder: Path, station: ReadyStation) -> Path:
    with sqlite3.connect(folder / "other.db3") as made:
        made.execute("CREATE TABLE people (name TEXT)")
    return folder / "other.db3"


def _silent(folder: Path, station: ReadyStation) -> Path:
    return write_recording(folder / "drive", station.registry, [], topics={"/ur10/state": STRING})


def _of_another_station(folder: Path, station: ReadyStation) -> Path:
    return write_recording(folder / "drive", station.registry, [text(station, 1.0)])


def _without_a_file(folder: Path, station: ReadyStation) -> Path:
    write_recording(folder / "drive", station.registry, drive(station)).unlink()
    return folder / "drive"


def _metadata(old: str, new: str) -> Making:
    def make(folder: Path, station: ReadyStation) -> Path:
        write_recording(folder / "drive", station.registry, drive(station), "SQLITE3", packed=CompressionMode.MESSAGE)
        metadata = folder / "drive" / "metadata.yaml"
        assert old in metadata.read_text()
        metadata.write_text(metadata.read_text().replace(old, new))
        return folder / "drive"

    return make


UNUSABLE: dict[str, tuple[str, Making]] = {
    "no bytes": ("recording.no-bytes", _written("a.mcap", b"")),
    "a text": ("recording.form", _written("a.mcap", b"hello")),
    "ROS 1": ("recording.ros-1", _written("a.bag", b"#ROSBAG V2.0\n")),
    "metadata alone": ("recording.only-metadata", _written("metadata.yaml", b"rosbag2_bagfile_information:\n")),
    "cut MCAP": ("recording.cut-off", _cut("MCAP")),
    "cut database": ("recording.broken", _cut("SQLITE3")),
    "garbled": ("recording.broken", _garbled),
    "another database": ("recording.broken", _other_database),
    "packed rubbish": ("recording.broken", _written("a.mcap.zstd", b"\x28\xb5\x2f\xfd" + bytes(50))),
    "no archive": ("recording.zip", _written("a.zip", b"PK\x03\x04" + bytes(100))),
    "outside": ("recording.zip-path", _zip_of(outside=b"")),
    "absolute": ("recording.zip-path", _zip_of(absolute=b"")),
    "windows": ("recording.zip-path", _zip_of(windows=b"")),
    "several": ("recording.several", _zip_of(one=b"", other=b"")),
    "nothing of it": ("recording.no-files", _zip_of(note=b"hm")),
    "a bomb": ("recording.unpacked", _zip_of(large=LARGE)),
    "bad metadata": ("recording.metadata", _zip_of(metadata=b"a: [")),
    "other metadata": ("recording.metadata", _zip_of(metadata=b"a: 1")),
    "a missing file": ("recording.missing", _without_a_file),
    "other compression": ("recording.compression", _metadata("compression_format: zstd", "compression_format: xz")),
    "silent": ("recording.empty", _silent),
    "another station": ("recording.other-station", _of_another_station),
}


@pytest.mark.parametrize("case", UNUSABLE)
def test_what_cannot_be_used_says_why_and_what_to_do(case: str, bolts: ReadyStation, tmp_path: Path) -> None:
    wanted, making = UNUSABLE[case]
    source = making(tmp_path, bolts)
    with ExitStack() as stack:
        refused = stack.enter_context(pytest.raises(RecordingError))
        bag = stack.enter_context(opened(source, tmp_path, "its-name"))
        read_recording(bag, bolts, Budget.seconds(60.0))
    assert _id(refused.value) == wanted, refused.value.why
    assert str(tmp_path) not in str(refused.value.why)  # where it lies here is nobody's affair
    assert not list(tmp_path.parent.glob("**/outside.mcap"))


def test_what_would_fill_the_memory_is_refused(
    bolts: ReadyStation, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bags, "MOST_CHUNK", 100)
    with pytest.raises(RecordingError) as refused, opened(_file("MCAP")(tmp_path, bolts), tmp_path):
        pass
    assert _id(refused.value) == "recording.chunk"
    monkeypatch.setattr(bags, "MOST_MESSAGE", 10)
    with opened(_folder("SQLITE3", CompressionMode.MESSAGE)(tmp_path / "packed", bolts), tmp_path) as bag:
        found = read_recording(bag, bolts, Budget.seconds(60.0))
    assert [(each.topic, each.count) for each in found.troubles] == [(ROBOT, found.counts[ROBOT])]
