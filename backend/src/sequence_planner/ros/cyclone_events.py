"""What cyclonedds says about qualities of service: peers that do not agree, and promises that were not kept.

Each endpoint has a status for each of these. A thread of its own sleeps until any of them changes, which is rare, so
the thread that takes samples has nothing to do with it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import Literal

import structlog
from cyclonedds.core import DDSException, DDSStatus, GuardCondition, WaitSet
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.util import duration

from sequence_planner.ros.cyclone_network import release
from sequence_planner.ros.cyclone_types import RawSample
from sequence_planner.ros.quality import QualityOfService

_log = structlog.get_logger(__name__)

_OF_READERS = DDSStatus.RequestedIncompatibleQos | DDSStatus.RequestedDeadlineMissed | DDSStatus.LivelinessChanged
_OF_WRITERS = DDSStatus.OfferedIncompatibleQos | DDSStatus.OfferedDeadlineMissed | DDSStatus.LivelinessLost

#: Names of policies by their number in the DDS specification.
_POLICIES = {2: "durability", 4: "deadline", 8: "liveliness", 11: "reliability"}


@dataclass(frozen=True)
class Change:
    """A change of one endpoint's status; `detail` names the policy, where one was not agreed on, or says what it is."""

    topic: str
    kind: Literal["incompatible", "deadline", "liveliness"]
    count: int
    detail: str


@dataclass(frozen=True)
class Watched:
    """One of our own endpoints and its quality of service."""

    topic: str
    quality: QualityOfService
    endpoint: DataReader[RawSample] | DataWriter[RawSample]


class EventWatch:
    """One thread that watches all endpoints of a participant, and calls `on_change` on that thread."""

    def __init__(self, participant: DomainParticipant, name: str, on_change: Callable[[Watched, Change], None]) -> None:
        self._on_change = on_change
        self._waitset = WaitSet(participant)
        self._wake = GuardCondition(participant)
        self._waitset.attach(self._wake)
        self._joining: SimpleQueue[Watched] = SimpleQueue()
        self._watched: list[Watched] = []
        self._closing = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def add(self, watched: Watched) -> None:
        """Watch an endpoint from now on; what has happened to it already is told at once."""
        reading = isinstance(watched.endpoint, DataReader)
        watched.endpoint.set_status_mask(_OF_READERS if reading else _OF_WRITERS)
        self._joining.put(watched)
        self._wake.set(True)

    def close(self) -> None:
        """End the thread."""
        self._closing = True
        self._wake.set(True)
        self._thread.join()
        release(self._waitset)
        release(self._wake)

    def _run(self) -> None:
        while not self._closing:
            try:
                self._waitset.wait(duration(infinite=True))
                self._wake.take()
                self._admit()
                for watched in self._watched:
                    for change in _changes(watched):
                        self._on_change(watched, change)
            except DDSException:
                _log.exception("DDS failed while watching qualities of service")
                time.sleep(1.0)  # If it lasts, the log fills slowly and the processor stays free.

    def _admit(self) -> None:
        while True:
            try:
                watched = self._joining.get_nowait()
            except Empty:
                return
            self._watched.append(watched)
            self._waitset.attach(watched.endpoint)


def _changes(watched: Watched) -> list[Change]:
    """Return what has changed since the last time, which resets it."""
    topic, quality, endpoint = watched.topic, watched.quality, watched.endpoint
    found = []
    if isinstance(endpoint, DataReader):
        incompatible = endpoint.get_requested_incompatible_qos_status()
        missed = endpoint.get_requested_deadline_missed_status()
        alive = endpoint.get_liveliness_changed_status()
        if alive.not_alive_count_change > 0:
            detail = f"a publisher has not shown for {quality.liveliness or 0:g} s that it is alive"
            found.append(Change(topic, "liveliness", alive.not_alive_count, detail))
        done = "received"
    else:
        incompatible = endpoint.get_offered_incompatible_qos_status()
        missed = endpoint.get_offered_deadline_missed_status()
        lost = endpoint.get_liveliness_lost_status()
        if lost.total_count_change > 0:
            detail = f"this publisher has not shown for {quality.liveliness or 0:g} s that it is alive"
            found.append(Change(topic, "liveliness", lost.total_count, detail))
        done = "published"
    if incompatible.total_count_change > 0:
        policy = _POLICIES.get(incompatible.last_policy_id, f"policy {incompatible.last_policy_id}")
        found.append(Change(topic, "incompatible", incompatible.total_count, policy))
    if missed.total_count_change > 0:
        detail = f"no sample {done} within its deadline of {quality.deadline or 0:g} s"
        found.append(Change(topic, "deadline", missed.total_count, detail))
    return found
