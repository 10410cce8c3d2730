"""The planner's process as the controller meets it: killed, standing still, or failing, it never holds anything up."""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import signal
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from functools import partial
from multiprocessing.process import BaseProcess

import pytest

from control.bench import cell, until
from sequence_planner.automaton.tick import initial_state
from sequence_planner.control import planner_process
from sequence_planner.control.planner_process import Listener, PlannerProcess
from sequence_planner.planning.plan import Answer, PlanAnswer, PlanRequest, Verdict


@dataclass
class Asking:
    planner: PlannerProcess
    answers: list[Answer] = field(default_factory=list)
    failures: list[tuple[str, bool]] = field(default_factory=list)

    def ask(self, goal: str = "fetch(left)") -> None:
        self.planner.ask(PlanRequest(dict(initial_state(cell()[0].automaton)), (goal,)))


def run(scenario: Callable[[Asking], Awaitable[None]]) -> None:
    async def live() -> None:
        station, supervisor = cell()
        answers: list[Answer] = []
        failures: list[tuple[str, bool]] = []
        listener = Listener(
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


def processes() -> list[BaseProcess]:
    return [child for child in multiprocessing.active_children() if child.name == "planner"]


def test_a_question_asked_at_once_is_answered() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        assert asking.planner.busy
        with pytest.raises(RuntimeError):
            asking.ask()
        await until(lambda: not asking.planner.busy)
        (answer,) = asking.answers
        assert isinstance(answer, PlanAnswer)
        assert answer.verdict is Verdict.FOUND
        assert asking.planner.trouble is None

    run(scenario)


def test_an_error_nobody_thought_of_is_told_and_the_next_question_is_answered() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask("no such operation")
        await until(lambda: bool(asking.failures))
        ((why, again),) = asking.failures
        assert "KeyError" in why
        assert not again, "the same question would fail again"
        assert asking.planner.trouble == why
        await until(lambda: not asking.planner.busy)
        asking.ask()
        await until(lambda: bool(asking.answers) or len(asking.failures) > 1)
        if not asking.answers:  # it was asked in the moment in which the process ended
            assert asking.failures[1][1], "it may be asked again"
            await until(lambda: not asking.planner.busy)
            asking.ask()
            await until(lambda: bool(asking.answers))
        assert asking.planner.trouble is None

    run(scenario)


def test_one_that_is_killed_is_replaced_without_a_question_too() -> None:
    async def scenario(asking: Asking) -> None:
        asking.ask()
        await until(lambda: bool(asking.answers))
        (before,) = processes()
        before.kill()
        await until(lambda: [p.pid for p in processes()] not in ([], [before.pid]))
        assert asking.failures == []
        await until(lambda: not asking.planner.busy)
        asking.ask()
        await until(lambda: len(asking.answers) == 2)

    run(scenario)


def test_one_that_stands_still_holds_up_nothing_and_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planner_process, "GRACE", -4.5)  # with the deadline, half a second

    async def scenario(asking: Asking) -> None:
        asking.ask()
        await until(lambda: bool(asking.answers))
        (still,) = processes()
        assert still.pid is not None
        os.kill(still.pid, signal.SIGSTOP)
        began = time.monotonic()
        asking.ask()
        assert time.monotonic() - began < 0.1
        await until(lambda: bool(asking.failures))
        assert asking.failures == [("the planner was silent too long and is started again", True)]
        monkeypatch.undo()
        await until(lambda: not asking.planner.busy)
        asking.ask()
        await until(lambda: len(asking.answers) == 2)

    run(scenario)


def test_one_that_dies_again_and_again_is_replaced_ever_later() -> None:
    async def scenario(asking: Asking) -> None:
        died: list[float] = []
        for _ in range(3):
            await until(lambda: bool(processes()))
            (process,) = processes()
            process.kill()
            died.append(time.monotonic())
            await until(partial(has_gone, process.pid))
        assert died[2] - died[1] > 1.5
        assert asking.planner.trouble == "the planner has ended and is started again"

    run(scenario)
