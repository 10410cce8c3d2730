"""The names in the files of a station, entry by entry: which texts there are, and what is around each."""

from __future__ import annotations

import re

from sequence_planner.expressions.parser import parse
from sequence_planner.expressions.syntax import ExpressionError, Name, Span
from sequence_planner.model.source import SourceText
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.references.declared import SECTIONS, Declared, parameters
from sequence_planner.workshop.references.definitions import read_definitions
from sequence_planner.workshop.references.expressions import Expressions
from sequence_planner.workshop.references.naming import Naming, steps_of
from sequence_planner.workshop.references.occurrences import Gathered, Occurrence, Surroundings, Where
from sequence_planner.workshop.references.parts import Part, value_of, variable_of
from sequence_planner.workshop.references.pipelines import Pipelines
from sequence_planner.workshop.references.texts import (
    OPERATIONS,
    SPECIFICATIONS,
    STATION,
    WORK_MASTERS,
    Content,
    entry,
    items,
    pairs,
    text_at,
)

_CONDITIONS = (("enabled",), ("start", "when"), ("executing",), ("finished",), ("finish", "when"))
_ACTIONS = (("start", "do"), ("finish", "do"), ("cancel", "do"))
_IN_BRACES = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)\}")


def gather(content: Content, messages: MessageRegistry | None, word: str | None = None) -> tuple[Declared, Gathered]:
    """What is named in the files, and where. With `word`, only in expressions that hold it."""
    gathered = Gathered()
    declared = Declared(content, messages)
    naming = Naming(declared, gathered)
    walk = _Walk(naming, Expressions(naming, word))
    walk.station(content.get(STATION))
    for resource, file, found in content.resources():
        walk.resource(resource, file, found)
    Pipelines(naming, content).read()
    walk.operations(content.get(OPERATIONS))
    walk.specifications(content.get(SPECIFICATIONS))
    walk.work_masters(content.get(WORK_MASTERS))
    read_definitions(content, gathered)
    return declared, gathered


