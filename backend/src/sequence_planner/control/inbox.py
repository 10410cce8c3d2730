"""What has been heard and not been looked at yet, bounded: a topic that floods the station does not hold it up."""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Iterator, Sequence

from sequence_planner.control.bad_input import Reports
from sequence_planner.control.feeds import one_per_topic
from sequence_planner.ros.transport import Sample

MOST_WAITING = 500  # samples of one topic; then the oldest are passed over
LONGEST = 0.02  # seconds for which one look at what waits may go on


class Inbox:
    """Samples in the order in which they were received. What is passed over is noted in `reports`."""

    def __init__(self, reports: Reports) -> None:
        self._reports = reports
        self._waiting: deque[Sample] = deque()

    def __bool__(self) -> bool:
        return bool(self._waiting)

    def put(self, samples: Sequence[Sample]) -> None:
        """Samples have come."""
        self._waiting.extend(samples)

    def parts(self) -> Iterator[list[Sample]]:
        """What waits, in parts of which no topic has more than one; the rest stays when that takes too long."""
        end = time.monotonic() + LONGEST
        if len(self._waiting) > MOST_WAITING:
            self._pass_over(time.monotonic())
        waiting, self._waiting = self._waiting, deque()
        parts = one_per_topic(waiting)
        for part in parts:
            yield part
            if time.monotonic() > end:
                break
        self._waiting.extendleft(reversed([sample for part in parts for sample in part]))

    def _pass_over(self, now: float) -> None:
        """Only the newest samples of each topic stay."""
        surplus = {
            topic: count - MOST_WAITING
            for topic, count in Counter(sample.topic for sample in self._waiting).items()
            if count > MOST_WAITING
        }
        kept: deque[Sample] = deque()
        left = dict(surplus)
        for sample in self._waiting:
            if left.get(sample.topic, 0):
                left[sample.topic] -= 1
            else:
                kept.append(sample)
        self._waiting = kept
        for topic, count in surplus.items():
            text = f"messages come faster than they can be looked at: {count} were passed over for newer ones"
            self._reports.note(topic, text, now, lasting=False)
