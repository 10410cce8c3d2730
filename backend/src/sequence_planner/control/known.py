"""What is known of a station from before the controller was started."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sequence_planner.control.alarming.keeping import PutAside
from sequence_planner.control.conduct import Beginning
from sequence_planner.control.view import BeliefView


@dataclass(frozen=True)
class Known:
    """What came back from the journal: estimates and why they were believed, outputs, service, and alarms put aside.

    `left_out` says what did not come back, and why; `produced` that production had been started.
    """

    beginning: Beginning | None = None
    aside: Mapping[str, PutAside] = field(default_factory=dict)
    beliefs: Mapping[str, BeliefView] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    produced: bool = False
