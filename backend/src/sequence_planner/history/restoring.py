"""What is known of the station as its controller starts: what it believed and had commanded, from the journal."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Final

from sqlalchemy import Connection

from sequence_planner.automaton.structure import Automaton, Kind
from sequence_planner.control.conduct import Beginning, OutOfService
from sequence_planner.control.happenings import Confirmed
from sequence_planner.control.jobs import Jobs
from sequence_planner.control.moment import Moment
from sequence_planner.control.vocabulary import Mode, ServiceKind
from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.types import Value, contains
from sequence_planner.history.codec import BEGUN, SNAPSHOT, Codec, kind_of
from sequence_planner.history.restoring_jobs import restored_jobs
from sequence_planner.history.shapes import UnreadableError
from sequence_planner.journal import run_journal
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.storage.error import StorageError

_PAGE: Final = 1000  # records read at once
# What records say of the conduct where it changed.
_CONDUCT: Final = ("service", "done", "mode", "stepping", "by_order", "waits", "answers")
_CONFIRMED: Final = kind_of(Confirmed)


@dataclass(frozen=True)
class Restored:
    """How an execution begins. `left_out` says what came back and does not fit the model any more."""

    beginning: Beginning
    left_out: tuple[str, ...]


def beginning(connection: Connection, automaton: Automaton, now: Moment) -> Restored | None:
    """What the journal knows of the last life; None if there was none.

    Raises `StorageError` where a record cannot be read. One that is not as it was written is said, and believed.
    """
    whole = _last_whole(connection)
    if whole is None:
        return None
    with _readable(whole):
        known, changed = _read(connection, whole)
        found = known.restored(automaton, now)
    if not changed:
        return found
    text = f"record {changed[0]} of what happened is missing, or is not as it was written: verify the journal"
    return replace(found, left_out=(text, *found.left_out))


def last_mode(connection: Connection) -> Mode | None:
    """The mode in which the last life was last, whatever the model was; None if there was none.

    Raises `StorageError` where a record cannot be read.
    """
    whole = _last_whole(connection)
    if whole is None:
        return None
    with _readable(whole):
        return _read(connection, whole)[0].mode


def _last_whole(connection: Connection) -> RunRecord | None:
    """The last record that says everything."""
    return next(iter(run_journal.before(connection, None, 1, (BEGUN, SNAPSHOT))), None)


@contextmanager
def _readable(whole: RunRecord) -> Iterator[None]:
    """What is wrong with records from `whole` on is raised as `StorageError`."""
    try:
        yield
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise StorageError(
            f"the journal cannot be read from record {whole.number} on ({error!r}): see what `sequence-planner "
            "journal --verify` finds, and start with a copy of the database, or with another one"
        ) from error


def _read(connection: Connection, whole: RunRecord) -> tuple[_Known, list[int]]:
    """What is known after the last record, and which records are not as they were written."""
    number = whole.number
    last = run_journal.get(connection, number - 1)
    changed = [] if whole.is_whole((last or run_journal.begin(connection)).hash) else [number]
    known = _Known(whole)
    while page := run_journal.after(connection, number, _PAGE):
        for record, before in zip(page, [known.record, *page], strict=False):
            if record.number != before.number + 1 or not record.is_whole(before.hash):
                changed.append(record.number)
            known.take(record)
        number = page[-1].number
    return known, changed


class _Known:
    """What is known after each of the records."""

    def __init__(self, record: RunRecord) -> None:
        self.record = record  # the last one
        self._last = record.time
        self._found: dict[str, Any] = json.loads(record.content)
        self._unconfirmed = set(self._found["unconfirmed"])
        self._jobs: dict[str, Any] = dict(self._found.get("jobs", {}))

    def take(self, record: RunRecord) -> None:
        content = json.loads(record.content)
        self.record = record
        self._last = max(self._last, record.time)
        changes = content.get("changes", {})
        self._found["values"] |= changes
        self._found |= {name: content[name] for name in _CONDUCT if name in content}
        for job, document in content.get("jobs", {}).items():
            if document is None:  # it was forgotten
                self._jobs.pop(job, None)
            else:
                self._jobs[job] = document
        what = content.get("what", {})
        seen = what.get("names", ()) if record.kind == _CONFIRMED else what.get("values", {})
        self._unconfirmed.difference_update(changes, set(seen) - set(what.get("taken_back", ())))

    @property
    def mode(self) -> Mode:
        return Mode(self._found["mode"])

    def restored(self, automaton: Automaton, now: Moment) -> Restored:
        left_out: list[str] = []
        beginning = Beginning(
            self._values(automaton, left_out),
            self._found["unconfirmed_since"] if self._unconfirmed else self._last,
            self._service(automaton, left_out),
            self._done(automaton, left_out),
            now,
            self.mode,
            bool(self._found["stepping"]),
            self.record.number,  # each change of the state is in a record of its own, so there were fewer
            self._restored_jobs(automaton, left_out, now),
            self._answers(automaton),
        )
        return Restored(beginning, tuple(left_out))

    def _restored_jobs(self, automaton: Automaton, left_out: list[str], now: Moment) -> Jobs:
        by_order, waits = bool(self._found.get("by_order", False)), self._found.get("waits", [])
        return restored_jobs(automaton, by_order, self._jobs, waits, left_out, now)

    def _answers(self, automaton: Automaton) -> dict[str, Value]:
        """What was said of estimates that are there still, and as it was said."""
        values, estimates = self._found["values"], automaton.names(Kind.ESTIMATED)
        said = {name: value for name, value in self._found.get("answers", {}).items() if name in estimates}
        fitting = {name: value for name, value in said.items() if contains(automaton.variables[name].type, value)}
        return {name: value for name, value in fitting.items() if values.get(name) == value}

    def _values(self, automaton: Automaton, left_out: list[str]) -> dict[str, Value]:
        fitting: dict[str, Value] = {}
        for name, value in self._found["values"].items():
            variable = automaton.variables.get(name)
            if variable is None or variable.kind not in (Kind.ESTIMATED, Kind.OUTPUT):
                left_out.append(f"{name} was {print_value(value)}, and is no estimate and no output any more")
            elif not contains(variable.type, value):
                left_out.append(f"{name} was {print_value(value)}, and ranges over {variable.type} now")
            else:
                fitting[name] = value
        return fitting

    def _service(self, automaton: Automaton, left_out: list[str]) -> tuple[OutOfService, ...]:
        parts = {
            ServiceKind.RESOURCE: automaton.resources,
            ServiceKind.ABILITY: automaton.abilities,
            ServiceKind.OPERATION: automaton.operations,
        }
        fitting: list[OutOfService] = []
        for document in self._found["service"]:
            try:
                each: OutOfService = Codec(automaton).decode(OutOfService, document)
            except UnreadableError as error:
                left_out.append(f"something was out of service, which cannot be read: {error}")
                continue
            if each.name in parts[each.of]:
                fitting.append(each)
            else:
                left_out.append(f"{each.of} {each.name} was out of service, and is not there any more")
        return tuple(fitting)

    def _done(self, automaton: Automaton, left_out: list[str]) -> frozenset[str]:
        done = frozenset(self._found["done"])
        once = {name for name, each in automaton.operations.items() if not each.repeat}
        left_out += [
            f"operation {name} was completed, and is none that does not repeat" for name in sorted(done - once)
        ]
        return done & once
