"""Secrets of webhooks in the database: sealed, since they must be there to sign, under a key that is not in it.

The key is in a file of this user alone, beside that of SQLite or in this user's state folder. Whoever has only the
database, or a backup of it, can neither read a secret nor put another in its place (AES-256-GCM, bound to the webhook's
id).
"""

from __future__ import annotations

import base64
import os
from pathlib import Path
from typing import TYPE_CHECKING, Final

from sequence_planner.journal import signing_key
from sequence_planner.storage.address import PostgresqlServer, SqliteFile
from sequence_planner.storage.error import StorageError

if TYPE_CHECKING:  # most stations have no webhooks
    from cryptography.hazmat.primitives.ciphers.aead import AESGCM

_KEY_SIZE: Final = 32  # bytes
_NONCE_SIZE: Final = 12


class UnreadableSecretError(Exception):
    """A secret cannot be read, as its key is not the one that it was sealed with."""


def key_file(place: SqliteFile | PostgresqlServer) -> Path:
    """Where the key is."""
    checkpoints = signing_key.key_file(place)
    return checkpoints.with_name(checkpoints.name.replace("checkpoint-key", "webhook-key").replace(".pem", ".key"))


class Seal:
    """Seals and opens with the key in a file, which is made with the first secret."""

    def __init__(self, file: Path) -> None:
        self._file = file

    def seal(self, secret: str, webhook: str) -> str:
        """A secret as it is stored. Raises `StorageError` when there is no key and none can be made."""
        nonce = os.urandom(_NONCE_SIZE)
        return base64.b64encode(
            nonce + self._cipher(make=True).encrypt(nonce, secret.encode(), webhook.encode())
        ).decode()

    def open(self, sealed: str, webhook: str) -> str:
        """The secret. Raises `UnreadableSecretError`, and `StorageError` when the file cannot be read."""
        from cryptography.exceptions import InvalidTag  # noqa: PLC0415 - see above

        stored = base64.b64decode(sealed)
        if not self._file.exists():
            raise UnreadableSecretError(f"{self._file} is not there, with which its secret was sealed")
        try:
            opened = self._cipher().decrypt(stored[:_NONCE_SIZE], stored[_NONCE_SIZE:], webhook.encode())
        except InvalidTag:
            raise UnreadableSecretError(f"its secret was sealed with another key than that in {self._file}") from None
        return opened.decode()

    def _cipher(self, *, make: bool = False) -> AESGCM:
        from cryptography.hazmat.primitives.ciphers.aead import AESGCM  # noqa: PLC0415 - see above

        try:
            if make and not self._file.exists():
                _make(self._file)
            key = self._file.read_bytes()
        except OSError as error:
            raise StorageError(
                f"{self._file}, the key of webhooks' secrets, cannot be used: {error.strerror}"
            ) from error
        if len(key) != _KEY_SIZE:
            raise StorageError(f"{self._file} holds no key of webhooks' secrets: put the right one in its place")
        return AESGCM(key)


def _make(file: Path) -> None:
    """Write a new key, whole or not at all; of several that do so at once the first wins."""
    file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    new = file.with_name(f"{file.name}.{os.getpid()}.{os.urandom(4).hex()}")
    descriptor = os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
    try:
        with os.fdopen(descriptor, "wb") as opened:
            opened.write(os.urandom(_KEY_SIZE))
            opened.flush()
            os.fsync(opened.fileno())
        try:
            os.link(new, file)
        except FileExistsError:
            return
    finally:
        new.unlink()
