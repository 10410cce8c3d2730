"""Processes whose fork server has died: who sees how they end."""

from __future__ import annotations

import contextlib
import ctypes
from typing import Final

_SUBREAPER: Final = 36  # PR_SET_CHILD_SUBREAPER of prctl(2)


def reap_orphans() -> None:
    """Be the parent of all that descends from this process and has lost its own, where the system lets one be."""
    with contextlib.suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(_SUBREAPER, 1, 0, 0, 0)
