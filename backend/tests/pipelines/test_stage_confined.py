"""A station's own functions have what they need and no more, where the system offers to keep them from it."""

from __future__ import annotations

import platform
import re
import socket
import sqlite3
import stat
from pathlib import Path

import pytest
from structlog.testing import capture_logs
from typer.testing import CliRunner

from pipelines.stage_texts import MESSAGE, VARIABLES, build
from sequence_planner.cli import configuration
from sequence_planner.pipelines.record import Record
from sequence_planner.pipelines.stages.own import confinement, process
from sequence_planner.pipelines.stages.own.confinement import CALLS, FILES, missing
from sequence_planner.pipelines.stages.own.program import CONFINED
from sequence_planner.pipelines.stages.own.stage import PythonStage
from sequence_planner.pipelines.stages.own.system_calls import CLONE, CLONE3, FORBIDDEN, PRLIMIT64, TGKILL

NUMBERS = {
    0: Path("/usr/include/x86_64-linux-gnu/asm/unistd_64.h"),
    1: Path("/usr/include/asm-generic/unistd.h"),
}
CONFINES = pytest.mark.skipif(bool(missing()), reason=f"this system cannot keep stages from {' and '.join(missing())}")
TEXT = (
    "python: {file: stages/acts.py, function: act, reads: {force: real, mode: text}, gives: {text: text}, deadline: 20}"
)


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A model with a secret beside its stages, and a table of them."""
    (tmp_path / "stages").mkdir()
    (tmp_path / "stages" / "table.csv").write_text("1,2\n", encoding="utf-8")
    with sqlite3.connect(tmp_path / "station.sqlite") as database:
        database.execute("CREATE TABLE people (password)")
    database.close()
    (tmp_path / "station.yaml").write_text("name: cell\n", encoding="utf-8")
    return tmp_path


def acted(model: Path, act: str) -> tuple[object, list[str]]:
    """What a stage gives that does this, and what is wrong with it. `M` is the model, `S` the folder of its stages."""
    (model / "stages" / "acts.py").write_text(
        f"import os, socket, subprocess, sys, threading\nM, S = {str(model)!r}, {str(model / 'stages')!r}\n"
        f"def act(force, mode):\n    return {{'text': str({act})}}\n",
        encoding="utf-8",
    )
    stage = build(TEXT, MESSAGE, VARIABLES, folder=model).stage
    assert isinstance(stage, PythonStage)
    course = stage.begin_patiently()
    try:
        record = course.take(Record({"force": 1.0, "mode": "x"}), 0.0)
        assert record is not None
        return record.values["text"], record.troubles
    finally:
        course.close()


@CONFINES
@pytest.mark.parametrize(
    "act",
    [
        "open('/etc/passwd').read()",
        "open('/proc/self/root/etc/passwd').read()",
        "open(f'/proc/{os.getppid()}/environ').read()",
        "open(M + '/station.sqlite', 'rb').read()",
        "open(M + '/station.yaml').read()",
        "os.listdir(M)",
        "open(S + '/made', 'w').write('x')",
        "open(M + '/made', 'w').write('x')",
        "open(M + '/../made', 'w').write('x')",
        "os.unlink(M + '/station.yaml')",
        "os.truncate(M + '/station.yaml', 0)",
        "os.rename(M + '/station.yaml', M + '/made')",
        "os.chmod(M + '/station.sqlite', 0o777)",
        "os.utime(M + '/station.yaml', (0, 0))",
        "os.setxattr(M + '/station.yaml', 'user.made', b'x')",
        "socket.create_connection(('127.0.0.1', PORT))",
        "socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)",
        "socket.socket(socket.AF_INET, socket.SOCK_DGRAM)",
        "__import__('urllib.request').request.urlopen('http://127.0.0.1:PORT/')",
        "subprocess.run(['true'])",
        "os.fork()",
        "os.execv(sys.executable, [sys.executable, '-V'])",
        "os.kill(os.getppid(), 9)",
        "os.setpriority(os.PRIO_PROCESS, os.getppid(), 19)",
        "__import__('resource').prlimit(os.getppid(), __import__('resource').RLIMIT_NOFILE, (3, 3))",
    ],
)
def test_a_stage_that_takes_more_than_it_needs_fails_with_a_clear_finding(model: Path, act: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.setblocking(False)
        text, troubles = acted(model, act.replace("PORT", str(listener.getsockname()[1])))
        with pytest.raises(BlockingIOError):
            listener.accept()
    assert text is None
    [trouble] = troubles
    assert trouble.startswith("stages/acts.py act")
    assert CONFINED in trouble
    assert sorted(each.name for each in model.iterdir()) == ["stages", "station.sqlite", "station.yaml"]
    assert not (model / "stages" / "made").exists()
    assert not (model.parent / "made").exists()
    assert (model / "station.yaml").read_text(encoding="utf-8") == "name: cell\n"
    assert stat.S_IMODE((model / "station.sqlite").stat().st_mode) != 0o777


@pytest.mark.parametrize(
    ("act", "gives"),
    [
        ("open(S + '/table.csv').read().strip()", "1,2"),
        ("__import__('numpy').linalg.norm([3.0, 4.0])", "5.0"),
        ("__import__('statistics').mean([1, 3])", "2"),
        ("__import__('zoneinfo').ZoneInfo('UTC')", "UTC"),
        ("[each.start() or each.join() for each in [threading.Thread(target=print)]]", "[None]"),
        ("len(os.urandom(4))", "4"),
        ("open('/dev/null', 'w').write('x')", "1"),
    ],
)
def test_a_stage_has_what_it_needs(model: Path, act: str, gives: str) -> None:
    if "numpy" in act:
        pytest.importorskip("numpy")
    assert acted(model, act) == (gives, [])


def test_a_stage_has_no_more_memory_than_it_may(model: Path) -> None:
    text, [trouble] = acted(model, "len(bytearray(5 * 1024 ** 3))")
    assert text is None
    assert "MemoryError" in trouble


def test_a_stage_is_not_told_of_the_station(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SEQUENCE_PLANNER_PORT", "8000")
    monkeypatch.setenv("MADE_UP", "x")
    text, troubles = acted(model, "sorted(os.environ)")
    assert not troubles
    assert "SEQUENCE_PLANNER_PORT" not in str(text)
    assert "MADE_UP" not in str(text)


def test_where_the_system_does_not_offer_it_that_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(confinement, "_landlock_version", lambda: 0)
    monkeypatch.setattr(platform, "machine", lambda: "m68k")
    assert missing() == [FILES, CALLS]
    with capture_logs() as logs:
        process.note_unconfined([FILES, CALLS])
        process.note_unconfined([FILES, CALLS])
    assert [each["open_to_them"] for each in logs] == [f"{FILES}, {CALLS}"]
    file = tmp_path / "station.toml"
    file.write_text("port = 8443\n", encoding="utf-8")
    said = CliRunner().invoke(configuration.configuration, ["check", str(file)]).output
    assert "Python stages" in said
    monkeypatch.undo()
    said = CliRunner().invoke(configuration.configuration, ["check", str(file)]).output
    assert ("Python stages" in said) is bool(missing())


@pytest.mark.parametrize("column", NUMBERS)
def test_calls_have_the_numbers_that_the_kernel_gives_them(column: int) -> None:
    if not NUMBERS[column].exists():
        pytest.skip(f"{NUMBERS[column]} is not here")
    text = NUMBERS[column].read_text(encoding="utf-8")
    known = {
        name: int(number) for name, number in re.findall(r"#define __NR(?:3264)?_(\w+)\s+(\d+)$", text, re.MULTILINE)
    }
    more = {"clone": CLONE, "clone3": CLONE3, "tgkill": TGKILL, "prlimit64": PRLIMIT64}
    numbers = {name: each[column] for name, each in {**FORBIDDEN, **more}.items()}
    assert {name: known[name] for name in numbers if name in known} == {
        name: number for name, number in numbers.items() if name in known
    }
    assert len(numbers.keys() & known.keys()) > 60
