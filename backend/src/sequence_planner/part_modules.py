"""What the processes of a station import: the fork server does so once for all of them, while the launcher starts.

What is needed first stands first: a process is forked as soon as all is imported that it needs. The server has most to
import that nobody else needs, so what it does without comes after it. What a station needs only when it runs is
imported `LATER`.
"""

from __future__ import annotations

from typing import Final

LOGS: Final = ("sequence_planner.lean_structlog",)
MESSAGES: Final = ("sequence_planner.ros.codec_ready",)
BEGINNING: Final = ("sequence_planner.first_things",)
_CONTROLLING: Final = ("sequence_planner.cli.controlling",)
CONTROLLER: Final = (*_CONTROLLING, *MESSAGES)
EMULATOR: Final = ("sequence_planner.cli.emulating", *MESSAGES)
NETWORK: Final = ("sequence_planner.ros.cyclone",)  # of who joins it by that
SERVER: Final = ("sequence_planner.cli.serving",)
LATER: Final = tuple(
    f"sequence_planner.{each}"
    for each in (
        "planning.worker",
        "planning.racing.lane",
        "analysis.never_together_process",
        "planning.advice.worker",
        "planning.reasons.diagnoser",
        "mes.sequencing.process",
        "history.worker",
        "workshop.checking",
        "workshop.tasks",
        "workshop.editing_worker",
        "workshop.language_worker",
        "workshop.pipelines.worker",
    )
)
NOW: Final = (*LOGS, *BEGINNING, *_CONTROLLING, *SERVER, *EMULATOR)
