"""Forked processes begin as new ones do, end with whoever has started them, and say how they have ended."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection, Pipe
from pathlib import Path

import pytest

from forking import works
from sequence_planner.forking import starting
from sequence_planner.forking.child import LOST, Child
from sequence_planner.forking.starting import children, hang_up, start
from support.places import TESTS
from support.waiting import PATIENCE, patience, until


def is_there(pid: int) -> bool:
    """Whether a process lives; one that nobody has waited for does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):  # it ends just now
        return False


@contextmanager
def started(work: Callable[..., None], *arguments: object, leads: bool = False) -> Iterator[tuple[Child, Connection]]:
    ours, theirs = Pipe()
    child = start(work, *arguments, name=work.__name__, connection=theirs, leads=leads)
    with ours:
        try:
            yield child, ours
        finally:
            child.kill()
            child.join()


def test_it_begins_as_a_new_process_does(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    with started(works.describe) as (child, connection):
        first = connection.recv()
        assert child.wait(PATIENCE) == 0
    with started(works.wait) as (other, other_connection):
        other_connection.recv()
        with started(works.describe) as (_, connection):
            second = connection.recv()
        assert other.poll() is None
    assert first == second, "nothing of another process is left in it"
    assert first["folder"] == str(tmp_path)
    assert first["path"] == sys.path
    assert first["input"] == ""
    assert first["title"] == "sequence-planner: describe"
    assert first["threads"] == 2, "its own, and that of its lifeline"
    assert first["parent"] != os.getpid()


def test_it_has_the_environment_of_whoever_has_started_it(monkeypatch: pytest.MonkeyPatch) -> None:
    for value in ("one", "two"):
        monkeypatch.setenv("OF_A_TEST", value)
        with started(works.tell, "OF_A_TEST", "OF_NO_TEST") as (_, connection):
            assert connection.recv() == [value, None]


def test_it_says_how_it_has_ended() -> None:
    with started(works.fail) as (child, _):
        assert child.wait(PATIENCE) == 7
        assert child.poll() == 7
    with started(works.wait) as (child, connection):
        assert child.poll() is None
        with pytest.raises(subprocess.TimeoutExpired):
            child.wait(0.05)
        assert connection.recv() == child.pid
        child.terminate()
        assert child.wait(PATIENCE) == -signal.SIGTERM
    with started(works.wait) as (child, connection):
        os.kill(connection.recv(), signal.SIGKILL)
        assert child.wait(PATIENCE) == -signal.SIGKILL
        child.kill()  # nothing is left that could be meant
        assert child not in children()


def test_what_cannot_be_imported_ends_it_alone() -> None:
    ours, theirs = Pipe()
    with ours:
        child = start("no.such.module:work", name="nothing", connection=theirs)
        assert child.wait(PATIENCE) == 1
        with pytest.raises(EOFError):
            ours.recv()
    with started(works.wait) as (other, connection):
        assert connection.recv() == other.pid


def test_one_that_is_killed_before_it_has_begun_ends() -> None:
    for _ in range(20):
        with started(works.wait) as (child, connection):
            child.kill()
            assert child.wait(PATIENCE) == -signal.SIGKILL
            with pytest.raises((EOFError, ConnectionError)):
                while True:
                    assert not is_there(connection.recv()) or child.poll() is not None


def test_many_are_started_and_ended_from_many_threads() -> None:
    ended: list[int] = []

    def life() -> None:
        for number in range(10):
            with started(works.wait if number % 2 else works.fail) as (child, connection):
                if number % 2:
                    assert connection.recv() == child.pid
                    child.kill()
                ended.append(child.wait(PATIENCE))

    threads = [threading.Thread(target=life) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert sorted(ended) == [-signal.SIGKILL] * 20 + [7] * 20
    assert children() == []


def test_one_that_leads_ends_with_all_that_it_has_started() -> None:
    with started(works.wait_with_another, leads=True) as (child, connection):
        itself, other = connection.recv()
        os.kill(itself, signal.SIGKILL)  # as the system does when memory is short
        child.join()
        until(lambda: not is_there(other))
    with started(works.wait_with_another, leads=True) as (child, connection):
        numbers = connection.recv()
        child.kill()
        child.join()
        until(lambda: not any(map(is_there, numbers)))


def test_what_it_starts_comes_from_the_same_server_and_ends_with_it() -> None:
    with started(works.start_another) as (child, connection):
        itself, other, server, known = connection.recv()
        assert other == known
        assert Path(f"/proc/{other}/stat").read_text().rpartition(")")[2].split()[1] == str(server)
        os.kill(itself, signal.SIGKILL)
        child.join()
        until(lambda: not is_there(other))


PARENT = """
import sys, time
from multiprocessing.connection import Pipe
from forking import works
from sequence_planner.forking.starting import start
ours, theirs = Pipe()
child = start(works.start_another, name="child", connection=theirs)
print(*ours.recv(), flush=True)
time.sleep(60)
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("alone", [False, True])
def test_all_end_with_a_parent_that_is_killed(how: signal.Signals, alone: bool, short_path: Path) -> None:
    """Their server, too; and where that was killed before, they do so without it."""
    variables = {**os.environ, "TMPDIR": str(short_path), "PYTHONPATH": os.pathsep.join(map(str, [TESTS, *sys.path]))}
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell runs in the background ignores it
    command = [sys.executable, "-c", PARENT]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=variables) as parent:
        assert parent.stdout is not None
        itself, other, server, _ = map(int, parent.stdout.readline().split())
        if alone:
            os.kill(server, signal.SIGKILL)
            until(lambda: not is_there(server))
            assert is_there(itself)
            assert is_there(other)
        parent.send_signal(how)
    until(lambda: not any(map(is_there, (itself, other, server))))
    if not alone:
        until(lambda: list(short_path.iterdir()) == [])


def test_where_the_server_stands_still_nobody_waits_for_it() -> None:
    with started(works.wait) as (first, connection), started(works.wait) as (second, other):
        number = connection.recv()
        server = int(Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[1])
        os.kill(server, signal.SIGSTOP)
        try:
            os.kill(other.recv(), signal.SIGKILL)
            with pytest.raises(subprocess.TimeoutExpired):
                second.wait(0.5)  # the server may say yet how it has ended
            began = time.monotonic()
            first.kill()
            assert first.wait(PATIENCE) == -signal.SIGKILL
            assert time.monotonic() - began < patience(1)
            with started(works.wait) as (never, nothing):
                assert never.poll() is None
                assert not never.has_begun

                def hear(nothing: Connection = nothing) -> None:
                    with pytest.raises((EOFError, OSError)):
                        nothing.recv()

                hearing = threading.Thread(target=hear)
                hearing.start()
                began = time.monotonic()
                never.terminate()
                assert never.wait(PATIENCE) == LOST
                assert never.pid is None
                hang_up(nothing)
                hearing.join(PATIENCE)
                assert not hearing.is_alive()
                assert time.monotonic() - began < patience(1), "nobody waits for what stands still"
            assert second.poll() is None
        finally:
            os.kill(server, signal.SIGCONT)
        assert second.wait(PATIENCE) == -signal.SIGKILL
    with started(works.wait) as (child, connection):
        assert connection.recv() == child.pid


def test_what_was_not_wanted_any_more_before_it_had_begun_does_not_begin() -> None:
    with started(works.wait) as (_, connection):
        number = connection.recv()
        server = int(Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[1])
        os.kill(server, signal.SIGSTOP)
        dropped: list[int] = []
        for _ in range(5):
            with started(works.wait) as (child, ours):
                child.kill()
                dropped.append(os.dup(ours.fileno()))
        os.kill(server, signal.SIGCONT)
        for descriptor in dropped:
            with Connection(descriptor) as theirs, pytest.raises((EOFError, ConnectionError)):
                theirs.recv()


def test_one_to_which_nobody_refers_any_more_ends() -> None:
    ours, theirs = Pipe()
    with ours:
        child = start(works.wait, name="wait", connection=theirs)
        number = ours.recv()
        assert child.pid == number
        del child
        until(lambda: not is_there(number))


def test_two_threads_that_wait_for_the_number_both_get_it() -> None:
    for _ in range(20):
        with started(works.wait) as (child, connection):
            found: list[int | None] = []
            threads = [threading.Thread(target=lambda child=child, found=found: found.append(child.pid)) for _ in "abc"]
            for each in threads:
                each.start()
            for each in threads:
                each.join(PATIENCE)
            assert found == [connection.recv()] * 3
            assert child.poll() is None


def test_a_server_that_stands_still_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    own = starting.OwnServer()
    monkeypatch.setattr(starting, "OWN", own)
    monkeypatch.setattr(starting, "_PROBE_EVERY", 0.0)
    monkeypatch.setattr(starting, "LONGEST_SILENCE", 1.0)
    with started(works.wait) as (child, connection):
        number = connection.recv()
        server = int(Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[1])
        for _ in range(30):  # it answers, and stays
            own.look_after()
            time.sleep(0.05)
        assert is_there(server)
        os.kill(server, signal.SIGSTOP)
        with started(works.wait) as (waiting, other):
            end = time.monotonic() + PATIENCE
            while not other.poll(0.05):
                own.look_after()
                assert time.monotonic() < end
            assert waiting.pid == other.recv()
        assert not is_there(server)
        assert child.poll() is None


def test_where_the_server_has_died_it_can_still_be_ended_and_another_server_forks_the_next() -> None:
    with started(works.wait) as (child, connection):
        number = connection.recv()
        server = int(Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[1])
        os.kill(server, signal.SIGKILL)
        until(lambda: not is_there(server))
        assert child.poll() is None
        assert is_there(number)
        with started(works.wait) as (next_one, next_connection):
            assert next_connection.recv() == next_one.pid
        child.kill()
        assert child.wait(PATIENCE) == LOST
        assert not is_there(number)
