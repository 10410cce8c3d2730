"""Replay of a run from its journal, with a digest check at each record."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import (
    Answered,
    Asked,
    ByOrderChanged,
    CalledOff,
    Confirmed,
    Corrected,
    CycleStopChanged,
    Event,
    Explained,
    Forced,
    ForceReleased,
    JobCommanded,
    JobForgotten,
    JobsSequenced,
    JobTaken,
    ModeChanged,
    OperatorPlanStarted,
    OperatorPlanStopped,
    ProductionStarted,
    ServiceChanged,
    SteppingChanged,
    StepTaken,
    Ticked,
    Unanswered,
)
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.codec import (
    BEGUN,
    KINDS,
    OTHER_VERSION,
    SNAPSHOT,
    TICKED,
    Codec,
    HistoryError,
    Senses,
    TickBook,
    UnreadableError,
)
from sequence_planner.execution.record.recorder import Memory, model_digest
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.planning.problem import Contract
from sequence_planner.version import VERSION

# An execution that is taken through records of the journal, each of which says what it must come to.

_DEADLINE = 0.0  # of questions, which nobody answers here: the answers are in the journal


class Player:
    """Plays records in order, from one that says everything on."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._supervisor = supervisor
        self._model = model_digest(automaton)
        self._codec = Codec(automaton)
        self._memory = Memory(automaton, self._codec)
        self._book = TickBook()
        self._execution: Executor | None = None
        self._program = VERSION  # that has written the records
        self.now = Timestamp(0.0, 0.0)
        """Time of the last record that has one."""

    @property
    def execution(self) -> Executor:
        """The execution as the last record left it."""
        if self._execution is None:
            raise HistoryError("history-gone", "begin with a record that says everything: `begun` or `snapshot`")
        return self._execution

    def play(self, record: RunRecord) -> str | None:
        """Do what a record says; how it then is not as the record says, None if it is.

        Raises `HistoryError` for a record of another model, for one that cannot be read, and for one of another version
        of the program that this one cannot do again.
        """
        if record.kind not in KINDS and record.kind not in (BEGUN, SNAPSHOT):
            return None
        try:
            content = json.loads(record.content)
            if now := content.get("now") or content.get("what", {}).get("now"):
                self.now = Timestamp(*(now if isinstance(now, list) else (now["epoch"], now["monotonic"])))
            if record.kind in KINDS:
                self._happen(self._happening(record.kind, content))
            else:
                self._program = str(content.get("program", VERSION))
                if record.kind == BEGUN or self._execution is None:
                    self._begin(record, content)
                else:
                    self._execution.drop_caches()
        except (ValueError, LookupError, TypeError, AttributeError) as error:
            why = f"record {record.number} cannot be read: {error or type(error).__name__}"
            if self._program != VERSION:
                raise self._of_another_version(why) from error
            raise HistoryError("history-unreadable", why) from error
        if self._memory.digest(self.execution) == content.get("digest"):
            return None
        difference = self._difference(record, content)
        if self._program != VERSION:
            raise self._of_another_version(difference)
        return difference

    def _begin(self, record: RunRecord, content: dict[str, Any]) -> None:
        if content.get("model") != self._model:
            if self._program != VERSION:
                raise self._of_another_version(f"record {record.number} has another digest of the model")
            raise HistoryError(
                "model-changed",
                f"record {record.number} was written with another model of the station, or another version of it: what "
                "has happened then can be replayed with that model only",
            )
        self._execution = self._memory.execution(self._supervisor, content["memory"])
        self._book = TickBook(self._codec.decode(Senses, content["senses"]))

    def _happening(self, kind: str, content: dict[str, Any]) -> Event:
        return self._book.tick(content) if kind == TICKED else self._codec.happening(kind, content)

    def _happen(self, happening: Event) -> None:
        execution = self.execution
        match happening:
            case Ticked(measured, obstacles, silent, now):
                execution.tick(measured, now, obstacles, silent)
            case Asked(contract):
                ask = execution.request if contract is Contract.FAST else execution.better
                ask(_DEADLINE)
            case Answered(answer) if execution.asked is not None:
                execution.adopt(execution.asked, answer)
            case Answered():
                raise UnreadableError("it is an answer that nobody had asked for")
            case Unanswered(why, again):
                execution.unanswered(why, again)
            case Explained(diagnosis):
                execution.explained(diagnosis)
            case ProductionStarted():
                execution.start_production()
            case ModeChanged(mode, by, now):
                execution.change_mode(mode, by, now)
            case CalledOff(by, now):
                execution.call_off(by, now)
            case CycleStopChanged(on, by, why, now):
                execution.set_cycle_stop(on, by, why, now)
            case SteppingChanged(on):
                execution.set_stepping(on)
            case StepTaken():
                execution.take_step()
            case ServiceChanged(of, name, in_service, by, why, now):
                execution.set_service(of, name, in_service, by, why, now)
            case Corrected(values, by, why, now, taken_back):
                execution.correct(values, by, why, now, taken_back)
            case Confirmed(names, by, now):
                execution.confirm(names, by, now)
            case Forced(name, value, until, by, why):
                execution.force(name, value, until, by, why)
            case ForceReleased(name):
                execution.release(name)
            case OperatorPlanStarted(operator_plan, now):
                execution.start_operator_plan(operator_plan, now)
            case OperatorPlanStopped(by, now):
                execution.stop_operator_plan(by, now)
            case _:
                self._happen_to_jobs(happening)

    def _happen_to_jobs(self, happening: Event) -> None:
        execution = self.execution
        match happening:
            case ByOrderChanged(on, by, why, now):
                execution.set_by_order(on, by, why, now)
            case JobTaken(job, title, work_master, by, now):
                execution.accept_job(job, title, work_master, by, now)
            case JobsSequenced(waits, by, now):
                execution.sequence_jobs(waits, by, now)
            case JobCommanded(job, act, by, why, now):
                execution.command_job(job, act, by, why, now)
            case JobForgotten(job, by, now):
                execution.forget_job(job, by, now)

    def _of_another_version(self, why: str) -> HistoryError:
        """Say what keeps a record from being done again that another version of the program has written."""
        return HistoryError(
            OTHER_VERSION,
            f"{why}. It was written by another version of the program, {self._program}, and this is {VERSION}: "
            "that one replays it, in a backup from before the update and with the model of that time",
        )

    def _difference(self, record: RunRecord, content: dict[str, Any]) -> str:
        """In what the replayed execution is not as it was, as far as the record says how it was."""
        where = f"record {record.number} ({record.kind})"
        if "memory" in content:
            mine = self._memory.document(self.execution)
            parts = [part for part, was in content["memory"].items() if mine.get(part) != was]
            return f"{where} comes to another state: {', '.join(parts) or 'nothing that it tells'} is different"
        state = self.execution.state
        other = [name for name, value in content.get("changes", {}).items() if state.get(name) != value]
        what = f"{', '.join(other)} should have changed as it did" if other else "its digest is another one"
        return f"{where} comes to another state: {what}"


