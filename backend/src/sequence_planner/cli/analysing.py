"""What synthesis finds of a model that a command is given: kept from an earlier command, or found in a process."""

from __future__ import annotations

import asyncio
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import Annotated

import typer

from sequence_planner.analysis.analysis import COUNTING, Analysis
from sequence_planner.analysis.document import (
    AnalysisDocument,
    document_of,
    read_supervisor,
    supervisor_document,
)
from sequence_planner.analysis.process import SynthesisEndedError, analysing
from sequence_planner.analysis.store import Kept, keep, kept
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.cli.options import refuse
from sequence_planner.synthesis.supervision import synthesise

Deadline = Annotated[
    float, typer.Option("--deadline", min=0.1, max=86_400, help="Seconds that synthesis and its checks may take.")
]
USUAL_DEADLINE = 120.0
_QUIET = 1.0  # seconds before anything is said about what is being done


@dataclass(frozen=True)
class Found:
    """What was found. `unfinished` says why that is not all."""

    document: AnalysisDocument
    supervisor: Supervisor | None
    unfinished: str | None


def analysed(automaton: Automaton, deadline: float = USUAL_DEADLINE, counts: bool = False) -> Found:
    """What is found of `automaton` within `deadline` seconds, with numbers of states only if `counts` asks for them.

    A terminal's standard error is told what goes on.
    """
    known = kept(automaton)
    if known is not None and not (counts and known.analysis.pending):
        supervisor = None if known.supervisor is None else read_supervisor(automaton, known.supervisor)
        return Found(known.analysis, supervisor, None)
    analysis, unfinished = asyncio.run(_heard(automaton, deadline, counts))
    document = document_of(automaton, analysis)
    if analysis.pending in (None, COUNTING):
        supervisor_kept = None if analysis.supervisor is None else supervisor_document(analysis.supervisor)
        keep(automaton, Kept(analysis=document, supervisor=supervisor_kept))
    return Found(document, analysis.supervisor, unfinished)


def supervisor_of(automaton: Automaton, deadline: float = USUAL_DEADLINE) -> Supervisor:
    """The supervisor of `automaton`, kept or computed here and now. Ends the command if that takes too long.

    Raises `SynthesisError` if there is none.
    """
    known = kept(automaton)
    if known is not None and known.supervisor is not None:
        return read_supervisor(automaton, known.supervisor)
    try:
        with _within(deadline):
            return synthesise(automaton)
    except TimeoutError:
        refuse(f"the safe states could not be computed within {deadline:g} s: let fewer variables bear on them")
    except MemoryError:
        refuse("the safe states have outgrown the memory set aside for them: let fewer variables bear on them")


@contextmanager
def _within(seconds: float) -> Iterator[None]:
    """Raise `TimeoutError` in the block after so many seconds; in the main thread only."""

    def ring(number: int, frame: FrameType | None) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


async def _heard(automaton: Automaton, deadline: float, counts: bool) -> tuple[Analysis, str | None]:
    found = Analysis("the safe states")
    began = time.monotonic()
    try:
        async with asyncio.timeout(deadline), analysing(automaton) as finding:
            async for found in finding:
                _tell(found, time.monotonic() - began)
                if found.pending == COUNTING and not counts:
                    break
    except TimeoutError:
        return found, f"{found.pending} could not be computed within {deadline:g} s: allow more with --deadline"
    except SynthesisEndedError as ended:
        return found, f"{found.pending} could not be computed: {ended}"
    return found, None


def _tell(found: Analysis, seconds: float) -> None:
    if sys.stderr.isatty() and seconds > _QUIET and found.pending is not None:
        typer.echo(f"{seconds:5.1f} s: computing {found.pending}", err=True)
