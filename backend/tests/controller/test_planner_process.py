"""The planner's process as the controller meets it: killed, standing still, or failing, it never holds anything up."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from queue import SimpleQueue

import pytest

from sequence_planner.automaton.tick import initial_state
from sequence_planner.controller.planner_client import PlannerListener, PlannerProcess
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.language.syntax import Variable
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest, correction_text, member_text
from sequence_planner.planning.portfolio.engines import LANES
from sequence_planner.planning.portfolio.worker import Answer, work
from sequence_planner.planning.problem import Circumstances, Goal, PlanAnswer, PlanRequest, Verdict, goals_of
from sequence_planner.process import worker
from sequence_planner.process.budget import Budget
from sequence_planner.process.worker import Companion, Ended, Word, WorkerQuestion, WorkerReady, stand_by
from support.cell import cell
from support.places import CELL
from support.waiting import until_async


@dataclass
class Asking:
    planner: PlannerProcess
    answers: list[Answer] = field(default_factory=list)
    failures: list[tuple[str, bool]] = field(default_factory=list)

    def has(self, answers: int) -> bool:
        return len(self.answers) == answers

    def ask(self, goal: str = "fetch(left)") -> None:
        automaton = cell()[0].automaton
        self.planner.ask(PlanRequest(dict(initial_state(automaton)), goals_of(automaton, (goal,))))

    def ask_nonsense(self) -> None:
        nonsense = Goal("fetch(left)", Variable("no such variable", BOOLEAN))
        self.planner.ask(PlanRequest(dict(initial_state(cell()[0].automaton)), (nonsense,)))


def run(scenario: Callable[[Asking], Awaitable[None]]) -> None:
    async def live() -> None:
        station, supervisor = cell()
        answers: list[Answer] = []
        failures: list[tuple[str, bool]] = []
        listener = PlannerListener(
            lambda request, answer: answers.append(answer), lambda request, why, again: failures.append((why, again))
        )
        planner = PlannerProcess(station.automaton, supervisor, asyncio.get_running_loop(), listener)
        try:
            await scenario(Asking(planner, answers, failures))
        finally:
            planner.close()
        assert not processes()

    asyncio.run(live())


def has_gone(pid: int | None) -> bool:
    return pid not in [process.pid for process in processes()]


def processes() -> list[Child]:
    return [child for child in children() if child.name == "planner"]


def test_a_question_asked_at_once_is_answered() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        assert asking.planner.busy
        with pytest.raises(RuntimeError):
            asking.ask()
        await until_async(lambda: not asking.planner.busy)
        (answer,) = asking.answers
        assert isinstance(answer, PlanAnswer)
        assert answer.verdict is Verdict.FOUND
        assert asking.planner.trouble is None

    run(scenario)


def test_it_says_why_there_is_no_plan_at_all() -> None:
    async def scenario(asking: Asking) -> None:
        automaton = cell()[0].automaton
        offline = Circumstances(offline=frozenset(automaton.resources))
        goals = goals_of(automaton, ("fetch(left)",))
        asking.planner.ask(DiagnosisRequest(initial_state(automaton), goals, offline))
        await until_async(lambda: not asking.planner.busy)
        (answer,) = asking.answers
        assert isinstance(answer, Diagnosis)
        assert answer.reason is not None
        texts = [member_text(member) for member in answer.reason.members]
        assert "the goal fetch(left)" in texts
        assert any(text.endswith(" is offline") for text in texts)
        assert any(correction_text(each).endswith(" online") for each in answer.corrections)

    run(scenario)


def test_an_error_nobody_thought_of_is_told_and_the_next_question_is_answered() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask_nonsense()
        await until_async(lambda: bool(asking.failures))
        ((why, again),) = asking.failures
        assert "KeyError" in why
        assert not again, "the same question would fail again"
        assert asking.planner.trouble == why
        await until_async(lambda: not asking.planner.busy)
        asking.ask()
        await until_async(lambda: bool(asking.answers) or len(asking.failures) > 1)
        if not asking.answers:  # it was asked in the moment in which the process ended
            assert asking.failures[1][1], "it may be asked again"
            await until_async(lambda: not asking.planner.busy)
            asking.ask()
            await until_async(lambda: bool(asking.answers))
        assert asking.planner.trouble is None

    run(scenario)


def test_one_that_is_killed_is_replaced_without_a_question_too() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        await until_async(lambda: bool(asking.answers))
        (before,) = processes()
        before.kill()
        await until_async(lambda: [p.pid for p in processes()] not in ([], [before.pid]))
        assert asking.failures == []
        await until_async(lambda: not asking.planner.busy)
        asking.ask()
        await until_async(lambda: len(asking.answers) == 2)

    run(scenario)


def test_it_begins_with_a_question_and_ends_when_nobody_has_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "ANSWERER_RESTS_AFTER", 0.2)

    async def scenario(asking: Asking) -> None:
        await asyncio.sleep(0.1)
        assert processes() == []
        for number in range(1, 4):
            asking.ask()
            assert len(processes()) == 1
            await until_async(partial(asking.has, number))
            began = time.monotonic()
            await until_async(lambda: processes() == [])
            assert time.monotonic() - began > 0.1, "it may be asked more at once"
            assert not asking.planner.busy
        assert asking.failures == []
        assert asking.planner.replaced == 0
        assert asking.planner.trouble is None

    run(scenario)


def test_a_question_in_the_moment_in_which_it_ends_is_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "ANSWERER_RESTS_AFTER", 0.0)

    async def scenario(asking: Asking) -> None:
        for number in range(1, 6):
            asking.ask()
            await until_async(partial(asking.has, number))
        assert asking.failures == []

    run(scenario)


def test_one_that_stands_still_holds_up_nothing_and_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        await until_async(lambda: bool(asking.answers))
        (still,) = processes()
        assert still.pid is not None
        os.kill(still.pid, signal.SIGSTOP)
        monkeypatch.setattr(worker, "GRACE", -4.5)  # with the deadline, half a second
        began = time.monotonic()
        asking.ask()
        assert time.monotonic() - began < 0.1
        await until_async(lambda: bool(asking.failures))
        assert asking.failures == [("the planner was silent too long and is started again", True)]
        monkeypatch.undo()
        await until_async(lambda: not asking.planner.busy)
        asking.ask()
        await until_async(lambda: len(asking.answers) == 2)

    run(scenario)


def test_one_that_dies_again_and_again_is_replaced_ever_later() -> None:
    async def scenario(asking: Asking) -> None:
        died: list[float] = []
        asking.ask()
        for _ in range(3):
            await until_async(lambda: bool(processes()))
            (process,) = processes()
            process.kill()
            died.append(time.monotonic())
            await until_async(partial(has_gone, process.pid))
        assert died[2] - died[1] > 1.5
        assert asking.planner.trouble == "the planner has ended and is started again"

    run(scenario)


def test_a_question_that_is_called_off_is_not_answered_and_the_next_one_is() -> None:
    async def scenario(asking: Asking) -> None:
        asking.planner.call_off()  # there is nothing to call off
        for _ in range(3):
            asking.ask()
            asking.planner.call_off()
            assert not asking.planner.busy
        asking.ask()
        await until_async(lambda: not asking.planner.busy)
        await asyncio.sleep(0.2)
        assert len(asking.answers) == 1
        assert asking.failures == []

    run(scenario)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="only Linux says which process started which")
def test_after_one_that_has_died_over_a_question_engines_are_in_processes_of_their_own() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        await until_async(lambda: bool(asking.answers))
        (first,) = processes()
        assert first.pid is not None
        os.kill(first.pid, signal.SIGSTOP)
        asking.ask()
        first.kill()
        await until_async(lambda: bool(asking.failures))
        assert asking.failures == [("the planner has ended and is started again", True)]
        await until_async(lambda: not asking.planner.busy)
        asking.ask()
        await until_async(lambda: len(asking.answers) == 2)
        (cautious,) = processes()
        assert cautious.pid != first.pid
        titles = set(map(title, descendants(os.getpid())))
        assert {f"sequence-planner: planner {lane.name}" for lane in LANES} <= titles

    run(scenario)


# The process of a planner that is asked something, and all that it has started, as its parent sees them.
PARENT = f"""
import signal, threading, time
from pathlib import Path
from sequence_planner.automaton.tick import initial_state
from sequence_planner.planning.problem import PlanRequest, goals_of
from sequence_planner.process.worker import Companion, WorkerAnswered, WorkerQuestion
from sequence_planner.planning.diagnoser import DiagnosisModel
from sequence_planner.planning.portfolio.worker import Planning, work
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import FewerSpecifications
from sequence_planner.synthesis.supervisor import synthesise

