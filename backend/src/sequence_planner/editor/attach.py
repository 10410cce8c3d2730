"""Attachment of a network topic to a draft: type definitions, proposed stages and names, edited document."""

from __future__ import annotations

import asyncio
import difflib
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from shutil import copytree
from tempfile import TemporaryDirectory
from typing import Literal

from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.declarations import FLAGS
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.record import (
    FieldType as RecordFieldType,
)
from sequence_planner.language.records.record import (
    ListType,
    NestedType,
    RealType,
    RecordType,
    TextType,
)
from sequence_planner.language.types import BooleanType, IntegerRange
from sequence_planner.model.fields import fault_of_name
from sequence_planner.model.paths import EditError
from sequence_planner.model.yaml.editor import comment, in_brackets, insert, replace
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.model.yaml.saving import digest, edit_file
from sequence_planner.pipelines.inference import MOST_VALUES
from sequence_planner.pipelines.message_types import message_fields
from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import NetworkEndpoint, Transport
from sequence_planner.ros.types.definitions import FieldType
from sequence_planner.ros.types.errors import UnknownMessageTypeError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.type_discovery import TypeNotFoundError, find_type
from sequence_planner.station import ReadyStation, prepare_station

# What keeps a topic from being attached.


class AttachError(Exception):
    """A topic cannot be attached; the text says why and what to do, `slug` names the kind for programs."""

    def __init__(self, slug: str, detail: str) -> None:
        super().__init__(detail)
        self.slug = slug


# Types that were found on the network, as the `.msg` files that define them.


def definition_files(registry: MessageRegistry, type_names: Iterable[str], source: str) -> dict[PurePosixPath, str]:
    """The files, below the station's folder, with their text. Raises `AttachError` for a type that is no message."""
    files: dict[PurePosixPath, str] = {}
    for type_name in type_names:
        package, kind, name = type_name.split("/")
        if kind != "msg":
            raise AttachError("no-message", f"{type_name} belongs to a service or an action, and is no message")
        files[PurePosixPath("messages", package, "msg", f"{name}.msg")] = _text(registry, type_name, source)
    return files


def _text(registry: MessageRegistry, type_name: str, source: str) -> str:
    head = f"# As {source} describes it on the network, where constants, defaults and comments are not told."
    fields = (f"{_written(field)} {name}" for name, field in registry.fields(type_name).items())
    return "\n".join((head, *fields, ""))


def _written(field: FieldType) -> str:
    """A type as a `.msg` file has it: a message is named without the middle part."""
    return str(field).replace("/msg/", "/") if field.kind == "message" else str(field)


# A topic as it is found on the network: who has it, of which type, in which direction and quality.

LOOK_EVERY = 0.1  # seconds
TYPE_WITHIN = 3.0  # seconds in which a node answers what its type is

_MESSAGE = re.compile(r"[a-z][a-z0-9_]*/msg/[A-Za-z][A-Za-z0-9]*")

InOut = Literal["in", "out"]


@dataclass(frozen=True)
class FoundTopic:
    """A topic, and how the station would use it. `source` is who has it; `found_types` are no file's."""

    name: str
    type_name: str
    direction: InOut
    quality: QualityOfService
    source: str
    found_types: tuple[str, ...] = ()


async def find_topic(
    transport: Transport, *, registry: MessageRegistry, name: str, direction: InOut | None, within: float
) -> FoundTopic:
    """Look for a topic for so many seconds, and find out its type, which is entered into `registry`.

    Without a `direction` a topic that others publish comes in, and one that they only subscribe to goes out. Raises
    `AttachError` for a topic that is not there, or of which the type cannot be known.
    """
    ends = await _ends(transport, name, within)
    if direction is None:
        direction = "in" if any(each.direction == "publisher" for each in ends) else "out"
    wanted = "publisher" if direction == "in" else "subscriber"
    others = [each for each in ends if each.direction == wanted] or ends
    types = sorted({each.type_name for each in others})
    if len(types) > 1:
        raise AttachError("ambiguous-type", f"{name} is used with several types: {', '.join(types)}")
    if not _MESSAGE.fullmatch(types[0]):
        raise AttachError("no-message", f"{name} has the type {types[0]}, which is no message of ROS 2")
    before = set(registry.found())
    await _know_type(transport, registry, others)
    new = tuple(sorted(set(registry.found()) - before))
    source = next((each.node for each in others if each.node), "a program that does not tell its node")
    return FoundTopic(name, types[0], direction, _heard_quality(others, direction), source, new)


