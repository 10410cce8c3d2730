"""Which names of a resource are free for what a new topic brings."""

from __future__ import annotations

import re
from collections.abc import Iterable

from sequence_planner.attaching.errors import AttachError
from sequence_planner.attaching.network import InOut
from sequence_planner.automaton.grounding.declarations import FLAGS
from sequence_planner.automaton.structure import Kind
from sequence_planner.expressions.lexer import KEYWORDS
from sequence_planner.station import ReadyStation

_RESOURCE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)


def check_resource(name: str) -> None:
    """Raise `AttachError` unless a resource may have this name."""
    if not _RESOURCE.fullmatch(name) or name in KEYWORDS | {"null"}:
        raise AttachError("bad-name", f"`{name}` is no name for a resource: write letters, digits and underscores")


def renamed(
    fields: Iterable[str], station: ReadyStation, resource: str, topic: str, direction: InOut
) -> dict[str, str]:
    """The fields that must be called otherwise, because something has their name, each with a name that is free."""
    taken = _taken(station, resource, direction)
    found: dict[str, str] = {}
    for field in fields:
        if field in taken:
            stem = f"{topic.rsplit('/', 1)[-1]}_{field}"
            names = (stem, *(f"{stem}_{number}" for number in range(2, 1000)))
            found[field] = next(each for each in names if each not in taken)
        taken.add(found.get(field, field))
    return found


def _taken(station: ReadyStation, resource: str, direction: InOut) -> set[str]:
    automaton, fed = station.automaton, station.pipelines.feeds
    persons = {each.human.acknowledgement for each in automaton.abilities.values() if each.human is not None}
    taken = set(FLAGS)
    taken |= {_short(name, resource) for name, each in automaton.abilities.items() if each.resource == resource}
    for name, variable in automaton.variables.items():
        if variable.resource == resource:
            is_open = variable.kind is Kind.MEASURED and name not in fed and name not in persons
            if direction == "out":
                is_open = variable.kind is not Kind.MEASURED
            if not is_open:
                taken.add(_short(name, resource))
    return taken


def _short(name: str, resource: str) -> str:
    """A ground name without its resource and parameters."""
    return re.split(r"[\[(]", name.removeprefix(f"{resource}."), maxsplit=1)[0]
