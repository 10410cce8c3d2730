"""Signed checkpoints: statements of how far both chains had come, to be kept where nobody of the station can write.

Whoever may change the database's structure could make a chain anew, with all its hashes. That does not fit a checkpoint
that was made before, and they cannot sign another one without the key, which is not in the database.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Final

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from sqlalchemy import Connection, RowMapping, func, insert, select

from sequence_planner.journal import audit, run_journal
from sequence_planner.journal.chain import BELOW_ALL, Position
from sequence_planner.journal.run_tables import RUN_CHECKPOINTS
from sequence_planner.journal.signing_key import key_file, public_text, signing_key
from sequence_planner.storage.database import Database, StorageError

_PAGE: Final = 1000  # checkpoints read at once
_ALL: Final = select(RUN_CHECKPOINTS.c.content, RUN_CHECKPOINTS.c.public_key, RUN_CHECKPOINTS.c.signature)
_STRICT: Final = ConfigDict(frozen=True, extra="forbid")


class Place(BaseModel):
    """The number and the hash of a record."""

    model_config = _STRICT
    number: int = Field(ge=0)
    hash: str

    def position(self) -> Position:
        """It as a place in a chain."""
        return Position(self.number, self.hash)


class Statement(BaseModel):
    """What is signed: at this time both chains ended so. `checkpoint` counts from 1."""

    model_config = _STRICT
    checkpoint: int
    time: float
    audit: Place
    run: Place


class Checkpoint(BaseModel):
    """A signed statement: `content` is its text, as it was signed with Ed25519; key and signature are in hex."""

    model_config = _STRICT
    content: str
    public_key: str = Field(pattern="^[0-9a-f]{64}$")
    signature: str = Field(pattern="^[0-9a-f]{128}$")

    def statement(self) -> Statement:
        """What it says. Raises `StorageError` if it says nothing that could have been signed."""
        try:
            return Statement.model_validate_json(self.content)
        except ValidationError as error:
            raise StorageError("a checkpoint cannot be read: it was changed") from error

    def is_signed(self) -> bool:
        """Whether the signature is that of its key."""
        from cryptography.exceptions import InvalidSignature  # noqa: PLC0415
        from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey  # noqa: PLC0415

        try:
            key = Ed25519PublicKey.from_public_bytes(bytes.fromhex(self.public_key))
            key.verify(bytes.fromhex(self.signature), self.content.encode())
        except (InvalidSignature, ValueError):
            return False
        return True


def make(database: Database, now: float) -> Checkpoint:
    """Sign how far both chains have come, and keep that in the database too. Raises `StorageError`."""
    key = signing_key(key_file(database.place))
    with database.writing() as connection:
        ends = {"audit": audit.end(connection), "run": run_journal.end(connection)}
        if None in ends.values():
            raise StorageError(f"the journal's end was taken out of {database.place}: put a copy in its place")
        number = (connection.execute(select(func.max(RUN_CHECKPOINTS.c.number))).scalar() or 0) + 1
        content = json.dumps(
            {
                "checkpoint": number,
                "time": now,
                **{chain: {"number": end.number, "hash": end.hash} for chain, end in ends.items() if end is not None},
            }
        )
        made = Checkpoint(content=content, public_key=public_text(key), signature=key.sign(content.encode()).hex())
        row = {"number": number, "run_number": made.statement().run.number, **made.model_dump()}
        connection.execute(insert(RUN_CHECKPOINTS), row)
    return made


def newest(connection: Connection) -> Checkpoint | None:
    """The newest checkpoint; None before the first."""
    row = connection.execute(_ALL.order_by(RUN_CHECKPOINTS.c.number.desc()).limit(1)).mappings().one_or_none()
    return None if row is None else _checkpoint(row)


def everything(connection: Connection) -> Iterator[Checkpoint]:
    """All that are kept in the database, in order. Raises `StorageError` for one that cannot be read."""
    number = BELOW_ALL
    chosen = _ALL.add_columns(RUN_CHECKPOINTS.c.number).order_by(RUN_CHECKPOINTS.c.number).limit(_PAGE)
    while page := connection.execute(chosen.where(RUN_CHECKPOINTS.c.number > number)).mappings().all():
        yield from map(_checkpoint, page)
        number = page[-1]["number"]


def signed_up_to(connection: Connection) -> int:
    """The number of the last record of the run that a checkpoint covers."""
    return connection.execute(select(func.max(RUN_CHECKPOINTS.c.run_number))).scalar() or 0


def _checkpoint(row: RowMapping) -> Checkpoint:
    try:
        return Checkpoint(content=row["content"], public_key=row["public_key"], signature=row["signature"])
    except ValidationError as error:
        raise StorageError("a checkpoint in the database cannot be read: it was changed") from error
