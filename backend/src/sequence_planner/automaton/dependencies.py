"""What depends on what: the order of flags."""

from __future__ import annotations

from collections.abc import Sequence
from graphlib import CycleError, TopologicalSorter

from sequence_planner.automaton.structure import Flag
from sequence_planner.expressions.syntax import variables


def ordered_flags(flags: Sequence[Flag]) -> tuple[tuple[Flag, ...], tuple[str, ...]]:
    """The flags in an order in which none reads a later one, and a circle of names if there is no such order."""
    by_name = {flag.name: flag for flag in flags}
    graph = {flag.name: [read for read in variables(flag.predicate) if read in by_name] for flag in flags}
    try:
        order = tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        return tuple(flags), tuple(error.args[1])
    return tuple(by_name[name] for name in order), ()
