"""What devices say that makes no sense: reported once for each cause, with how often and when.

Texts about the same thing differ in the values they name, so a cause is a text without them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

SHOWN = 10.0  # seconds for which a cause is shown after it was last seen, although what came since makes sense
MOST_CAUSES = 5  # of one place; what is seen beyond them counts as the last of these

_VALUES = re.compile(r"'[^']*'|\"[^\"]*\"|[-+]?\b(\d[\w.+-]*|nan|inf)\b")


@dataclass
class Report:
    """One cause. Times are on the clock of `time.monotonic`; `text` is what was said last."""

    text: str
    first: float
    last: float
    count: int = 1


class Reports:
    """All causes that are to be shown, by place: a topic, a service or an action."""

    def __init__(self) -> None:
        self._places: dict[str, dict[str, Report]] = {}
        self._troubled: set[str] = set()  # places where the last that came made no sense

    def note(self, place: str, text: str, now: float, lasting: bool = True) -> None:
        """Something made no sense; when `lasting`, it is shown until what comes makes sense again."""
        causes = self._places.setdefault(place, {})
        if lasting:
            self._troubled.add(place)
        cause = _VALUES.sub("…", text)
        if cause not in causes and len(causes) >= MOST_CAUSES:
            cause = max(causes, key=lambda each: causes[each].last)
        report = causes.get(cause)
        if report is None:
            causes[cause] = Report(text, now, now)
        else:
            report.text, report.last, report.count = text, now, report.count + 1

    def settle(self, place: str) -> None:
        """What came last makes sense."""
        self._troubled.discard(place)

    def current(self, now: float) -> Iterator[tuple[str, str, Report]]:
        """Each report with its place and a key for its cause; those that are long over are forgotten."""
        for place, causes in list(self._places.items()):
            for cause, report in list(causes.items()):
                if now - report.last > SHOWN and not (place in self._troubled and _is_last(report, causes)):
                    del causes[cause]
                else:
                    yield place, cause, report
            if not causes:
                del self._places[place]


def _is_last(report: Report, causes: dict[str, Report]) -> bool:
    return report.last == max(each.last for each in causes.values())
