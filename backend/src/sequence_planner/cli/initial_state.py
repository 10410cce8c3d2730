"""The moment a command begins at: the initial state, or one that a file holds."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.tick import initial_state, record_activity, synchronise
from sequence_planner.cli.options import refuse
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import contains

T = TypeVar("T")
StateFile = Annotated[
    str | None, typer.Option("--state", metavar="FILE", help="Begin with the state in FILE (- is standard input).")
]


@dataclass(frozen=True)
class StartingPoint:
    """A state, and the operations that are active in it."""

    state: State
    active: frozenset[str]


def named(known: Mapping[str, T], name: str, what: str) -> T:
    """Return what of `known` bears the name; end the command if nothing does."""
    if name not in known:
        refuse(f"there is no {what} `{name}`{suggestion(name, known)}")
    return known[name]


MOST_NAMED = 4  # of several operations


def named_operation(automaton: Automaton, name: str) -> str:
    """Return the name of an operation; end the command if it is none, and say which are meant if it is of several."""
    if name in automaton.operations:
        return name
    within = [each for each in automaton.operations if f"operation.{each}.sequence.{name}" in automaton.places]
    if name in automaton.work_masters:
        within = [each for each in automaton.operations if each in automaton.work_masters[name].operations]
    if within:
        what = "a work master" if name in automaton.work_masters else "a sequence"
        some = ", ".join(f"`{each}`" for each in within[:MOST_NAMED])
        of = f"its operations are {some}" + (f" and {more} more" if (more := len(within) - MOST_NAMED) > 0 else "")
        refuse(f"`{name}` is {what}, and a plan is for operations that are active together: name some ({of})")
    return named(automaton.operations, name, "operation").name


def moment(automaton: Automaton, file: str | None) -> StartingPoint:
    """Return what `file` holds, as `tick --json` writes it.

    Variables that are left out have their initial value, which must be one alone, and flags equal their predicates.
    """
    if file is None:
        return StartingPoint(initial_state(automaton), frozenset())
    try:
        text = sys.stdin.read() if file == "-" else Path(file).read_text(encoding="utf-8")
        document = json.loads(text)
    except (OSError, ValueError, RecursionError) as error:
        refuse(f"{file} holds no state: {error}")
    values = document.get("state") if isinstance(document, dict) else None
    active = document.get("active", []) if isinstance(document, dict) else None
    if not isinstance(values, dict) or not isinstance(active, list):
        refuse(f'{file} holds no state: expected {{"state": {{variable: value}}, "active": [operation]}}')
    for name, value in values.items():
        if name not in automaton.types:
            refuse(f"{file}: there is no variable `{name}`{suggestion(name, automaton.types)}")
        if value is None and name in automaton.variables and automaton.variables[name].kind is not Kind.MEASURED:
            refuse(f"{file}: `{name}` is no measured variable: its value is always known")
        if value is not None and not contains(automaton.types[name], value):
            refuse(f"{file}: `{value}` is no value of `{name}`, which ranges over {automaton.types[name]}")
    for name in active:
        named(automaton.operations, str(name), "operation")
    if automaton.initial is not None and (left := [name for name in automaton.variables if name not in values]):
        refuse(f"{file}: `initial` describes several states, so each variable needs a value: {', '.join(left)}")
    now = frozenset(map(str, active))
    state = record_activity(automaton, synchronise(automaton, {**automaton.initial_valuation, **values}), now)
    return StartingPoint({**state, **values}, now)
