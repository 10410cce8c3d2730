"""The order of work is there in time, whatever becomes of the process that looks for it."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Awaitable, Callable

import pytest

from mes.works import NOW, check, shop
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.mes.scheduling.problem import JobWork, Schedule, WorkOperation
from sequence_planner.mes.scheduling.scheduler import LATE, Sequencer
from support.waiting import patience

PATIENCE = 60.0  # seconds


def run(scenario: Callable[[Sequencer], Awaitable[None]], late: float = LATE) -> None:
    async def live() -> None:
        sequencer = Sequencer(late)
        try:
            async with asyncio.timeout(PATIENCE):
                await scenario(sequencer)
        finally:
            sequencer.close()
        assert not processes()

    asyncio.run(live())


def processes() -> list[Child]:
    return [child for child in children() if child.name == "order of work"]


async def ordered(sequencer: Sequencer, works: list[JobWork], limit: float = 20.0) -> Schedule:
    """The order as the process finds it, which may still be starting."""
    while (schedule := await sequencer.sequence(works, [], NOW, limit)).fallback:
        check(works, [], schedule)
        await asyncio.sleep(0.05)
    return schedule


def test_it_answers_and_when_it_is_killed_rule_does_until_there_is_another() -> None:
    works = shop(3, seed=1)

    async def scenario(sequencer: Sequencer) -> None:
        first = await ordered(sequencer, works)
        check(works, [], first)
        assert first.optimal
        (process,) = processes()
        asked = asyncio.create_task(sequencer.sequence(shop(40, seed=2), [], NOW, 60.0))
        await asyncio.sleep(0)  # it has asked
        process.kill()
        schedule = await asked
        assert schedule.fallback == "the order of work has ended and is started again"
        check(shop(40, seed=2), [], schedule)
        assert await ordered(sequencer, works) == first
        assert [each.pid for each in processes()] != [process.pid]

    run(scenario)


def test_one_that_stands_still_is_not_waited_for_longer_than_was_said() -> None:
    works = shop(3, seed=1)

    async def scenario(sequencer: Sequencer) -> None:
        await ordered(sequencer, works)
        (process,) = processes()
        assert process.pid is not None
        os.kill(process.pid, signal.SIGSTOP)
        began = time.monotonic()
        schedule = await sequencer.sequence(works, [], NOW, 0.3)
        assert time.monotonic() - began < patience(5)
        assert schedule.fallback == "no order was found within 0.3 s"
        check(works, [], schedule)
        os.kill(process.pid, signal.SIGCONT)
        assert not (await ordered(sequencer, works)).fallback

    run(scenario, late=0.0)


def test_what_a_busy_machine_finds_of_a_thousand_orders_is_taken_although_it_is_late() -> None:
    works = shop(1000, seed=3)

    async def scenario(sequencer: Sequencer) -> None:
        await ordered(sequencer, shop(2, seed=1))
        schedule = await sequencer.sequence(works, [], NOW, 0.05)  # in which no machine reads the question
        check(works, [], schedule)
        assert (schedule.fallback, schedule.optimal) == ("", False)
        assert 20 <= schedule.horizon < 1000

    run(scenario, late=PATIENCE)


def test_what_cannot_be_worked_is_refused_and_the_next_question_is_answered() -> None:
    circle = WorkOperation(frozenset({"a"}), 1.0, frozenset())

    async def scenario(sequencer: Sequencer) -> None:
        await ordered(sequencer, shop(2, seed=1))
        with pytest.raises(ValueError, match="in a circle"):
            await sequencer.sequence([JobWork("job", 0, None, None, {"a": circle})], [], NOW, 20)
        await ordered(sequencer, shop(2, seed=1))

    run(scenario)
