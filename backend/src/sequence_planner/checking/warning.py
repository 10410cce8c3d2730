"""A suspicion about a model, and how the parts of a model are named in it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from sequence_planner.automaton.grounding.findings import without_arguments
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.expressions.place import Place
from sequence_planner.expressions.printing import print_value
from sequence_planner.synthesis.traces import Trace

MOST_NAMED = 4  # of several names in a message


@dataclass(frozen=True, order=True)
class ModelWarning:
    """Where something is suspicious, a stable name for what it is, and what to do about it.

    A `trace` shows how it comes about, where there is one to show.
    """

    place: Place
    kind: str
    message: str
    trace: Trace | None = field(default=None, compare=False)

    def __str__(self) -> str:
        return f"{self.place}: warning: {self.message} [{self.kind}]"


def place(automaton: Automaton, *names: str) -> Place:
    """Where the first of `names` that is known was written; else the beginning of the model."""
    return next((automaton.places[name] for name in names if name in automaton.places), Place(automaton.name, 1, 1))


def families(names: Iterable[str]) -> Mapping[str, tuple[str, ...]]:
    """Ground names by what was written: the instances of `move(p)` under `move`."""
    found: dict[str, list[str]] = defaultdict(list)
    for name in names:
        found[without_arguments(name)].append(name)
    return {family: tuple(members) for family, members in found.items()}


def listed(names: Sequence[str], most: int | None = MOST_NAMED) -> str:
    """Several names, in backticks; of more than `most` only the first."""
    shown = ", ".join(f"`{name}`" for name in names[:most])
    return shown if most is None or len(names) <= most else f"{shown} and {len(names) - most} more"


def described(state: State, names: Iterable[str]) -> str:
    """The values of `names`, as a condition of the language."""
    return " and ".join(f"{name} == {_shown(state, name)}" for name in names)


def _shown(state: State, name: str) -> str:
    value = state[name]
    return "unknown" if value is None else print_value(value)
