"""The addresses of a provider that are asked: by HTTPS, or without it on this machine alone."""

from __future__ import annotations

import re
from ipaddress import ip_address
from urllib.parse import SplitResult, urlsplit

LONGEST_ISSUER = 400  # characters of the address of a provider
_WRITTEN = re.compile(r"[!-~]{1,2000}")  # no blanks, nothing that does not show


def is_safe(url: str) -> bool:
    """Return whether nobody between can read or change what is said there."""
    if _WRITTEN.fullmatch(url) is None or "\\" in url:
        return False
    try:
        parts = urlsplit(url)
        _ = parts.port  # raises where it is none
    except ValueError:
        return False
    if not parts.hostname or parts.username is not None or parts.password is not None:
        return False
    return parts.scheme == "https" or (parts.scheme == "http" and _is_here(parts))


def _is_here(parts: SplitResult) -> bool:
    try:
        return parts.hostname == "localhost" or ip_address(parts.hostname or "").is_loopback
    except ValueError:
        return False
