"""A station's own functions: called in a process of their own, which may fail in every way and hold nothing up."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from structlog.testing import capture_logs

from pipelines.stage_texts import MESSAGE, VARIABLES, build, findings
from pipelines.station_writing import Heard, write_station
from sequence_planner.core.secrets import CLIENT_SECRET, PASSWORD
from sequence_planner.core.storage_error import DATABASE
from sequence_planner.language.records.record import Record
from sequence_planner.model.stages.base import NotInvertibleError
from sequence_planner.model.stages.python import PythonCourse, PythonStage
from sequence_planner.model.stages.sandbox.confinement import missing
from sequence_planner.pipelines.examples import failures, loading_failures
from sequence_planner.station import prepare_station
from support.examples import TIMED
from support.waiting import PATIENCE, until

FORCE = """
import os, subprocess, sys, time
from scale import FACTOR

calls = 0

def judge(force, mode):
    global calls
    calls += 1
    if mode == "hang":
        while True:
            pass
    if mode == "sleep":
        time.sleep(60)
    if mode == "child":
        subprocess.Popen(["sleep", "60"])
        time.sleep(60)
    if mode == "raise":
        raise ValueError("no such force")
    if mode == "exit":
        sys.exit(3)
    if mode == "die":
        os._exit(3)
    if mode == "print":
        print("hello", "x" * 1000)
        print("beside", file=sys.stderr)
        for n in range(100):
            print(n)
    if mode == "files":
        return {"valve": True, "text": ",".join(sorted(os.listdir("/proc/self/fd"), key=int))}
    if mode == "environment":
        return {"valve": True, "text": " ".join(os.environ)}
    if mode == "nothing":
        return None
    if mode == "wrong":
        return {"valve": 1, "text": [], "more": 2}
    if mode == "odd":
        return {"valve": object()}
    if mode == "much":
        return {"text": "x" * 2_000_000}
    if mode == "flood":
        while True:
            print("x" * 1000)
    if mode == "pid":
        return {"valve": True, "text": f"{os.getpid()} {calls}"}
    return {"valve": None if force is None else force * FACTOR > 1, "text": repr(mode)}
"""
TEXT = """python:
  {file: stages/force.py, function: judge, reads: {force: real, mode: text}, gives: {valve: bool, text: text}}"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "stages").mkdir()
    (tmp_path / "stages" / "force.py").write_text(FORCE, encoding="utf-8")
    (tmp_path / "stages" / "scale.py").write_text("FACTOR = 2.0\n", encoding="utf-8")
    return tmp_path


def made(folder: Path, text: str = TEXT, deadline: float = PATIENCE) -> PythonStage:
    written = build(text[:-1] + f", deadline: {deadline}}}", MESSAGE, VARIABLES, folder=folder)
    assert isinstance(written.stage, PythonStage), written.findings
    return written.stage


@contextmanager
def patient(stage: PythonStage) -> Iterator[PythonCourse]:
    course = stage.begin_patiently()
    try:
        yield course
    finally:
        course.close()


def call(course: PythonCourse, mode: object, force: object = 1.0) -> tuple[object, object, list[str]]:
    record = course.take(Record({"force": force, "mode": mode}), 0.0)
    assert record is not None
    return record.values["valve"], record.values["text"], record.troubles


def is_gone(process: int) -> bool:
    try:
        os.kill(process, 0)
        return Path(f"/proc/{process}/stat").read_text(encoding="utf-8").split()[2] == "Z"
    except (ProcessLookupError, FileNotFoundError):  # it may go while its file is read
        return True


def test_a_function_is_called_with_what_it_reads(folder: Path) -> None:
    with patient(made(folder)) as course:
        assert call(course, "a") == (True, "'a'", [])
        assert call(course, "b", 0.5) == (False, "'b'", [])
        assert call(course, None, None) == (None, "None", [])  # what is unknown is None
        assert call(course, "a", float("nan")) == (
            None,
            "'a'",
            ["force is nan, and stages/force.py judge reads real"],
        )


