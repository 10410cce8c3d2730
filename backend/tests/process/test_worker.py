"""Processes that are asked under a deadline: whatever becomes of one, nobody waits for long, and nothing is left."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from process.lives import RefusedError, counting, growing, leading, reporting, slow, work
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.process.task import BackgroundTask, TooLargeError, WorkerError
from sequence_planner.process.worker import FOLDER, Worker, WorkerLateError, WorkerLoop
from support.waiting import patience, until, until_async

Scenario = Callable[[Worker[object, Any]], Awaitable[None]]
NAMED = f"{work.__module__}:{work.__name__}"
MODEL = "model"


def processes() -> list[Child]:
    return [child for child in children() if child.name == "tested"]


def run(scenario: Scenario, model: object = MODEL, prepare: Any = work, **options: Any) -> None:  # noqa: ANN401
    """Live through it with a worker, of which nothing is left."""

    async def live() -> None:
        worker: Worker[object, Any] = Worker(prepare, model, "tested", errors=(RefusedError,), **options)
        try:
            async with asyncio.timeout(60):
                await scenario(worker)
        finally:
            worker.close()
        assert not processes()
        with pytest.raises(WorkerError):
            await worker.ask("model", 1.0)

    asyncio.run(live())


def has_gone(process: Child) -> bool:
    return process not in processes()


def lives(number: object) -> bool:
    """Whether there is such a process that has not ended, whoever may still have to hear of its end."""
    try:
        return " Z " not in Path(f"/proc/{number}/stat").read_text(encoding="ascii")
    except OSError:
        return False


async def only() -> Child:
    await until_async(lambda: len(processes()) == 1)
    return processes()[0]


async def why_not(worker: Worker[object, Any], question: object, seconds: float = 20.0) -> WorkerError:
    with pytest.raises(WorkerError) as refused:
        await worker.ask(question, seconds)
    return refused.value


@pytest.mark.parametrize("prepare", [work, NAMED])
def test_questions_are_answered_in_their_order_by_one_process(prepare: object) -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        assert not processes()
        first, model, last = await asyncio.gather(*(worker.ask(each, 20) for each in ("process", "model", "process")))
        assert (model, first) == (MODEL, last)
        assert first == ((await only()).pid, os.nice(0) + 3)
        assert (worker.trouble, worker.replaced) == (None, 0)

    run(scenario, prepare=prepare, niceness=3)


def test_all_that_is_answered_is_heard_and_the_last_is_the_answer() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        heard: list[object] = []
        assert await worker.ask("count", 20, heard.append) == 2
        assert heard == [0, 1, 2]

    run(scenario)


def test_an_error_that_may_be_is_raised_and_the_process_goes_on() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        before = await worker.ask("process", 20)
        with pytest.raises(RefusedError, match="not that"):
            await worker.ask("refuse", 20)
        assert worker.trouble == "not that"
        assert await worker.ask("process", 20) == before
        assert worker.trouble is None

    run(scenario)


@pytest.mark.parametrize(
    ("question", "why", "again"),
    [
        ("fail", "the tested failed (ZeroDivisionError: of its own making)", False),
        ("forget", "the tested has ended and is started again", True),
        (lambda: None, "the tested has ended and is started again", True),  # what has no name cannot be sent
    ],
)
def test_after_an_error_nobody_thought_of_another_process_answers(question: object, why: str, again: bool) -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        before, _ = await worker.ask("process", 20)
        error = await why_not(worker, question)
        assert (str(error), error.again, worker.trouble) == (why, again, why)
        await until_async(lambda: worker.replaced == 1 and not worker.away)
        after, _ = await worker.ask("process", 20)
        assert after != before
        assert worker.trouble is None

    run(scenario)


def test_one_that_is_killed_is_replaced_without_a_question_too() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        before, _ = await worker.ask("process", 20)
        (await only()).kill()
        await until_async(lambda: [each.pid for each in processes()] not in ([], [before]))
        assert (await worker.ask("process", 20))[0] != before

    run(scenario)


def test_one_that_is_not_kept_begins_again_only_with_a_question() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        before, _ = await worker.ask("process", 20)
        asked = asyncio.create_task(why_not(worker, "sleep"))
        await asyncio.sleep(0.1)
        (await only()).kill()
        assert (await asked).again
        assert not worker.begun
        await asyncio.sleep(0.2)
        assert not processes()
        assert (await worker.ask("process", 20))[0] != before

    run(scenario, kept=False)


def test_it_ends_when_nobody_has_a_question_and_begins_when_somebody_will_have_one() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        for _ in range(2):
            await worker.ask("model", 20)
            began = time.monotonic()
            await until_async(lambda: not processes())
            assert time.monotonic() - began > 0.1, "it may be asked more at once"
        worker.begin()
        await only()
        await until_async(lambda: not processes())
        assert (worker.replaced, worker.away, worker.trouble) == (0, False, None)

    run(scenario, rests_after=0.2)


def test_a_question_in_the_moment_in_which_it_ends_is_answered() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        for _ in range(5):
            assert await worker.ask("model", 20) == MODEL

    run(scenario, rests_after=0.0)


@pytest.mark.parametrize("kept", [True, False])
def test_one_that_stands_still_holds_up_nothing_and_is_ended(kept: bool) -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        still, _ = await worker.ask("process", 20)
        os.kill(still, signal.SIGSTOP)
        began = time.monotonic()
        error = await why_not(worker, "model", 0.3)
        assert 0.45 < time.monotonic() - began < patience(1.5)
        assert isinstance(error, WorkerLateError)
        assert str(error) == "the tested was silent too long and is started again"
        await until_async(lambda: not worker.away)
        assert (await worker.ask("process", 20))[0] != still

    run(scenario, late=0.2, kept=kept)


def test_one_that_dies_again_and_again_is_replaced_ever_later() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        worker.begin()
        died: list[float] = []
        for _ in range(3):
            process = await only()
            process.kill()
            died.append(time.monotonic())
            await until_async(partial(has_gone, process))
        assert died[2] - died[1] > 1.5
        error = await why_not(worker, "model")
        assert (str(error), error.again) == ("the tested has ended and is started again", True)

    run(scenario)


def test_a_question_that_is_called_off_is_not_answered_and_the_next_one_is() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        before = await worker.ask("process", 20)
        for pause in (0.0, 0.1, 0.0):
            asked = asyncio.create_task(worker.ask("off", 600))
            await asyncio.sleep(pause)
            asked.cancel()
            assert isinstance((await asyncio.gather(asked, return_exceptions=True))[0], asyncio.CancelledError)
            assert await worker.ask("process", 20) == before

    run(scenario)


def test_one_that_does_not_come_back_from_what_was_called_off_is_replaced_whatever_is_asked() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        before, _ = await worker.ask("process", 20)
        asked = asyncio.create_task(worker.ask("sleep", 600))
        await asyncio.sleep(0.1)
        asked.cancel()
        began = time.monotonic()
        assert (await why_not(worker, "model", 600)).again
        assert time.monotonic() - began < patience(2)
        await until_async(lambda: not worker.away)
        assert (await worker.ask("process", 20))[0] != before

    run(scenario, late=0.5)


def test_where_it_may_not_be_late_it_ends_when_nobody_waits_any_more() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        for pause in (0.0, 0.01, 0.3):
            asked = asyncio.create_task(worker.ask("off", 600))
            await asyncio.sleep(pause)
            asked.cancel()
            await asyncio.gather(asked, return_exceptions=True)
            assert not worker.begun
            await until_async(lambda: not processes())
        assert await worker.ask("model", 20) == MODEL

    run(scenario, late=0.0, starting=None, kept=False)


@pytest.mark.parametrize(("starting", "late"), [(0.2, False), (30.0, False), (None, True)])
def test_it_is_given_time_to_begin_or_none_beyond_that_of_the_question(starting: float | None, late: bool) -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        began = time.monotonic()
        if starting == 30.0:
            assert await worker.ask("model", 0.5) == MODEL
            return
        error = await why_not(worker, "model", 0.5)
        assert isinstance(error, WorkerLateError)
        assert time.monotonic() - began == pytest.approx(starting or 0.5, abs=0.4)

    run(scenario, prepare=slow, starting=starting, late=0.0 if late else 5.0)


def test_after_one_that_has_died_over_a_question_the_next_one_is_cautious() -> None:
    async def scenario(worker: Worker[object, Any]) -> None:
        assert await worker.ask("model", 20) == MODEL
        for question, model in (("fail", MODEL), ("forget", "cautious")):
            await why_not(worker, question)
            await until_async(lambda: not worker.away)
            assert await worker.ask("model", 20) == model

    run(scenario, cautious="cautious")


def test_each_process_has_an_empty_folder_of_which_nothing_is_left() -> None:
    folders: list[Path] = []

    async def scenario(worker: Worker[object, Any]) -> None:
        for names in ([], ["file"], []):
            folder, before = await worker.ask("write", 20)
            assert before == names
            folders.append(folder)
            if names:
                await why_not(worker, "fail")
                await until_async(lambda: not worker.away)

    run(scenario, FOLDER)
    assert len(set(folders)) == 2
    assert not any(each.exists() for each in folders)


def test_who_has_no_event_loop_waits_for_answers_and_can_give_up() -> None:
    loop = WorkerLoop()
    worker: Worker[str, object] = Worker(work, MODEL, "tested")
    assert loop.submit(worker.ask("model", 20)).result(20) == MODEL
    asked = loop.submit(worker.ask("off", 600))
    asked.cancel()
    assert loop.submit(worker.ask("model", 20)).result(20) == MODEL
    loop.close(worker)
    assert not processes()


# A process that has one that is asked something, as its parent sees both.
PARENT = """
import asyncio, signal, sys
from process.lives import work
from sequence_planner.process.task import BackgroundTask
from sequence_planner.process.worker import Worker

