"""Samples reach the event loop in batches, in order, and never pile up without end."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Sequence

import structlog

from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.transport import Sample


def numbered(numbers: Sequence[int]) -> list[Sample]:
    return [Sample("/count", number.to_bytes(4, "little"), float(number)) for number in numbers]


def numbers_of(samples: Sequence[Sample]) -> list[int]:
    return [int.from_bytes(sample.data, "little") for sample in samples]


def test_what_waits_comes_as_one_batch() -> None:
    async def scenario() -> None:
        batches: list[list[int]] = []
        delivery = Delivery(asyncio.get_running_loop(), "/count", lambda batch: batches.append(numbers_of(batch)))

        def push_all() -> None:
            for number in range(1000):
                delivery.push(numbered([number]))

        thread = threading.Thread(target=push_all)
        thread.start()
        thread.join()  # The loop stands still meanwhile.
        assert batches == []
        await asyncio.sleep(0.01)
        assert batches == [list(range(1000))]
        delivery.push(numbered([7]))
        await asyncio.sleep(0.01)
        assert batches[1:] == [[7]]

    asyncio.run(scenario())


def test_a_loop_that_stands_still_loses_the_oldest_and_is_told() -> None:
    async def scenario() -> None:
        batches: list[list[int]] = []
        loop = asyncio.get_running_loop()
        delivery = Delivery(loop, "/count", lambda batch: batches.append(numbers_of(batch)), capacity=3)
        delivery.push(numbered(range(5)))
        with structlog.testing.capture_logs() as logs:
            await asyncio.sleep(0.01)
        assert batches == [[2, 3, 4]]
        assert [(log["topic"], log["lost"]) for log in logs] == [("/count", 2)]

    asyncio.run(scenario())


def test_nothing_comes_after_the_end() -> None:
    batches: list[list[int]] = []

    async def scenario() -> Delivery:
        delivery = Delivery(asyncio.get_running_loop(), "/count", lambda batch: batches.append(numbers_of(batch)))
        delivery.push(numbered([1]))
        delivery.close()
        delivery.push(numbered([2]))
        await asyncio.sleep(0.01)
        return Delivery(asyncio.get_running_loop(), "/count", lambda batch: batches.append(numbers_of(batch)))

    late = asyncio.run(scenario())
    late.push(numbered([3]))  # The loop is closed by now.
    assert batches == []