async def _ends(transport: Transport, name: str, within: float) -> list[NetworkEndpoint]:
    """The endpoints of others on a topic, once there are any that all tell their node, or time is up."""
    until = asyncio.get_running_loop().time() + within
    while True:
        graph = [each for each in transport.graph() if not each.own]
        found = [each for each in graph if each.topic == name]
        is_late = asyncio.get_running_loop().time() >= until
        if found and (is_late or all(each.node is not None for each in found)):
            return found
        if is_late:
            known = sorted({each.topic for each in graph})
            near = suggestion(name, known) or f"; there are {', '.join(known) or 'none'}"
            raise AttachError("no-topic", f"nobody has a topic {name} on this network{near}")
        await asyncio.sleep(LOOK_EVERY)


async def _know_type(transport: Transport, registry: MessageRegistry, others: Sequence[NetworkEndpoint]) -> None:
    """Find out the type of an endpoint unless it is known; of several that have it, one that tells is enough."""
    endpoint = others[0]
    try:
        ours = registry.type_hash(endpoint.type_name)
    except UnknownMessageTypeError:
        ours = None
    if ours is not None:
        theirs = next((each.type_hash for each in others if each.type_hash not in (None, ours)), None)
        if theirs is not None:
            said = f"{endpoint.topic} has another definition of {endpoint.type_name}"
            raise AttachError("other-definition", f"{said}: theirs is {theirs}, ours is {ours}")
        return
    failed = ""
    for each in others:
        try:
            await find_type(transport, registry, each, TYPE_WITHIN)
        except TypeNotFoundError as error:
            failed = str(error)
        else:
            return
    raise AttachError("no-type", failed)


def _heard_quality(others: Sequence[NetworkEndpoint], direction: InOut) -> QualityOfService:
    """A quality with which the station meets all of them."""
    if direction == "in":
        return QualityOfService(
            reliable=all(each.reliable for each in others),
            transient_local=all(each.transient_local for each in others),
            depth=_depth(all(each.reliable for each in others), all(each.transient_local for each in others)),
        )
    wishes = [each.deadline for each in others if each.deadline is not None]
    lasting = any(each.transient_local for each in others)
    return QualityOfService(transient_local=lasting, depth=_depth(True, lasting), deadline=min(wishes, default=None))


def _depth(reliable: bool, transient_local: bool) -> int:
    """As the names for qualities have it."""
    if not reliable:
        return QualityOfService.SENSOR_DATA.depth
    return QualityOfService.LATCHED.depth if transient_local else QualityOfService.RELIABLE.depth


# Which names of a resource are free for what a new topic brings.


def check_resource(name: str) -> None:
    """Raise `AttachError` unless a resource may have this name."""
    if (fault := fault_of_name(name, "resource")) is not None:
        raise AttachError("bad-name", fault)
    if name == "null":
        raise AttachError("bad-name", f"`{name}` is no name that YAML would read as a text: take another name")


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


# Stages for the fields of a message that are no variables by themselves: a beginning, for people to go on with.

DEEPEST = 3  # messages within messages that are looked into
MOST = 20  # proposals
_TIMES = ("std_msgs/msg/Header", "builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")


@dataclass(frozen=True)
class StageProposal:
    """A stage as a document has it, and the variable that it gives with its type, None where it gives none."""

    stage: Mapping[str, object]
    variable: str | None = None
    type: str | None = None


def is_variable(field: RecordFieldType) -> bool:
    """Return whether a field becomes a variable of its name by itself."""
    return isinstance(field, BooleanType) or (
        isinstance(field, IntegerRange) and field.maximum - field.minimum < MOST_VALUES
    )


def proposals(fields: RecordType, direction: InOut) -> list[StageProposal]:
    """Return what could be made of the fields that are no variables by themselves, in their order."""
    make = _incoming if direction == "in" else _outgoing
    found = (each for path, field in _leaves(fields) if (each := make(path, field)) is not None)
    return [each for each, _ in zip(found, range(MOST), strict=False)]


def _leaves(fields: RecordType, above: str = "", depth: int = 0) -> Iterator[tuple[str, RecordFieldType]]:
    """The fields that are no variables by themselves, those within messages too; times are left out."""
    for name, field in fields.items():
        path = f"{above}{name}"
        if isinstance(field, NestedType):
            if field.name not in _TIMES and depth < DEEPEST:
                yield from _leaves(field.fields, f"{path}.", depth + 1)
        elif depth > 0 or not is_variable(field):
            yield path, field


