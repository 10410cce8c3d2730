"""The tables of this room. No column holds a time: the clocks of several machines need not agree."""

from sqlalchemy import BigInteger, Boolean, Column, Integer, String, Table

from sequence_planner.storage.metadata import METADATA

NAME = String(100)
NUMBER = BigInteger().with_variant(Integer, "sqlite")

LEASE = Table(
    "command_lease",
    METADATA,
    Column("id", Integer, primary_key=True, autoincrement=False),  # there is one row, the first
    Column("holder", NAME, nullable=False),  # who commands, or did last
    Column("model", String(64), nullable=False),  # digest of what the holder runs; empty: of what was deployed there
    Column("epoch", NUMBER, nullable=False),  # how often it was taken
    Column("renewals", NUMBER, nullable=False),  # since it was taken
    Column("free", Boolean, nullable=False),  # the holder has let go of it
    # Up to which epoch it is certain that nothing was accepted that is not in the journal.
    Column("settled", NUMBER, nullable=False, server_default="-1"),
)

STANDBYS = Table(
    "standbys",
    METADATA,
    Column("name", NAME, primary_key=True),
    Column("model", String(64), nullable=False),
    Column("signs", NUMBER, nullable=False),  # how often it has said that it is there
)
