"""Symbol index of a draft: named model parts, declarations and gathered occurrences."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from sequence_planner.automaton.declarations import FLAGS, OPERATION
from sequence_planner.editor.symbols.fields import inferred
from sequence_planner.editor.symbols.texts import (
    OPERATIONS,
    SPECIFICATIONS,
    STATION,
    WORK_MASTERS,
    ModelContent,
    entry,
    items,
    message_of,
    pairs,
    text_at,
)
from sequence_planner.language.syntax import Span
from sequence_planner.model.paths import EditError, shown_path
from sequence_planner.model.sequences import KINDS as SEQUENCE_KINDS
from sequence_planner.model.sequences import is_sequence
from sequence_planner.model.source import ExpandedText, SourceText
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.graph import GOAL_STATE, GoalState
from sequence_planner.ros.types.messages import MessageRegistry

# What of a model has a name, and how each is told from all others.

# What each kind is called in a sentence.
KINDS: Mapping[str, str] = {
    "enumeration": "the enumeration",
    "value": "the value",
    "set": "the set",
    "relation": "the relation",
    "map": "the map",
    "predicate": "the predicate",
    "word": "the word",
    "resource": "the resource",
    "type": "the type",
    "variable": "the variable",
    "ability": "the ability",
    "effect": "the effect",
    "alarm": "the alarm",
    "operation": "the operation",
    "sequence": "the sequence",
    "specification": "the specification",
    "work_master": "the work master",
    "parameter": "the parameter",
    "topic": "the topic",
    "flow": "the flow",
    "service": "the service",
    "action": "the action",
    "message": "the type of message",
}
# Kinds whose names are those of ROS 2, and known in the whole station.
ROS_KINDS = frozenset({"topic", "service", "action", "message"})
_OF_RESOURCE = frozenset({"variable", "ability", "flow", "alarm", "set", "predicate", "relation", "map"})
_WITHIN = frozenset({"effect", "parameter"})


class ModelPart(NamedTuple):
    """Something with a name. `owner` is what it belongs to, without which the name does not tell it:

    the enumeration of a value; the resource of a variable, an ability, a flow or what it has for short; the ability of
    an effect; the package of a type, where it has one; and for a parameter the full name of its ability, effect,
    variable or predicate, or the id of what else it belongs to, such as `operation:press`. The word of a quantifier
    belongs to that: the file, the entry, and its number in the text.
    """

    kind: str
    owner: str | None
    name: str

    @property
    def id(self) -> str:
        """Such as `variable:robot.pose`, `value:pose.home`, `parameter:robot.move.to` or `topic:/robot/state`."""
        return f"{self.kind}:{self.full}"

    @property
    def full(self) -> str:
        """The name with its owner, such as `robot.pose`."""
        return self.name if self.owner is None else f"{self.owner}.{self.name}"

    def __str__(self) -> str:
        return f"{KINDS[self.kind]} `{self.name if self.kind == 'word' else self.full.rpartition(':')[2]}`"


def parse_part(text: str) -> ModelPart:
    """The part of an `id`. Raises `EditError` for a text that is none."""
    kind, _, full = text.partition(":")
    if kind not in KINDS or not full:
        known = ", ".join(KINDS)
        raise EditError(f"`{text}` names no part: write its kind and its name, as in variable:robot.pose ({known})")
    owner, _, name = ("", "", full) if kind in ROS_KINDS else full.rpartition(".")
    return ModelPart(kind, owner or None, name)


def value_of(enumeration: str, name: str) -> ModelPart:
    """A value of an enumeration."""
    return ModelPart("value", enumeration, name)


def variable_of(resource: str | None, name: str) -> ModelPart:
    """A variable of a resource, or of the station."""
    return ModelPart("variable", resource, name)


def following(part: ModelPart, old: ModelPart, new: ModelPart) -> ModelPart:
    """Return what `part` is called when `old` is called `new`: the same, or with that name, or with an owner of that
    name.
    """
    if part == old:
        return new
    owner = part.owner
    if owner is None:
        return part
    match old.kind:
        case "resource":
            is_own = part.kind in _OF_RESOURCE and owner == old.name
            if is_own:
                return part._replace(owner=new.name)
            if part.kind in _WITHIN and owner.startswith(f"{old.name}."):
                return part._replace(owner=f"{new.name}{owner[len(old.name) :]}")
        case "enumeration" if part.kind == "value" and owner == old.name:
            return part._replace(owner=new.name)
        case "ability" | "variable" | "predicate" | "effect" if part.kind in _WITHIN:
            if owner == old.full or (old.kind == "ability" and owner.startswith(f"{old.full}.")):
                return part._replace(owner=f"{new.full}{owner[len(old.full) :]}")
        case "operation" | "specification" | "sequence" | "work_master" | "type" if (
            part.kind == "parameter" and owner == old.id
        ):
            return part._replace(owner=new.id)
    return part


def belongs_to(part: ModelPart, whole: ModelPart) -> bool:
    """Return whether `part` is `whole`, or goes with it when it is deleted."""
    return part == whole or following(part, whole, whole._replace(name=f"{whole.name}'")) != part


# The names that a draft declares, as far as it can be read: what grounding's declarations are to a sound model.

SECTIONS = ("measured", "output", "estimated")

# The parameters of a part, each with the name of its enumeration.
Parameters = Mapping[str, str]


@dataclass(frozen=True)
class DeclaredVariable:
    """A variable: the section it stands in, its type as written, its parameters, and whether a file declares it."""

    section: str
    type: str | None = None
    parameters: Parameters = field(default_factory=dict)
    is_written: bool = True


class Declared:
    """The names of a draft. Variables and abilities are known by their full names.

    A variable that no file declares is there as well if the stages of a pipeline give it, or a message does whose
    fields `messages` knows.
    """

    def __init__(self, content: ModelContent, messages: MessageRegistry | None) -> None:
        self.messages = messages
        self.homes: dict[str, dict[str, str]] = {}  # by enumeration or set, its values with where each is declared
        self.sets: set[str] = set()
        self.ordered: list[str] = []
        self.relations: dict[str, Parameters] = {}
        self.maps: dict[str, tuple[Parameters, str]] = {}
        self.predicates: dict[str, Parameters] = {}
        self.resources: dict[str, object] = {name: found for name, _, found in content.resources()}
        self.variables: dict[str, DeclaredVariable] = {}
        self.abilities: dict[str, Parameters] = {}
        self.operations: dict[str, Parameters] = {}
        self.sequences: set[str] = set()
        self.parts: list[ModelPart] = []
        self.sent: set[str] = set()  # topics on which the station speaks
        station = content.get(STATION)
        self._read_enumerations(station)
        self._read_short(None, station)
        self._read_variables(None, "estimated", entry(station, "estimated"))
        self.parts += [ModelPart("alarm", None, str(each)) for each, _ in pairs(entry(station, "alarms"))]
        for resource, found in self.resources.items():
            self._read_resource(resource, found)
        self._read_others(content)
        self.parts += [ModelPart("message", None, name) for name in map(message_of, content.definitions) if name]
        has_actions = any(pairs(entry(found, "actions")) for found in self.resources.values())
        if has_actions:
            self.homes.setdefault(GOAL_STATE, dict.fromkeys(map(str, GoalState), GOAL_STATE))
        self.values: dict[str, list[str]] = {}
        for enumeration, homes in self.homes.items():
            for value, home in homes.items():
                if home == enumeration:
                    self.values.setdefault(value, []).append(enumeration)

    def own(self, resource: str, section: str) -> Iterator[tuple[str, DeclaredVariable]]:
        """The variables of one section of a resource, by their names without it."""
        for name, variable in self.variables.items():
            owner, _, own = name.rpartition(".")
            if owner == resource and variable.section == section:
                yield own, variable

    def enumeration(self, resource: str | None, name: str) -> str | None:
        """The enumeration over which a variable ranges, if it does."""
        found = self.variables.get(variable_of(resource, name).full)
        return None if found is None or found.type not in self.homes else found.type

    def value(self, domain: str, name: str) -> ModelPart:
        """A value of an enumeration or set, where it is declared: perhaps by an enumeration that is included."""
        return value_of(self.homes.get(domain, {}).get(name, domain), name)

    def domain(self, name: str) -> ModelPart:
        """An enumeration or a set, by its full name."""
        if name not in self.sets:
            return ModelPart("enumeration", None, name)
        owner, _, own = name.rpartition(".")
        return ModelPart("set", owner or None, own)

    def full(self, resource: str | None, name: str) -> str:
        """The full name of an enumeration or a set that is named in a resource, or for the station as a whole."""
        own = f"{resource}.{name}"
        return own if own in self.sets else name

    def ranges(self, resource: str | None, written: object) -> Parameters:
        """The parameters of a part of a resource, each with the full name of its enumeration."""
        return {name: self.full(resource, of) for name, of in parameters(written).items()}

    def _read_enumerations(self, station: object) -> None:
        written = {str(name): document for name, document in pairs(entry(station, "enumerations"))}
        own = {name: own_values(document) for name, document in written.items()}

        def homes(name: str, around: tuple[str, ...]) -> dict[str, str]:
            found = dict.fromkeys(map(str, own.get(name, ())), name)
            for each in map(str, items(entry(written.get(name), "includes"))):
                if each not in around:
                    found = {**homes(each, (*around, each)), **found}
            return found

        for name, document in written.items():
            self.homes[name] = homes(name, (name,))
            self.parts.append(ModelPart("enumeration", None, name))
            self.parts += [ModelPart("value", name, str(value)) for value in own[name]]
            if entry(document, "ordered") is True:
                self.ordered.append(name)
        sets: dict[str, tuple[str | None, object]] = {}
        for resource, whole in ((None, station), *self.resources.items()):
            for name, document in pairs(entry(whole, "sets")):
                part = ModelPart("set", resource, str(name))
                sets[part.full] = resource, document
                self.parts.append(part)
        self.sets = {name for name in sets if name not in self.homes}

        def contents(name: str, around: tuple[str, ...]) -> dict[str, str]:
            if name not in self.sets or name in around:
                return self.homes.get(name, {})
            resource, document = sets[name]
            whole = contents(self.full(resource, str(entry(document, "of"))), (*around, name))
            kept = entry(document, "values")
            named = {
                value
                for each in map(str, items(entry(document, "except") if kept is None else kept))
                for value in ([each] if each in whole else contents(self.full(resource, each), (*around, name)))
            }
            return {value: home for value, home in whole.items() if (value in named) is (kept is not None)}

        self.homes |= {name: contents(name, ()) for name in self.sets}

    def _read_short(self, resource: str | None, written: object) -> None:
        for name, document in pairs(entry(written, "relations")):
            between = items(entry(document, "between"))
            part = ModelPart("relation", resource, str(name))
            self.relations[part.full] = {str(at): self.full(resource, str(each)) for at, each in enumerate(between)}
            self.parts.append(part)
        for name, document in pairs(entry(written, "maps")):
            part = ModelPart("map", resource, str(name))
            source, target = (self.full(resource, str(entry(document, key))) for key in ("from", "to"))
            self.maps[part.full] = {"0": source}, target
            self.parts.append(part)
        for name, document in pairs(entry(written, "predicates")):
            part = ModelPart("predicate", resource, str(name))
            self.predicates[part.full] = self.ranges(resource, entry(document, "parameters"))
            self._note(part, self.predicates[part.full], part.full)

    def _read_variables(self, resource: str | None, section: str, written: object) -> None:
        for name, document in pairs(written):
            part = variable_of(resource, str(name))
            type_ = text_at(document, "type")
            of = self.ranges(resource, entry(document, "for"))
            type_name = None if type_ is None else self.full(resource, str(type_))
            self.variables.setdefault(part.full, DeclaredVariable(section, type_name, of))
            self._note(part, of, part.full)

    def _read_resource(self, resource: str, found: object) -> None:
        self.parts.append(ModelPart("resource", None, resource))
        for section in SECTIONS:
            self._read_variables(resource, section, entry(found, section))
        self._read_short(resource, found)
        for name, document in pairs(entry(found, "abilities")):
            part = ModelPart("ability", resource, str(name))
            self.abilities[part.full] = self.ranges(resource, entry(document, "parameters"))
            self._note(part, self.abilities[part.full], part.full)
            for effect, inner in pairs(entry(document, "effects")):
                of = ModelPart("effect", part.full, str(effect))
                self._note(of, self.ranges(resource, entry(inner, "for")), of.full)
        self.parts += [ModelPart("alarm", resource, str(each)) for each, _ in pairs(entry(found, "alarms"))]
        self.parts += [ModelPart("flow", resource, str(flow)) for flow, _ in pairs(entry(found, "flows"))]
        self.sent |= {str(each) for each, topic in pairs(entry(found, "topics")) if entry(topic, "direction") == "out"}
        for kind in ("topic", "service", "action"):
            self.parts += [ModelPart(kind, None, str(each)) for each, _ in pairs(entry(found, f"{kind}s"))]
        for own, variable in inferred(found, self.messages).items():
            full = f"{resource}.{own}"
            declared = self.variables.get(full)
            if declared is None and full not in self.abilities and own not in FLAGS:
                self.variables[full] = DeclaredVariable(variable.section, variable.type, is_written=False)
            elif declared is not None and declared.type is None and variable.type is not None:
                self.variables[full] = DeclaredVariable(declared.section, variable.type, declared.parameters)

    def _read_others(self, content: ModelContent) -> None:
        for name, document in pairs(content.get(OPERATIONS)):
            part = operation_part(name, document)
            if part.kind == "operation":
                self.operations[part.name] = parameters(entry(document, "parameters"))
                self._note(part, self.operations[part.name], part.id)
            else:
                self.sequences.add(part.name)
                self._note(part, parameters_within(document), part.id)
        for name, document in pairs(content.get(SPECIFICATIONS)):
            part = ModelPart("specification", None, str(name))
            self._note(part, parameters(entry(document, "parameters")), part.id)
        for name, document in pairs(content.get(WORK_MASTERS)):
            part = ModelPart("work_master", None, str(name))
            self._note(part, parameters_within(document), part.id)

    def _note(self, part: ModelPart, of: Parameters, holder: str) -> None:
        self.parts.append(part)
        self.parts += [ModelPart("parameter", holder, name) for name in of]


def own_values(document: object) -> list[SourceText]:
    """The values that an enumeration declares itself."""
    written = document if isinstance(document, list) else entry(document, "values")
    return [value for value in items(written) if isinstance(value, SourceText)]


def parameters(written: object) -> Parameters:
    """The parameters of a part, each with its enumeration."""
    return {str(name): str(of) for name, of in pairs(written) if isinstance(of, SourceText)}


def operation_part(name: str, document: object) -> ModelPart:
    """What an entry of `operations.yaml` is."""
    return ModelPart("sequence" if is_sequence(document) else "operation", None, str(name))


def parameters_within(document: object) -> Parameters:
    """The parameters of a sequence or a work master, and of all parts of it."""
    found = dict(parameters(entry(document, "for")))
    for branch in (*(branch for branch, _ in branches_in(document)), *items(entry(document, "orders"))):
        found |= parameters_within(branch)
    return found


def branches_in(document: object) -> Iterator[tuple[object, tuple[str | int, ...]]]:
    """The branches of a part of a sequence, each with where it stands in that."""
    for kind in SEQUENCE_KINDS:
        written = entry(document, kind)
        if isinstance(written, list):
            yield from ((branch, (kind, index)) for index, branch in enumerate(written))
        elif written is not None:
            yield written, (kind,)


def is_activity(names: list[str]) -> bool:
    """Return whether a dotted name is that of an operation's activity."""
    return len(names) == 3 and names[0] == OPERATION and names[2] == "active"


