"""Builder of the station view: the live document of a running station, and detection of changes."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, Protocol, runtime_checkable

from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.controller.views.station import StationIdentity, StationView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.synthesis.guards import SupervisorGuard

# Whether a view tells more than the one before: a station at rest is not shown anew again and again.

LONGEST: Final = 0.9  # seconds after which it is shown all the same: how many messages have come changes all the time


class Shown:
    """The view that was shown last."""

    def __init__(self) -> None:
        self._last: StationView | None = None
        self._since = 0.0  # on the clock of `time.monotonic`

    def is_news(self, view: StationView) -> bool:
        """Return whether it is to be shown, which it then is: else only the time, and when messages came, are
        others.
        """
        last, now = self._last, time.monotonic()
        if last is not None and now - self._since < LONGEST and _lasting(view) == _lasting(last):
            return False
        self.note(view)
        return True

    def note(self, view: StationView) -> None:
        """It is shown, news or not."""
        self._last, self._since = view, time.monotonic()


def _lasting(view: StationView) -> StationView:
    topics = {name: each.model_copy(update={"last": None, "messages": 0}) for name, each in view.topics.items()}
    return view.model_copy(update={"time": 0.0, "topics": topics})


# The document a running station shows, built from all that is known of it at one moment.


@runtime_checkable
class ShowsPart(Protocol):
    """A feature that has a part of the document."""

    def view_part(self, moment: Timestamp) -> Mapping[str, object]:
        """Members of `StationView` as they are now."""


class ViewBuilder:
    """Builds views of the parts that features have."""

    def __init__(self, identity: StationIdentity, execution: Executor) -> None:
        self._identity = identity
        self._execution = execution
        self._features: Sequence[ShowsPart] = ()
        self.analysis: AnalysisDocument | None = None
        self.guards: Mapping[str, SupervisorGuard] = {}  # that the supervisor adds, as far as they are known

    def show(self, features: Iterable[object]) -> None:
        """Take the parts of those that have one, in this order."""
        self._features = [feature for feature in features if isinstance(feature, ShowsPart)]

    def know(self, analysis: AnalysisDocument, guards: Mapping[str, SupervisorGuard] | None) -> None:
        """Take note of what synthesis has found beside the supervisor, to be shown."""
        self.analysis, self.guards = analysis, guards or {}

    def now(self) -> StationView:
        """The whole document as it is now."""
        moment = Timestamp.now()
        parts: dict[str, Any] = {}
        for feature in self._features:
            parts |= feature.view_part(moment)
        return StationView(
            station=self._identity,
            tick=self._execution.ticks,
            time=moment.epoch,
            revision=self._execution.revision,
            analysis=self.analysis,
            standby=None,
            deployment=None,
            **parts,
        )
