"""Signed checkpoints of both journal chains, for external storage, and their Ed25519 key."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

from pydantic import Field, ValidationError
from sqlalchemy import Connection, RowMapping, func, insert, select

from sequence_planner.core.data_models import DataModel
from sequence_planner.core.storage_error import StorageError
from sequence_planner.db.database import Database
from sequence_planner.db.location import PostgresqlServer, SqliteFile, state_folder
from sequence_planner.journal import audit, run_journal
from sequence_planner.journal.hash_chain import BELOW_ALL, ChainPosition
from sequence_planner.journal.run_journal import RUN_CHECKPOINTS

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

# The key that signs checkpoints: an Ed25519 key in a file of this user alone, never in the database.


def key_file(place: SqliteFile | PostgresqlServer) -> Path:
    """Return where the key is: beside the file of SQLite; for PostgreSQL in this user's state folder."""
    if isinstance(place, SqliteFile):
        return place.path.with_name(f"{place.path.name}-checkpoint-key.pem")
    mark = hashlib.sha256(str(place).encode()).hexdigest()[:8]
    return state_folder() / f"checkpoint-key-{mark}.pem"


def signing_key(file: Path) -> Ed25519PrivateKey:
    """The key in a file, which is made if it is not there. Raises `StorageError`."""
    try:
        if not file.exists():
            _make(file)
        return _read(file)
    except OSError as error:
        raise StorageError(f"{file}, the key that signs checkpoints, cannot be used: {error.strerror}") from error


def public_key(file: Path) -> str | None:
    """The public key in hexadecimal digits; None where there is no key yet. Raises `StorageError`."""
    return public_text(signing_key(file)) if file.exists() else None


def public_text(key: Ed25519PrivateKey) -> str:
    """The public half in hexadecimal digits."""
    return key.public_key().public_bytes_raw().hex()


def _read(file: Path) -> Ed25519PrivateKey:
    # Most programs never sign, and start sooner for it.
    from cryptography.exceptions import UnsupportedAlgorithm  # noqa: PLC0415
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey  # noqa: PLC0415
    from cryptography.hazmat.primitives.serialization import load_pem_private_key  # noqa: PLC0415

    try:
        key = load_pem_private_key(file.read_bytes(), password=None)
    except (ValueError, TypeError, UnsupportedAlgorithm):
        key = None
    if not isinstance(key, Ed25519PrivateKey):
        raise StorageError(
            f"{file} holds no Ed25519 key: put the right one in its place, or move it away for a new one"
        )
    return key


def _make(file: Path) -> None:
    """Write a new key, whole or not at all; of several that do so at once the first wins."""
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey  # noqa: PLC0415
    from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat  # noqa: PLC0415

    text = Ed25519PrivateKey.generate().private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    new = file.with_name(f"{file.name}.{os.getpid()}.{os.urandom(4).hex()}")
    descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
    try:
        with os.fdopen(descriptor, "wb") as opened:
            opened.write(text)
            opened.flush()
            os.fsync(opened.fileno())
        try:
            os.link(new, file)
        except FileExistsError:
            return
    finally:
        new.unlink()


# Signed checkpoints: statements of how far both chains had come, to be kept where nobody of the station can write.
#
# Whoever may change the database's structure could make a chain anew, with all its hashes. That does not fit a
# checkpoint that was made before, and they cannot sign another one without the key, which is not in the database.

_PAGE: Final = 1000  # checkpoints read at once
_ALL: Final = select(RUN_CHECKPOINTS.c.content, RUN_CHECKPOINTS.c.public_key, RUN_CHECKPOINTS.c.signature)


class Place(DataModel):
    """The number and the hash of a record."""

    number: int = Field(ge=0)
    hash: str

    def position(self) -> ChainPosition:
        """It as a place in a chain."""
        return ChainPosition(self.number, self.hash)


class Statement(DataModel):
    """The statement that is signed: at this time both chains ended so. `checkpoint` counts from 1."""

    checkpoint: int
    time: float
    audit: Place
    run: Place


class Checkpoint(DataModel):
    """A signed statement: `content` is its text, as it was signed with Ed25519; key and signature are in hex."""

    content: str
    public_key: str = Field(pattern="^[0-9a-f]{64}$")
    signature: str = Field(pattern="^[0-9a-f]{128}$")

    def statement(self) -> Statement:
        """Return what it says. Raises `StorageError` if it says nothing that could have been signed."""
        try:
            return Statement.model_validate_json(self.content)
        except ValidationError as error:
            raise StorageError("a checkpoint cannot be read: it was changed") from error

    def is_signed(self) -> bool:
        """Return whether the signature is that of its key."""
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
