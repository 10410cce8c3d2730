"""The run done again from the journal: each record must lead to the digest that was written when it happened."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.execution import Execution
from sequence_planner.control.moment import Moment
from sequence_planner.history.codec import BEGUN, SNAPSHOT
from sequence_planner.history.error import OTHER_VERSION, HistoryError
from sequence_planner.history.player import Player
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.journal.whole_run import WholeRun
from sequence_planner.version import VERSION

_PAGE: Final = 1000  # records read at once
_FEW: Final = 20  # of those that say everything, which are long
_WHOLE: Final = (BEGUN, SNAPSHOT)


@dataclass(frozen=True)
class Replayed:
    """A record that was replayed, and the execution as it is then, until the next one; `now` is when that is.

    `difference` says in what it did not come to what the record says.
    """

    record: RunRecord
    execution: Execution
    now: Moment
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
    """Where to begin. Raises `HistoryError` where there is nothing to begin with."""
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
