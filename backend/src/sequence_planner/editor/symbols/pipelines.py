"""Symbol collection in pipelines, messages and examples: bindings of variables to message fields."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping

from sequence_planner.editor.symbols.collectors import (
    Fields,
    Names,
    Naming,
    RecordName,
)
from sequence_planner.editor.symbols.fields import Pipeline, pipelines
from sequence_planner.editor.symbols.index import (
    Binding,
    DeclaredVariable,
    Gathered,
    ModelPart,
    Occurrence,
    Unwritten,
    Where,
    variable_of,
)
from sequence_planner.editor.symbols.stages import Stages, kinds_of
from sequence_planner.editor.symbols.texts import (
    MarkedStages,
    ModelContent,
    entry,
    file_of,
    given_by,
    items,
    marked_in,
    message_of,
    named_in,
    pairs,
    text_at,
)
from sequence_planner.language.records.field_paths import NoFieldError, find_field
from sequence_planner.language.syntax import Span
from sequence_planner.language.types import IntegerRange, Place
from sequence_planner.model.source import SourceText
from sequence_planner.model.stages.marks import NameUse
from sequence_planner.model.yaml.editor import insert, remove, replace
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.pipelines.graph import GOAL_STATE
from sequence_planner.ros.types.messages import MessageRegistry

# Variables that a message names: an incoming field writes the variable of its name, an outgoing one reads it.


def bind(stages: Stages, pipeline: Pipeline, marked: MarkedStages, file: str) -> None:
    """Note the variables that are bound to fields of a message by their names, at the end of a pipeline."""
    names = stages.names
    declared = names.naming.declared
    is_unknown = pipeline.fields is None
    read = named_in(marked, pipeline.incoming, NameUse.CONSUMED, NameUse.RENAMED) if is_unknown else set()
    made: Collection[str] = set(names.fields)
    if pipeline.incoming:
        made = names.given | named_in(marked, True, NameUse.RENAMED)
    for section in ("measured",) if pipeline.incoming else ("measured", "output", "estimated"):
        for name, variable in declared.own(names.resource, section):
            part = variable_of(names.resource, name)
            enumeration = declared.enumeration(names.resource, name)
            if name in made or not _is_bound(name, variable, stages, pipeline, read):
                continue
            where = f"of the messages of {pipeline.called}"
            gathered = names.naming.gathered
            if pipeline.fields is None:
                why = f"{part} may be a field {where}, whose definition is not known"
                gathered.tie(part, why)
            elif _is_of_constants(name, enumeration, pipeline):
                why = f"the field `{name}` {where} says the values of {part} by numbers of their names"
                gathered.tie(part, why)
            else:
                why = f"{part} would be the field `{name}` {where}"
                binding = Binding(*gathered.home_of(file, pipeline.path), pipeline.incoming, name, why)
                gathered.bindings.setdefault(part, []).append(binding)
            entry_of = Where(file, pipeline.path, f"{pipeline.kind} {pipeline.path[1]}", 2)
            gathered.unwritten.append(Unwritten(part, entry_of, pipeline.incoming, why))
            stages.tie(enumeration, f"the field `{name}` {where} says the values of {part} by their names")
            if pipeline.incoming:
                names.fields.setdefault(name, RecordName(part, enumeration))


def _is_of_constants(name: str, enumeration: str | None, pipeline: Pipeline) -> bool:
    """Return whether an outgoing message has constants for the values of a variable: that holds for no field of a
    stage.
    """
    field = (pipeline.fields or {}).get(name)
    return not pipeline.incoming and enumeration is not None and isinstance(field, IntegerRange)


def _is_bound(name: str, variable: DeclaredVariable, stages: Stages, pipeline: Pipeline, read: set[str]) -> bool:
    """Return whether a variable that no stage makes is a field of the message, or may be one where nobody knows it."""
    if name in pipeline.ignored or variable.parameters:
        return False
    if pipeline.fields is None:
        may_be_one = variable.section == ("measured" if pipeline.incoming else "output")
        return may_be_one and name not in read and not _is_made_elsewhere(name, stages, pipeline)
    try:
        find_field(pipeline.fields, name)
    except NoFieldError:
        return False
    return True


def _is_made_elsewhere(name: str, stages: Stages, pipeline: Pipeline) -> bool:
    """Return whether the pipeline of another message of the resource makes a variable, or uses it."""
    resource = stages.names.naming.declared.resources.get(stages.names.resource)
    for _, topic in pairs(entry(resource, "topics")):
        stages_there = entry(topic, "pipeline")
        if stages_there is pipeline.stages or (entry(topic, "direction") == "in") is not pipeline.incoming:
            continue
        marked = marked_in(stages_there)
        used = () if pipeline.incoming else named_in(marked, False, NameUse.CONSUMED, NameUse.RENAMED)
        if name in given_by(marked) or name in used:
            return True
    return False


# The types of messages that a station defines, and those that their fields name.

# The type of a field that is a message itself: of the same package, or with its package, and `msg` or without.
_FIELD = re.compile(r"\s*((?:([a-z]\w*)/(?:msg/)?)?([A-Z]\w*))(?:\[[^\]]*\])?\s+\w+")


def read_definitions(content: ModelContent, gathered: Gathered) -> None:
    """Note each definition, and the types of its fields."""
    for file, text in content.definitions.items():
        name = message_of(file) or ""
        where = Where(file, (), f"message {name}", 0)
        none = Span(0, 0)
        gathered.occurrences.append(Occurrence(ModelPart("message", None, name), where, None, none, none, True))
        own = name.partition("/")[0]
        for number, line in enumerate(text.splitlines(), start=1):
            if found := _FIELD.match(line):
                part = ModelPart("message", None, f"{found[2] or own}/msg/{found[3]}")
                written = SourceText(found[1], Place(file, number, found.start(1) + 1), found[1])
                gathered.add(part, where, written)


# The names in examples of pipelines: variables and fields, and their values.


def read_examples(names: Names, before: Fields, examples: object, where: Where) -> None:
    """Note what examples name; `before` are the fields with which the records of a flow begin."""
    for index, example in enumerate(items(examples)):
        _read_example(names, before, example, where.to(index))
        for number, step in enumerate(items(entry(example, "steps"))):
            _read_example(names, before, step, where.to(index, "steps", number))


def _read_example(names: Names, before: Fields, example: object, where: Where) -> None:
    given, gives = where.to("given"), where.to("gives")
    if names.incoming:
        end = Names(names.naming, names.resource, True, names.fields, frozenset())
        _read_values(end, entry(example, "gives"), gives)
    else:
        start = Names(names.naming, names.resource, False, {}, frozenset())
        _read_values(start, entry(example, "given"), given)
    if before:
        _read_given(Names(names.naming, names.resource, True, before, frozenset()), entry(example, "given"), given)


def _read_values(names: Names, content: object, where: Where) -> None:
    for name, value in pairs(content):
        at = where.to(name)
        names.naming.note_value(names.read(name, at), at, value)


def _read_given(names: Names, content: object, where: Where) -> None:
    """Read what the sources of a flow give: by alias in a merge, else by name."""
    for alias, fields in pairs(content):
        if isinstance(fields, dict):
            own = {
                name.partition(".")[2]: field for name, field in names.fields.items() if name.startswith(f"{alias}.")
            }
            _read_values(Names(names.naming, names.resource, True, own, frozenset()), fields, where.to(alias))
    if not any("." in name for name in names.fields):
        _read_values(names, content, where)


# Variables that bear the names of fields of messages: said by a `rename` stage, or left to the names alone.


def said(files: Mapping[str, str], bindings: Iterable[Binding]) -> dict[str, str]:
    """The files in which a `rename` stage says what the names alone have said: `{field: field}`."""
    new: dict[str, str] = {}
    for each in bindings:
        text = new.get(each.file, files[each.file])
        stages = items(entry(ModelContent({each.file: text})[each.file], *each.path))
        new[each.file] = _with(text, each, stages)
    return new


def _with(text: str, binding: Binding, stages: list[object]) -> str:
    name, path = binding.field, binding.path
    stage = {"rename": {name: name}}
    if not stages:
        inside = entry(ModelContent({binding.file: text})[binding.file], *path[:-1])
        is_there = isinstance(inside, dict) and path[-1] in inside
        return replace(text, path, [stage]) if is_there else insert(text, path, [stage])
    index = _index(binding.incoming, stages)
    if pairs(entry(stages[index], "rename")):
        return insert(text, (*path, index, "rename", name), name)
    if binding.incoming:
        return insert(text, (*path, 0), stage, before=0)
    return insert(text, (*path, len(stages)), stage)


def unsaid(files: Mapping[str, str], part: ModelPart, messages: MessageRegistry | None) -> dict[str, str]:
    """The files of a variable, and of the types of its resource, without the `rename` stages that say what its name
    alone says.
    """
    file, content, new = file_of(part.owner or ""), ModelContent(files), dict[str, str]()
    for pipeline in pipelines(content.whole.get(file, content[file]), messages):
        if part.name not in (pipeline.fields or {}) or part.name in pipeline.ignored:
            continue
        home, path = Gathered(content).home_of(file, pipeline.path)
        text = new.get(home, files[home])
        if not (stages := items(entry(ModelContent({home: text})[home], *path))):
            continue
        index = _index(pipeline.incoming, stages)
        said_there = {str(field): str(name) for field, name in pairs(entry(stages[index], "rename"))}
        if said_there.get(part.name) == part.name:
            new[home] = _without(text, (*path, index, "rename", part.name), len(said_there), len(stages))
    return new


def _without(text: str, path: EntryPath, names: int, stages: int) -> str:
    """`text` without a pair of a stage; without the stage, or the pipeline, that would then be empty."""
    if names > 1:
        return remove(text, path)
    return remove(text, path[:-2] if stages > 1 else path[:-3])


def _index(incoming: bool, stages: list[object]) -> int:
    """The stage that has what a message says, or what is said in one: the first, or the last."""
    return 0 if incoming else len(stages) - 1


# The names in topics, services, actions and flows.

_STATUS = "the status of an action ranges over the states of a goal, whose names are given"


class PipelineCollector:
    """Reads the pipelines of all resources. What stands at the end of each is known by what flows call it."""

    def __init__(self, naming: Naming, content: ModelContent) -> None:
        self._naming = naming
        self._content = content
        self._ends: dict[str, Fields] = {}
        self._kinds: dict[str, str] = {}
        self._flows = {
            f"{resource}.{name}": (resource, Where(file, ("flows", str(name)), f"flow {resource}.{name}", 2), flow)
            for resource, file, found in content.resources()
            for name, flow in pairs(entry(found, "flows"))
        }
        self._begun: set[str] = set()

    def read(self, only: str | None = None) -> None:
        """All of them, flows behind their sources; or those that matter to what is named in a file."""
        flows = (where.file for _, where, _ in self._flows.values())
        if only is not None and not any(self._content.is_made_of(each, only) for each in flows):
            self._flows.clear()
        else:
            only = None
        for resource, file, found in self._content.resources():
            if only is not None and not self._content.is_made_of(file, only):
                continue
            for kind in ("topic", "service", "action"):
                for name, document in pairs(entry(found, f"{kind}s")):
                    where = Where(file, (f"{kind}s", str(name)), f"{kind} {name}", 2)
                    self._naming.gathered.add(ModelPart(kind, None, str(name)), where, name, declares=True)
                    self._kinds[str(name)] = kind
                    self._client(resource, document, where)
            self._read_resource(resource, file, found)
        for full in self._flows:
            self._flow(full)

    def _client(self, resource: str, document: object, where: Where) -> None:
        """The type of what is sent, and the variables that call a service or an action or say what became of a goal."""
        if (type_ := text_at(document, "type")) is not None:
            self._naming.gathered.add(ModelPart("message", None, str(type_)), where.to("type"), type_)
        for key in ("when", "status"):
            if (text := text_at(document, key)) is not None:
                part, is_status = variable_of(resource, str(text)), key == "status"
                self._naming.gathered.add(part, where.to(key), text, writes=is_status)
        if (status := text_at(document, "status")) is not None:
            enumeration = self._naming.declared.enumeration(resource, str(status))
            for value in self._naming.declared.homes.get(enumeration or "", ()):
                self._naming.gathered.tie(self._naming.declared.value(enumeration or "", value), _STATUS)
            if enumeration == GOAL_STATE:
                self._naming.gathered.tie(ModelPart("enumeration", None, GOAL_STATE), _STATUS)

    def _read_resource(self, resource: str, file: str, found: object) -> None:
        for pipeline in pipelines(found, self._naming.declared.messages):
            where = Where(file, pipeline.path, f"{pipeline.kind} {pipeline.path[1]}", 2)
            marked = marked_in(pipeline.stages)
            given = given_by(marked)
            kinds = kinds_of(marked, self._naming.declared, resource)
            names = Names(self._naming, resource, pipeline.incoming, {}, given, kinds)
            stages = Stages(names, f"the {pipeline.kind} {pipeline.called}")
            stages.read(marked, where)
            bind(stages, pipeline, marked, file)
            self._ends[pipeline.called] = names.fields
            examples = entry(found, *pipeline.path[:2], "examples")
            above = Where(file, (*pipeline.path[:2], "examples"), where.owner, 2)
            read_examples(names, {}, examples, above)
        for name, action in pairs(entry(found, "actions")):
            if (status := text_at(action, "status")) is not None:
                field = RecordName(variable_of(resource, str(status)), GOAL_STATE)
                self._ends[f"{name} status"] = {str(status): field}

    def _flow(self, name: str) -> Fields:
        if name in self._begun or name not in self._flows:
            return self._ends.get(name, {})
        self._begun.add(name)
        resource, where, flow = self._flows[name]
        key = next(key for key, _ in pairs(entry(self._content.whole.get(where.file), "flows")) if key == where.path[1])
        self._naming.gathered.add(ModelPart("flow", resource, str(key)), where, key, declares=True)
        fields: Fields = {}
        written, at = entry(flow, "from"), where.to("from")
        match written:
            case dict():
                for alias, source in pairs(written):
                    ends = self._source(resource, source, at.to(alias))
                    fields |= {f"{alias}.{each}": field for each, field in ends.items()}
            case list():
                for index, source in enumerate(items(written)):
                    fields |= self._source(resource, source, at.to(index))
            case _:
                fields |= self._source(resource, written, at)
        self._pass_through(resource, fields, where)
        before = dict(fields)
        marked = marked_in(entry(flow, "pipeline"))
        kinds = kinds_of(marked, self._naming.declared, resource)
        names = Names(self._naming, resource, True, fields, given_by(marked), kinds)
        Stages(names, where.owner).read(marked, where.to("pipeline"))
        self._ends[name] = names.fields
        read_examples(names, before, entry(flow, "examples"), where.to("examples"))
        return names.fields

    def _pass_through(self, resource: str, fields: Fields, where: Where) -> None:
        """A variable of another resource that becomes one of this resource because both bear the same name."""
        for name, field in fields.items():
            part = variable_of(resource, name)
            variable = self._naming.declared.variables.get(part.full)
            if variable is None or field.part is None or field.part == part or variable.section != "measured":
                continue
            why = f"{part} and {field.part} are one in a flow because their names are the same"
            for each in (part, field.part):
                self._naming.gathered.tie(each, why)
                self._naming.gathered.unwritten.append(Unwritten(each, where, each == part, why))
            self._naming.link(self._naming.declared.enumeration(resource, name), field.enumeration)

    def _source(self, resource: str, written: object, where: Where) -> Fields:
        """Return what a source of a flow has at its end."""
        if not isinstance(written, SourceText):
            return {}
        text = str(written)
        for full, start in ((f"{resource}.{text}", 0), (text, text.rfind(".") + 1)):
            if full in self._flows:
                owner, _, name = full.rpartition(".")
                if start:
                    own = ModelPart("resource", None, owner)
                    self._naming.gathered.add(own, where, written, Span(0, start - 1), whole=Span(0, len(text)))
                span = Span(start, len(text))
                self._naming.gathered.add(
                    ModelPart("flow", owner, name), where, written, span, whole=Span(0, len(text))
                )
                return self._flow(full)
        name = text.partition(" ")[0]
        kind = self._kinds.get(name)
        if kind is None:
            self._find_later(name, where, written)
        else:
            self._naming.gathered.add(ModelPart(kind, None, name), where, written, Span(0, len(name)))
        return self._ends.get(text, {})

    def _find_later(self, name: str, where: Where, written: SourceText) -> None:
        if name.startswith("/"):  # of no resource that could be read
            self._naming.gathered.add(ModelPart("topic", None, name), where, written, Span(0, len(name)))
