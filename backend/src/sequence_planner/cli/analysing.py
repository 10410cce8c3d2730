"""Analysis results for commands: from the cache or a worker process, and printed as findings."""

from __future__ import annotations

import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Annotated

import typer

from sequence_planner.analysis.analysis import COUNTING, FINDINGS, GUARDS, SAFE, Analysis, QuestionCounts
from sequence_planner.analysis.report import AnalysisDocument, FindingDocument, TraceDocument, document_of
from sequence_planner.analysis.store import key, known_supervisor, name_key, read, write
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.cli.options import FINDINGS as FOUND
from sequence_planner.cli.options import refuse
from sequence_planner.core.numerals import counted
from sequence_planner.process.memory_limit import USUAL

if TYPE_CHECKING:
    from sequence_planner.analysis.checks.connections import Connections
    from sequence_planner.analysis.checks.evidence import Evidence
    from sequence_planner.analysis.checks.rules import CheckProgress
    from sequence_planner.analysis.checks.warning import ModelWarning

# What is found of a model that a command is given: kept from an earlier command, or found in a process.

Deadline = Annotated[
    float,
    typer.Option("--deadline", min=0.1, max=86_400, help="Seconds that it may take to find out about the model."),
]
USUAL_DEADLINE = 120.0
_COUNTING = 120_000_000  # nodes, see `synthesis.transition_relation`: ten seconds or so, whatever the deadline is
_QUIET = 1.0  # seconds before anything is said about what is being done


@dataclass(frozen=True)
class Limits:
    """The number of seconds it may take, from the moment these are made, and of GB of memory."""

    deadline: float = USUAL_DEADLINE
    memory: float = USUAL
    began: float = field(default_factory=time.monotonic)

    @property
    def left(self) -> float:
        """So many seconds are left, 0 at least."""
        return max(0.0, self.began + self.deadline - time.monotonic())


@dataclass(frozen=True)
class Found:
    """The findings of an analysis. `unfinished` says why that is not all; `suspicious` is what checks that need no
    synthesis found, where they were asked for.
    """

    document: AnalysisDocument
    questions: QuestionCounts | None = None
    unfinished: str | None = None
    suspicious: tuple[ModelWarning, ...] = ()


def analysed(automaton: Automaton, limits: Limits, counts: bool = False) -> Found:
    """Return what synthesis finds of `automaton` within `limits`, with numbers of states only if `counts` asks for
    them.

    A terminal's standard error is told what goes on.
    """
    unwanted = frozenset[str]() if counts else frozenset({COUNTING})
    known = _kept(automaton, unwanted)
    if known is not None:
        return known
    from sequence_planner.analysis.finding import analyses, without_numbers  # noqa: PLC0415

    evidence = _evidence(automaton) if counts else None
    work = (analyses, automaton, _COUNTING, True, True, evidence) if counts else (without_numbers, automaton)
    return _found(automaton, limits, _Hearing(work, unwanted), far=counts)


def guarded(automaton: Automaton, names: frozenset[str], limits: Limits) -> Found:
    """The guards that the supervisor adds to the abilities of these names, found within `limits`, if not kept."""
    known = _kept(automaton, {COUNTING})
    if known is not None:
        return known
    from sequence_planner.analysis.finding import guards_of  # noqa: PLC0415

    supervisor = known_supervisor(automaton)
    hearing = _Hearing((guards_of, automaton, names, supervisor), {COUNTING})
    unfinished = hearing.hear(limits)
    found = hearing.analysis
    if supervisor is None and found.supervisor is not None:
        write(key(automaton), found.supervisor)
    return Found(document_of(automaton, found), unfinished=unfinished)


def checked(automaton: Automaton, connections: Connections | None, limits: Limits) -> Found:
    """Return what synthesis and all checks find within `limits`; `connections` are those of a station to its topics."""
    from sequence_planner.analysis.checks.rules import CONFLICTS  # noqa: PLC0415
    from sequence_planner.analysis.finding import everything  # noqa: PLC0415

    unwanted = frozenset({GUARDS, COUNTING})
    known = _kept(automaton, unwanted)
    evidence = _evidence(automaton) if known is None else None
    hearing = _Hearing((everything, automaton, connections, known is None, evidence), unwanted, after=CONFLICTS)
    found = _found(automaton, limits, hearing)
    return found if known is None else replace(known, unfinished=found.unfinished, suspicious=found.suspicious)


def _kept(automaton: Automaton, unwanted: Collection[str]) -> Found | None:
    """Return what is kept of an earlier command, if nothing is missing but what is `unwanted`."""
    known = read(key(automaton), Found)
    return None if known is None or known.document.pending not in (None, *unwanted) else known


def _evidence(automaton: Automaton) -> Evidence | None:
    """Return what answers about the model of this name rested on when it was last looked at."""
    from sequence_planner.analysis.finding import known_evidence  # noqa: PLC0415

    return known_evidence(automaton)


def _found(automaton: Automaton, limits: Limits, hearing: _Hearing, *, far: bool = True) -> Found:
    """Return what is heard, and keep it: but not what is unknown only as nobody looked `far`."""
    unfinished = hearing.hear(limits)
    analysis = hearing.analysis
    found = Found(document_of(automaton, analysis), analysis.questions)
    if hearing.evidence is not None:
        write(name_key(automaton), hearing.evidence)
    if analysis.supervisor is not None:
        write(key(automaton), analysis.supervisor)
    known = far or all(each.kind != "too-many-states" for each in analysis.warnings or ())
    if analysis.pending in (None, GUARDS, COUNTING) and known:
        write(key(automaton), found)
    return replace(found, unfinished=unfinished, suspicious=tuple(sorted(hearing.suspicious)))