async def live():
    # As all that runs here does. `asyncio.run` alone misses a signal that comes just before it begins to wait.
    asyncio.get_running_loop().add_signal_handler(signal.SIGINT, asyncio.current_task().cancel)
    worker = Worker(work, "model", "tested")
    print((await worker.ask("process", 20))[0], flush=True)
    await worker.ask("sleep", 600)

if __name__ == "__main__":
    asyncio.run(live())
"""


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_it_ends_with_its_parent_however_that_ends(how: signal.Signals) -> None:
    tests = Path(__file__).parents[1]
    with subprocess.Popen(
        [sys.executable, "-c", PARENT],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tests), os.environ.get("PYTHONPATH", "")])},
    ) as parent:
        assert parent.stdout is not None
        number = int(parent.stdout.readline())
        parent.send_signal(how)
    until(lambda: not lives(number), seconds=5)


# One piece of work.


def task(function: Callable[..., Any], *arguments: object, **options: Any) -> BackgroundTask[Any]:  # noqa: ANN401
    return BackgroundTask(function, arguments, "tested", 3, errors=(RefusedError,), **options)


async def heard(of: BackgroundTask[Any], most: int = 100) -> list[object]:
    found: list[object] = []
    async with of.telling() as telling:
        async for each in telling:
            found.append(each)
            if len(found) == most:
                break
    assert not processes()
    return found


def test_what_is_told_is_heard_one_by_one_and_then_the_error() -> None:
    assert asyncio.run(heard(task(counting, 3, 0.0), 3)) == [0, 1, 2]
    with pytest.raises(RefusedError, match="no more"):
        asyncio.run(heard(task(counting, 3, 0.0)))
    told: list[object] = []
    with pytest.raises(RefusedError, match="no more"):
        told.extend(task(counting, 3, 0.0).told(20))
    reports: list[object] = []
    assert asyncio.run(task(reporting, 1, reports=True).found(reports.append)) == 2
    assert reports == [1, 2]


def test_work_that_takes_more_memory_than_there_is_or_is_killed_ends() -> None:
    with pytest.raises(TooLargeError, match=r"more than 0\.25 GB"):
        asyncio.run(heard(task(growing, gigabytes=0.25), 10**6))

    async def killed() -> None:
        async with task(counting, 2, 600.0).telling() as telling:
            assert await anext(telling) == 0
            processes()[0].kill()
            await anext(telling)

    with pytest.raises(WorkerError, match="has ended without an answer"):
        asyncio.run(killed())


@pytest.mark.parametrize("pause", [0.0, 0.01, 0.3])
def test_whoever_no_longer_wants_work_does_not_wait(pause: float) -> None:
    async def scenario() -> float:
        working = asyncio.create_task(heard(task(counting, 2, 600.0)))
        await asyncio.sleep(pause)
        began = time.monotonic()
        working.cancel()
        await asyncio.wait({working})
        return time.monotonic() - began

    assert asyncio.run(scenario()) < 0.5
    assert not processes()


def test_one_that_leads_ends_with_all_that_it_has_started() -> None:
    (number,) = asyncio.run(heard(task(leading, leads=True), 1))
    until(lambda: not lives(number), seconds=5)
