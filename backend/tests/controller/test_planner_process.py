"""The planner's process as the controller meets it: killed, standing still, or failing, it never holds anything up."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from sequence_planner.automaton.tick import initial_state
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.planning.diagnosis import Diagnosis, DiagnosisRequest, correction_text, member_text
from sequence_planner.planning.portfolio.engines import LANES
from sequence_planner.planning.portfolio.worker import Answer, Request, planner_process
from sequence_planner.planning.problem import Circumstances, PlanAnswer, PlanRequest, Verdict, goals_of
from sequence_planner.process.task import WorkerError
from sequence_planner.process.worker import Worker
from support.cell import cell
from support.places import CELL
from support.waiting import until_async


@dataclass
class Asking:
    planner: Worker[Request, Answer]
    answers: list[Answer] = field(default_factory=list)
    failures: list[tuple[str, bool]] = field(default_factory=list)
    asked: list[asyncio.Task[None]] = field(default_factory=list)

    @property
    def busy(self) -> bool:
        return self.planner.away or not all(each.done() for each in self.asked)

    def has(self, answers: int) -> bool:
        return len(self.answers) == answers

    def ask(self, goal: str = "fetch(left)") -> None:
        automaton = cell()[0].automaton
        self.put(PlanRequest(dict(initial_state(automaton)), goals_of(automaton, (goal,))))

    def put(self, request: Request) -> None:
        self.asked.append(asyncio.create_task(self._put(request)))

    async def _put(self, request: Request) -> None:
        try:
            self.answers.append(await self.planner.ask(request, request.deadline))
        except WorkerError as error:
            self.failures.append((str(error), error.again))


def run(scenario: Callable[[Asking], Awaitable[None]]) -> None:
    async def live() -> None:
        station, supervisor = cell()
        planner = planner_process(station.automaton, supervisor)
        try:
            await scenario(Asking(planner))
        finally:
            planner.close()
        assert not processes()

    asyncio.run(live())


def processes() -> list[Child]:
    return [child for child in children() if child.name == "planner"]


def test_a_question_asked_at_once_is_answered() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        assert asking.busy
        asking.ask()
        await until_async(lambda: not asking.busy)
        for answer in asking.answers:
            assert isinstance(answer, PlanAnswer)
            assert answer.verdict is Verdict.FOUND
        assert asking.has(2), "the other one waits for its turn"
        assert asking.planner.trouble is None

    run(scenario)


def test_it_says_why_there_is_no_plan_at_all() -> None:
    async def scenario(asking: Asking) -> None:
        automaton = cell()[0].automaton
        offline = Circumstances(offline=frozenset(automaton.resources))
        goals = goals_of(automaton, ("fetch(left)",))
        asking.put(DiagnosisRequest(initial_state(automaton), goals, offline))
        await until_async(lambda: not asking.busy)
        (answer,) = asking.answers
        assert isinstance(answer, Diagnosis)
        assert answer.reason is not None
        texts = [member_text(member) for member in answer.reason.members]
        assert "the goal fetch(left)" in texts
        assert any(text.endswith(" is offline") for text in texts)
        assert any(correction_text(each).endswith(" online") for each in answer.corrections)

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
        await until_async(lambda: not asking.busy)
        asking.ask()
        await until_async(lambda: len(asking.answers) == 2)
        (cautious,) = processes()
        assert cautious.pid != first.pid
        titles = set(map(title, descendants(os.getpid())))
        assert {f"sequence-planner: planner {lane.name}" for lane in LANES} <= titles

    run(scenario)


# The process of a planner that is asked something, and all that it has started, as its parent sees them.
PARENT = f"""
import asyncio, signal
from pathlib import Path
from sequence_planner.automaton.tick import initial_state
from sequence_planner.planning.problem import PlanRequest, goals_of
from sequence_planner.process.worker import Worker
from sequence_planner.planning.diagnoser import DiagnosisModel
from sequence_planner.planning.portfolio.worker import Planning, work
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import FewerSpecifications
from sequence_planner.synthesis.supervisor import synthesise

if __name__ == "__main__":
    automaton = prepare_station(Path({str(CELL)!r})).automaton
    supervisor = synthesise(automaton)
    model = DiagnosisModel(automaton, supervisor, FewerSpecifications(automaton, supervisor))
    request = PlanRequest(dict(initial_state(automaton)), goals_of(automaton, ("fetch(left)",)))

    async def live():
        # As all that runs here does. `asyncio.run` alone misses a signal that comes just before it begins to wait.
        asyncio.get_running_loop().add_signal_handler(signal.SIGINT, asyncio.current_task().cancel)
        planner = Worker(work, Planning(model, cautious=True), "planner")
        await planner.ask(request, 30.0)
        print("ready", flush=True)
        await asyncio.sleep(60)

    asyncio.run(live())
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
