"""What is known of the station as its controller begins, and whether that is the last that anybody asked of it."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.alarming.keeping import KIND as ASIDE
from sequence_planner.control.alarming.keeping import aside_from
from sequence_planner.control.belief import KIND as BELIEFS
from sequence_planner.control.belief import beliefs_from
from sequence_planner.control.conduct import Beginning
from sequence_planner.control.happenings import ProductionStarted
from sequence_planner.control.known import Known
from sequence_planner.control.moment import Moment
from sequence_planner.control.view import Mode
from sequence_planner.history.codec import BEGUN, kind_of
from sequence_planner.history.restoring import beginning, last_mode
from sequence_planner.immutable import replace as replaced
from sequence_planner.journal.ending import Ending, ending
from sequence_planner.journal.entry import described
from sequence_planner.journal.last_word import LastWord, Word
from sequence_planner.journal.run_journal import last
from sequence_planner.storage.database import Database


def what_is_known(database: Database, automaton: Automaton) -> Known:
    """What the journal knows of the station from before. Raises `StorageError`."""
    with database.reading() as connection:
        restored = beginning(connection, automaton, Moment.now())
        aside, beliefs = last(connection, ASIDE), last(connection, BELIEFS)
        begun, started = last(connection, BEGUN), last(connection, kind_of(ProductionStarted))
    return Known(
        restored.beginning if restored else None,
        {} if aside is None else aside_from(json.loads(aside.content)),
        {} if beliefs is None else beliefs_from(json.loads(beliefs.content)),
        restored.left_out if restored else (),
        begun is not None and started is not None and started.number > begun.number,
    )


def how_it_ended(database: Database, last_word: LastWord) -> Ending:
    """What the journal and the last word say together. Raises `StorageError`."""
    with database.reading() as connection:
        return ending(connection, last_word.lives, BEGUN)


def as_it_ended(known: Known, ended: Ending, before: str | None) -> Known:
    """`known`, at rest where it is not certain that the last that the journal knows is the last that was asked for.

    `before` is the station that commanded before, if that was another one.
    """
    if ended.is_certain:
        return known
    # Nothing came back, and yet somebody has stopped the station: as nothing of that life has reached the journal.
    begins = known.beginning or Beginning({}, None, (), frozenset(), Moment.now())
    word, mode = ended.word, begins.mode
    if word is None and mode is not Mode.AUTOMATIC:
        return known  # it is at rest anyway
    because = _not_in_journal(word) if word is not None else _unknown(before)
    return replace(known, beginning=replaced(begins, mode=_as_it_ended(mode, ended)), halted=because)


def last_known_mode(database: Database, ended: Ending) -> Mode:
    """The mode in which the station begins, as far as it is known before it is prepared. Raises `StorageError`."""
    with database.reading() as connection:
        return _as_it_ended(last_mode(connection) or Mode.AUTOMATIC, ended)


def _as_it_ended(mode: Mode, ended: Ending) -> Mode:
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