@pytest.mark.parametrize(
    ("mode", "troubles"),
    [
        ("raise", ["ValueError: no such force"]),
        ("exit", ["SystemExit: 3"]),
        ("die", ["has ended by itself"]),
        ("nothing", ["returned None, and no dict"]),
        ("odd", ["TypeError: object is no plain value"]),
        ("much", ["returned more than 1000000 characters"]),
        (
            "wrong",
            [
                "gave valve the value 1, which is not bool",
                "gave text the value [], which is not text",
                "returned 'more', which is not among what it gives",
            ],
        ),
    ],
)
def test_what_it_does_wrong_is_unknown_and_said(folder: Path, mode: str, troubles: list[str]) -> None:
    with patient(made(folder)) as course:
        valve, text, said = call(course, mode)
        assert (valve, text) == (None, None)
        assert said == [f"stages/force.py judge {trouble}" for trouble in troubles]
        until(lambda: call(course, "a") == (True, "'a'", []))  # at once, or with a new process


@pytest.mark.parametrize("mode", ["hang", "sleep", "flood", *(["child"] if missing() else [])])
def test_one_that_does_not_answer_is_killed_and_replaced(folder: Path, mode: str) -> None:
    with patient(made(folder, deadline=0.05)) as course:
        first = str(call(course, "pid")[1]).split()[0]
        assert call(course, mode) == (None, None, ["stages/force.py judge gave no answer within 2 s"])
        assert is_gone(int(first))
        until(lambda: call(course, "a")[0] is True)
        second = str(call(course, "pid")[1]).split()[0]
        assert first != second


def test_one_that_always_hangs_is_started_ever_more_rarely(folder: Path) -> None:
    file = folder / "stages" / "force.py"
    file.write_text(f"print('started')\n{FORCE}", encoding="utf-8")
    with capture_logs() as logs, patient(made(folder, deadline=0.05)) as course:
        for _ in range(100):  # while it rests, the answer comes at once
            assert call(course, "sleep")[2] == ["stages/force.py judge gave no answer within 2 s"]
    assert 0 < [entry.get("line") for entry in logs].count("started") <= 10


def test_no_file_of_ours_is_open_in_it(folder: Path) -> None:
    with (folder / "ours").open("w") as ours, patient(made(folder)) as course:
        os.set_inheritable(ours.fileno(), True)
        files = str(call(course, "files")[1]).split(",")
        # Standard input, output and error, the answers, and the directory that is being read.
        assert len(files) <= 5
        assert str(ours.fileno()) not in files or ours.fileno() < 5


