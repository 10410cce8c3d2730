"""What happened in the world, told by nobody but the world."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

WRONG = ("collision", "dropped", "wrong", "over-torque", "on air")  # an event with one of these words must never be


@dataclass
class Verdict:
    """Events in their order, each with the seconds of the world at which it was."""

    events: list[tuple[float, str]] = field(default_factory=list)

    def note(self, now: float, event: str) -> None:
        """Take down an event."""
        self.events.append((round(now, 3), event))

    @property
    def wrong(self) -> list[str]:
        """The events that must never be."""
        return [event for _, event in self.events if any(word in event for word in WRONG)]

    @property
    def counted(self) -> Counter[str]:
        """How often each event was."""
        return Counter(event for _, event in self.events)
