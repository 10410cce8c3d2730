"""The imports of a station's processes: the fork server does them once for all, while the launcher starts.

What is needed first stands first: a process is forked as soon as all is imported that it needs. The server has most to
import that nobody else needs, so what it does without comes after it. What a station needs only when it runs is
imported `LATER`.
"""

from __future__ import annotations

from typing import Final

LOGS: Final = ("sequence_planner.core.lean_structlog",)
MESSAGES: Final = ("sequence_planner.ros.types.codec_ready",)
BEGINNING: Final = ("sequence_planner.startup.prestart_tasks",)
_CONTROLLING: Final = ("sequence_planner.cli.station.controller",)
CONTROLLER: Final = (*_CONTROLLING, *MESSAGES)
EMULATOR: Final = ("sequence_planner.cli.station.simulate", *MESSAGES)
NETWORK: Final = ("sequence_planner.ros.transports.cyclonedds",)  # of who joins it by that
SERVER: Final = ("sequence_planner.cli.station.run",)
LATER: Final = tuple(
    f"sequence_planner.{each}"
    for each in (
        "planning.portfolio.worker",
        "planning.portfolio.race",
        "analysis.mutual_exclusion",
        "planning.recovery.worker",
        "planning.diagnoser",
        "mes.scheduling.scheduler",
        "history.worker",
        "editor.checks",
        "editor.editing_worker",
        "editor.language_worker",
        "editor.pipelines.worker",
    )
)
NOW: Final = (*LOGS, *BEGINNING, *_CONTROLLING, *SERVER, *EMULATOR)