def test_no_secret_of_the_environment_is_told_to_it(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for secret in (CLIENT_SECRET, PASSWORD, DATABASE):
        monkeypatch.setenv(secret, "hidden")
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    with patient(made(folder)) as course:
        names = str(call(course, "environment")[1]).split()
    assert {CLIENT_SECRET, PASSWORD, DATABASE}.isdisjoint(names)
    assert "ROS_DOMAIN_ID" not in names
    assert "PATH" in names


def test_what_it_prints_is_logged_in_part(folder: Path) -> None:
    with capture_logs() as logs, patient(made(folder)) as course:
        assert call(course, "print")[0] is True
    lines = [str(entry.get("line")) for entry in logs if entry["event"] == "a stage printed"]
    assert len(lines) == 20
    assert "hello " + "x" * 494 in lines
    assert "beside" in lines
    assert [entry["lines"] for entry in logs if entry["event"] == "a stage printed more"] == [82]
    assert {entry["stage"] for entry in logs} == {"stages/force.py judge"}


def test_records_go_on_when_they_are_answered_and_nothing_waits(folder: Path) -> None:
    course = made(folder).begin()
    out: list[Record] = []
    begun = time.process_time()
    for number in range(200):
        record = course.take(Record({"force": number * 1.0, "mode": "a", "number": number}), number * 0.01)
        out += [] if record is None else [record]
    assert not TIMED or time.process_time() - begun < 1.0
    assert course.due is not None

    def last() -> bool:
        assert course.due is not None
        record = course.wake(course.due)
        out.extend([] if record is None else [record])
        return bool(out) and out[-1].values["number"] == 199

    until(last)
    assert course.due is None
    assert course.wake(1e9) is None
    numbers = [record.values["number"] for record in out]
    assert numbers == sorted(set(map(int, map(str, numbers))))  # in order, none twice, the last not lost
    assert all(record.values["valve"] is (record.values["force"] != 0.0) for record in out)
    course.close()


def test_a_missed_deadline_makes_what_it_gives_unknown_and_nothing_waits(folder: Path) -> None:
    course = made(folder, deadline=0.05).begin()
    assert course.take(Record({"force": 1.0, "mode": "sleep"}), 0.0) is None
    out: list[Record] = []

    def has_come() -> bool:
        record = course.wake(1.0)
        out.extend([] if record is None else [record])
        return bool(out)

    until(has_come)
    assert (out[0].values["valve"], out[0].values["text"]) == (None, None)
    assert out[0].troubles == ["stages/force.py judge gave no answer within 0.05 s"]
    course.close()


def test_what_made_no_sense_in_a_record_that_is_passed_over_is_said(folder: Path) -> None:
    course = made(folder).begin()
    course.take(Record({"number": 0, "mode": "sleep"}), 0.0)
    course.take(Record({"number": 1}, ["one is odd"]), 0.1)
    newest = Record({"number": 2})
    course.take(newest, 0.2)
    assert newest.troubles == ["one is odd"]
    course.close()


def test_its_process_ends_with_the_course(folder: Path) -> None:
    stage = made(folder)
    with patient(stage) as course:
        process = int(str(call(course, "pid")[1]).split()[0])
    until(lambda: is_gone(process))
    course.close()  # may be repeated
    forgotten = stage.begin_patiently()
    process = int(str(call(forgotten, "pid")[1]).split()[0])
    del forgotten
    until(lambda: is_gone(process))


def test_each_beginning_starts_afresh(folder: Path) -> None:
    stage = made(folder)
    for _ in range(2):
        with patient(stage) as course:
            assert [str(call(course, "pid")[1]).split()[1] for _ in range(2)] == ["1", "2"]


def test_nothing_is_written_beside_the_file(folder: Path) -> None:
    with patient(made(folder)) as course:
        call(course, "a")
    assert sorted(path.name for path in (folder / "stages").iterdir()) == ["force.py", "scale.py"]


@pytest.mark.parametrize(
    ("code", "why"),
    [
        ("import nonexistent_thing\n", "ModuleNotFoundError: No module named 'nonexistent_thing'"),
        ("raise SystemExit\n", "SystemExit"),
        ("import os; os._exit(1)\n", "has ended by itself"),
        ("", None),
    ],
)
def test_a_file_that_cannot_be_loaded_is_found_by_loading_it(folder: Path, code: str, why: str | None) -> None:
    file = folder / "stages" / "force.py"
    file.write_text(code + FORCE, encoding="utf-8")
    stage = made(folder)
    expected = None if why is None else f"stages/force.py judge cannot be loaded: {why}"
    assert stage.loading_trouble() == expected
    if expected is not None:
        with patient(stage) as course:
            assert call(course, "a") == (None, None, [expected])


def test_it_cannot_be_read_backwards(folder: Path) -> None:
    stage = made(folder)
    stage.backwards({"force": 1.0})
    with pytest.raises(NotInvertibleError, match=r"stages/force.py judge cannot be read backwards"):
        stage.backwards({"valve": True})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "{file: ‹../force.py, function: f, reads: {}, gives: {valve: bool}}",
            "`../force.py` is outside the station's folder `stages`",
        ),
        (
            "{file: ‹/etc/passwd, function: f, reads: {}, gives: {valve: bool}}",
            "`/etc/passwd` is outside the station's folder `stages`",
        ),
        (
            "{file: ‹stages/link.py, function: f, reads: {}, gives: {valve: bool}}",
            "`stages/link.py` is outside the station's folder `stages`",
        ),
        (
            "{file: ‹stages/forse.py, function: f, reads: {}, gives: {valve: bool}}",
            "the station has no file `stages/forse.py`; did you mean `stages/force.py`?",
        ),
        (
            "{file: ‹stages/wrong.py, function: f, reads: {}, gives: {valve: bool}}",
            "`stages/wrong.py` is no Python: invalid syntax in line 2",
        ),
        (
            "{file: ‹stages/nul.py, function: f, reads: {}, gives: {valve: bool}}",
            "`stages/nul.py` is no Python: source code string cannot contain null bytes",
        ),
        (
            "{file: stages/force.py, function: ‹juge, reads: {}, gives: {valve: bool}}",
            "`stages/force.py` defines no function `juge`; did you mean `judge`?",
        ),
        (
            "{file: stages/force.py, function: ‹judge, reads: {force: real}, gives: {valve: bool}}",
            "`judge` needs mode, which the stage does not read",
        ),
        (
            "{file: stages/force.py, function: judge, gives: {valve: bool}, "
            "reads: {force: real, mode: text, ‹door: bool}}",
            "`judge` has no parameter `door`",
        ),
        (
            "{file: stages/force.py, function: judge, reads: {force: real, mode: ‹real}, gives: {valve: bool}}",
            "`mode` is text in the record, and the function reads real",
        ),
        (
            "{file: stages/force.py, function: judge, reads: {force: ‹0..3, mode: text}, gives: {valve: bool}}",
            "`force` is real in the record, and the function reads 0..3",
        ),
        (
            "{file: stages/force.py, function: judge, reads: {force: real, mode: text}, gives: {valve: ‹boole}}",
            "unknown type `boole`: write bool, real, text, a range such as 0..3, names such as {open, closed}, "
            "or a list such as real[6]",
        ),
    ],
)
def test_what_is_wrong_is_found_without_running_it(folder: Path, text: str, message: str) -> None:
    (folder / "force.py").write_text("def f(): ...\n", encoding="utf-8")
    (folder / "stages" / "link.py").symlink_to(folder / "force.py")
    (folder / "stages" / "wrong.py").write_text("x = 1\ndef (:\n", encoding="utf-8")
    (folder / "stages" / "nul.py").write_bytes(b"x = 1\0")
    text = f"python: {text}"
    found = findings(text.replace("‹", ""), folder=folder)
    assert f"1:{text.index('‹') + 1}: {message}" in found
    assert len(found) == 1


