"""The key that signs checkpoints: an Ed25519 key in a file of this user alone, never in the database."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import TYPE_CHECKING

from sequence_planner.storage.address import PostgresqlServer, SqliteFile
from sequence_planner.storage.error import StorageError
from sequence_planner.storage.location import state_folder

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey


def key_file(place: SqliteFile | PostgresqlServer) -> Path:
    """Where the key is: beside the file of SQLite; for PostgreSQL in this user's state folder."""
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
