"""Traversal of a station's files for symbols, with the context and relation kind of each text."""

from __future__ import annotations

import re
from dataclasses import replace
from enum import StrEnum

from sequence_planner.editor.symbols.collectors import Expressions, Naming, steps_of
from sequence_planner.editor.symbols.index import (
    SECTIONS,
    Declared,
    Gathered,
    ModelPart,
    Occurrence,
    Parameters,
    TextContext,
    Where,
    branches_in,
    operation_part,
    own_values,
    parameters,
    value_of,
    variable_of,
)
from sequence_planner.editor.symbols.mimic import VARIABLE_IN_BRACES, MimicCollector
from sequence_planner.editor.symbols.pipelines import PipelineCollector, read_definitions
from sequence_planner.editor.symbols.scenarios import ScenarioCollector
from sequence_planner.editor.symbols.texts import (
    MIMIC,
    OPERATIONS,
    SPECIFICATIONS,
    STATION,
    WORK_MASTERS,
    ModelContent,
    entry,
    items,
    pairs,
    text_at,
)
from sequence_planner.editor.symbols.types import TypeCollector
from sequence_planner.language.parser import parse
from sequence_planner.language.syntax import ExpressionError, Name, Span
from sequence_planner.model.paths import has_scenarios
from sequence_planner.model.source import SourceText
from sequence_planner.model.yaml.reader import EntryPath
from sequence_planner.ros.types.messages import MessageRegistry

# In which manner a use ties one thing to another.


class Manner(StrEnum):
    """What who uses a thing does with it. Those of a pipeline are said from its side: it feeds a variable."""

    RUNS = "runs"  # a work master or a sequence, an operation
    AFTER = "after"  # a work master: others wait for it
    BRINGS = "brings"  # a work master: the value for a new product
    GOAL = "goal"
    PRECONDITION = "precondition"
    FORMULA = "formula"  # over the runs of an operation
    FORBIDS = "forbids"
    EXCLUDES = "excludes"
    ORDERS = "orders"
    ZONE = "zone"
    ALARMS = "alarms"  # people are told
    REST = "rest"  # the station at rest
    GUARD = "guard"  # of a start
    PROGRESS = "progress"  # what is so while an ability is executing, and when it has finished
    ACKNOWLEDGEMENT = "acknowledgement"  # by a person
    COMMANDS = "commands"  # an ability, an output variable
    WRITES = "writes"  # an ability, any other variable
    EFFECT = "effect"  # what a device is expected to do
    EXPECTS = "expects"  # when an effect is expected
    READS = "reads"
    FEEDS = "feeds"  # from ROS 2
    SENDS = "sends"  # to ROS 2
    SOURCE = "source"  # of a flow
    CARRIES = "carries"  # a type of message
    EXAMPLE = "example"
    RANGES = "ranges"  # over an enumeration
    NAMES = "names"  # a value, a parameter or a resource


_ROS = ("topic", "service", "action")
_BY_KEY = {
    "alarm": {"when": Manner.ALARMS},
    "ability": {
        "enabled": Manner.GUARD,
        "until": Manner.PROGRESS,
        "executing": Manner.PROGRESS,
        "finished": Manner.PROGRESS,
        "human": Manner.ACKNOWLEDGEMENT,
    },
    "operation": {"goal": Manner.GOAL, "precondition": Manner.PRECONDITION, "local": Manner.FORMULA},
    "specification": {"exclusive": Manner.EXCLUDES, "order": Manner.ORDERS, "zone": Manner.ZONE},
    "work_master": {"brings": Manner.BRINGS},
}
_OTHERWISE = {
    "specification": Manner.FORBIDS,
    "work_master": Manner.RUNS,
    "sequence": Manner.RUNS,
    "message": Manner.CARRIES,
}


