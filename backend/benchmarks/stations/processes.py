"""The processes of a station that is measured, as the system shows them (proc(5))."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

_TICKS = os.sysconf("SC_CLK_TCK")
_PROC = Path("/proc")


@dataclass(frozen=True)
class Process:
    """One of them; `title` is its command line in one text."""

    number: int
    parent: int
    begun: int
    title: str
    seconds: float
    """Of a processor, with those that it has started and waited for."""

    def runs(self, name: str) -> bool:
        """Whether it is the part of a station that runs the command `name`, forked or executed."""
        return re.search(rf"(?:^sequence-planner|sequence_planner\.cli) {name} ", self.title) is not None

    @property
    def megabytes(self) -> float:
        """The memory that is its own, and its share of what it has in common with others."""
        text = (_PROC / str(self.number) / "smaps_rollup").read_text()
        return int(next(line for line in text.splitlines() if line.startswith("Pss:")).split()[1]) / 1024


def station_processes(launcher: int) -> list[Process]:
    """The launcher and all that descend from it, the oldest first."""
    everybody = {each.number: each for each in map(_process, _PROC.glob("[0-9]*")) if each is not None}
    found = {launcher}
    while more := {each.number for each in everybody.values() if each.parent in found} - found:
        found |= more
    return sorted((everybody[number] for number in found if number in everybody), key=lambda each: each.begun)


def part(launcher: int, name: str) -> Process | None:
    """The process that runs the command `name`; None while there is none."""
    return next((each for each in station_processes(launcher) if each.runs(name)), None)


def _process(folder: Path) -> Process | None:
    try:
        fields = (folder / "stat").read_text().rpartition(")")[2].split()
        title = (folder / "cmdline").read_text(errors="replace").replace("\0", " ").strip()
    except OSError:  # it has ended just now
        return None
    seconds = sum(map(int, fields[11:15])) / _TICKS
    return Process(int(folder.name), int(fields[1]), int(fields[19]), f"{title} ", seconds)
