"""Bytes and definitions that somebody made to do harm: they are refused, within bounded time and memory."""

from __future__ import annotations

import asyncio
import gc
import math
import threading
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from hypothesis import given
from ros_networks import standard

from core.choices import Choices, made_by
from sequence_planner.ros.delivery import CAPACITY, Delivery
from sequence_planner.ros.transport import Sample
from sequence_planner.ros.types.definitions import FieldType
from sequence_planner.ros.types.errors import MalformedMessageError, MessageDefinitionError
from sequence_planner.ros.types.messages import MessageRegistry
from support.examples import examples
from support.waiting import until_async

SERVICES = [standard().service(name) for name in standard().service_names()]
TYPES = [
    *standard().type_names(),
    *(name for service in SERVICES for name in (service.request, service.response, service.event)),
    *(f"example_interfaces/action/Fibonacci_{part}" for part in ("FeedbackMessage", "SendGoal_Request")),
]
HOSTILE = [b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\0\x80", b"\0\0\0\0", b"\xc3\x28\xc3\x28", b"\0\0\xc0\x7f"]


@contextmanager
def memory_stays_below(limit: int) -> Iterator[None]:
    """Measure what is allocated at most at any time, in bytes."""
    gc.collect()
    tracemalloc.start()
    try:
        yield
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < limit, f"{peak} bytes allocated"


def value_of(field: FieldType, choices: Choices) -> object:
    def single() -> object:
        if field.kind == "message":
            return values_of(field.type_name, choices)
        if field.kind == "string":
            return choices.pick(["", "a", "åäö", "abcdefgh"])[: field.max_length or None]
        if field.kind == "bool":
            return choices.chance(2)
        if field.range is not None:
            return choices.pick([field.range[0], field.range[1], 0, 1])
        return choices.pick([0.0, 1.5, math.nan, -math.inf])

    if field.array is None:
        return single()
    count = choices.number(0, min(2, field.max_items or 2)) if field.array == "sequence" else field.array
    return [single() for _ in range(count)]


def values_of(type_name: str, choices: Choices) -> dict[str, object]:
    return {name: value_of(field, choices) for name, field in standard().fields(type_name).items()}


def mutated(choices: Choices) -> tuple[str, bytes]:
    """The bytes of a message, with some of them cut off, added or overwritten."""
    type_name = choices.pick(TYPES)
    data = bytearray(standard().encode(type_name, values_of(type_name, choices)))
    for _ in range(choices.number(1, 3)):
        place = choices.number(0, len(data))
        match choices.number(0, 3):
            case 0:
                aligned = place & ~3
                data[aligned : aligned + 4] = choices.pick(HOSTILE)
            case 1:
                del data[place:]
            case 2:
                data += bytes(choices.number(1, 9))
            case _:
                data[place : place + 1] = bytes([choices.number(0, 255)])
    return type_name, bytes(data)


@given(made_by(mutated))
@examples(600)
def test_mutated_messages_are_read_or_malformed(case: tuple[str, bytes]) -> None:
    type_name, data = case
    try:
        values = standard().decode(type_name, data)
    except MalformedMessageError as error:
        assert error.type_name == type_name
    else:
        # What is read can be written again, unless it has what no sender writes: a NUL within a string.
        if b"\0" not in "".join(texts_of(values)).encode():
            standard().encode(type_name, values)


def texts_of(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for inner in value.values():
            yield from texts_of(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from texts_of(inner)


@pytest.mark.parametrize("claim", HOSTILE[:3])
def test_a_hundred_bytes_that_claim_gigabytes_cost_nothing(claim: bytes) -> None:
    for type_name in TYPES:  # Code for a type is made on first use, which is not what is measured.
        standard().decode(type_name, standard().encode(type_name, {}))
    started = time.process_time()
    with memory_stays_below(2**20):
        for type_name in TYPES:
            for place in range(4, 100, 4):
                data = b"\0\1\0\0" + bytes(place - 4) + claim + bytes(96 - place)
                try:
                    standard().decode(type_name, data)
                except MalformedMessageError:
                    continue
    each = (time.process_time() - started) / (len(TYPES) * 24)
    assert each < 0.01  # seconds, memory tracing included


def test_a_sequence_of_empty_messages_costs_no_more_than_its_bytes(tmp_path: Path) -> None:
    for name, text in {"Nothing": "", "Many": "Nothing[] all\n"}.items():
        (tmp_path / "cell_msgs" / "msg").mkdir(parents=True, exist_ok=True)
        (tmp_path / "cell_msgs" / "msg" / f"{name}.msg").write_text(text)
    registry = MessageRegistry.from_folder(tmp_path)
    data = b"\0\1\0\0" + (50_000).to_bytes(4, "little") + bytes(50_000)
    with memory_stays_below(32 * 2**20):
        assert registry.decode("cell_msgs/msg/Many", data) == {"all": [{}] * 50_000}
    with memory_stays_below(2**20), pytest.raises(MalformedMessageError):
        registry.decode("cell_msgs/msg/Many", b"\0\1\0\0" + (2**32 - 1).to_bytes(4, "little") + bytes(92))


def test_bounds_hold_for_what_is_received(tmp_path: Path) -> None:
    for folder, bound in (("ours", "<=3"), ("theirs", "")):
        path = tmp_path / folder / "cell_msgs" / "msg" / "Tag.msg"
        path.parent.mkdir(parents=True)
        path.write_text(f"string{bound} name\nuint8[{bound}] code\nstring{bound}[] more\n")
    ours, theirs = (MessageRegistry.from_folder(tmp_path / folder) for folder in ("ours", "theirs"))
    tag = "cell_msgs/msg/Tag"
    values = {"name": "abc", "code": [1, 2, 3], "more": ["abc"]}
    assert ours.decode(tag, theirs.encode(tag, values)) == values
    for name, value in (("name", "abcd"), ("code", [1, 2, 3, 4]), ("more", ["a", "abcd"])):
        with pytest.raises(MalformedMessageError, match="at most 3"):
            ours.decode(tag, theirs.encode(tag, values | {name: value}))


def test_not_a_number_is_received_as_it_is() -> None:
    nan = b"\0\1\0\0" + b"\0\0\0\0\0\0\xf8\x7f"
    received = standard().decode("std_msgs/msg/Float64", nan)["data"]
    assert isinstance(received, float)
    assert math.isnan(received)


def test_definitions_without_an_end_in_sight_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "cell_msgs" / "msg"
    folder.mkdir(parents=True)
    for number in range(2000):
        (folder / f"M{number}.msg").write_text(f"M{number + 1} inner\n")
    (folder / "M2000.msg").write_text("bool end\n")
    with pytest.raises(MessageDefinitionError, match="more than 64 messages within one another"):
        MessageRegistry.from_folder(tmp_path)


def test_a_flood_at_10_khz_keeps_memory_flat() -> None:
    """The loop stands still half of the time; what waits is bounded in number and in bytes."""
    size, seconds = 1000, 3

    async def scenario() -> None:
        heard = 0

        def hear(batch: object) -> None:
            nonlocal heard
            assert isinstance(batch, tuple)
            heard += len(batch)
            time.sleep(0.05)  # a loop that is busy elsewhere

        delivery = Delivery(asyncio.get_running_loop(), "/flood", hear)

        def flood() -> None:
            for _ in range(seconds * 100):
                delivery.push(Sample("/flood", bytes(size), 0.0) for _ in range(100))
                time.sleep(0.01)

        thread = threading.Thread(target=flood)
        thread.start()
        await asyncio.sleep(0.5)
        with memory_stays_below(4 * CAPACITY * size // 10):
            await asyncio.to_thread(thread.join)
        await until_async(lambda: heard == seconds * 10_000, "all samples are heard")

    asyncio.run(scenario())


def test_large_samples_that_wait_are_bounded_in_bytes() -> None:
    async def scenario() -> None:
        batches: list[int] = []
        loop = asyncio.get_running_loop()
        delivery = Delivery(loop, "/camera", lambda batch: batches.append(len(batch)), capacity_bytes=10_000_000)
        with memory_stays_below(13_000_000):
            for _ in range(100):
                delivery.push([Sample("/camera", bytes(1_000_000), 0.0)])
        await asyncio.sleep(0.01)
        delivery.push([Sample("/camera", bytes(20_000_000), 0.0)])  # The newest comes, however large.
        await asyncio.sleep(0.01)
        assert batches == [10, 1]

    asyncio.run(scenario())
