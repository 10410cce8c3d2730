"""Messages of emulated devices: encoding by pipeline inversion, and endpoints per resource."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set

from sequence_planner.automaton.automaton import State
from sequence_planner.language.records.field_paths import FieldPath, NoFieldError, find_field
from sequence_planner.language.records.record import FieldType, ListType, NestedType, RealType, RecordType
from sequence_planner.language.types import BooleanType, IntegerRange
from sequence_planner.model.source import Finding
from sequence_planner.model.stages.base import NotInvertibleError
from sequence_planner.pipelines.graph import Chain, Flow, IncomingPipeline, Joining, StationPipelines
from sequence_planner.ros.transport import Sample, Transport, TransportError

# The devices' way to the network: each resource has endpoints of its own, which can go and come again.

Hear = Callable[[Sequence[Sample]], None]


class Links:
    """The endpoints of the devices of `resources`; `hear` takes their commands."""

    def __init__(
        self, pipelines: StationPipelines, resources: Set[str], connect: Callable[[], Transport], hear: Hear
    ) -> None:
        self._pipelines = pipelines
        self._resources = sorted(resources)
        self._connect = connect
        self._hear = hear
        self._open: dict[str, Transport] = {}

    def keep(self, offline: Set[str]) -> None:
        """Have the devices of all resources but these on the network. Raises `TransportError`."""
        for resource in self._resources:
            if resource in offline and resource in self._open:
                self._open.pop(resource).close()
            elif resource not in offline and resource not in self._open:
                self._open[resource] = self._joined(resource)

    def publish(self, topic: str, type_name: str, data: bytes) -> None:
        """Send a message of a device that is on the network. Raises `TransportError`."""
        link = self._open.get(self._pipelines.incoming[topic].topic.resource)
        if link is None:
            raise TransportError(f"the device on {topic} is not on the network")
        link.publish(topic, type_name, data)

    def close(self) -> None:
        """Leave the network."""
        for link in self._open.values():
            link.close()
        self._open.clear()

    def _joined(self, resource: str) -> Transport:
        link = self._connect()
        for incoming in self._pipelines.incoming.values():
            if incoming.topic.resource == resource:
                link.advertise(incoming.topic.name, incoming.topic.type_name, incoming.topic.quality)
        for outgoing in self._pipelines.outgoing.values():
            if outgoing.topic.resource == resource:
                link.subscribe(outgoing.topic.name, outgoing.topic.type_name, outgoing.topic.quality, self._hear)
        return link


# What an emulated device says: the message from which the pipelines would read its state, found backwards.

Message = dict[str, object]


class CannotSpeakError(Exception):
    """No message says what a device would have to say; `finding` has the stage, and what to do."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(str(finding))
        self.finding = finding


def spoken(pipelines: StationPipelines, topic: str, state: State, before: Mapping[str, object]) -> Message:
    """The fields of the message with which the device behind a topic says `state`; others have their default.

    `before` is what it said last: numbers that mean the same stay as they are. Raises `CannotSpeakError`.
    """
    needed: dict[str, dict[str, object]] = {}  # for each topic and flow, fields at its end
    for flow in reversed(list(pipelines.flows.values())):
        if topic in pipelines.topics_of(flow.name):
            values = {**needed.pop(flow.name, {}), **_own(flow, state)}
            _backwards(flow.name, flow.chain, values, {})
            _hand_up(flow, values, pipelines, needed)
    pipeline = pipelines.sources[topic]
    values = {**needed.pop(topic, {}), **_own(pipeline, state)}
    _backwards(topic, pipeline.chain, values, before)
    return _message(pipeline.chain.fields[0], values)


def glided(current: Message, origin: Message, goal: Message, share: float) -> Message:
    """`current`, with its numbers at a share of the way from where they were to where they will be."""
    return {name: _between(value, origin.get(name), goal.get(name), share) for name, value in current.items()}


def _between(current: object, origin: object, goal: object, share: float) -> object:
    match current, origin, goal:
        case float(), float(), float():
            return origin + share * (goal - origin)
        case dict(), dict(), dict():
            return glided(current, origin, goal, share)
        case list(), list(), list() if len(current) == len(origin) == len(goal):
            return [_between(*items, share) for items in zip(current, origin, goal, strict=True)]
    return current


def _own(node: IncomingPipeline | Flow, state: State) -> dict[str, object]:
    return {each.field: value for each in node.writings if (value := state[each.variable]) is not None}


def _backwards(name: str, chain: Chain, values: dict[str, object], before: Mapping[str, object]) -> None:
    """Add to what stands at the end of a chain what could have stood before each stage.

    What a stage gives is not what was there before, unless it reads that too. A device that is between points stays
    where it is: there is more than one place that says so.
    """
    for number, stage in reversed(list(enumerate(chain.stages, start=1))):
        if stage.kind == "discretise":
            values |= {
                path: now for path in stage.reads if path not in values and (now := _at(before, path)) is not None
            }
        try:
            stage.backwards(values)
        except NotInvertibleError as error:
            finding = Finding(stage.place, f"`{name}` → stage {number} `{stage.kind}` cannot be emulated: {error}")
            raise CannotSpeakError(finding) from error
        for given in stage.gives.keys() - stage.reads:
            values.pop(given, None)


def _at(message: Mapping[str, object], path: str) -> object:
    key, *steps = path.split(".")
    return FieldPath(path, key, tuple(steps)).get(message)


def _hand_up(flow: Flow, values: Mapping[str, object], pipelines: StationPipelines, needed: dict[str, Message]) -> None:
    """Give the sources of a flow what its records need to begin with."""
    for alias, source in flow.sources.items():
        end = pipelines.node(source).chain.end
        prefix = f"{alias}." if flow.joining is Joining.MERGE else ""
        for path, value in values.items():
            name = path.removeprefix(prefix)
            if path.startswith(prefix) and _is_of(end, name):
                needed.setdefault(source, {}).setdefault(name, value)


def _is_of(fields: RecordType, path: str) -> bool:
    return path.split(".", maxsplit=1)[0].split("[", maxsplit=1)[0] in fields or path in fields


def _message(fields: RecordType, values: Mapping[str, object]) -> Message:
    """The nested fields of a message from values by path; what is no field of it is left out."""
    message: Message = {}
    for path, value in values.items():
        try:
            found, _ = find_field(fields, path)
        except NoFieldError:
            continue
        message[found.key] = _with(message.get(found.key), fields[found.key], found.steps, value)
    return message


def _with(old: object, type_: FieldType, steps: tuple[str | int, ...], value: object) -> object:
    """A field with `value` at a path within it, the rest as it was or at its default."""
    if not steps:
        return value
    step, *deeper = steps
    if isinstance(type_, ListType) and isinstance(step, int):
        items = list(old) if isinstance(old, list) else [_zero(type_.element)] * (type_.length or 0)
        items += [_zero(type_.element)] * (step + 1 - len(items))
        items[step] = _with(items[step], type_.element, tuple(deeper), value)
        return items
    assert isinstance(type_, NestedType)
    inner = dict(old) if isinstance(old, dict) else {}
    inner[step] = _with(inner.get(step), type_.fields[str(step)], tuple(deeper), value)
    return inner


def _zero(type_: FieldType) -> object:
    """The value ROS 2 gives an item of a list that nobody set."""
    match type_:
        case BooleanType():
            return False
        case IntegerRange():
            return 0
        case RealType():
            return 0.0
        case NestedType():
            return {}
        case ListType():
            return []
    return ""