def manner_of(part: ModelPart, by: ModelPart | None, path: EntryPath, declared: Declared, *, writes: bool) -> Manner:
    """Tell how `by`, or the station itself, uses a part at an entry within it; `writes` holds where that gets a
    value.
    """
    if part.kind in ("enumeration", "set"):
        return Manner.RANGES
    if part.kind in ("value", "parameter", "resource", "type", "word"):
        return Manner.NAMES
    if by is None:
        return Manner.REST
    if by.kind in (*_ROS, "flow"):
        return _of_pipeline(part, path, writes=writes, outgoing=_is_outgoing(by, path, declared))
    key = str(path[0]) if path else ""
    if by.kind == "ability" and key not in _BY_KEY["ability"]:
        return _of_transition(part, path, declared, writes=writes)
    if by.kind == "work_master" and "after" in path:
        return Manner.AFTER
    return _BY_KEY.get(by.kind, {}).get(key) or _OTHERWISE.get(by.kind, Manner.READS)


def _of_transition(part: ModelPart, path: EntryPath, declared: Declared, *, writes: bool) -> Manner:
    is_condition = "when" in path[1:]
    if path and path[0] == "effects":
        if is_condition:
            return Manner.EXPECTS
        return Manner.EFFECT if writes else Manner.READS
    if is_condition:
        return Manner.GUARD if path[0] == "start" else Manner.PROGRESS
    if not writes:
        return Manner.READS
    variable = declared.variables.get(part.full)
    return Manner.COMMANDS if variable is not None and variable.section == "output" else Manner.WRITES


def _of_pipeline(part: ModelPart, path: EntryPath, *, writes: bool, outgoing: bool) -> Manner:
    key = path[0] if path else ""
    if part.kind == "message":
        return Manner.CARRIES
    if key == "from":
        return Manner.SOURCE
    if key == "examples":
        return Manner.EXAMPLE
    if writes:
        return Manner.FEEDS
    return Manner.SENDS if outgoing or key == "when" else Manner.READS


def _is_outgoing(by: ModelPart, path: EntryPath, declared: Declared) -> bool:
    """Return whether a stage is of what is sent: a request, a goal, or a topic that somebody else reads."""
    if by.kind == "topic":
        return by.name in declared.sent
    return bool(path) and path[0] in ("request", "goal")


# The names in the files of a station, entry by entry: which texts there are, and what is around each.

_CONDITIONS = (("enabled",), ("start", "when"), ("until",), ("executing",), ("finished",), ("finish", "when"))
_ACTIONS = (("start", "do"), ("finish", "do"), ("cancel", "do"))
_IN_BRACES = re.compile(r"\{([A-Za-z_][A-Za-z0-9_]*)\}")