class _Walk:
    def __init__(self, naming: Naming, expressions: Expressions) -> None:
        self._naming = naming
        self._read = expressions
        self._add = naming.gathered.add

    def station(self, content: object) -> None:
        """Enumerations, the station's variables, and the states of rest."""
        top = Where(STATION, (), "station", 0)
        for name, values in pairs(entry(content, "enumerations")):
            where = top.to("enumerations", name).within(f"enumeration {name}")
            self._add(Part("enumeration", None, str(name)), where, name, declares=True)
            for index, value in enumerate(items(values)):
                if isinstance(value, SourceText):
                    self._add(value_of(str(name), str(value)), where.to(index), value, declares=True)
        self._variables(None, entry(content, "estimated"), top.to("estimated"))
        self._read.condition(entry(content, "rest"), top.to("rest"))

    def resource(self, resource: str, file: str, content: object) -> None:
        """Variables and abilities; what stands in pipelines has a walk of its own."""
        top = Where(file, (), f"resource {resource}", 0, Surroundings(resource))
        none = Span(0, 0)
        part = Part("resource", None, resource)
        self._naming.gathered.occurrences.append(Occurrence(part, top, None, none, none, True))
        for section in SECTIONS:
            self._variables(resource, entry(content, section), top.to(section))
        for name, ability in pairs(entry(content, "abilities")):
            self._ability(resource, name, ability, top.to("abilities", name))

    def _variables(self, resource: str | None, section: object, where: Where) -> None:
        for name, document in pairs(section):
            part = variable_of(resource, str(name))
            at = where.to(name).within(f"variable {part.full}", Surroundings(resource, part.full))
            self._add(part, at, name, declares=True)
            if (type_ := text_at(document, "type")) is not None:
                self._enumeration(type_, at.to("type"))
            self._parameters(part.full, entry(document, "for"), at.to("for"))
            enumeration = self._naming.declared.enumeration(resource, str(name))
            self._naming.note_value(enumeration, at.to("initial"), entry(document, "initial"))

    def _ability(self, resource: str, name: SourceText, document: object, where: Where) -> None:
        part = Part("ability", resource, str(name))
        around = Surroundings(resource, part.full, parameters(entry(document, "parameters")), True)
        at = where.within(f"ability {part.full}", around)
        self._add(part, at, name, declares=True)
        self._parameters(part.full, entry(document, "parameters"), at.to("parameters"))
        self._title(entry(document, "title"), at.to("title"))
        self._title(entry(document, "human", "task"), at.to("human", "task"))
        if (acknowledgement := text_at(document, "human", "acknowledgement")) is not None:
            self._add(variable_of(resource, str(acknowledgement)), at.to("human", "acknowledgement"), acknowledgement)
        for path in _CONDITIONS:
            self._read.condition(entry(document, *path), at.to(*path))
        for path in _ACTIONS:
            self._read.actions(entry(document, *path), at.to(*path))
        for effect, inner in pairs(entry(document, "effects")):
            below = at.to("effects", effect)
            self._add(Part("effect", part.full, str(effect)), below, effect, declares=True)
            self._read.condition(entry(inner, "when"), below.to("when"))
            self._read.actions(entry(inner, "do"), below.to("do"))

    def operations(self, content: object) -> None:
        """Preconditions, goals and formulas."""
        for name, document in pairs(content):
            part = Part("operation", None, str(name))
            at = self._whole(part, OPERATIONS, name, document)
            for key in ("precondition", "goal"):
                self._read.condition(entry(document, key), at.to(key))
            self._read.condition(entry(document, "local"), at.to("local"), is_formula=True)

    def specifications(self, content: object) -> None:
        """What must never be, in all its forms."""
        for name, document in pairs(content):
            at = self._whole(Part("specification", None, str(name)), SPECIFICATIONS, name, document)
            for key in ("forbidden", "never", "while"):
                self._read.condition(entry(document, key), at.to(key))
            for index, text in enumerate(items(entry(document, "exclusive"))):
                self._exclusive(text, at.to("exclusive", index))
            for index, text in enumerate(items(entry(document, "order"))):
                self._read.condition(text, at.to("order", index))
            for resource, inside in pairs(entry(document, "zone")):
                below = at.to("zone", resource)
                self._add(Part("resource", None, str(resource)), below, resource)
                own = Surroundings(str(resource), at.around.holder, at.around.parameters)
                self._read.condition(inside, Where(below.file, below.path, below.owner, below.depth, own))

    def _whole(self, part: Part, file: str, name: SourceText, document: object) -> Where:
        """The entry of an operation or a specification, with what both have."""
        around = Surroundings(None, part.id, parameters(entry(document, "parameters")))
        at = Where(file, (str(name),), f"{part.kind} {name}", 1, around)
        self._add(part, at, name, declares=True)
        self._parameters(part.id, entry(document, "parameters"), at.to("parameters"))
        self._title(entry(document, "title"), at.to("title"))
        return at

    def work_masters(self, content: object) -> None:
        """The operations of jobs, and what a new product brings."""
        for name, document in pairs(content):
            at = Where(WORK_MASTERS, (str(name),), f"work master {name}", 1)
            self._add(Part("work_master", None, str(name)), at, name, declares=True)
            self._read.actions(entry(document, "brings"), at.to("brings"))
            for step, inner in pairs(entry(document, "operations")):
                self._operation(step, at.to("operations", step))
                for index, before in enumerate(items(entry(inner, "after"))):
                    self._operation(before, at.to("operations", step, "after", index))

    def _operation(self, text: object, where: Where) -> None:
        """An operation with its arguments."""
        if (name := self._name(text, where)) is None or not isinstance(text, SourceText) or len(name.path) != 1:
            return
        step = steps_of(name, text)[0]
        self._add(Part("operation", None, step.word.text), where, text, step.word.span, whole=name.span)
        of = self._naming.declared.operations.get(step.word.text, {})
        self._naming.note_arguments(step.arguments, of, where, text, name.span)

    def _exclusive(self, text: object, where: Where) -> None:
        """An ability, with its arguments or without."""
        if (name := self._name(text, where)) is None or not isinstance(text, SourceText) or len(name.path) != 2:
            return
        resource, ability = steps_of(name, text)
        part = Part("ability", resource.word.text, ability.word.text)
        self._add(Part("resource", None, resource.word.text), where, text, resource.word.span, whole=name.span)
        self._add(part, where, text, ability.word.span, whole=name.span)
        of = self._naming.declared.abilities.get(part.full, {})
        self._naming.note_arguments(ability.arguments, of, where, text, name.span)

    def _name(self, text: object, where: Where) -> Name | None:
        if not isinstance(text, SourceText):
            return None
        try:
            found = parse(text)
        except ExpressionError:
            self._naming.gathered.unread.append((where, text))
            return None
        return found if isinstance(found, Name) else None

    def _parameters(self, holder: str, written: object, where: Where) -> None:
        for name, of in pairs(written):
            self._add(Part("parameter", holder, str(name)), where.to(name), name, declares=True)
            if isinstance(of, SourceText):
                self._enumeration(of, where.to(name))

    def _enumeration(self, text: SourceText, where: Where) -> None:
        if str(text).isidentifier() and text != "bool":
            self._add(Part("enumeration", None, str(text)), where, text)

    def _title(self, text: object, where: Where) -> None:
        """A text for people, in which a parameter stands in braces."""
        if not isinstance(text, SourceText):
            return
        for match in _IN_BRACES.finditer(text):
            if match[1] in where.around.parameters:
                part = Part("parameter", where.around.holder, match[1])
                self._add(part, where, text, Span(*match.span(1)))
