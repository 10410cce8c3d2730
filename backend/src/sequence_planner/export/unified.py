"""Any one-shot planner of the unified-planning library as an engine; `pip install .[pddl]` brings it and Fast Downward.

The library and the planner work in a process of their own, which is killed when the time is over. What they find is a
plan of ours once it has been replayed, as that of every engine. Run as a program, this module is that process.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.export.pddl import PddlText, pddl_text
from sequence_planner.export.sequential import ExportError, sequential
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Contract, Plan
from sequence_planner.process.budget import Budget

FAST_DOWNWARD = "fast-downward"


class UnifiedPlanningError(Exception):
    """The library has no such planner, or it failed."""


def installed() -> bool:
    """Return whether the library and Fast Downward are there."""
    return all(find_spec(name) is not None for name in ("unified_planning", "up_fast_downward"))


def planners() -> tuple[str, ...]:
    """The names of the one-shot planners that the library can use here; none without the library."""
    if not installed():
        return ()
    factory = import_module("unified_planning.shortcuts").get_environment().factory
    return tuple(sorted(name for name in factory.engines if factory.engine(name).is_oneshot_planner()))


class UnifiedPlanning:
    """Plans by the planner that the library knows as `name`. It has no part in minimal plans, and proves nothing."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, name: str = FAST_DOWNWARD) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self.name = name

    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan, if one is found in time; nothing for a question that has no counterpart in PDDL.

        Raises `UnifiedPlanningError`.
        """
        if task.contract is not Contract.FAST:
            return Finding()
        try:
            question = sequential(self._automaton, self._supervisor, task.state, task.goals, task.circumstances)
            text = pddl_text(question)
        except ExportError:
            return Finding()
        plan = self._planned(text, budget)
        return Finding() if plan is None or len(plan.ticks) > task.longest else Finding(plan)

    def _planned(self, text: PddlText, budget: Budget) -> Plan | None:
        with tempfile.TemporaryDirectory() as folder:
            domain, problem, written = (Path(folder) / name for name in ("domain.pddl", "problem.pddl", "plan"))
            domain.write_text(text.domain, encoding="utf-8")
            problem.write_text(text.problem, encoding="utf-8")
            process = subprocess.Popen(
                [sys.executable, "-m", __name__, self.name, domain, problem, written],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                start_new_session=True,  # so that the planner it starts ends with it
            )
            try:
                with budget.interrupting(lambda: _kill(process)):
                    _, said = process.communicate()
            finally:
                _kill(process)
            if process.returncode and not budget.spent:
                lines = said.decode(errors="replace").strip().splitlines() or ["it said nothing"]
                raise UnifiedPlanningError(f"the planner {self.name} failed: {lines[-1]}")
            return text.plan(written.read_text(encoding="utf-8")) if written.exists() else None


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End it with all that it has started: planners put their own processes into groups of their own."""
    descendants = _descendants(process.pid)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    for each in descendants:
        with contextlib.suppress(ProcessLookupError):
            os.kill(each, signal.SIGKILL)


def _descendants(pid: int) -> list[int]:
    """Return what the process, and what it has started, has started; where the system lists processes in files."""
    children: dict[int, list[int]] = {}
    for status in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            parent = int(status.read_text().rpartition(")")[2].split()[1])
            children.setdefault(parent, []).append(int(status.parent.name))
    found: list[int] = []
    pending = [pid]
    while pending:
        new = children.get(pending.pop(), [])
        found += new
        pending += new
    return found


def _solve(name: str, domain: str, problem: str, written: str) -> None:
    """Have the library plan, and write an action on each line. The file is there once it is complete."""
    io = import_module("unified_planning.io")
    shortcuts = import_module("unified_planning.shortcuts")
    shortcuts.get_environment().credits_stream = None
    asked = io.PDDLReader().parse_problem(domain, problem)
    with shortcuts.OneshotPlanner(name=name) as planner:
        plan = planner.solve(asked).plan
    if plan is not None:
        unfinished = Path(f"{written}.unfinished")
        unfinished.write_text("".join(f"({each.action.name})\n" for each in plan.actions), encoding="utf-8")
        unfinished.rename(written)


if __name__ == "__main__":
    _solve(*sys.argv[1:])
