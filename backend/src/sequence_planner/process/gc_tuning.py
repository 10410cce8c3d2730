"""Python's collector of reference cycles, put off where much is made that stays."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

_MUCH = 500_000  # objects that others can refer to, some hundred MB at most


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


@contextmanager
def collection_seldom() -> Iterator[None]:
    """For a command that answers one question and ends: collect only when there is much; what is left ends with it."""
    usual = gc.get_threshold()
    gc.set_threshold(_MUCH, *usual[1:])
    try:
        yield
    finally:
        gc.freeze()
        gc.set_threshold(*usual)


def keep_everything() -> None:
    """Keep what there is now: it is looked through once more, and then never again, since each look stops all else."""
    gc.collect()
    gc.freeze()