if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background job ignores it
    automaton = prepare_station(Path({str(CELL)!r})).automaton
    ready = threading.Event()
    hear = lambda word: ready.set() if isinstance(word, WorkerAnswered) else None
    supervisor = synthesise(automaton)
    model = DiagnosisModel(automaton, supervisor, FewerSpecifications(automaton, supervisor))
    planner = Companion(work, Planning(model, cautious=True), hear, "planner")
    request = PlanRequest(dict(initial_state(automaton)), goals_of(automaton, ("fetch(left)",)))
    planner.ask(WorkerQuestion(1, 30.0, request))
    ready.wait()
    print("ready", flush=True)
    time.sleep(60)
"""


def descendants(pid: int) -> set[int]:
    """The processes that it has started, and those have."""
    children: dict[int, list[int]] = {}
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
            children.setdefault(parent, []).append(int(folder.name))
    found: set[int] = set()
    pending = [pid]
    while pending:
        new = children.get(pending.pop(), [])
        found.update(new)
        pending += new
    return found


def title(pid: int) -> str:
    """What `ps` shows of a process."""
    return Path(f"/proc/{pid}/cmdline").read_text().strip("\0 ")


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="only Linux says which process started which")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_nothing_is_left_of_it_when_its_parent_is_killed(how: signal.Signals) -> None:
    with subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as parent:
        assert parent.stdout is not None
        assert parent.stdout.readline() == b"ready\n"
        left = descendants(parent.pid)
        assert len(left) > len(LANES)
        parent.send_signal(how)
    end = time.monotonic() + 5
    while any(Path(f"/proc/{pid}").exists() for pid in left):
        assert time.monotonic() < end, "it has not ended"
        time.sleep(0.05)


def forgetful(connection: Connection) -> None:
    """The life of a process that has no memory left for any answer."""

    def prepare(model: object) -> Callable[[object, Budget], Iterator[object]]:
        def answer(content: object, budget: Budget) -> Iterator[object]:
            raise MemoryError

        return answer

    stand_by(connection, prepare)


def test_without_memory_it_ends_and_the_question_may_be_asked_of_another_one() -> None:
    heard: SimpleQueue[Word] = SimpleQueue()
    process: Companion[str, str] = Companion(forgetful, "nothing", heard.put, "planner")
    process.ask(WorkerQuestion(1, 5.0, "what comes next?"))
    assert [type(heard.get(timeout=30)) for _ in range(2)] == [WorkerReady, Ended]
    process.close()


def test_a_word_that_cannot_be_sent_ends_the_process_so_that_nobody_waits_for_ever() -> None:
    heard: list[Word] = []
    over = threading.Event()

    def hear(word: Word) -> None:
        heard.append(word)
        if isinstance(word, Ended):
            over.set()

    nothing_to_send = lambda: None  # noqa: E731 - what has no name cannot be sent
    planner: Companion[object, object] = Companion(work, nothing_to_send, hear, "planner")
    assert over.wait(30)
    planner.close()
