"""What is known of a station from before the controller was started."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from sequence_planner.control.alarming.keeping import PutAside
from sequence_planner.control.conduct import Beginning
from sequence_planner.control.control_view import ControlView
from sequence_planner.control.view import BeliefView, DeploymentView
from sequence_planner.control.vocabulary import Mode


@dataclass(frozen=True)
class Known:
    """What came back from the journal: estimates and why they were believed, outputs, service, and alarms put aside.

    `left_out` says what did not come back, and why; `produced` that production had been started. `control` is who is
    in control, and `deployment` the last one, where the controller begins because of one. `halted` says why the station
    begins at rest, where that is not what the journal says.
    """

    beginning: Beginning | None = None
    aside: Mapping[str, PutAside] = field(default_factory=dict)
    beliefs: Mapping[str, BeliefView] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    produced: bool = False
    control: ControlView | None = None
    deployment: DeploymentView | None = None
    halted: str | None = None

    @property
    def was_at_work(self) -> bool:
        """Whether operations were executed, and nobody had told the station otherwise since."""
        return self.produced and self.beginning is not None and self.beginning.mode is Mode.AUTOMATIC