def _incoming(path: str, field: RecordFieldType) -> StageProposal | None:
    name = variable_name(path)
    match field:
        case BooleanType():
            return StageProposal({"rename": {path: name}}, name, "bool")
        case IntegerRange() if is_variable(field):
            return StageProposal({"rename": {path: name}}, name, str(field))
        case RealType() | IntegerRange():
            return StageProposal({"expression": {f"{name}_is_positive": f"{path} > 0"}}, f"{name}_is_positive", "bool")
        case TextType():
            stage = {"match": {"field": path, "variable": f"{name}_is_ready", "equals": "ready"}}
            return StageProposal(stage, f"{name}_is_ready", "bool")
        case ListType(TextType()):
            return StageProposal(
                {"member": {"field": path, "item": "part", "variable": f"has_{name}"}}, f"has_{name}", "bool"
            )
        case ListType(RealType() | IntegerRange()):
            stage = {"expression": {f"{name}_0_is_positive": f"{path}[0] > 0"}}
            return StageProposal(stage, f"{name}_0_is_positive", "bool")
        case ListType(BooleanType()):
            return StageProposal({"rename": {f"{path}[0]": f"{name}_0"}}, f"{name}_0", "bool")
    return None


def _outgoing(path: str, field: RecordFieldType) -> StageProposal | None:
    match field:
        case BooleanType():
            return StageProposal({"constant": {path: False}})
        case IntegerRange():
            return StageProposal({"constant": {path: max(field.minimum, 0)}})
        case RealType():
            return StageProposal({"constant": {path: 0.0}})
        case TextType():
            return StageProposal({"constant": {path: "ready"}})
        case ListType(RealType(), int(length)):
            return StageProposal({"constant": {path: [0.0] * length}})
    return None


def variable_name(path: str) -> str:
    """A name for what a field becomes: `pose.position.x` is `pose_position_x`."""
    return re.sub(r"\W+", "_", path).strip("_")


# A topic in the text of a resource's document. Every byte that was there stays.

USUAL_DEADLINE = 1.0  # seconds without a message after which what it said counts no more

_INTRODUCTION = {
    "in": "What else could be made of its fields: stages of `pipeline`, what they give is declared under `measured`.",
    "out": "What else could be sent in its fields: stages of `pipeline`.",
}


def document(topic: FoundTopic, stages: Sequence[Mapping[str, object]]) -> dict[str, object]:
    """The entry of a topic."""
    entry: dict[str, object] = {"type": topic.type_name, "direction": topic.direction}
    if topic.direction == "in" and not topic.quality.transient_local:
        entry["deadline"] = USUAL_DEADLINE
    if topic.quality != QualityOfService.RELIABLE:
        entry["quality"] = _quality(topic.quality)
    return {**entry, "pipeline": [dict(stage) for stage in stages]} if stages else entry


def _quality(quality: QualityOfService) -> object:
    name = str(quality)
    if not name.startswith("{"):
        return name
    return {
        "reliability": "reliable" if quality.reliable else "best_effort",
        "durability": "transient_local" if quality.transient_local else "volatile",
        "depth": quality.depth,
        **({} if quality.deadline is None else {"deadline": quality.deadline}),
    }


def with_topic(text: str, topic: FoundTopic, entry: Mapping[str, object], measured: Mapping[str, object]) -> str:
    """The text of a document with the topic and these variables. Raises `EditError`."""
    text = _with_entries(text, "topics", {topic.name: entry})
    return _with_entries(text, "measured", measured) if measured else text


def _with_entries(text: str, section: str, entries: Mapping[str, object]) -> str:
    content = read_text(text, "the document").content
    present = content if isinstance(content, dict) else {}
    if section not in present:
        after = "topics" if section != "topics" and "topics" in present else "title" if "title" in present else None
        return insert(text, (section,), dict(entries), after=after)
    if not present[section]:
        return replace(text, (section,), dict(entries))
    for name, entry in entries.items():
        text = insert(text, (section, name), entry)
    return text


def with_proposals(text: str, topic: FoundTopic, proposals: Sequence[StageProposal]) -> str:
    """The text with comments above the topic that propose stages: where they belong to it, and leave with it."""
    if not proposals:
        return text
    return comment(
        text, ("topics", topic.name), [_INTRODUCTION[topic.direction], *(f"  - {_stage(each)}" for each in proposals)]
    )


