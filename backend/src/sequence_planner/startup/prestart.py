"""The tasks that the launcher has other processes do as a station begins.

It lives as long as the station, and has no more use for models and databases then: what reads them would take several
times as long to import as all that it needs, and as much memory. So a process does that which is soon over.
"""

from __future__ import annotations

from dataclasses import dataclass
from multiprocessing.connection import Pipe
from pathlib import Path
from typing import Any, Final

from sequence_planner.forking.starting import start
from sequence_planner.server.settings import Endpoint, SettingsError

_FUNCTIONS: Final = "sequence_planner.startup.prestart_tasks"


@dataclass(frozen=True)
class StationBeginning:
    """The station that shall begin, see `launcher.Launch`; where it is `shared` several stations have that database."""

    model: Path
    database: str
    new: bool
    shared: bool


@dataclass(frozen=True)
class Begun:
    """The lines `said` to people, and why the station cannot begin, if it is `refused`."""

    said: tuple[str, ...] = ()
    refused: str | None = None


def begin(what: StationBeginning) -> Begun:
    """See whether the model can be used, or else be repaired, and have the database ready. Raises `SettingsError`."""
    begun: Begun = _asked("begin", what.model, what)
    return begun


def first_start(model: Path, database: str, endpoint: Endpoint, *, at_terminal: bool) -> str | None:
    """Return how the first administrator gets in, None when there is one already. Raises `SettingsError`.

    The link is a secret for whoever sits `at_terminal`; where there is none the output is kept somewhere, such as in a
    journal that others read, and then it is only said how to get it.
    """
    said: str | None = _asked("first_start", model, model, database, endpoint, at_terminal)
    return said


def _asked(function: str, model: Path, *arguments: object) -> Any:  # noqa: ANN401 (what each of them sends)
    """Return what a process of its own answers. Raises `SettingsError` where it does not."""
    ours, theirs = Pipe(duplex=False)
    with ours:
        working = start(f"{_FUNCTIONS}:{function}", *arguments, name="beginning", connection=theirs)
        try:
            answer = ours.recv()
        except EOFError:
            text = f"{model}: the process that reads it has ended without an answer; is memory short?"
            raise SettingsError(text) from None
        working.wait()
    return answer
