"""The tables of this room: the one draft of the station, and who changed what in it. Times are seconds since the epoch.

What a file was when the draft began stands beside what it is, so that what somebody does to the files of the station
meanwhile can be brought together with it.
"""

from sqlalchemy import BigInteger, Column, Double, Integer, String, Table, Text

from sequence_planner.storage.metadata import METADATA

PATH = String(300)

DRAFT_FILES = Table(
    "draft_files",
    METADATA,
    Column("path", PATH, primary_key=True),
    Column("text", Text, nullable=True),  # none: it was taken away
    Column("base", Text, nullable=True),  # none: it is new
)

DRAFT_CHANGES = Table(
    "draft_changes",
    METADATA,
    Column("number", BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=False),
    Column("time", Double, nullable=False),
    Column("by_id", String(200), nullable=False),
    Column("by_name", String(200), nullable=False),
    Column("kind", String(20), nullable=False),
    Column("of", BigInteger().with_variant(Integer, "sqlite"), nullable=True),  # what is undone, or done again
    Column("title", String(300), nullable=False),
    Column("files", Text, nullable=False),  # JSON: {path: [before, after]}
)
