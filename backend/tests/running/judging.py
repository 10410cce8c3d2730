"""What the journal of a station that was killed again and again must say: all of it, and nothing done twice."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from sequence_planner.automaton.automaton import Automaton, State, target
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.db.database import Database
from sequence_planner.execution.record.codec import BEGUN, TICKED
from sequence_planner.execution.record.replay import Replayed, replay
from sequence_planner.journal import run_journal
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.hash_chain import START, ChainPosition, broken_at
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.evaluator import holds


@dataclass
class Kept:
    """Reads what is in the journal behind what it has read before. What it once has read must stay as it is."""

    database: Database
    end: ChainPosition = START
    kinds: Counter[str] = field(default_factory=Counter)

    def look(self) -> list[RunRecord]:
        """The records since the last look, each of which is chained to the one before."""
        found: list[RunRecord] = []
        with self.database.reading() as connection:
            before = run_journal.get(connection, self.end.number)
            assert self.end == START or (before is not None and before.hash == self.end.hash), "a record was changed"
            while page := run_journal.after(connection, self.end.number + len(found), 1000):
                found += page
        if found:
            last = ChainPosition(found[-1].number, found[-1].hash)
            assert broken_at(found, self.end, last) is None
            self.end = last
            self.kinds.update(each.kind for each in found)
        return found

    def has(self, record: Mapping[str, object]) -> bool:
        """Whether a record that was shown to somebody is there as it was shown."""
        with self.database.reading() as connection:
            found = run_journal.get(connection, int(str(record["number"])))
        return found is not None and found.hash == record["hash"]


class Judge:
    """Does all of the journal again on the reference, and looks at each start."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self.starts: Counter[str] = Counter()
        self.outputs: list[State] = []  # all that outputs ever were, in order
        self._under_way: set[str] = set()
        self._of_earlier_lives: set[str] = set()
        self._before: State | None = None

    def judge(self, database: Database) -> None:
        """AssertionError when something is otherwise than it was, was started twice, or led out of the safe set."""
        with database.reading() as connection:
            for each in replay(WholeRun(connection), self._automaton, self._supervisor):
                assert each.difference is None, each.difference
                self._look(each)

    def _look(self, each: Replayed) -> None:
        state, where = each.execution.state, f"record {each.record.number}"
        content = json.loads(each.record.content) if each.record.kind == TICKED else {}
        self._under_way -= {
            name for how in ("finished", "ended", "called_off", "given_up") for name in content.get(how, ())
        }
        if each.record.kind == BEGUN:
            self._of_earlier_lives |= self._under_way
        if each.record.kind in ("corrected", "mode-changed", "called-off"):
            self._under_way -= set(self._taken_back(state))
        self._under_way -= set(self._seen_to_be_over(state))
        self._of_earlier_lives &= self._under_way
        for name in content.get("started", ()):
            assert name not in self._under_way, f"{where}: {name} was started, and had not finished since it was"
            self.starts[name] += 1
            if self._automaton.abilities[name].finish_guard is not None:
                self._under_way.add(name)
        if "started" in content:
            assert self._supervisor.safe.includes(state), f"{where}: {content['started']} led out of the safe set"
            for specification in self._automaton.specifications.values():
                assert not holds(specification.forbidden, state), f"{where}: {specification.name}"
        outputs = {name: state[name] for name in self._automaton.outputs}
        if self.outputs[-1:] != [outputs]:
            self.outputs.append(outputs)
        self._before = state

    def _seen_to_be_over(self, state: State) -> Iterator[str]:
        """What came to its end while no controller was there to finish it."""
        for name in self._of_earlier_lives:
            if state[self._automaton.abilities[name].flag("executing")] is False:
                yield name

    def _taken_back(self, state: State) -> Iterator[str]:
        """What a person has told to do otherwise: an output that its start wrote is another one now."""
        before = self._before or state
        for name in self._under_way:
            written = {target(action) for action in self._automaton.abilities[name].start_actions}
            if any(state[each] != before[each] for each in written & self._automaton.outputs):
                yield name

    def require_decided(self, topic: str, heard: Sequence[Mapping[str, object]]) -> None:
        """Commands, in the order in which they were heard, must all be in the journal, in this order."""
        outputs = iter(self.outputs)
        for number, command in enumerate(heard):
            found = any(command.items() <= each.items() for each in outputs)
            decided = [{name: each[name] for name in command} for each in self.outputs]
            assert found, f"{topic}: {command} is not in the journal: {list(heard[: number + 1])} {decided}"