def supervisor_of(automaton: Automaton, limits: Limits | None = None) -> Supervisor:
    """The supervisor of `automaton`, kept or computed within `limits`. Ends the command if that takes too much.

    Raises `SynthesisError` if there is none.
    """
    if (known := known_supervisor(automaton)) is not None:
        return known
    from sequence_planner.analysis.worker import told  # noqa: PLC0415
    from sequence_planner.process.task import WorkerError  # noqa: PLC0415
    from sequence_planner.synthesis.supervisor import SynthesisError, tried  # noqa: PLC0415

    limits = limits or Limits()
    found = None
    try:
        for found in told(limits.memory, limits.left, tried, automaton):
            if not isinstance(found, Supervisor):
                raise SynthesisError(found)
            write(key(automaton), found)
    except TimeoutError:
        late = f"the safe states could not be computed within {limits.deadline:g} s"
        refuse(f"{late}: allow more with --deadline, or let fewer variables bear on them", FOUND)
    except WorkerError as ended:
        refuse(f"the safe states could not be computed: {ended}", FOUND)
    assert isinstance(found, Supervisor)
    return found


def read_within(path: Path, limits: Limits) -> Automaton:
    """The automaton of a model. Ends the command if it cannot be used, or not be read within `limits`."""
    try:
        with within(limits.left):
            return usable_automaton(path)
    except DeadlinePassed:
        refuse(f"{path}: it could not be read within {limits.deadline:g} s: allow more with --deadline", FOUND)


class DeadlinePassed(BaseException):
    """The end of the block of `within`, at whatever line. As `KeyboardInterrupt`, it is no error of the file that is
    being read just then, and no handler of such errors takes it for one.
    """


@contextmanager
def within(seconds: float) -> Iterator[None]:
    """Raise `DeadlinePassed` in the block after so many seconds; in the main thread only."""

    def ring(number: int, frame: FrameType | None) -> None:
        raise DeadlinePassed

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, max(seconds, 1e-6))  # 0 would be no deadline at all
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


Work = tuple[Callable[..., "Iterator[CheckProgress | Analysis]"], *tuple[object, ...]]


@dataclass
class _Hearing:
    """The words of a process that does `work`, by now; `after` is what it looks for at last, and nobody waits for what
    is `unwanted`.
    """

    work: Work
    unwanted: Collection[str]
    after: str | None = None
    analysis: Analysis = field(default_factory=lambda: Analysis(SAFE))
    suspicious: set[ModelWarning] = field(default_factory=set)
    evidence: Evidence | None = None
    _pending: str | None = None

    def hear(self, limits: Limits) -> str | None:
        """Hear it until it is all, or `limits` are reached; returns what was not found then, and why."""
        from sequence_planner.analysis.worker import told  # noqa: PLC0415
        from sequence_planner.process.task import WorkerError  # noqa: PLC0415

        try:
            for word in told(limits.memory, limits.left, *self.work):
                self._take(word)
                self._tell(time.monotonic() - limits.began)
        except TimeoutError:
            return f"{self._left()} could not be computed within {limits.deadline:g} s: {self._advice()}"
        except WorkerError as ended:
            return f"{self._left()} could not be computed: {ended}"
        return None

    def _take(self, word: CheckProgress | Analysis) -> None:
        if isinstance(word, Analysis):
            self.analysis, self.evidence = word, word.evidence or self.evidence
        else:
            self.suspicious |= set(word.warnings)
        self._pending = word.pending

    def _left(self) -> str:
        """Say what has not been found."""
        pending = self.analysis.pending
        left = [self._pending or pending, pending, GUARDS if pending == FINDINGS else None, self.after]
        return " and ".join(dict.fromkeys(each for each in left if each is not None and each not in self.unwanted))

    def _advice(self) -> str:
        if self._pending == COUNTING:
            return "allow ten more with --deadline; if that is not enough either, there are too many to be counted"
        return "allow more with --deadline"

    def _tell(self, seconds: float) -> None:
        if sys.stderr.isatty() and seconds > _QUIET and self._pending is not None:
            typer.echo(f"{seconds:5.1f} s: computing {self._pending}", err=True)


# Findings for people: where, what, and a run that shows it.

_LONG = 10  # steps: of a run that is longer it is only said how long it is


def finding_document(finding: FindingDocument) -> dict[str, object]:
    """A finding for programs: in English alone."""
    return finding.model_dump(exclude={"said"})


def finding_lines(finding: FindingDocument, runs: bool = False) -> list[str]:
    """A finding, and its trace indented below it: a long one only where `runs` are asked for."""
    where = f"{finding.file}:{finding.line}:{finding.column}"
    told = [] if finding.trace is None else _told(finding.trace)
    if len(told) > _LONG and not runs:
        told = [f"a run of {len(told)} steps shows it, which `check --runs` prints"]
    return [f"{where}: {finding.severity}: {finding.message} [{finding.kind}]", *(f"  {line}" for line in told)]


def counts_line(findings: Collection[FindingDocument]) -> str:
    """Say how many findings there are, of which kinds."""
    kinds = Counter(finding.kind for finding in findings)
    return f"{counted(len(findings), 'finding')}: {', '.join(f'{number} {kind}' for kind, number in kinds.items())}"


def _told(trace: TraceDocument) -> list[str]:
    """The lines of a trace up to the first state that is forbidden: what comes after it is of less interest."""
    lines = [step.text for step in trace.steps]
    until = next((number for number, step in enumerate(trace.steps, start=1) if step.forbidden_by), len(lines))
    left = len(lines) - until
    return lines if left < 2 else [*lines[:until], f"and {left} further steps, which --json shows"]
