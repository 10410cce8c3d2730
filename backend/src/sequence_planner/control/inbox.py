"""What has been heard and not been looked at yet, bounded: a topic that floods the station does not hold it up."""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Iterator, Sequence

from sequence_planner.control.bad_input import Reports
from sequence_planner.control.feeds import one_per_topic
from sequence_planner.ros.transport import Sample

MOST_WAITING = 500  # samples of one topic; then the oldest are passed over
AGAIN = 1.0  # seconds after which the same is said anew, and not once more
LONGEST = 0.02  # seconds for which one look at what waits may go on


class Inbox:
    """Samples in the order in which they were received. What is passed over is noted in `reports`."""

    def __init__(self, reports: Reports) -> None:
        self._reports = reports
        self._waiting: deque[Sample] = deque()
        self._last: dict[str, Sample] = {}

    def __bool__(self) -> bool:
        return bool(self._waiting)

    def put(self, samples: Sequence[Sample]) -> bool:
        """Samples have come; whether one of them is to be looked at now, and not only at the next look.

        It is not where a topic says again and again what it has said: that tells no more than that it is alive.
        """
        self._waiting.extend(samples)
        news = False
        for sample in samples:
            last, self._last[sample.topic] = self._last.get(sample.topic), sample
            same = last is not None and (last.data, last.trouble) == (sample.data, sample.trouble)
            news = news or not same or last is None or sample.received - last.received > AGAIN
        return news

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