# Places at which parts of a model are named, as they are gathered from its files.


@dataclass(frozen=True, slots=True)
class TextContext:
    """The context of names around a text, for what they mean: its resource, and the parameters of what it stands in,
    with their enumerations.

    `holder` is the owner of these parameters; `has_flags` holds within an ability. `words` are those of the parameters
    that a quantifier binds, or an effect of the ability.
    """

    resource: str | None = None
    holder: str = ""
    parameters: Mapping[str, str] = field(default_factory=dict)
    has_flags: bool = False
    words: Mapping[str, ModelPart] = field(default_factory=dict)

    def parameter(self, word: str) -> ModelPart:
        """The parameter, or the word of a quantifier or an effect."""
        return self.words.get(word) or ModelPart("parameter", self.holder, word)


@dataclass(frozen=True, slots=True)
class Where:
    """An entry of a file, and whom it is a part of: `owner`, which stands at the first `depth` steps of its path."""

    file: str
    path: EntryPath
    owner: str
    depth: int
    around: TextContext = TextContext()

    def to(self, *steps: str | int) -> Where:
        """An entry within this one."""
        return Where(self.file, self.path + tuple(map(_plain, steps)), self.owner, self.depth, self.around)

    def within(self, owner: str, around: TextContext | None = None) -> Where:
        """This entry as a part of its own, with names of its own."""
        return Where(self.file, self.path, owner, len(self.path), self.around if around is None else around)

    @property
    def said(self) -> str:
        """In words a person knows, such as `ability robot.move: start.when`."""
        inner = shown_path(self.path[self.depth :])
        return f"{self.owner}: {inner}" if inner else self.owner


