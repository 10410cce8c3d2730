"""What can follow a state, start by start."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State


class Stepping:
    """Runs of one automaton under one supervisor, whose starts are taken one at a time."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._safe = None if supervisor.safe.everything else supervisor.safe

    def begin(self, state: State) -> CompiledRun:
        """A run that is in `state`."""
        return CompiledRun(self._compiled, state)

    def following(self, run: CompiledRun) -> Iterator[tuple[str, CompiledRun]]:
        """The starts that can be taken, each with the run after it; the same ones in the same order each time."""
        for name in sorted(run.startable()):
            after = run.fork()
            if after.start(name) and (self._safe is None or self._safe.includes(after.values)):
                yield name, after

    @cached_property
    def _compiled(self) -> CompiledTick:
        return CompiledTick(self._automaton, hot=False)