# The run done again from the journal: each record must lead to the digest that was written when it happened.

_PAGE: Final = 1000  # records read at once
_FEW: Final = 20  # of those that say everything, which are long
_WHOLE: Final = (BEGUN, SNAPSHOT)


@dataclass(frozen=True)
class Replayed:
    """A record that was replayed, and the execution as it is then, until the next one; `now` is when that is.

    `difference` says in what it did not come to what the record says.
    """

    record: RunRecord
    execution: Executor
    now: Timestamp
    difference: str | None


def replay(
    run: WholeRun, automaton: Automaton, supervisor: Supervisor, from_: int = 1, to: int | None = None
) -> Iterator[Replayed]:
    """Replay the records from the last one that says everything and is not above `from_`, up to `to` or all there are.

    It ends with the first record that does not come to what it says. Raises `HistoryError` where the model is another
    one, a record cannot be read, or was written by another version of the program and cannot be done again by this one.
    """
    player = Player(automaton, supervisor)
    number = _start(run, from_) - 1
    while page := run.after(number, _PAGE):
        for record in page:
            if to is not None and record.number > to:
                return
            try:
                difference = player.play(record)
            except HistoryError as error:
                raise _with_the_next(run, record.number, error) from error
            yield Replayed(record, player.execution, player.now, difference)
            if difference is not None:
                return
        number = page[-1].number


def _start(run: WholeRun, number: int) -> int:
    """Return where to begin. Raises `HistoryError` where there is nothing to begin with."""
    found = run.before(number + 1, 1, _WHOLE) or run.after(0, 1, _WHOLE)
    if not found:
        raise HistoryError("history-gone", "nothing has happened yet: the journal has no record of a run")
    return found[0].number


def _with_the_next(run: WholeRun, number: int, error: HistoryError) -> HistoryError:
    """The same, and where this version of the program can begin again behind what another one has written."""
    if error.slug != OTHER_VERSION:
        return error
    own = (each for each in _whole_after(run, number) if json.loads(each.content).get("program") == VERSION)
    first = next(own, None)
    further = "nothing was written by this one yet" if first is None else f"this one goes on from record {first.number}"
    return HistoryError(OTHER_VERSION, f"{error.detail}; {further}")


def _whole_after(run: WholeRun, number: int) -> Iterator[RunRecord]:
    """Records behind `number` that say everything."""
    while page := run.after(number, _FEW, _WHOLE):
        yield from page
        number = page[-1].number
