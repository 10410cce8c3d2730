"""Model graph: all named parts of a model in layers (Dahl et al.) with their relations, and its view."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.controller.views.part import View
from sequence_planner.editor.symbols.definitions import Manner, gather, manner_of
from sequence_planner.editor.symbols.index import (
    Declared,
    Gathered,
    ModelPart,
    Where,
    parse_part,
    variable_of,
)
from sequence_planner.editor.symbols.rename import Usage, homes_of, usage_of
from sequence_planner.editor.symbols.texts import (
    MIMIC,
    OPERATIONS,
    SPECIFICATIONS,
    STATION,
    WORK_MASTERS,
    ModelContent,
    message_of,
    text_at,
    title_at,
)
from sequence_planner.editor.symbols.types import type_part
from sequence_planner.model.paths import has_scenarios, resource_of, shown_path, type_of
from sequence_planner.model.source import Finding
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.graph import GOAL_STATE
from sequence_planner.process.gc_tuning import collection_put_off
from sequence_planner.ros.types.messages import MessageRegistry

# The model as a whole: all that has a name, on the layers of Dahl et al., and what is tied to what.
#
# The layers are those of the paper: 0 what nodes of ROS 2 measure and are told, 1 the abilities of resources with what
# they estimate, 2 operations and specifications, 3 the order of work. All ties are uses that `gather` finds, once each.

_LAYERS = {
    "work_master": 3,
    "sequence": 3,
    "operation": 2,
    "specification": 2,
    "ability": 1,
    "effect": 1,
    "alarm": 1,
    "predicate": 1,
}
_OF_FILE = {SPECIFICATIONS: "specification", WORK_MASTERS: "work_master"}
_FROM_ROS = (Manner.FEEDS, Manner.SENDS)
_OF_STATION = {
    "enumerations": "enumeration",
    "sets": "set",
    "relations": "relation",
    "maps": "map",
    "predicates": "predicate",
    "estimated": "variable",
    "alarms": "alarm",
}
_OF_RESOURCE = {
    "abilities": "ability",
    "flows": "flow",
    "alarms": "alarm",
    "sets": "set",
    "relations": "relation",
    "maps": "map",
    "predicates": "predicate",
}
_OF_SECTION = {"topics": "topic", "services": "service", "actions": "action"}


class Standing(StrEnum):
    """Origin of a node."""

    DECLARED = "declared"
    IMPLIED = "implied"  # by messages or stages, or given with ROS 2
    MISSING = "missing"  # it is only named


@dataclass(frozen=True)
class ModelNode:
    """Something with a name. `section` is that of a variable; `within` is the thing that it is shown as a part of.

    `place` is where it is declared, or else first used.
    """

    part: ModelPart
    layer: int
    standing: Standing
    resource: str | None
    section: str | None
    within: ModelPart | None
    title: str | None
    place: Usage | None


@dataclass(frozen=True)
class ModelEdge:
    """A use of a thing by another, or by the station itself. `entry` says where in it, such as `start.when`.

    `written` says whether a text names the thing there; if none does, line and column are those of the name of `by`.
    """

    part: ModelPart
    by: ModelPart | None
    manner: Manner
    file: str
    line: int
    column: int
    entry: str
    written: bool


@dataclass(frozen=True)
class ModelGraph:
    """All things in the order of the files, and all ties; `skipped` and `unread` are what could not be read."""

    things: tuple[ModelNode, ...]
    ties: tuple[ModelEdge, ...]
    skipped: tuple[Finding, ...] = ()
    unread: tuple[Finding, ...] = ()


@collection_put_off()
def graph(files: Mapping[str, str], messages: MessageRegistry | None = None) -> ModelGraph:
    """The graph of a draft, as far as it can be read. `messages` are the types of messages that the station knows."""
    content = ModelContent(files)
    declared, gathered = gather(content, messages)
    ties = _ties(declared, gathered)
    things = _Things(content, declared, gathered, ties).all()
    unread = [
        Finding(text.place, f"{where.said}: this cannot be read, and may name something")
        for where, text in gathered.unread
    ]
    return ModelGraph(things, ties, tuple(content.skipped), tuple(unread))


def user(where: Where) -> ModelPart | None:
    """The part that an entry of a file belongs to: what uses what is named there. None is the station itself."""
    file, path = where.file, where.path
    if file == OPERATIONS:
        return ModelPart(where.owner.partition(" ")[0], None, str(path[0]))
    if (kind := _OF_FILE.get(file)) is not None:
        return ModelPart(kind, None, str(path[0]))
    if (message := message_of(file)) is not None:
        return ModelPart("message", None, message)
    if (type_ := type_of(file)) is not None:
        return type_part(type_)
    resource = resource_of(file)
    if len(path) < 2 or path[0] == "arguments":
        return None if resource is None else ModelPart("resource", None, resource)
    section, name = str(path[0]), str(path[1])
    if resource is None:
        return ModelPart(_OF_STATION[section], None, name) if section in _OF_STATION else None
    if section in _OF_SECTION:
        return ModelPart(_OF_SECTION[section], None, name)
    return ModelPart(_OF_RESOURCE.get(section, "variable"), resource, name)


def _ties(declared: Declared, gathered: Gathered) -> tuple[ModelEdge, ...]:
    found: dict[ModelEdge, None] = {}
    homes = homes_of(gathered)
    for each in gathered.occurrences:
        if each.declares or each.text is None or each.part.kind == "word":
            continue
        # A picture shows the station, and scenarios test it: they are no part of what it does.
        if each.where.file == MIMIC or has_scenarios(each.where.file):
            continue
        place, where = each.text.at(each.span), each.where
        by = user(where)
        manner = manner_of(each.part, by, where.path[where.depth :], declared, writes=each.writes)
        inner = shown_path(where.path[where.depth :])
        found[ModelEdge(each.part, by, manner, each.home_file, place.line, place.column, inner, True)] = None
    for unwritten in gathered.unwritten:
        where = unwritten.where
        home = homes.get((where.file, where.path[: where.depth]))
        line, column = (home.line, home.column) if home else (1, 1)
        by, inner = user(where), shown_path(where.path[where.depth :])
        manner = manner_of(unwritten.part, by, where.path[where.depth :], declared, writes=unwritten.writes)
        file = home.file if home else where.file
        found[ModelEdge(unwritten.part, by, manner, file, line, column, inner, False)] = None
    return tuple(found)


class _Things:
    def __init__(
        self, content: ModelContent, declared: Declared, gathered: Gathered, ties: tuple[ModelEdge, ...]
    ) -> None:
        self._content = content
        self._declared = declared
        self._homes = {each.part: (each.where, usage_of(each)) for each in gathered.occurrences if each.declares}
        self._first: dict[ModelPart, ModelEdge] = {}
        for tie in ties:
            before = self._first.get(tie.part)
            if before is None or (tie.manner in _FROM_ROS and before.manner not in _FROM_ROS):
                self._first[tie.part] = tie
        self._parts = dict.fromkeys(
            (*declared.parts, *map(_variable, declared.variables), *self._first, *(tie.by for tie in ties if tie.by))
        )

    def all(self) -> tuple[ModelNode, ...]:
        return tuple(map(self._thing, self._parts))

    def _thing(self, part: ModelPart) -> ModelNode:
        where, place = self._homes.get(part, (None, None))
        first = self._first.get(part)
        if place is None and first is not None:
            place = Usage(part, first.file, (), first.line, first.column, 0, "", "", False)
        variable = self._declared.variables.get(part.full) if part.kind == "variable" else None
        section = None if variable is None else variable.section
        return ModelNode(
            part, self._layer(part, section), self._standing(part), self._resource(part, where, place), section,
            self._within(part), None if where is None else self._title(where.file, where.path), place,
        )  # fmt: skip

    def _layer(self, part: ModelPart, section: str | None) -> int:
        if part.kind == "parameter" and (within := self._within(part)) is not None:
            return self._layer(within, None)
        is_estimated = section == "estimated" or (part.kind == "variable" and part.owner is None)
        return 1 if is_estimated else _LAYERS.get(part.kind, 0)

    def _standing(self, part: ModelPart) -> Standing:
        if part in self._homes:
            return Standing.DECLARED
        is_made = part.kind == "variable" and (part.full in self._declared.variables or self._is_passing(part))
        is_given = GOAL_STATE in (part.name, part.owner) or (part.kind == "message" and not self._is_own(part))
        return Standing.IMPLIED if is_made or is_given else Standing.MISSING

    def _is_own(self, message: ModelPart) -> bool:
        package = message.name.partition("/")[0]
        return any(each.kind == "message" and each.name.partition("/")[0] == package for each in self._declared.parts)

    def _is_passing(self, part: ModelPart) -> bool:
        """Return whether it is only a step on the way through a pipeline."""
        first = self._first.get(part)
        return part.full not in self._declared.variables and first is not None and first.manner is Manner.FEEDS

    def _within(self, part: ModelPart) -> ModelPart | None:
        owner = part.owner or ""
        match part.kind:
            case "value":
                return ModelPart("enumeration", None, owner)
            case "effect":
                return parse_part(f"ability:{owner}")
            case "parameter" if ":" in owner:
                return parse_part(owner)
            case "parameter":
                holders = {"ability": self._declared.abilities, "predicate": self._declared.predicates}
                kind = next((kind for kind in holders if owner in holders[kind]), "variable")
                is_effect = parse_part(f"effect:{owner}") in self._homes
                return parse_part(f"{'effect' if is_effect else kind}:{owner}")
            case "variable" if self._is_passing(part):
                return self._first[part].by
        return None

    def _resource(self, part: ModelPart, where: Where | None, place: Usage | None) -> str | None:
        """The resource to which it belongs: for what is of ROS 2, that in whose file it stands."""
        if part.kind == "variable" or part.kind in _OF_RESOURCE.values():
            return part.owner
        if part.kind == "resource":
            return part.name
        is_in_file = part.kind in ("topic", "service", "action", "effect", "parameter") and place is not None
        file = place.file if where is None and place is not None else "" if where is None else where.file
        return resource_of(file) if is_in_file else None

    def _title(self, file: str, path: EntryPath) -> str | None:
        content = self._content.whole.get(file)
        found = title_at(content, *map(str, path), "title")
        return None if found is None else str(found)


def _variable(full: str) -> ModelPart:
    owner, _, name = full.rpartition(".")
    return variable_of(owner or None, name)


def station_of(files: Mapping[str, str]) -> tuple[str, str | None]:
    """The name and the title of a station, as far as they can be read."""
    content = ModelContent({STATION: files.get(STATION, "")}).get(STATION)
    return str(text_at(content, "name") or ""), title_at(content, "title")


# What is shown of a model as a whole.

STATION_NODE = "station"
_OPERATIONS = 2  # the layer on which the states of rest are


class ThingView(View):
    """Something with a name: `id` is that of a part, such as `variable:robot.pose`, or `station` for the station.

    `layer` is that of the paper: 0 ROS 2, 1 abilities and estimates, 2 operations and specifications, 3 the order of
    work. `within` is the index of the thing that it is a part of, as a value is of an enumeration. File, line and
    column are where it is declared, or else first used; the file is null where it is given.
    """

    id: str
    kind: str
    name: str
    title: str | None
    layer: int
    standing: Standing
    resource: str | None
    section: str | None
    within: int | None
    file: str | None
    line: int
    column: int


class TieView(View):
    """A use of the thing with index `thing` by that with index `by`, at the entry `at` within that.

    `written` is false where no text names it: then a field of a message has its name, and line and column are of `by`.
    """

    thing: int
    by: int
    manner: Manner
    at: str
    file: str
    line: int
    column: int
    written: bool


class GraphView(View):
    """All things of the draft after its change `number`, and all ties between them; `unread` could not be read."""

    number: int
    things: list[ThingView]
    ties: list[TieView]
    unread: list[FindingDocument]


def graph_view(number: int, graph: ModelGraph, name: str, title: str | None) -> GraphView:
    """The view of a graph of a station."""
    station = ThingView(
        id=STATION_NODE, kind=STATION_NODE, name=name, title=title, layer=_OPERATIONS, standing=Standing.DECLARED,
        resource=None, section=None, within=None, file="station.yaml", line=1, column=1,
    )  # fmt: skip
    index: dict[ModelPart | None, int] = {None: 0}
    index |= {thing.part: number for number, thing in enumerate(graph.things, start=1)}
    return GraphView(
        number=number,
        things=[station, *(_thing(each, index) for each in graph.things)],
        ties=[
            TieView(
                thing=index[each.part],
                by=index[each.by],
                manner=each.manner,
                at=each.entry,
                file=each.file,
                line=each.line,
                column=each.column,
                written=each.written,
            )
            for each in graph.ties
        ],
        unread=[error_document(each) for each in (*graph.skipped, *graph.unread)],
    )


def _thing(thing: ModelNode, index: dict[ModelPart | None, int]) -> ThingView:
    place = thing.place
    return ThingView(
        id=thing.part.id,
        kind=thing.part.kind,
        name=thing.part.full.rpartition(":")[2],
        title=thing.title,
        layer=thing.layer,
        standing=thing.standing,
        resource=thing.resource,
        section=thing.section,
        within=None if thing.within is None else index.get(thing.within),
        file=None if place is None else place.file,
        line=1 if place is None else place.line,
        column=1 if place is None else place.column,
    )
