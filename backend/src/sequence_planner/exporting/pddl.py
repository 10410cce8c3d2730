"""Questions in PDDL, the language of classical planners, and their plans read back.

The texts use STRIPS with negative and disjunctive conditions and conditional effects (Fox and Long 2003, level 1), and
neither types nor parameters of actions.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from sequence_planner.exporting.pddl_writer import PddlWriter
from sequence_planner.exporting.sequential import ExportError, Move, Sequential
from sequence_planner.planning.plan import Plan, PlanTick

# A line of a plan: an action in brackets, perhaps with the time before it.
_STEP = re.compile(r"^\s*(?:[\d.]+\s*:)?\s*\(\s*([^\s()]+)\s*\)")


@dataclass(frozen=True)
class PddlText:
    """A question as texts of PDDL. `moves` says what each action is in a run of ticks, by its name there."""

    domain: str
    problem: str
    moves: Mapping[str, tuple[Move, str]]

    def plan(self, text: str) -> Plan:
        """The plan that a planner has written, an action on each line, as the ticks it means.

        Where nothing else makes ticks, a goal that is reached ends one, and so does a start that comes again. Raises
        `ExportError` for an action that is none of ours.
        """
        ticks: list[PlanTick] = []
        effects: list[str] = []
        starts: list[str] = []

        def end_tick() -> None:
            ticks.append(PlanTick(tuple(effects), tuple(starts)))
            effects.clear()
            starts.clear()

        moves = [self._move(step[1]) for line in text.splitlines() if (step := _STEP.match(line))]
        for move, name in moves:
            if move is Move.BEGIN or (move is Move.REACH and starts) or (move is Move.START and name in starts):
                end_tick()
            if move is Move.EFFECT:
                effects.append(name)
            elif move is Move.START:
                starts.append(name)
        if moves:
            end_tick()
        return Plan(_without_last_starts(ticks), minimal_ticks=False, minimal_starts=False)

    @cached_property
    def timed(self) -> bool:
        """Whether it goes by ticks; else each start could have one of its own."""
        return any(move is Move.SETTLED for move, _ in self.moves.values())

    def _move(self, action: str) -> tuple[Move, str]:
        found = self.moves.get(action.lower())
        if found is None:
            raise ExportError(f"the plan has the action `{action}`, which the exported domain has not")
        return found


def pddl_text(question: Sequential) -> PddlText:
    """The question in PDDL. Raises `ExportError` for an expression that takes too many cases."""
    writer = PddlWriter(question)
    return PddlText(writer.domain(), writer.problem(), {name: move for name, move, _ in writer.actions})


def _without_last_starts(ticks: list[PlanTick]) -> tuple[PlanTick, ...]:
    """The goals count after step 3, so what the last tick starts is of no use."""
    return (*ticks[:-1], PlanTick(ticks[-1].effects, ())) if ticks else ()
