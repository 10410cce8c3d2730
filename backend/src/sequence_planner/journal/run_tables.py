"""The tables of the run: all that has happened at the station, from which it can be done again."""

from __future__ import annotations

from typing import Final

from sqlalchemy import Column, Double, Index, String, Table, Text

from sequence_planner.journal.chain import NUMBER, position_table
from sequence_planner.storage.metadata import METADATA

LONGEST_KIND: Final = 40  # characters

RUN: Final = Table(
    "run",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("kind", String(LONGEST_KIND), nullable=False),
    Column("content", Text, nullable=False),
    Column("hash", String(64), nullable=False),
    Index("ix_run_kind_number", "kind", "number"),
)
"""`content` is JSON text."""

RUN_BEGIN: Final = position_table("run_begin")
"""One row with the last record that retention has cut off; the run begins behind it."""

RUN_END: Final = position_table("run_end")
"""One row with the last record, so that records missing at the end show, as does a second station that writes."""

RUN_CHECKPOINTS: Final = Table(
    "run_checkpoints",
    METADATA,
    Column("number", NUMBER, primary_key=True, autoincrement=False),
    Column("run_number", NUMBER, nullable=False),
    Column("content", Text, nullable=False),
    Column("public_key", String(64), nullable=False),
    Column("signature", String(128), nullable=False),
)
"""Signed statements of how far both chains had come. `content` is the text that is signed."""
