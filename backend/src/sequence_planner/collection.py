"""Python's collector of reference cycles, put off where much is made that stays."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collection_put_off() -> Iterator[None]:
    """Collect nothing meanwhile: a large model is a million objects, and looking for cycles doubles the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def keep_everything() -> None:
    """What there is now stays: it is looked through once more, and then never again, since each look stops all else."""
    gc.collect()
    gc.freeze()
