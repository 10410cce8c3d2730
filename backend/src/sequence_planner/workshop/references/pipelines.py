"""The names in topics, services, actions and flows."""

from __future__ import annotations

from sequence_planner.expressions.syntax import Span
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.goal_states import GOAL_STATE
from sequence_planner.workshop.references.binding import bind
from sequence_planner.workshop.references.examples import read_examples
from sequence_planner.workshop.references.fields import pipelines
from sequence_planner.workshop.references.naming import Naming
from sequence_planner.workshop.references.occurrences import Unwritten, Where
from sequence_planner.workshop.references.parts import Part, value_of, variable_of
from sequence_planner.workshop.references.record import Field, Fields, Names
from sequence_planner.workshop.references.stages import Stages, given_by, kinds_of
from sequence_planner.workshop.references.texts import Content, entry, items, pairs, text_at

_STATUS = "the status of an action ranges over the states of a goal, whose names are given"


class Pipelines:
    """Reads the pipelines of all resources. What stands at the end of each is known by what flows call it."""

    def __init__(self, naming: Naming, content: Content) -> None:
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

    def read(self) -> None:
        """All of them, flows behind their sources."""
        for resource, file, found in self._content.resources():
            for kind in ("topic", "service", "action"):
                for name, document in pairs(entry(found, f"{kind}s")):
                    where = Where(file, (f"{kind}s", str(name)), f"{kind} {name}", 2)
                    self._naming.gathered.add(Part(kind, None, str(name)), where, name, declares=True)
                    self._kinds[str(name)] = kind
                    self._client(resource, document, where)
            self._read_resource(resource, file, found)
        for full in self._flows:
            self._flow(full)

    def _client(self, resource: str, document: object, where: Where) -> None:
        """The type of what is sent, and the variables that call a service or an action or say what became of a goal."""
        if (type_ := text_at(document, "type")) is not None:
            self._naming.gathered.add(Part("message", None, str(type_)), where.to("type"), type_)
        for key in ("when", "status"):
            if (text := text_at(document, key)) is not None:
                part, is_status = variable_of(resource, str(text)), key == "status"
                self._naming.gathered.add(part, where.to(key), text, writes=is_status)
        if (status := text_at(document, "status")) is not None:
            enumeration = self._naming.declared.enumeration(resource, str(status))
            for value in self._naming.declared.enumerations.get(enumeration or "", ()):
                self._naming.gathered.tie(value_of(enumeration or "", value), _STATUS)
            if enumeration == GOAL_STATE:
                self._naming.gathered.tie(Part("enumeration", None, GOAL_STATE), _STATUS)

    def _read_resource(self, resource: str, file: str, found: object) -> None:
        for pipeline in pipelines(found, self._naming.declared.messages):
            where = Where(file, pipeline.path, f"{pipeline.kind} {pipeline.path[1]}", 2)
            given = given_by(pipeline.stages)
            kinds = kinds_of(pipeline.stages, self._naming.declared, resource)
            names = Names(self._naming, resource, pipeline.incoming, {}, given, kinds)
            stages = Stages(names, f"the {pipeline.kind} {pipeline.called}")
            stages.read(pipeline.stages, where)
            bind(stages, pipeline, file)
            self._ends[pipeline.called] = names.fields
            examples = entry(found, *pipeline.path[:2], "examples")
            above = Where(file, (*pipeline.path[:2], "examples"), where.owner, 2)
            read_examples(names, {}, examples, above)
        for name, action in pairs(entry(found, "actions")):
            if (status := text_at(action, "status")) is not None:
                field = Field(variable_of(resource, str(status)), GOAL_STATE)
                self._ends[f"{name} status"] = {str(status): field}

    def _flow(self, name: str) -> Fields:
        if name in self._begun or name not in self._flows:
            return self._ends.get(name, {})
        self._begun.add(name)
        resource, where, flow = self._flows[name]
        key = next(key for key, _ in pairs(entry(self._content.get(where.file), "flows")) if key == where.path[1])
        self._naming.gathered.add(Part("flow", resource, str(key)), where, key, declares=True)
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
        pipeline = entry(flow, "pipeline")
        kinds = kinds_of(pipeline, self._naming.declared, resource)
        names = Names(self._naming, resource, True, fields, given_by(pipeline), kinds)
        Stages(names, where.owner).read(pipeline, where.to("pipeline"))
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
        """What a source of a flow has at its end."""
        if not isinstance(written, SourceText):
            return {}
        text = str(written)
        for full, start in ((f"{resource}.{text}", 0), (text, text.rfind(".") + 1)):
            if full in self._flows:
                owner, _, name = full.rpartition(".")
                if start:
                    own = Part("resource", None, owner)
                    self._naming.gathered.add(own, where, written, Span(0, start - 1), whole=Span(0, len(text)))
                span = Span(start, len(text))
                self._naming.gathered.add(Part("flow", owner, name), where, written, span, whole=Span(0, len(text)))
                return self._flow(full)
        name = text.partition(" ")[0]
        kind = self._kinds.get(name)
        if kind is None:
            self._find_later(name, where, written)
        else:
            self._naming.gathered.add(Part(kind, None, name), where, written, Span(0, len(name)))
        return self._ends.get(text, {})

    def _find_later(self, name: str, where: Where, written: SourceText) -> None:
        if name.startswith("/"):  # of no resource that could be read
            self._naming.gathered.add(Part("topic", None, name), where, written, Span(0, len(name)))
