"""Berkeley ABC, a model checker for hardware: `bmc3` for shortest plans, `pdr` for proofs that there is none."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import NamedTuple

from compared.timing import child

PROGRAM = shutil.which("berkeley-abc") or shutil.which("abc")


class Outcome(NamedTuple):
    """The CPU time of the process; how many ticks the plan has, or 0; whether it is proven that there is none."""

    seconds: float
    ticks: int
    proven: bool


def bmc3(circuit: Path, limit: float) -> Outcome:
    """Bounded model checking (Biere et al. 1999)."""
    return _run(f"read_aiger {circuit}; bmc3 -T {limit:.0f}", limit)


def pdr(circuit: Path, limit: float) -> Outcome:
    """Property directed reachability (Een, Mishchenko and Brayton 2011)."""
    return _run(f"read_aiger {circuit}; pdr -T {limit:.0f}", limit)


def _run(script: str, limit: float) -> Outcome:
    assert PROGRAM is not None
    ended = child((PROGRAM, "-c", script), limit + 5)
    found = re.search(r"asserted in frame (\d+)", ended.output)
    return Outcome(ended.seconds, int(found[1]) + 1 if found else 0, "Property proved" in ended.output)
