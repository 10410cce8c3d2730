"""Emulated devices: delayed effects of the model, and decoding of commands to variables."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from itertools import product

from sequence_planner.automaton.automaton import Automaton, Effect, Kind, target
from sequence_planner.automaton.tick import effect_writes
from sequence_planner.language.records.field_paths import FieldPath, shown
from sequence_planner.language.types import Value, contains
from sequence_planner.pipelines.chain_runtime import first_message
from sequence_planner.pipelines.graph import Flow, OutgoingPipeline, Setting, StationPipelines
from sequence_planner.simulation.messages import CannotSpeakError, Message, glided, spoken

# What an emulated device takes from a command: the variables that it says, found by trying their values.
#
# A message is made from variables by stages that need not have an inverse. But the variables have few values, and
# mostly each field depends on few of them, so a device can know every command that it may hear. Numbers are compared
# by their distance: what is on the wire is rounded, and a command is always one of those that can be made.

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

    def __deepcopy__(self, memo: object) -> CommandReader:
        return self  # it never changes

    @property
    def variables(self) -> frozenset[str]:
        """The variables that a message says."""
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
    """Return how far a value is from another; infinite where they are of different kinds, or differ without a
    measure.
    """
    if isinstance(said, tuple) and isinstance(known, tuple):
        if len(said) != len(known):
            return math.inf
        return max((_distance(a, b) for a, b in zip(said, known, strict=True)), default=0.0)
    if isinstance(said, float) and isinstance(known, int | float) and not isinstance(known, bool):
        return abs(said - known) if math.isfinite(said) else math.inf
    if known is None:
        return 0.0  # left at its default: it says nothing
    return 0.0 if said == known and type(said) is type(known) else math.inf


# How emulated devices behave: an effect of the model happens some time after its guard has come to hold.
#
# A device knows the commands it was sent and its own state, never what the controller believes. Behind a discretised
# variable there are numbers, which glide to their next named point while the effect that leads there is on its way.


@dataclass(frozen=True)
class _Underway:
    """An effect of a `resource` that will write `writes` at `due`; `origin` has the messages from which a glide began,
    if it `glides`.
    """

    resource: str | None
    began: float
    due: float
    writes: Mapping[str, Value]
    origin: Mapping[str, Message]
    glides: bool


class EmulatedDevices:
    """The devices behind all topics of a station. Times are seconds on any clock that only goes forward.

    `speed` divides all durations; `seed` draws them, up to `jitter` seconds longer than the model has it. Effects on
    variables that no topic feeds, such as a person's acknowledgement, are nobody's here and never happen. With
    `resources` only the devices of these are emulated, and what the others say has to be told to `observe`.
    """

    def __init__(
        self,
        automaton: Automaton,
        pipelines: StationPipelines,
        speed: float = 1.0,
        seed: int = 0,
        *,
        jitter: float = 0.0,
        resources: Set[str] | None = None,
    ) -> None:
        self._automaton = automaton
        self._pipelines = pipelines
        self._speed = speed
        self._random = random.Random(seed)
        self._jitter = jitter
        self._resources = resources
        self._slowness: Mapping[str, float] = {}
        self._lost: dict[str, float] = {}  # seconds by which the clock of a device that was slow is behind
        self._now: float | None = None
        fed = {
            variable: name for variable, name in pipelines.feeds.items() if self.emulates(resource_of(pipelines, name))
        }
        self.topics = {variable: sorted(pipelines.topics_of(name)) for variable, name in fed.items()}
        self._between = {each.variable: each.between for node in pipelines.nodes for each in node.writings}
        said = {**pipelines.outgoing, **pipelines.requests}
        self._readers = {name: CommandReader(each, automaton) for name, each in said.items()}
        self._effects = [
            effect
            for effect in automaton.effects
            if not effect.fault and all(target(action) in fed for action in effect.actions)
        ]
        # Nothing has been commanded yet, so the outputs are unknown until a message brings them.
        self.state: dict[str, Value | None] = dict(automaton.initial_valuation)
        self.state |= dict.fromkeys((*automaton.names(Kind.OUTPUT), *automaton.names(Kind.ESTIMATED)), None)
        self.state |= dict.fromkeys(pipelines.heeded, False)
        self._messages: dict[str, Message] = {}
        for topic in pipelines.sources:
            self._messages[topic] = spoken(pipelines, topic, self.state, {})
        self._underway: dict[str, _Underway] = {}
        self.on_change: Callable[[], None] = lambda: None
        """Called when something is otherwise than it was: other effects may be possible, other reports due."""

    @property
    def spoken(self) -> list[str]:
        """The topics, services and actions on which the devices say something."""
        return list(self._messages)

    def restore_values(self, values: Mapping[str, Value | None], messages: Mapping[str, Message]) -> None:
        """Stand as devices of another model did, in all that is here too, before any time has passed.

        A goal or a request that was under way is not known here. On a topic on which it cannot be said how things were
        together, all is as at the beginning.
        """
        goals = {name for use in self._pipelines.actions.values() for name in use.status.variables}
        outputs = set(self._automaton.names(Kind.OUTPUT)) - self._pipelines.heeded
        taken = {
            name: value
            for name in (self.topics.keys() | outputs) - goals
            if (value := values.get(name)) is not None and contains(self._automaton.variables[name].type, value)
        }
        while (unsaid := self._restore(taken, messages)) is not None:
            taken = {name: value for name, value in taken.items() if unsaid not in self.topics.get(name, ())}

    def _restore(self, taken: Mapping[str, Value], before: Mapping[str, Message]) -> str | None:
        """Take these values; or the topic on which that cannot be said, and nothing has changed then."""
        state, said = {**self.state, **taken}, dict(self._messages)
        for topic in self._spoken_on(name for name in taken if name in self.topics):
            try:
                said[topic] = spoken(self._pipelines, topic, state, {**said[topic], **before.get(topic, {})})
            except CannotSpeakError:
                return topic
        self.state, self._messages = state, said
        return None

    def emulates(self, resource: str) -> bool:
        """Return whether the devices of a resource are emulated here."""
        return self._resources is None or resource in self._resources

    def observe(self, values: Mapping[str, Value | None]) -> None:
        """Take note of what the devices say that are not emulated here."""
        self._know({name: value for name, value in values.items() if name not in self.topics})

    def slow(self, slowness: Mapping[str, float]) -> None:
        """From now on the devices of these resources need so many times as long, and all others as long as ever."""
        self._slowness = dict(slowness)
        self.on_change()

    def restart(self, resource: str) -> None:
        """The devices of a resource are as at the beginning, and have heard no command."""
        initial, pipelines = self._automaton.initial_valuation, self._pipelines
        for name, source in pipelines.feeds.items():
            if resource_of(pipelines, source) == resource:
                self.state[name] = initial[name]
        self.state |= dict.fromkeys(self._commanded(resource))
        for topic, pipeline in pipelines.sources.items():
            if pipeline.topic.resource == resource:
                self._messages[topic] = spoken(pipelines, topic, self.state, {})
        for effect in self._effects:
            if effect.resource == resource:
                self._underway.pop(effect.name, None)
        self.on_change()

    def _commanded(self, resource: str) -> set[str]:
        said = (*self._pipelines.outgoing.values(), *self._pipelines.requests.values())
        names = {name for each in said if each.topic.resource == resource for name in each.variables}
        return {name for name in names if self._automaton.variables[name].kind is Kind.OUTPUT} - self._pipelines.heeded

    def command(self, topic: str, message: Mapping[str, object]) -> list[str]:
        """Take a message on an outgoing topic of the station, or a request; returns what in it made no sense."""
        values, troubles = self._readers[topic].read(message)
        self._know({n: value for n, value in values.items() if self._automaton.variables[n].kind is Kind.OUTPUT})
        return troubles

    def report(self, topic: str) -> dict[str, object]:
        """The message that the device behind an incoming topic, a service or an action would send now."""
        return self._messages[topic]

    def want(self, output: str, is_wanted: bool) -> None:
        """A request for which the station sets an output has come, or has been answered."""
        self._know({output: is_wanted})

    def _know(self, values: Mapping[str, Value | None]) -> None:
        if any(self.state.get(name) != value for name, value in values.items()):
            self.state |= values
            self.on_change()

    def is_underway(self, variables: Iterable[str]) -> bool:
        """Return whether an effect on one of these variables is on its way."""
        return any(not each.writes.keys().isdisjoint(variables) for each in self._underway.values())

    def set_value(self, variable: str, value: Value) -> None:
        """Bring a measured variable to a value by hand. Raises ValueError for a variable or value that is none."""
        if variable not in self.topics:
            known = ", ".join(sorted(self.topics))
            raise ValueError(f"no emulated device has `{variable}`; there are {known}")
        type_ = self._automaton.variables[variable].type
        if not contains(type_, value):
            raise ValueError(f"`{value}` is no value of {variable}, which ranges over {type_}")
        self._set({variable: value})
        self._underway.clear()  # what was on its way starts anew from here

    def advance(self, now: float) -> None:
        """Let everything happen that is due at `now`, and set out on what has become possible."""
        passed = 0.0 if self._now is None else now - self._now
        self._now = now
        for resource, times in self._slowness.items():
            self._lost[resource] = self._lost.get(resource, 0.0) + passed * (1 - 1 / times)
        for effect in self._effects:
            self._advance(effect, now - self._lost.get(effect.resource, 0.0))

    def _advance(self, effect: Effect, now: float) -> None:
        """One effect, on the clock of its device."""
        writes = effect_writes(effect, self.state)
        if not writes:
            self._underway.pop(effect.name, None)
            return
        underway = self._underway.get(effect.name)
        if underway is None or underway.writes != writes:  # a new destination is a new journey
            seconds = self._random.uniform(effect.shortest, effect.longest + self._jitter) / self._speed
            glides = any(self._between.get(name) not in (None, value) for name, value in writes.items())
            origin = dict(self._messages)
            underway = _Underway(effect.resource, now, now + seconds, writes, origin, glides)
            self._underway[effect.name] = underway
        if now >= underway.due:
            self._set(writes)
            del self._underway[effect.name]
        elif underway.glides:
            self._glide(writes, underway, now)

    @property
    def due(self) -> float:
        """The time when the next thing happens by itself, after the last `advance`: at once where numbers glide; inf if
        none.
        """
        waiting = self._underway.values()
        if any(each.glides or each.resource in self._slowness for each in waiting):
            return -math.inf
        return min((each.due + self._lost.get(each.resource or "", 0.0) for each in waiting), default=math.inf)

    def _set(self, writes: Mapping[str, Value]) -> None:
        self.state |= writes
        self.on_change()
        for topic in self._spoken_on(writes):
            self._messages[topic] = spoken(self._pipelines, topic, self.state, self._messages[topic])

    def _spoken_on(self, variables: Iterable[str]) -> set[str]:
        return {topic for variable in variables for topic in self.topics[variable]}

    def _glide(self, writes: Mapping[str, Value], underway: _Underway, now: float) -> None:
        """Numbers go steadily to where they will be, but for those of a device that only leaves a point."""
        share = (now - underway.began) / (underway.due - underway.began)
        going = {name: value for name, value in writes.items() if self._between.get(name) not in (None, value)}
        for topic in self._spoken_on(going):
            now_said = self._messages[topic]
            goal = spoken(self._pipelines, topic, {**self.state, **going}, now_said)
            self._messages[topic] = glided(now_said, underway.origin[topic], goal, share)


def resource_of(pipelines: StationPipelines, name: str) -> str:
    """The resource of a topic or flow that feeds variables."""
    node = pipelines.node(name)
    return node.resource if isinstance(node, Flow) else node.topic.resource