def gather(
    content: ModelContent, messages: MessageRegistry | None, word: str | None = None, file: str | None = None
) -> tuple[Declared, Gathered]:
    """Return what is named in the files, and where. With `word`, only in expressions that hold it; with `file`, all
    that is in that one, and perhaps more.
    """
    gathered = Gathered(content)
    declared = Declared(content, messages)
    naming = Naming(declared, gathered)
    expressions = Expressions(naming, word)
    walk = _Walk(naming, expressions)
    if file in (None, STATION):
        walk.station(content.get(STATION))
    for resource, at, found in content.resources():
        if file is None or content.is_made_of(at, file):
            walk.resource(resource, at, found)
            walk.changed_in_instance(resource, at, content.get(at), found)
    PipelineCollector(naming, content).read(file)
    TypeCollector(declared, gathered, content).collect(file)
    if file in (None, OPERATIONS):
        walk.operations(content.get(OPERATIONS))
    if file in (None, SPECIFICATIONS):
        walk.specifications(content.get(SPECIFICATIONS))
    if file in (None, WORK_MASTERS):
        walk.work_masters(content.get(WORK_MASTERS))
    if file in (None, MIMIC):
        MimicCollector(naming, expressions).collect(content.get(MIMIC))
    scenarios = ScenarioCollector(naming, expressions, walk.named_operation, walk.named_ability)
    for each in content:
        if has_scenarios(each) and file in (None, each):
            scenarios.collect(each, content[each])
    if file is None or file in content.definitions:
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
            self._add(ModelPart("enumeration", None, str(name)), where, name, declares=True)
            listed = where if isinstance(values, list) else where.to("values")
            for index, value in enumerate(own_values(values)):
                self._add(value_of(str(name), str(value)), listed.to(index), value, declares=True)
            for index, each in enumerate(items(entry(values, "includes"))):
                self._naming.note_domain(each, where.to("includes", index))
            self._value_titles(str(name), entry(values, "titles"), where.to("titles"))
        self._sets(None, content, top)
        self._relations(None, content, top)
        self._maps(None, content, top)
        self._predicates(None, content, top)
        self._variables(None, entry(content, "estimated"), top.to("estimated"))
        self._alarms(None, content, top)
        self._read.condition(entry(content, "rest"), top.to("rest"))

    def _sets(self, resource: str | None, content: object, top: Where) -> None:
        for name, document in pairs(entry(content, "sets")):
            part = ModelPart("set", resource, str(name))
            at = top.to("sets", name).within(f"set {part.full}")
            self._add(part, at, name, declares=True)
            of = entry(document, "of")
            self._naming.note_domain(of, at.to("of"))
            for key in ("values", "except"):
                for index, each in enumerate(items(entry(document, key))):
                    self._naming.note_member(of, at.to(key, index), each)

    def _relations(self, resource: str | None, content: object, top: Where) -> None:
        for name, document in pairs(entry(content, "relations")):
            part = ModelPart("relation", resource, str(name))
            at = top.to("relations", name).within(f"relation {part.full}")
            self._add(part, at, name, declares=True)
            between = items(entry(document, "between"))
            for index, each in enumerate(between):
                self._naming.note_domain(each, at.to("between", index))
            for row, pair in enumerate(items(entry(document, "pairs"))):
                for side, (of, members) in enumerate(zip(between, items(pair), strict=False)):
                    where = at.to("pairs", row, side)
                    self._naming.note_member(of, where, members)
                    for index, each in enumerate(items(members)):
                        self._naming.note_member(of, where.to(index), each)
            if entry(document, "symmetric") is True and len(between) > 1:
                one, other = (self._naming.declared.full(resource, str(each)) for each in between[:2])
                self._naming.link(one, other)

    def _maps(self, resource: str | None, content: object, top: Where) -> None:
        for name, document in pairs(entry(content, "maps")):
            part = ModelPart("map", resource, str(name))
            at = top.to("maps", name).within(f"map {part.full}")
            self._add(part, at, name, declares=True)
            source, target = entry(document, "from"), entry(document, "to")
            ranges = self._naming.declared.full(resource, str(target))
            self._naming.note_domain(source, at.to("from"))
            self._naming.note_domain(target, at.to("to"))
            for key, value in pairs(entry(document, "values")):
                self._naming.note_member(source, at.to("values", key), key)
                self._naming.note_value(ranges, at.to("values", key), value)
            self._naming.note_value(ranges, at.to("otherwise"), entry(document, "otherwise"))

    def _predicates(self, resource: str | None, content: object, top: Where) -> None:
        for name, document in pairs(entry(content, "predicates")):
            part = ModelPart("predicate", resource, str(name))
            around = TextContext(resource, part.full, self._ranges(resource, entry(document, "parameters")))
            at = top.to("predicates", name).within(f"predicate {part.full}", around)
            self._add(part, at, name, declares=True)
            self._parameters(part.full, entry(document, "parameters"), at.to("parameters"))
            self._words(entry(document, "title"), at.to("title"))
            self._read.condition(document, at)
            self._read.condition(entry(document, "when"), at.to("when"))

    def resource(self, resource: str, file: str, content: object) -> None:
        """Variables and abilities; what stands in pipelines has a walk of its own."""
        top = Where(file, (), f"resource {resource}", 0, TextContext(resource))
        none = Span(0, 0)
        part = ModelPart("resource", None, resource)
        self._naming.gathered.occurrences.append(Occurrence(part, top, None, none, none, True))
        for section in SECTIONS:
            self._variables(resource, entry(content, section), top.to(section))
        for name, ability in pairs(entry(content, "abilities")):
            self._ability(resource, name, ability, top.to("abilities", name))
        self._sets(resource, content, top)
        self._relations(resource, content, top)
        self._maps(resource, content, top)
        self._predicates(resource, content, top)
        self._alarms(resource, content, top)

    def changed_in_instance(self, resource: str, file: str, own: object, whole: object) -> None:
        """The names of what an instance has of its type and says something of itself."""
        kinds = {**dict.fromkeys(SECTIONS, "variable"), "abilities": "ability", "alarms": "alarm", "flows": "flow"}
        for section, kind in kinds.items():
            of_type = {str(name) for name, _ in pairs(entry(whole, section)) if name.place.file != file}
            for name, document in pairs(entry(own, section)):
                part = ModelPart(kind, resource, str(name))
                where = Where(file, (section, str(name)), f"{kind} {part.full}", 2, TextContext(resource))
                if name in of_type:
                    self._add(part, where, name)
                inherited = entry(whole, section, str(name), "effects")
                others = {str(each) for each, _ in pairs(inherited) if each.place.file != file}
                for effect, _ in pairs(entry(document, "effects")):
                    if effect in others:
                        self._add(ModelPart("effect", part.full, str(effect)), where.to("effects", effect), effect)

    def _variables(self, resource: str | None, section: object, where: Where) -> None:
        for name, document in pairs(section):
            part = variable_of(resource, str(name))
            at = where.to(name).within(f"variable {part.full}", TextContext(resource, part.full))
            self._add(part, at, name, declares=True)
            if (type_ := text_at(document, "type")) is not None:
                self._enumeration(type_, at.to("type"))
            self._parameters(part.full, entry(document, "for"), at.to("for"))
            enumeration = self._naming.declared.enumeration(resource, str(name))
            self._naming.note_value(enumeration, at.to("initial"), entry(document, "initial"))
            self._value_titles(enumeration, entry(document, "titles"), at.to("titles"))
            around = at.within(
                at.owner, TextContext(resource, part.full, self._ranges(resource, entry(document, "for")))
            )
            for key in ("title", "phrase"):
                self._words(entry(document, key), around.to(key))
            self._value_titles(enumeration, entry(document, "by_hand"), at.to("by_hand"))
            for value, text in pairs(entry(document, "by_hand")):
                self._words(text, around.to("by_hand", value))

    def _ability(self, resource: str, name: SourceText, document: object, where: Where) -> None:
        part = ModelPart("ability", resource, str(name))
        around = TextContext(resource, part.full, self._ranges(resource, entry(document, "parameters")), True)
        at = where.within(f"ability {part.full}", around)
        self._add(part, at, name, declares=True)
        self._parameters(part.full, entry(document, "parameters"), at.to("parameters"))
        self._words(entry(document, "title"), at.to("title"))
        self._words(entry(document, "human", "task"), at.to("human", "task"))
        self._words(entry(document, "instruction", "text"), at.to("instruction", "text"))
        for key in ("image", "video"):
            self._title(entry(document, "instruction", key), at.to("instruction", key))
        for key in ("not_begun", "not_finished"):
            self._words(entry(document, "late", key), at.to("late", key))
            self._values_said(entry(document, "late", key), at.to("late", key))
        if (acknowledgement := text_at(document, "human", "acknowledgement")) is not None:
            self._add(variable_of(resource, str(acknowledgement)), at.to("human", "acknowledgement"), acknowledgement)
        for path in _CONDITIONS:
            self._read.condition(entry(document, *path), at.to(*path))
        for path in _ACTIONS:
            self._read.actions(entry(document, *path), at.to(*path))
        for effect, inner in pairs(entry(document, "effects")):
            below = at.to("effects", effect)
            own = ModelPart("effect", part.full, str(effect))
            self._add(own, below, effect, declares=True)
            self._parameters(own.full, entry(inner, "for"), below.to("for"))
            below = replace(below, around=_within_effect(around, own, self._ranges(resource, entry(inner, "for"))))
            self._read.condition(entry(inner, "when"), below.to("when"))
            self._read.actions(entry(inner, "do"), below.to("do"))

    def _alarms(self, resource: str | None, content: object, top: Where) -> None:
        for name, document in pairs(entry(content, "alarms")):
            part = ModelPart("alarm", resource, str(name))
            at = top.to("alarms", name).within(f"alarm {part.full}", TextContext(resource, part.full))
            self._add(part, at, name, declares=True)
            self._read.condition(entry(document, "when"), at.to("when"))

    def operations(self, content: object) -> None:
        """Preconditions, goals and formulas, and sequences."""
        for name, document in pairs(content):
            part = operation_part(name, document)
            at = self._whole(part, OPERATIONS, name, document)
            if part.kind == "sequence":
                self._sequence(part.id, document, at)
            for key in ("precondition", "goal"):
                self._read.condition(entry(document, key), at.to(key))
            self._read.condition(entry(document, "local"), at.to("local"), is_formula=True)

    def specifications(self, content: object) -> None:
        """Go through what must never be, in all its forms."""
        for name, document in pairs(content):
            at = self._whole(ModelPart("specification", None, str(name)), SPECIFICATIONS, name, document)
            for key in ("forbidden", "never", "while"):
                self._read.condition(entry(document, key), at.to(key))
            for index, text in enumerate(items(entry(document, "exclusive"))):
                self.named_ability(text, at.to("exclusive", index))
            for index, text in enumerate(items(entry(document, "order"))):
                self._read.condition(text, at.to("order", index))
            for resource, inside in pairs(entry(document, "zone")):
                below = at.to("zone", resource)
                self._add(ModelPart("resource", None, str(resource)), below, resource)
                own = TextContext(str(resource), at.around.holder, at.around.parameters)
                self._read.condition(inside, Where(below.file, below.path, below.owner, below.depth, own))

    def _whole(self, part: ModelPart, file: str, name: SourceText, document: object) -> Where:
        """The entry of an operation or a specification, with what both have."""
        around = TextContext(None, part.id, parameters(entry(document, "parameters")))
        at = Where(file, (str(name),), f"{part.kind} {name}", 1, around)
        self._add(part, at, name, declares=True)
        self._parameters(part.id, entry(document, "parameters"), at.to("parameters"))
        self._words(entry(document, "title"), at.to("title"))
        return at

    def work_masters(self, content: object) -> None:
        """The operations of jobs, and what a new product brings."""
        for name, document in pairs(content):
            part = ModelPart("work_master", None, str(name))
            at = Where(WORK_MASTERS, (str(name),), f"work master {name}", 1, TextContext(None, part.id))
            self._add(part, at, name, declares=True)
            self._sequence(part.id, document, at)
            self._read.actions(entry(document, "brings"), at.to("brings"))
            for index, order in enumerate(items(entry(document, "orders"))):
                self._sequence(part.id, order, at.to("orders", index))
            for step, inner in pairs(entry(document, "operations")):
                self.named_operation(step, at.to("operations", step))
                for index, before in enumerate(items(entry(inner, "after"))):
                    self.named_operation(before, at.to("operations", step, "after", index))

    def _sequence(self, holder: str, document: object, at: Where) -> None:
        """The operations and sequences that a part of a sequence orders."""
        self._parameters(holder, entry(document, "for"), at.to("for"))
        around = replace(at.around, parameters={**at.around.parameters, **parameters(entry(document, "for"))})
        for branch, path in branches_in(document):
            below = replace(at.to(*path), around=around)
            if isinstance(branch, SourceText):
                self.named_operation(branch, below)
            else:
                self._sequence(holder, branch, below)

    def named_operation(self, text: object, where: Where) -> None:
        """An operation with its arguments, or a sequence."""
        if (name := self._name(text, where)) is None or not isinstance(text, SourceText) or len(name.path) != 1:
            return
        step = steps_of(name, text)[0]
        if step.word.text in self._naming.declared.sequences:
            self._add(ModelPart("sequence", None, step.word.text), where, text, step.word.span, whole=name.span)
            return
        self._add(ModelPart("operation", None, step.word.text), where, text, step.word.span, whole=name.span)
        of = self._naming.declared.operations.get(step.word.text, {})
        self._naming.note_arguments(step.arguments, of, where, text, name.span)

    def named_ability(self, text: object, where: Where) -> None:
        """An ability, with its arguments or without."""
        if (name := self._name(text, where)) is None or not isinstance(text, SourceText) or len(name.path) != 2:
            return
        resource, ability = steps_of(name, text)
        part = ModelPart("ability", resource.word.text, ability.word.text)
        self._add(ModelPart("resource", None, resource.word.text), where, text, resource.word.span, whole=name.span)
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
            self._add(ModelPart("parameter", holder, str(name)), where.to(name), name, declares=True)
            if isinstance(of, SourceText):
                self._enumeration(of, where.to(name))

    def _ranges(self, resource: str | None, written: object) -> Parameters:
        return self._naming.declared.ranges(resource, written)

    def _enumeration(self, text: SourceText, where: Where) -> None:
        if self._naming.declared.full(where.around.resource, str(text)) in self._naming.declared.homes:
            self._naming.note_domain(text, where)
        elif str(text).isidentifier() and text != "bool":
            self._add(self._naming.declared.domain(str(text)), where, text)

    def _value_titles(self, enumeration: str | None, written: object, where: Where) -> None:
        """Words for values, by these."""
        for value, _ in pairs(written):
            self._naming.note_value(enumeration, where.to(value), value)

    def _words(self, written: object, where: Where) -> None:
        """A text for people, or one for each language."""
        self._title(written, where)
        for language, text in pairs(written):
            self._title(text, where.to(language))

    def _values_said(self, written: object, where: Where) -> None:
        """A text for people, or one for each language, in which variables stand in braces beside parameters."""
        if isinstance(written, SourceText):
            for match in VARIABLE_IN_BRACES.finditer(written):
                resource, name = match.groups()
                if resource is not None:
                    self._add(ModelPart("resource", None, resource), where, written, Span(*match.span(1)))
                    self._add(variable_of(resource, name), where, written, Span(*match.span(2)))
                elif name not in where.around.parameters:
                    own = variable_of(where.around.resource, name)
                    is_own = own.full in self._naming.declared.variables
                    self._add(own if is_own else variable_of(None, name), where, written, Span(*match.span(2)))
        for language, text in pairs(written):
            self._values_said(text, where.to(language))

    def _title(self, text: object, where: Where) -> None:
        """A text for people, in which a parameter stands in braces."""
        if not isinstance(text, SourceText):
            return
        for match in _IN_BRACES.finditer(text):
            if match[1] in where.around.parameters:
                part = ModelPart("parameter", where.around.holder, match[1])
                self._add(part, where, text, Span(*match.span(1)))


def _within_effect(around: TextContext, effect: ModelPart, each: Parameters) -> TextContext:
    """The names around the texts of an effect: those of its ability, and its own words."""
    words = {word: ModelPart("parameter", effect.full, word) for word in each}
    return replace(around, parameters={**around.parameters, **each}, words=words)
