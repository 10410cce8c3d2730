"""structlog without rich and Twisted, which it imports wherever they are installed and which nothing here uses.

Together they take four times as long to import as structlog itself. Whoever is the first to import structlog in a
process does it by this module.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

__all__ = ["structlog"]

_UNUSED: Final = ("rich", "twisted")


@contextmanager
def _as_if_not_installed(names: tuple[str, ...]) -> Iterator[None]:
    """Let no package of these be imported, but what has been already."""
    absent = [name for name in names if name not in sys.modules]
    sys.modules.update(dict.fromkeys(absent))  # type: ignore[arg-type]  # None there means that there is no such module
    try:
        yield
    finally:
        for name in absent:
            del sys.modules[name]


with _as_if_not_installed(_UNUSED):
    import structlog
