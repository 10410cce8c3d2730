"""The thread that takes samples from cyclonedds.

DDS listeners run on the library's own threads, swallow exceptions and can fire before their reader is known. A wait set
has none of that: one thread sleeps until any reader has samples, takes them all and queues them for the event loop. A
guard condition wakes the thread when a reader joins or the transport closes.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from queue import Empty, SimpleQueue

import structlog
from cyclonedds.core import (
    DDSException,
    GuardCondition,
    InstanceState,
    ReadCondition,
    SampleState,
    ViewState,
    WaitSet,
)
from cyclonedds.domain import DomainParticipant
from cyclonedds.sub import DataReader
from cyclonedds.util import duration

from sequence_planner.ros.cyclone_network import release
from sequence_planner.ros.cyclone_types import RawSample
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.transport import Sample

_log = structlog.get_logger(__name__)

#: Samples taken in one call.
_CHUNK = 256

_UNREAD = ViewState.Any | InstanceState.Any | SampleState.NotRead


def take_all(reader: DataReader[RawSample]) -> Iterator[RawSample]:
    """Yield what waits in `reader`, without the notices that a publisher came or went, which carry no data."""
    while True:
        taken = reader.take(_CHUNK)
        yield from (sample for sample in taken if isinstance(sample, RawSample) and sample.sample_info.valid_data)
        if len(taken) < _CHUNK:
            return


class Receiver:
    """One thread that serves all subscriptions of a participant. Call its methods on the event loop's thread."""

    def __init__(self, participant: DomainParticipant, name: str) -> None:
        self._waitset = WaitSet(participant)
        self._wake = GuardCondition(participant)
        self._waitset.attach(self._wake)
        self._joining: SimpleQueue[tuple[str, DataReader[RawSample], Delivery]] = SimpleQueue()
        self._serving: list[tuple[str, DataReader[RawSample], Delivery, ReadCondition]] = []
        self._closing = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def add(self, topic: str, reader: DataReader[RawSample], delivery: Delivery) -> None:
        """Take the samples of `reader` from now on, and those that wait in it."""
        self._joining.put((topic, reader, delivery))
        self._wake.set(True)

    def close(self) -> None:
        """End the thread. What it has queued for the event loop is the deliveries' affair."""
        self._closing = True
        self._wake.set(True)
        self._thread.join()
        release(self._waitset)
        for _, _, _, condition in self._serving:
            release(condition)
        release(self._wake)

    def _run(self) -> None:
        while not self._closing:
            try:
                self._waitset.wait(duration(infinite=True))
                self._wake.take()
                self._admit()
                for topic, reader, delivery, _ in self._serving:
                    samples = list(take_all(reader))
                    received = time.monotonic()
                    delivery.push(
                        Sample(topic, sample.data, received, sample.sample_info.publication_handle)
                        for sample in samples
                    )
            except DDSException:
                _log.exception("DDS failed while receiving")
                time.sleep(1.0)  # If it lasts, the log fills slowly and the processor stays free.

    def _admit(self) -> None:
        while True:
            try:
                topic, reader, delivery = self._joining.get_nowait()
            except Empty:
                return
            condition = ReadCondition(reader, _UNREAD)
            self._serving.append((topic, reader, delivery, condition))
            self._waitset.attach(condition)
