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

    def error(self, event: str, **values: object) -> None:
        """Say what has failed."""
        self._say("error", event, values)

    def _say(self, level: str, event: str, values: dict[str, object]) -> None:
        from sequence_planner.core.lean_structlog import structlog  # noqa: PLC0415

        log = structlog.get_logger(self._name)
        if not structlog.is_configured():  # by a process with a log: a command answers, and warns beside its answer
            only_warnings = structlog.make_filtering_bound_logger("warning")
            log = structlog.wrap_logger(structlog.PrintLogger(sys.stderr), wrapper_class=only_warnings)
        getattr(log, level)(event, **values)
