"""How the parts of a product look, and what is written beside them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, Literal

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.language.types import IntegerRange, Type, Value
from sequence_planner.model.mimic.documents import Look

MOST_PARTS: Final = 240  # of one variable: more could not be told apart


_BELOW_RING: Final = 17  # units: around what is worked on there is a ring


def label_place(
    marks: Sequence[tuple[float, float]], size: float, side: Literal["below", "right"]
) -> tuple[float, float]:
    """Return where the label of a part stands whose marks are drawn there."""
    x, y = (sum(each) / len(marks) for each in zip(*marks, strict=True))
    if side == "right":
        return max(each for each, _ in marks) + size * 0.9, y
    return x, y + (max(size * 1.4, size / 2 + _BELOW_RING) if len(marks) == 1 else 4)


def looks_of(of: Type) -> dict[str, Look]:
    """The look of each value: with the first it is empty, with the last done, and placed in between. A number is
    never done."""
    values = [text_of_value(each) for each in of.domain]
    looks: dict[str, Look] = dict.fromkeys(values, "placed")
    looks[values[0]] = "empty"
    if len(values) > 1 and not isinstance(of, IntegerRange):
        looks[values[-1]] = "done"
    return looks


def titles_of(automaton: Automaton, variable: str) -> dict[str, dict[str, str]]:
    """What the values of a variable are called by people, for those that the model has words for."""
    written = automaton.titles
    of, own = automaton.variables[variable].type, written.variables.get(without_arguments(variable))
    called = {value: (own.values.get(value) if own else None) or written.of_value(of, value) for value in of.domain}
    return {text_of_value(value): dict(words) for value, words in called.items() if words}


def text_of_value(value: Value) -> str:
    """A value as the page knows it in a list of texts."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def labels_of(indices: Sequence[str]) -> list[str]:
    """A short label for each index: the number in its name where these tell them apart, else its place in the order."""
    numbers = [re.findall(r"\d+", each) for each in indices]
    for which in (-1, 0):
        found = [each[which] if each else "" for each in numbers]
        if all(found) and (len(set(found)) == len(set(indices))):
            return found
    places = {each: str(number + 1) for number, each in enumerate(dict.fromkeys(indices))}
    return [places[each] for each in indices]