def _stage(proposal: StageProposal) -> str:
    return "; ".join(f"{kind}: {in_brackets(what)}" for kind, what in proposal.stage.items())


# A topic entered into a station's model: what changes, tried on a copy, and then made.


@dataclass(frozen=True)
class Attachment:
    """A change of a model that attaches a topic: entries of a resource's document, and definitions of messages.

    `expected` is the digest of the document that it was made for, None where there is none yet.
    """

    topic: FoundTopic
    document: PurePosixPath
    title: str
    entry: Mapping[str, object]
    measured: Mapping[str, object]
    proposals: tuple[StageProposal, ...]
    definitions: Mapping[PurePosixPath, str]
    expected: str | None

    def make(self, folder: Path) -> str:
        """Change the model in `folder`; returns the differences of all files. Raises `AttachError`: nothing changed."""
        new = dict(self.definitions)
        if self.expected is None:
            new[self.document] = self._changed(f"title: {self.title}\n")
        written: list[Path] = []
        try:
            for name, text in new.items():
                path = folder / name
                path.parent.mkdir(parents=True, exist_ok=True)
                with path.open("x", encoding="utf-8") as file:
                    written.append(path)
                    file.write(text)
            difference = "".join(_new_file(folder / name, text) for name, text in new.items())
            if self.expected is not None:
                difference += edit_file(folder / self.document, self._changed, expected=self.expected)
        except (OSError, EditError) as error:
            for path in written:
                path.unlink(missing_ok=True)
            raise AttachError("not-written", f"{folder} cannot be changed: {error}") from error
        return difference

    @contextmanager
    def made_on_copy(self, folder: Path) -> Iterator[tuple[Path, str]]:
        """A copy of the model, for as long as the block lasts, with the change and its differences."""
        with TemporaryDirectory() as scratch:
            copy = copytree(folder, Path(scratch) / folder.resolve().name, ignore_dangling_symlinks=True)
            yield copy, self.make(copy).replace(str(copy), str(folder))

    def _changed(self, text: str) -> str:
        text = with_topic(text, self.topic, self.entry, self.measured)
        return with_proposals(text, self.topic, self.proposals)


def attachment(folder: Path, registry: MessageRegistry, topic: FoundTopic, resource: str) -> Attachment:
    """The change that attaches a topic to a resource, which may be new; `registry` knows the type.

    Fields that are variables by themselves become variables, under another name where theirs is taken. Where there are
    none, the first proposal is made. Raises `AttachError`, and `ModelError` for a station that cannot be used.
    """
    check_resource(resource)
    station = prepare_station(folder)
    incoming, outgoing = station.pipelines.sources, station.pipelines.outgoing
    used = incoming.get(topic.name) or outgoing.get(topic.name)
    if used is not None:
        raise AttachError("attached", f"{topic.name} belongs to `{used.topic.resource}` already")
    fields = message_fields(registry, topic.type_name)
    made, proposed = _made(fields, station, resource, topic)
    path = folder / "resources" / f"{resource}.yaml"
    return Attachment(
        topic,
        PurePosixPath("resources", path.name),
        resource.replace("_", " ").capitalize(),
        document(topic, [each.stage for each in made]),
        {each.variable: {"type": each.type} for each in made if each.variable is not None},
        tuple(proposed),
        definition_files(registry, topic.found_types, topic.source),
        digest(path) if path.is_file() else None,
    )


def _made(
    fields: RecordType, station: ReadyStation, resource: str, topic: FoundTopic
) -> tuple[list[StageProposal], list[StageProposal]]:
    """The stages that are needed, and those that are only proposed."""
    proposed = proposals(fields, topic.direction)
    direct = [name for name, field in fields.items() if is_variable(field)]
    others = renamed(direct, station, resource, topic.name, topic.direction)
    made = [StageProposal({"rename": others})] if others else []
    if topic.direction == "in" and not direct:
        if not proposed:
            raise AttachError("nothing-to-measure", f"no field of {topic.type_name} can become a variable")
        made, proposed = proposed[:1], proposed[1:]
    return made, proposed


def _new_file(path: Path, text: str) -> str:
    lines = text.splitlines(keepends=True)
    return "".join(difflib.unified_diff([], lines, "/dev/null", str(path)))