def _plain(step: str | int) -> str | int:
    return str(step) if isinstance(step, str) else step


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A part named at `span` of a text, within the name at `whole`. `fixed` says why it cannot be written otherwise,
    and `writes` holds where a variable is given a value.

    The text of the declaration of a resource or of a type of message is the name of its file, so there is none. A text
    that an instance has of its type stands at `home`.
    """

    part: ModelPart
    where: Where
    text: SourceText | None
    span: Span
    whole: Span
    declares: bool = False
    fixed: str | None = None
    writes: bool = False
    home: tuple[str, EntryPath] | None = None

    @property
    def home_file(self) -> str:
        """The file in which the part is named."""
        return self.where.file if self.home is None else self.home[0]

    @property
    def home_path(self) -> EntryPath:
        """The entry of that file."""
        return self.where.path if self.home is None else self.home[1]


class Unwritten(NamedTuple):
    """A variable that an entry gives a value, or else reads, though no text there names it; `why` says how that is."""

    part: ModelPart
    where: Where
    writes: bool
    why: str


class Binding(NamedTuple):
    """A pipeline at whose end a variable is a field of a message, because both have the name `field`; `why` says so."""

    file: str
    path: tuple[str, ...]
    incoming: bool
    field: str
    why: str


@dataclass
class Gathered:
    """All that was found.

    `links` are pairs of values that are one because variables of their enumerations are compared. `ties` are parts
    whose names are not the model's alone, each with why; `bindings` are variables for which a stage could say what
    their names do. `hidden` are pairs of parts of which one stands in the way of the other. `unwritten` are uses
    without a text that names what is used. `unread` are texts that make no sense, so that names in them may be missed.
    """

    content: ModelContent
    occurrences: list[Occurrence] = field(default_factory=list)
    links: set[frozenset[ModelPart]] = field(default_factory=set)
    ties: dict[ModelPart, str] = field(default_factory=dict)
    bindings: dict[ModelPart, list[Binding]] = field(default_factory=dict)
    hidden: set[tuple[ModelPart, ModelPart]] = field(default_factory=set)
    unwritten: list[Unwritten] = field(default_factory=list)
    unread: list[tuple[Where, SourceText]] = field(default_factory=list)

    def add(
        self,
        part: ModelPart,
        where: Where,
        text: SourceText,
        span: Span | None = None,
        *,
        whole: Span | None = None,
        declares: bool = False,
        fixed: str | None = None,
        writes: bool = False,
    ) -> None:
        """Note that `text` names a part at `span`, or as a whole."""
        span = Span(0, len(text)) if span is None else span
        whole = whole or span
        while isinstance(text, ExpandedText):
            if (argument := text.argument(span)) is not None:
                text, span = argument, Span(0, len(argument))
                whole = span
                continue
            if any(each.start < span.end and span.start < each.end for each in text.pieces):
                self.tie(part, "its name is made of an argument of its type")
            span, whole, text = text.in_template(span), text.in_template(whole), text.template
        home = None if text.place.file == where.file else (text.place.file, self.content.path_of(text))
        if text.place.instance:
            text = SourceText(text, text.place._replace(instance=""), text.raw)
        self.occurrences.append(Occurrence(part, where, text, span, whole, declares, fixed, writes, home))

    def home_of(self, file: str, path: tuple[str, ...]) -> tuple[str, tuple[str, ...]]:
        """Return where an entry of a resource stands that an instance may have of its type."""
        content, home = self.content.whole.get(file), (file, path)
        for depth, step in enumerate(path, start=1):
            key = next((key for key, _ in pairs(content) if key == step), None)
            if key is None:
                break
            source = key.template if isinstance(key, ExpandedText) else key
            is_own = source.place.file == file
            at = path[:depth] if is_own else tuple(map(str, self.content.path_of(source)))
            home = (source.place.file, (*at, *path[depth:]))
            content = entry(content, step)
        return home

    def tie(self, part: ModelPart, why: str) -> None:
        """Note that the name of a part is not the model's alone."""
        self.ties.setdefault(part, why)
