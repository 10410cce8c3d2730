"""A log for modules of commands that seldom have something to say: structlog takes longer to import than they do."""

from __future__ import annotations

import sys


class LateLog:
    """As `structlog.get_logger`, but that nothing is imported before something is said."""

    def __init__(self, name: str) -> None:
        self._name = name

    def info(self, event: str, **values: object) -> None:
        """Say what goes on."""
        self._say("info", event, values)

    def warning(self, event: str, **values: object) -> None:
        """Say what somebody should look at."""
        self._say("warning", event, values)

    def _say(self, level: str, event: str, values: dict[str, object]) -> None:
        from sequence_planner.lean_structlog import structlog  # noqa: PLC0415

        if not structlog.is_configured():  # by a process with a log: what a command answers is on standard output
            structlog.configure(logger_factory=structlog.PrintLoggerFactory(sys.stderr))
        getattr(structlog.get_logger(self._name), level)(event, **values)
