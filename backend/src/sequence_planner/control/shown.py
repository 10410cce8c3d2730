"""Whether a view tells more than the one before: a station at rest is not shown anew again and again."""

from __future__ import annotations

import time
from typing import Final

from sequence_planner.control.view import StationView

LONGEST: Final = 0.9  # seconds after which it is shown all the same: how many messages have come changes all the time


class Shown:
    """What was shown last."""

    def __init__(self) -> None:
        self._last: StationView | None = None
        self._since = 0.0  # on the clock of `time.monotonic`

    def is_news(self, view: StationView) -> bool:
        """Whether it is to be shown, which it then is: else only the time, and when messages came, are others."""
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
