"""Header before a request or a response in Cyclone's mapping of services: whose call it is, and its number."""

from __future__ import annotations

import struct
from typing import NamedTuple

_ENCAPSULATION = 4  # bytes of a CDR message before its body
_SIZE = 16  # bytes of the header


class CallHeader(NamedTuple):
    """A call: the number of its client, and its own number among that client's calls."""

    client: int
    number: int


def with_header(header: CallHeader, message: bytes) -> bytes:
    """Return the CDR bytes `message` with the header before its body."""
    order = "<" if message[1] else ">"
    return message[:_ENCAPSULATION] + struct.pack(f"{order}Qq", *header) + message[_ENCAPSULATION:]


def split_header(data: bytes) -> tuple[CallHeader, bytes] | None:
    """Return the header of the received bytes and the CDR bytes without it, or None when they are no call."""
    if len(data) < _ENCAPSULATION + _SIZE or data[:2] not in (b"\0\0", b"\0\1"):
        return None
    order = "<" if data[1] else ">"
    header = CallHeader(*struct.unpack_from(f"{order}Qq", data, _ENCAPSULATION))
    return header, data[:_ENCAPSULATION] + data[_ENCAPSULATION + _SIZE :]
