"""How the last life of a controller has ended: whether all that was accepted in it is in the journal."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import Connection

from sequence_planner.journal import run_journal
from sequence_planner.journal.chain import START
from sequence_planner.journal.last_word import Life, Word
from sequence_planner.journal.run_journal import RunRecord


@dataclass(frozen=True)
class Ending:
    """`is_certain` where the last that the journal has is the last that was accepted. If it is not, `word` is what is
    known of the rest, and None where nothing is. `life` is the last one, if it was of this station.
    """

    is_certain: bool
    word: Word | None = None
    life: Life | None = None


def ending(connection: Connection, lives: Sequence[Life], begun_kind: str) -> Ending:
    """What the journal and the last words of this station say together; `begun_kind` is that of records that begin a
    life.

    A word counts as long as the journal does not reach as far as it, and no other life has begun since: that began
    paused where it was not certain of this. So a word of records that a restored backup does not have counts once.
    """
    end, begun = run_journal.end(connection), run_journal.last(connection, begun_kind)
    number = START.number if end is None else end.number
    for life in sorted(lives, key=lambda each: each.turn, reverse=True):
        if life.word is not None and life.word.number > number and not _is_over(life, begun):
            return Ending(False, life.word, life if _has_begun(connection, life, number) else None)
        if _has_begun(connection, life, number):
            break  # with all that the lives before it had said
    for life in lives:
        if _has_begun(connection, life, number) and not _is_over(life, begun):
            return Ending(True, life=life)
    return Ending(number == START.number and begun is None)


def _is_over(life: Life, begun: RunRecord | None) -> bool:
    """Whether another life has begun since."""
    return begun is not None and (begun.number > life.number or (begun.number == life.number and not _is(life, begun)))


def _has_begun(connection: Connection, life: Life, end: int) -> bool:
    """Whether the journal has its first record, or had it before that was cut off."""
    if life.number > end:
        return False
    found = run_journal.get(connection, life.number)
    return life.number <= run_journal.begin(connection).number if found is None else _is(life, found)


def _is(life: Life, record: RunRecord) -> bool:
    return life.hash == record.hash
