"""Qualities of service: how samples of a topic are kept and delivered, and what two sides must agree on.

Publisher and subscriber each have one. A subscriber that asks for more than a publisher offers gets nothing from it,
and DDS tells both sides of that and of promises that are broken later.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

from sequence_planner.core.immutable import Immutable

Direction = Literal["publisher", "subscriber"]

#: Samples that wait for a process which itself waits for the processor.
READER_DEPTH = 1000

_KEYS = ("reliability", "durability", "depth", "deadline", "liveliness")
_MAX_DEPTH = 100_000


@dataclass(frozen=True)
class QualityOfService:
    """The way samples of a topic are kept and delivered, as ROS 2 has it.

    `reliable`: lost samples are sent again. `transient_local`: a late joiner gets the samples kept. `depth`: so many
    samples are kept. `deadline` (s): a sample comes at least so often. `liveliness` (s): a publisher shows that it is
    alive at least so often, which its middleware does for it. None means that nothing is promised or asked for.
    """

    RELIABLE: ClassVar[QualityOfService]  # reliable, volatile, keep last 10: commands and states
    SENSOR_DATA: ClassVar[QualityOfService]  # best effort, keep last 5: fast streams where only the newest counts
    LATCHED: ClassVar[QualityOfService]  # reliable, transient local, keep last 1: late joiners get the last sample
    CALLS: ClassVar[QualityOfService]  # as ROS 2's services have it, with room for many calls at a time

    reliable: bool = True
    transient_local: bool = False
    depth: int = 10
    deadline: float | None = None
    liveliness: float | None = None

    @classmethod
    def of(cls, written: str | Mapping[str, object]) -> QualityOfService:
        """Return the quality that a model writes as a name or as a mapping; raises ValueError saying what to write.

        Names are `reliable`, `sensor_data` and `latched`. A mapping has any of `reliability` (reliable, best_effort),
        `durability` (volatile, transient_local), `depth`, `deadline` and `liveliness` (both in s).
        """
        if isinstance(written, str):
            if written not in _NAMED:
                raise ValueError(f"{written!r} is not a quality of service: write one of {', '.join(_NAMED)}")
            return _NAMED[written]
        for key in written:
            if key not in _KEYS:
                raise ValueError(f"a quality of service has no {key!r}: it has {', '.join(_KEYS)}")
        return cls(
            reliable=_choice(written, "reliability", ("reliable", "best_effort")) == "reliable",
            transient_local=_choice(written, "durability", ("volatile", "transient_local")) == "transient_local",
            depth=_depth(written.get("depth", cls.depth)),
            deadline=_seconds(written, "deadline"),
            liveliness=_seconds(written, "liveliness"),
        )

    @property
    def of_a_reader(self) -> QualityOfService:
        """The quality of a reader that loses nothing while its process is busy; its depth is nobody else's affair."""
        return replace(self, depth=max(self.depth, READER_DEPTH)) if self.reliable else self

    def __str__(self) -> str:
        """The quality as a model writes it."""
        for name, quality in _NAMED.items():
            if quality == self:
                return name
        parts = [
            f"reliability: {'reliable' if self.reliable else 'best_effort'}",
            f"durability: {'transient_local' if self.transient_local else 'volatile'}",
            f"depth: {self.depth}",
            *(f"{key}: {value:g}" for key in ("deadline", "liveliness") if (value := getattr(self, key)) is not None),
        ]
        return "{" + ", ".join(parts) + "}"


QualityOfService.RELIABLE = QualityOfService()
QualityOfService.SENSOR_DATA = QualityOfService(reliable=False, depth=5)
QualityOfService.LATCHED = QualityOfService(transient_local=True, depth=1)
QualityOfService.CALLS = QualityOfService(depth=READER_DEPTH)

_NAMED = {
    "reliable": QualityOfService.RELIABLE,
    "sensor_data": QualityOfService.SENSOR_DATA,
    "latched": QualityOfService.LATCHED,
}


class QualityEvent(Immutable):
    """A message of the middleware about the quality of service of one of our own endpoints.

    `incompatible`: a peer was found that does not agree, so nothing passes between the two. `deadline`: no sample came
    in time, or we sent none. `liveliness`: a publisher has stopped showing that it is alive. `count` is how often this
    has happened to the endpoint, and `text` says it in words, with both sides where there are two.
    """

    topic: str
    direction: Direction
    kind: Literal["incompatible", "deadline", "liveliness"]
    count: int
    text: str


def disagreements(offered: QualityOfService, wanted: QualityOfService) -> list[str]:
    """Return in words, each with both sides, where a subscriber wants more than a publisher offers."""
    found = []
    if wanted.reliable and not offered.reliable:
        found.append("reliability: the publisher offers best_effort, the subscriber wants reliable")
    if wanted.transient_local and not offered.transient_local:
        found.append("durability: the publisher offers volatile, the subscriber wants transient_local")
    for name, offer, want in (
        ("deadline", offered.deadline, wanted.deadline),
        ("liveliness", offered.liveliness, wanted.liveliness),
    ):
        if want is not None and (offer is None or offer > want):
            found.append(f"{name}: the publisher offers {_every(offer)}, the subscriber wants {_every(want)}")
    return found


def _every(seconds: float | None) -> str:
    return "none" if seconds is None else f"{seconds:g} s"


def _choice(written: Mapping[str, object], key: str, options: tuple[str, str]) -> str:
    value = written.get(key, options[0])
    if value not in options:
        raise ValueError(f"{key} is {value!r}: write {' or '.join(options)}")
    return str(value)


def _depth(value: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= _MAX_DEPTH:
        raise ValueError(f"depth is {value!r}: write how many samples are kept, from 1 to {_MAX_DEPTH}")
    return value


def _seconds(written: Mapping[str, object], key: str) -> float | None:
    value = written.get(key)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or value < 0.001:
        raise ValueError(f"{key} is {value!r}: write a time in seconds, at least 0.001")
    return float(value)
