"""What Cyclone DDS itself writes to the log.

It writes a line for every sample that it cannot read. A peer that is known to write otherwise, and of which the station
has told in its own words, would fill the log so; as long as one is there these lines are left out. Errors never are.
"""

from __future__ import annotations

import threading
from ctypes import CDLL

from cyclonedds.internal import load_cyclonedds

_LIBRARY: CDLL = load_cyclonedds()

_FATAL, _ERROR, _WARNING = 1, 2, 4  # of its log.h

_lock = threading.Lock()
_hushed: set[object] = set()


def hush(whose: object, known: bool) -> None:
    """Leave out Cyclone's warnings as long as anybody in this process has `known` reasons for them; else write them."""
    with _lock:
        (_hushed.add if known else _hushed.discard)(whose)
        _LIBRARY.dds_set_log_mask(_FATAL | _ERROR if _hushed else _FATAL | _ERROR | _WARNING)
