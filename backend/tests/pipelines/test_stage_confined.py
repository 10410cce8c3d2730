"""A station's own functions have what they need and no more, where the system offers to keep them from it."""

from __future__ import annotations

import ctypes
import os
import platform
import re
import socket
import sqlite3
import stat
import subprocess
import sys
from ast import literal_eval
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from structlog.testing import capture_logs
from typer.testing import CliRunner

from pipelines.stage_texts import MESSAGE, VARIABLES, build
from sequence_planner.cli.station import configuration
from sequence_planner.language.records.record import Record
from sequence_planner.model.stages import python
from sequence_planner.model.stages.python import PythonStage
from sequence_planner.model.stages.sandbox import confinement
from sequence_planner.model.stages.sandbox.confinement import (
    CALLS,
    CLONE,
    CLONE3,
    FCNTL,
    FILES,
    FORBIDDEN,
    OPEN,
    OPENAT,
    OPENAT2,
    PRLIMIT64,
    TGKILL,
    missing,
)
from sequence_planner.model.stages.sandbox.program import CONFINED

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
        f"import ctypes, fcntl, os, socket, subprocess, sys, threading\n"
        f"M, S = {str(model)!r}, {str(model / 'stages')!r}\n"
        "def called(name, *given):\n"
        "    if getattr(ctypes.CDLL(None, use_errno=True), name)(*given) < 0:\n"
        "        raise OSError(ctypes.get_errno(), name)\n"
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


@contextmanager
def shared_memory() -> Iterator[int]:
    """A segment that another process could have, by its number."""
    libc = ctypes.CDLL(None, use_errno=True)
    number = libc.shmget(0, 4096, 0o1600)
    try:
        assert number >= 0
        yield number
    finally:
        assert libc.shmctl(number, 0, None) == 0, "nobody has removed it"


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
        "socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)[0].sendto(b'x', M + '/listens')",
        "called('shmctl', SHARED, 0, None)",
        "called('shmat', SHARED, None, 0)",
        "called('inotify_init1', 0)",
        "fcntl.fcntl(os.pipe()[0], 8, os.getppid())",
        "fcntl.fcntl(os.pipe()[0], 10, 9)",
        "fcntl.fcntl(os.open(S + '/table.csv', os.O_RDONLY), fcntl.F_SETLEASE, fcntl.F_RDLCK)",
        "os.open(S + '/table.csv', os.O_RDONLY | os.O_TRUNC)",
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
    with (
        socket.create_server(("127.0.0.1", 0)) as listener,
        socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listens,
        shared_memory() as shared,
    ):
        listener.setblocking(False)
        listens.setblocking(False)
        listens.bind(str(model / "listens"))
        text, troubles = acted(
            model, act.replace("PORT", str(listener.getsockname()[1])).replace("SHARED", str(shared))
        )
        with pytest.raises(BlockingIOError):
            listener.accept()
        with pytest.raises(BlockingIOError):
            listens.recv(1)
    (model / "listens").unlink()
    assert text is None
    [trouble] = troubles
    assert trouble.startswith("stages/acts.py act")
    assert CONFINED in trouble
    assert sorted(each.name for each in model.iterdir()) == ["stages", "station.sqlite", "station.yaml"]
    assert not (model / "stages" / "made").exists()
    assert not (model.parent / "made").exists()
    assert (model / "stages" / "table.csv").read_text(encoding="utf-8") == "1,2\n"
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


# With Landlock of this version, which knows fewer rights, and so on an older kernel.
ON_OLDER = """
import os, sys
from sequence_planner.model.stages.sandbox import confinement
version, newest = int(sys.argv[1]), confinement._landlock_version()
sys.path.append(os.getcwd())
confinement._landlock_version = lambda: min(version, newest)
assert confinement.confine() == []
import fcntl
try:
    exec(sys.argv[2])
except PermissionError:
    sys.exit(7)
"""


@CONFINES
@pytest.mark.parametrize("version", range(1, 6))
@pytest.mark.parametrize(
    "act",
    [
        "os.open('table.csv', os.O_RDONLY | os.O_TRUNC)",
        "os.open('table.csv', os.O_RDWR | os.O_WRONLY | os.O_TRUNC)",
        "fcntl.fcntl(r := os.pipe()[0], 10, 9), fcntl.fcntl(r, 8, os.getppid())",
    ],
)
def test_an_older_kernel_keeps_it_from_that_too(tmp_path: Path, version: int, act: str) -> None:
    (table := tmp_path / "table.csv").write_text("1,2\n", encoding="utf-8")
    command = [sys.executable, "-c", ON_OLDER, str(version), act]
    ended = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (ended.returncode, table.read_text(encoding="utf-8")) == (7, "1,2\n"), ended.stderr


@CONFINES
def test_a_stage_cannot_fill_the_machine_with_threads_nor_raise_its_limits(model: Path) -> None:
    text, troubles = acted(model, "__import__('resource').getrlimit(__import__('resource').RLIMIT_NPROC)")
    assert not troubles
    soft, hard = literal_eval(str(text))
    assert confinement.MOST_THREADS < soft == hard < confinement.MOST_THREADS + 20_000
    if os.geteuid() != 0:  # whose threads the kernel does not count
        bomb = "[threading.Thread(target=threading.Event().wait, daemon=True).start() for _ in range(20_000)]"
        text, [trouble] = acted(model, f"threading.stack_size(32768), {bomb}")
        assert "can't start new thread" in trouble
    text, [trouble] = acted(model, "__import__('resource').setrlimit(__import__('resource').RLIMIT_AS, (-1, -1))")
    assert text is None
    text, troubles = acted(model, "[each for each in open('/proc/self/status') if each.startswith('CapEff')]")
    assert not troubles
    assert int(str(text).split("\\t")[1].split("\\n")[0], 16) & ~0b110 == 0


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
        python.note_unconfined([FILES, CALLS])
        python.note_unconfined([FILES, CALLS])
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
    more = {"clone": CLONE, "clone3": CLONE3, "tgkill": TGKILL, "prlimit64": PRLIMIT64, "fcntl": FCNTL}
    more |= {"openat": OPENAT, "openat2": OPENAT2}
    numbers = {name: each[column] for name, each in {**FORBIDDEN, **more, "open": OPEN}.items()}
    assert {name: known[name] for name in numbers if name in known} == {
        name: number for name, number in numbers.items() if name in known
    }
    assert len(numbers.keys() & known.keys()) > 60