def test_types_are_written_as_in_a_model(folder: Path) -> None:
    (folder / "stages" / "all.py").write_text(
        "def f(*, joints, levels, state, count=0, **more): ...\n", encoding="utf-8"
    )
    text = """
python:
  file: stages/all.py
  function: f
  reads: {joints: 'real[2]', levels: '0..255[]', state: '{manual, automatic}', door: bool}
  gives: {a: 'real[]', b: -1..1, c: '{x, y}'}
"""
    written = build(text, folder=folder)
    assert written.findings == []
    assert written.stage is not None
    assert {name: str(type_) for name, type_ in written.stage.gives.items()} == {
        "a": "real[]",
        "b": "-1..1",
        "c": "{x, y}",
    }


STATION = """
topics:
  /tank/state:
    type: tank_msgs/msg/State
    direction: in
    pipeline:
      - python: {file: stages/judge.py, function: judge, reads: {level: 0..255}, gives: {full: bool}, deadline: 20}
    examples:
      - {name: full, given: {level: 9}, gives: {full: true}}
      - {name: empty, given: {level: 1}, gives: {full: false}}
measured:
  full: {type: bool}
  level: {type: 0..255}
"""


def _station(tmp_path: Path, code: str) -> Path:
    station = write_station(tmp_path, STATION, {"State": "uint8 level\n"})
    (station / "stages").mkdir()
    (station / "stages" / "judge.py").write_text(code, encoding="utf-8")
    return station


def test_in_a_station_its_values_come_when_they_are_there(tmp_path: Path) -> None:
    heard = Heard(prepare_station(_station(tmp_path, "def judge(level):\n    return {'full': level > 5}\n")))
    assert heard.take("/tank/state", 0.0, level=9)["tank.full"] is None
    now = iter(range(10**9))
    until(lambda: heard.wake(float(next(now)))["tank.full"] is True)
    assert heard.known()["tank.level"] == 9
    heard.running.close()


@pytest.mark.parametrize(
    ("code", "findings"),
    [
        ("def judge(level):\n    return {'full': level > 5}\n", 0),
        ("def judge(level):\n    return {'full': level > 0}\n", 1),
        ("import nothing_of_that_name\ndef judge(level): ...\n", 1),
    ],
)
def test_examples_and_loading_are_checked(tmp_path: Path, code: str, findings: int) -> None:
    station = prepare_station(_station(tmp_path, code))
    found = loading_failures(station.pipelines) or failures(station.examples)
    assert len(found) == findings
