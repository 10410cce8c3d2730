"""How the station was at any record of the journal."""

from __future__ import annotations

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.history.error import HistoryError
from sequence_planner.history.replay import Replayed, replay
from sequence_planner.journal.whole_run import WholeRun


def looking_back(run: WholeRun, automaton: Automaton, supervisor: Supervisor, number: int) -> Replayed:
    """A record, with the execution as it was right after it.

    Raises `HistoryError` if there is no such record, if it cannot be replayed, or is not replayed as it was written.
    """
    if run.get(number) is None:
        begin = run.begin.number
        detail = f": records up to {begin} were cut off" if number <= begin else ""
        raise HistoryError("no-record", f"the journal has no record {number}{detail}")
    last: Replayed | None = None
    for last in replay(run, automaton, supervisor, number, number):
        if last.difference is not None:
            raise HistoryError(
                "history-differs", f"the run cannot be replayed up to record {number}: {last.difference}"
            )
    if last is None or last.record.number != number:
        raise HistoryError(
            "history-gone", f"nothing tells how the station was at record {number}: what was before it was cut off"
        )
    return last
