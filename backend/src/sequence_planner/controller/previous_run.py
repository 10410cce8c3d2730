"""Knowledge of the station as its controller begins, and whether that is the last that anybody asked of it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Set
from dataclasses import replace
from datetime import UTC, datetime
from typing import Final, TypeVar

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.controller.alarms.alarm import KIND as ASIDE
from sequence_planner.controller.alarms.alarm import aside_from
from sequence_planner.controller.features.plan import KIND as OPERATIONS
from sequence_planner.controller.features.plan import progress_from
from sequence_planner.controller.features.variables import KIND as BELIEFS
from sequence_planner.controller.features.variables import beliefs_from
from sequence_planner.controller.restore import RestoredState, beginning, last_mode
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace as replaced
from sequence_planner.db.database import Database
from sequence_planner.execution.events import ProductionStarted
from sequence_planner.execution.record.codec import BEGUN, SNAPSHOT, kind_of
from sequence_planner.execution.record.recorder import SNAPSHOT_EVERY
from sequence_planner.execution.state import InitialState
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.journal import run_journal
from sequence_planner.journal.entry import described
from sequence_planner.journal.last_accepted import LastEnding, LastWord, Word, ending

Told = TypeVar("Told")

_PAGE: Final = 50  # records read at once
_FURTHEST: Final = 2 * SNAPSHOT_EVERY  # records of beliefs between two that have all


def what_is_known(database: Database, automaton: Automaton) -> RestoredState:
    """Return what the journal knows of the station from before. Raises `StorageError`."""
    with database.reading() as connection:
        restored = beginning(connection, automaton, Timestamp.now())
        aside = run_journal.last(connection, ASIDE)
        beliefs = _last_told(connection, BELIEFS, set(automaton.names(Kind.ESTIMATED)), beliefs_from)
        progress = _last_told(connection, OPERATIONS, automaton.operations.keys(), progress_from)
        produced = _produced(connection)
    return RestoredState(
        restored.beginning if restored else None,
        {} if aside is None else aside_from(json.loads(aside.content)),
        beliefs,
        progress,
        restored.left_out if restored else (),
        produced,
    )


def _last_told(
    connection: Connection, kind: str, names: Set[str], read: Callable[[Mapping[str, JsonValue]], dict[str, Told]]
) -> dict[str, Told]:
    """The newest that records of the kind say of each name: one with all is not further back than the newest
    snapshot.
    """
    found = dict[str, Told]()
    number = None
    for _ in range(0, _FURTHEST, _PAGE):
        for record in (page := run_journal.before(connection, number, _PAGE, {kind})):
            told = read(json.loads(record.content))
            found = {**told, **found}
            if names <= told.keys():
                return found
            number = record.number
        if len(page) < _PAGE:
            break
    return found


def _produced(connection: Connection) -> bool:
    """Return whether production had been started in the last life, of whose records the first may have been cut off."""
    whole = next(iter(run_journal.before(connection, None, 1, {BEGUN, SNAPSHOT})), None)
    if whole is None:
        return False
    began = run_journal.last(connection, BEGUN) if "production" not in json.loads(whole.content) else whole
    started = run_journal.last(connection, kind_of(ProductionStarted))
    if began is whole and json.loads(whole.content).get("production") == Production.STARTED:
        return True
    return started is not None and (began is None or started.number > began.number)


def how_it_ended(database: Database, last_word: LastWord) -> LastEnding:
    """Return what the journal and the last word say together. Raises `StorageError`."""
    with database.reading() as connection:
        return ending(connection, last_word.lives, BEGUN)


def as_it_ended(known: RestoredState, ended: LastEnding, before: str | None) -> RestoredState:
    """`known`, at rest where it is not certain that the last that the journal knows is the last that was asked for.

    `before` is the station that commanded before, if that was another one.
    """
    if ended.is_certain:
        return known
    # Nothing came back, and yet somebody has stopped the station: as nothing of that life has reached the journal.
    begins = known.beginning or InitialState({}, None, (), frozenset(), Timestamp.now())
    word, mode = ended.word, begins.mode
    if word is None and mode is not Mode.AUTOMATIC:
        return known  # it is at rest anyway
    because = _not_in_journal(word) if word is not None else _unknown(before)
    return replace(known, beginning=replaced(begins, mode=_as_it_ended(mode, ended)), halted=because)


def last_known_mode(database: Database, ended: LastEnding) -> Mode:
    """The mode in which the station begins, as far as it is known before it is prepared. Raises `StorageError`."""
    with database.reading() as connection:
        return _as_it_ended(last_mode(connection) or Mode.AUTOMATIC, ended)


def _as_it_ended(mode: Mode, ended: LastEnding) -> Mode:
    """The mode after `mode`, which is what the journal knows."""
    if ended.is_certain:
        return mode
    if ended.word is not None:
        mode = Mode(ended.word.mode)
    return Mode.PAUSED if mode is Mode.AUTOMATIC else mode


def _not_in_journal(word: Word) -> str:
    when = datetime.fromtimestamp(word.time, UTC).strftime("%Y-%m-%d %H:%M:%S UTC")
    asked = f"{word.entry.actor.name} asked for {described(word.entry)} at {when}"
    return f"{asked}, which was carried out and had not reached the journal"


def _unknown(before: str | None) -> str:
    if before is not None:
        return f"{before} fell silent while it commanded, and nobody knows whether it was paused or held there since"
    return "nobody knows whether it was paused or held since the last that the journal has"
