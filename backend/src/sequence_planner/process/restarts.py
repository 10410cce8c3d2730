"""Restarts of a part of the station by the launcher: their number, told in a file of its folder to who asks for it."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping
from pathlib import Path

NAME = "restarts.json"


def write_restarts(folder: Path, restarts: Mapping[str, int]) -> None:
    """Tell them, whole or not at all. A disk that is full must not end who watches over the station."""
    new = folder / f"{NAME}.new"
    with contextlib.suppress(OSError):
        new.write_text(json.dumps(restarts), encoding="utf-8")
        new.replace(folder / NAME)


def read_restarts(folder: Path) -> dict[str, int]:
    """By the name of the part; empty where no launcher has told any."""
    try:
        read = json.loads((folder / NAME).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return {str(name): int(count) for name, count in read.items()} if isinstance(read, dict) else {}
