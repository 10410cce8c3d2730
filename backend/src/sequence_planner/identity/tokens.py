"""Tokens, codes and ids: all drawn from the system's source of randomness; of what is secret only a hash is kept."""

from __future__ import annotations

import re
import secrets
from hashlib import sha256

_ID = re.compile(r"[0-9a-z]{1,40}")


def new_id() -> str:
    """An id that may be seen by anybody: 16 hexadecimal digits, never used before."""
    return secrets.token_hex(8)


def is_id(text: str) -> bool:
    """Whether `text` could be an id at all; what could not is not asked of a database."""
    return _ID.fullmatch(text) is not None


def new_token() -> str:
    """A secret of 32 random bytes, fit for a URL's fragment, a cookie and a header."""
    return secrets.token_urlsafe(32)


def new_code() -> str:
    """Eight decimal digits that a person types: worth something only while few guesses are allowed."""
    return f"{secrets.randbelow(10**8):08}"


def hash_of(secret: str) -> str:
    """SHA-256 in hexadecimal digits. With 256 random bits in what is hashed, no slower hash is needed."""
    return sha256(secret.encode("utf-8", "surrogatepass")).hexdigest()


def same(one: str, other: str) -> bool:
    """Whether two hashes are the same, found out in a time that does not tell where they differ."""
    return secrets.compare_digest(one, other)
