"""How emulated devices behave: an effect of the model happens some time after its guard has come to hold.

A device knows the commands it was sent and its own state, never what the controller believes. Behind a discretised
variable there are numbers, which glide to their next named point while the effect that leads there is on its way.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.automaton.structure import Automaton, Kind, target
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.expressions.types import Value, contains
from sequence_planner.pipelines.pipeline import StationPipelines
from sequence_planner.pipelines.stages import DiscretiseStage, Record

Numbers = tuple[float, ...]

# How far outside the tolerance a device between named points starts, in tolerances.
_JUST_OUTSIDE = 2.0


@dataclass(frozen=True)
class _Underway:
    """An effect that will write `writes` at `due`; `origin` has the numbers from which a glide began."""

    began: float
    due: float
    writes: Mapping[str, Value]
    origin: Mapping[str, Numbers]


class EmulatedDevices:
    """The devices behind all topics of a station. Times are seconds on any clock that only goes forward.

    `speed` divides all durations; `seed` draws them. Effects on variables that no topic feeds, such as a person's
    acknowledgement, are nobody's here and never happen.
    """

    def __init__(self, automaton: Automaton, pipelines: StationPipelines, speed: float = 1.0, seed: int = 0) -> None:
        self._automaton = automaton
        self._pipelines = pipelines
        self._speed = speed
        self._random = random.Random(seed)
        fed = pipelines.feeds
        self._effects = [
            effect
            for effect in automaton.effects
            if not effect.fault and all(target(action) in fed for action in effect.actions)
        ]
        # Nothing has been commanded yet, so the outputs are unknown until a message brings them.
        self.state: dict[str, Value | None] = dict(automaton.initial_valuation)
        self.state |= dict.fromkeys((*automaton.names(Kind.OUTPUT), *automaton.names(Kind.ESTIMATED)), None)
        self._stages = {s.variable: s for p in pipelines.incoming.values() for s in p.discretised}
        self._numbers: dict[str, Numbers] = {}
        self._set({name: automaton.variables[name].initial for name in self._stages})
        self._underway: dict[str, _Underway] = {}

    def command(self, topic: str, record: Record) -> list[str]:
        """Take a message on an outgoing topic of the station; returns what in it made no sense."""
        reading = self._pipelines.outgoing[topic].device_reading(record)
        self.state |= reading.values
        return reading.troubles

    def report(self, topic: str) -> dict[str, object]:
        """The message that the device behind an incoming topic would send now."""
        return self._pipelines.incoming[topic].device_record(self.state, self._numbers)

    def put(self, variable: str, value: Value) -> None:
        """Bring a measured variable to a value by hand. Raises ValueError for a variable or value that is none."""
        if variable not in self._pipelines.feeds:
            known = ", ".join(sorted(self._pipelines.feeds))
            raise ValueError(f"no emulated device has `{variable}`; there are {known}")
        type_ = self._automaton.variables[variable].type
        if not contains(type_, value):
            raise ValueError(f"`{value}` is no value of {variable}, which ranges over {type_}")
        self._set({variable: value})
        self._underway.clear()  # what was on its way starts anew from here

    def advance(self, now: float) -> None:
        """Let everything happen that is due at `now`, and set out on what has become possible."""
        for effect in self._effects:
            writes = effect_writes(effect, self.state)
            if not writes:
                self._underway.pop(effect.name, None)
                continue
            underway = self._underway.get(effect.name)
            if underway is None or underway.writes != writes:  # a new destination is a new journey
                seconds = self._random.uniform(effect.shortest, effect.longest) / self._speed
                underway = _Underway(now, now + seconds, writes, dict(self._numbers))
                self._underway[effect.name] = underway
            if now >= underway.due:
                self._set(writes)
                del self._underway[effect.name]
            else:
                self._glide(writes, underway, now)

    def _set(self, writes: Mapping[str, Value]) -> None:
        self.state |= writes
        for name, value in writes.items():
            if name in self._stages:
                self._numbers[name] = self._at(self._stages[name], value)

    def _at(self, stage: DiscretiseStage, value: Value) -> Numbers:
        """The numbers of a named point, or ones near where the device is that are at none."""
        if (point := stage.coordinates.points.get(str(value))) is not None:
            return point
        numbers = self._numbers.get(stage.variable) or next(iter(stage.coordinates.points.values()))
        step = _JUST_OUTSIDE * stage.tolerance
        while stage.coordinates.nearest(numbers, stage.tolerance) is not None:
            numbers = (numbers[0] + step, *numbers[1:])
            step *= 2  # in the end beyond every point
        return numbers

    def _glide(self, writes: Mapping[str, Value], underway: _Underway, now: float) -> None:
        share = (now - underway.began) / (underway.due - underway.began)
        for name, value in writes.items():
            target = self._stages[name].coordinates.points.get(str(value)) if name in self._stages else None
            if target is not None:
                origin = underway.origin[name]
                self._numbers[name] = tuple(a + share * (b - a) for a, b in zip(origin, target, strict=True))
