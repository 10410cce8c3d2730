"""The faults of a model, gathered while it is grounded, and the parameters that grounding replaces by values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from sequence_planner.language.syntax import Span
from sequence_planner.language.types import EnumerationType, Place
from sequence_planner.model.source import Finding, SourceText

# What each parameter is: its value, and the enumeration it is of.
Binding = Mapping[str, tuple[str, EnumerationType]]


class Findings:
    """The findings so far."""

    def __init__(self) -> None:
        self.all: list[Finding] = []

    def add(self, where: SourceText | Place, message: str) -> None:
        """Note what is wrong at `where`."""
        self.all.append(Finding(where.place if isinstance(where, SourceText) else where, message))

    def add_within(self, text: SourceText, span: Span, message: str) -> None:
        """Note what is wrong at a part of `text`."""
        self.all.append(Finding(text.at(span), message))


def instance_name(name: str, binding: Binding, indexed: bool = False) -> str:
    """The name of a ground instance: `move_to_position(home)`, or `bolts[bolt_pair_1]` for a variable."""
    return with_arguments(name, (value for value, _ in binding.values()), indexed)


def with_arguments(name: str, values: Iterable[str], indexed: bool = False) -> str:
    """`name` with its arguments behind it."""
    arguments = ", ".join(values)
    if not arguments:
        return name
    return f"{name}[{arguments}]" if indexed else f"{name}({arguments})"


def without_arguments(name: str) -> str:
    """The name of what a ground instance is one of."""
    return re.sub(r"[\[(][^\])]*[\])]", "", name) if "(" in name or "[" in name else name


def readable(title: SourceText | None, name: str, binding: Binding) -> str:
    """A title, or the name in plain words, with `{parameter}` replaced by its value in plain words."""
    text = str(title) if title is not None else name.replace("_", " ")
    for parameter, (value, _) in binding.items():
        text = text.replace(f"{{{parameter}}}", value.replace("_", " "))
    return text
