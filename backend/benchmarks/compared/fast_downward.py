"""Fast Downward (Helmert 2006) as `up-fast-downward` brings it: lazy greedy search with the FF heuristic."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from compared.timing import child

from sequence_planner.export.pddl import PddlText
from sequence_planner.planning.problem import Plan

SEARCH = "let(ff, ff(), lazy_greedy([ff], preferred=[ff]))"


class Outcome(NamedTuple):
    """The CPU time of the search, a process of its own, and the plan; None where it was stopped."""

    seconds: float
    plan: Plan | None


def programs() -> Path | None:
    """The folder of its programs, or None where it is not installed."""
    found = find_spec("up_fast_downward")
    if found is None or found.origin is None:
        return None
    return Path(found.origin).parent / "downward" / "builds" / "release" / "bin"


class TranslationError(Exception):
    """It could not bring the question into its own format, or not in time."""


def translated(text: PddlText, folder: Path, limit: float = 30) -> Path:
    """The question in its own format, which the search reads; not measured. Raises `TranslationError`."""
    bin_ = programs()
    assert bin_ is not None
    domain, problem, sas = folder / "domain.pddl", folder / "problem.pddl", folder / "question.sas"
    sas.unlink(missing_ok=True)  # that of the question before
    domain.write_text(text.domain)
    problem.write_text(text.problem)
    # That many candidates are its variables themselves, which is what we want to know the invariants of.
    options = ("--invariant-generation-max-candidates", str(text.domain.count("\n")))
    command = (sys.executable, "-m", "fast_downward.translate", *options, "--sas-file", sas, domain, problem)
    ended = child(command, limit, folder=bin_)
    if not sas.exists():
        raise TranslationError(ended.output[-500:].strip() or f"not within {limit:g} s")
    return sas


def search(text: PddlText, sas: Path, limit: float) -> Outcome:
    """One search from the start of the process on."""
    bin_ = programs()
    assert bin_ is not None
    plan = sas.with_name("plan")
    plan.unlink(missing_ok=True)
    ended = child((bin_ / "downward", "--internal-plan-file", plan, "--search", SEARCH), limit, stdin=sas)
    return Outcome(ended.seconds, text.plan(plan.read_text()) if plan.exists() else None)
