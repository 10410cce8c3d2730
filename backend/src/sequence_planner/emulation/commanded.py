"""What an emulated device takes from a command: the variables that it says, found by trying their values.

A message is made from variables by stages that need not have an inverse. But the variables have few values, and mostly
each field depends on few of them, so a device can know every command that it may hear. Numbers are compared by their
distance: what is on the wire is rounded, and a command is always one of those that can be made.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from sequence_planner.automaton.structure import Automaton
from sequence_planner.expressions.types import Value
from sequence_planner.pipelines.graph import OutgoingPipeline, Setting
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.running_outgoing import first_message
from sequence_planner.pipelines.stages.values import shown

# Commands that a group of fields may have, so that all can be known beforehand.
MOST_COMMANDS = 20_000


class NotUnderstoodError(Exception):
    """A device cannot know what its commands mean; the text says why and what to do."""


@dataclass(frozen=True)
class _Group:
    """Fields of a message that depend on the same variables, and what they are for all values of these."""

    variables: tuple[str, ...]
    paths: tuple[FieldPath, ...]
    known: tuple[tuple[tuple[object, ...], tuple[Value, ...]], ...]

    def read(self, message: Mapping[str, object]) -> tuple[Value, ...] | None:
        """The values for which the fields are nearest to those of a message; None when they are like none."""
        said = tuple(_plain(path.get(message)) for path in self.paths)
        distance, values = min(
            ((_distance(said, fields), values) for fields, values in self.known),
            key=lambda each: each[0],
            default=(math.inf, None),
        )
        return values if distance < math.inf else None


class CommandReader:
    """Reads the messages of one outgoing topic as the device behind it does."""

    def __init__(self, pipeline: OutgoingPipeline, automaton: Automaton) -> None:
        """Raises `NotUnderstoodError` when the message has too many meanings."""
        self._groups = [_group(pipeline, automaton, settings) for settings in _together(pipeline.settings)]

    @property
    def variables(self) -> frozenset[str]:
        """What a message says."""
        return frozenset(name for group in self._groups for name in group.variables)

    def read(self, message: Mapping[str, object]) -> tuple[dict[str, Value | None], list[str]]:
        """The variables that a message says, unknown where it makes no sense, and what in it made none."""
        values: dict[str, Value | None] = {}
        troubles: list[str] = []
        for group in self._groups:
            read = group.read(message)
            values |= dict.fromkeys(group.variables) if read is None else dict(zip(group.variables, read, strict=True))
            if read is None:
                said = " and ".join(f"{path} is {shown(path.get(message))}" for path in group.paths)
                troubles.append(f"{said}: no command makes it so")
        return values, troubles


def _together(settings: Iterable[Setting]) -> Iterator[list[Setting]]:
    """The settings that have to be read together, because they depend on common variables."""
    groups: list[list[Setting]] = []
    for setting in settings:
        if setting.depends:
            common = [group for group in groups if any(each.depends & setting.depends for each in group)]
            groups = [group for group in groups if group not in common]
            groups.append([each for group in common for each in group] + [setting])
    yield from groups


def _group(pipeline: OutgoingPipeline, automaton: Automaton, settings: list[Setting]) -> _Group:
    depends = frozenset().union(*(setting.depends for setting in settings))
    variables = tuple(name for name in pipeline.variables if name in depends)
    domains = [automaton.variables[name].type.domain for name in variables]
    if math.prod(map(len, domains)) > MOST_COMMANDS:
        what = f"{', '.join(variables)} have more than {MOST_COMMANDS} values together in {pipeline.topic.name}"
        raise NotUnderstoodError(f"{what}: send them in fields of their own, or emulate the device by hand")
    known = []
    paths = tuple(FieldPath(s.field, *_split(s.field)) for s in settings)
    for values in product(*domains):
        state = {**automaton.initial_valuation, **dict(zip(variables, values, strict=True))}
        message = first_message(pipeline, state)
        if message is not None:
            known.append((tuple(_plain(path.get(message)) for path in paths), values))
    return _Group(variables, paths, tuple(known))


def _split(field: str) -> tuple[str, tuple[str, ...]]:
    key, *steps = field.split(".")
    return key, tuple(steps)


def _plain(value: object) -> object:
    return tuple(map(_plain, value)) if isinstance(value, list) else value


def _distance(said: object, known: object) -> float:
    """How far a value is from another; infinite where they are of different kinds, or differ without a measure."""
    if isinstance(said, tuple) and isinstance(known, tuple):
        if len(said) != len(known):
            return math.inf
        return max((_distance(a, b) for a, b in zip(said, known, strict=True)), default=0.0)
    if isinstance(said, float) and isinstance(known, int | float) and not isinstance(known, bool):
        return abs(said - known) if math.isfinite(said) else math.inf
    if known is None:
        return 0.0  # left at its default: it says nothing
    return 0.0 if said == known and type(said) is type(known) else math.inf
