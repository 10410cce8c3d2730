"""Symbol collection in expressions and actions, and in expressions over records: resolved names with their values."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping
from dataclasses import replace
from typing import NamedTuple

from sequence_planner.automaton.declarations import FLAGS
from sequence_planner.editor.symbols.index import (
    Declared,
    Gathered,
    ModelPart,
    Parameters,
    TextContext,
    Where,
    is_activity,
    value_of,
    variable_of,
)
from sequence_planner.language.names.scope import ENDS, STEPS
from sequence_planner.language.parser import parse, parse_assignment, parse_calculation, parse_formula
from sequence_planner.language.syntax import (
    NOWHERE,
    Assignment,
    Binder,
    Comparison,
    Component,
    Expression,
    ExpressionError,
    Membership,
    Name,
    NamedMembership,
    Quantified,
    RecordConstant,
    Selection,
    Span,
    children,
)
from sequence_planner.model.paths import shown_path
from sequence_planner.model.source import SourceText

# Which parts a dotted name names: what `NameScope` looks up in a sound model, in one that may be broken elsewhere.

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


class NameWord(NamedTuple):
    """A word of a name, and where it stands in the text."""

    text: str
    span: Span


class NameStep(NamedTuple):
    """One part of a dotted name, with its arguments."""

    word: NameWord
    arguments: tuple[NameWord, ...] = ()


class Named(NamedTuple):
    """The things a name names: its parts by the step that does, the parameters that a step's arguments are for, and the
    enumeration over which it ranges.
    """

    parts: Mapping[int, ModelPart]
    arguments: tuple[int, Parameters] | None = None
    enumeration: str | None = None


def steps_of(name: Name, text: str) -> tuple[NameStep, ...]:
    """The steps of a name that was read from `text`."""
    start = name.span.start
    if name.is_word:
        return (NameStep(NameWord(name.path[0].name, name.span)),)
    found = [
        NameWord(match[0], Span(start + match.start(), start + match.end()))
        for match in _WORD.finditer(text[start : name.span.end])
    ]
    inner = [each.span for part in name.path for each in part.arguments if isinstance(each, Name)]
    words = iter([word for word in found if not any(span.start <= word.span.start < span.end for span in inner)])
    return tuple(
        NameStep(
            next(words),
            tuple(NameWord(str(each), each.span) if isinstance(each, Name) else next(words) for each in part.arguments),
        )
        for part in name.path
    )


def _without_places(name: Name) -> tuple[NameStep, ...]:
    return tuple(
        NameStep(NameWord(part.name, NOWHERE), tuple(NameWord(str(each), NOWHERE) for each in part.arguments))
        for part in name.path
    )


class Naming:
    """Names in the light of what is declared; what they name is noted in `gathered`."""

    def __init__(self, declared: Declared, gathered: Gathered) -> None:
        self.declared = declared
        self.gathered = gathered
        self._found: dict[tuple[object, ...], Named | None] = {}

    def find(self, name: Name, around: TextContext) -> Named | None:
        """Return what a name names; nothing where no such name is declared."""
        key = (str(name), around.holder, around.resource, around.has_flags, *around.words.values())
        if key not in self._found:
            self._found[key] = self._find(_without_places(name), around)
        return self._found[key]

    def _find(self, steps: tuple[NameStep, ...], around: TextContext) -> Named | None:
        word = steps[0].word.text
        is_word = len(steps) == 1 and not steps[0].arguments
        if is_word and word in around.parameters:
            enumeration = around.parameters[word]
            return Named({0: around.parameter(word)}, None, enumeration)
        if is_word and around.has_flags and word in FLAGS:
            return Named({})
        candidates = list(self._candidates(steps, around.resource))
        fitting = (each for each in candidates if self._fits(each, steps))
        return next(fitting, candidates[0] if candidates else None)

    def implied(self, steps: tuple[NameStep, ...], around: TextContext) -> Named | None:
        """Return what a name that is declared nowhere would name."""
        names = [step.word.text for step in steps]
        if len(names) > 1 and names[0] in self.declared.resources:
            resource = ModelPart("resource", None, names[0])
            is_flag = names[-1] in FLAGS
            return Named({0: resource, 1: ModelPart("ability" if is_flag else "variable", names[0], names[1])})
        if is_activity(names):
            return Named({1: ModelPart("operation", None, names[1])})
        if around.resource is not None and len(names) == 1:
            return Named({0: variable_of(around.resource, names[0])})
        if around.resource is not None and len(names) == 2 and names[1] in FLAGS:
            return Named({0: ModelPart("ability", around.resource, names[0])})
        return None

    def note(
        self, named: Named, steps: tuple[NameStep, ...], where: Where, text: SourceText, *, writes: bool = False
    ) -> None:
        """Note that a name at some place names these parts, or with `writes` gives the last of them a value."""
        whole = Span(steps[0].word.span.start, (steps[-1].arguments or (steps[-1].word,))[-1].span.end)
        for index, part in named.parts.items():
            is_written = writes and index == max(named.parts)
            self.gathered.add(part, where, text, steps[index].word.span, whole=whole, writes=is_written)
        if named.arguments is not None:
            index, parameters = named.arguments
            self.note_arguments(steps[index].arguments, parameters, where, text, whole)

    def note_arguments(
        self,
        words: tuple[NameWord, ...],
        parameters: Parameters,
        where: Where,
        text: SourceText,
        whole: Span | None = None,
    ) -> None:
        """Note what the arguments of a name are: parameters around it, or values."""
        around = where.around
        for word, enumeration in zip(words, parameters.values(), strict=False):
            if word.text in around.parameters:
                self.gathered.add(around.parameter(word.text), where, text, word.span, whole=whole)
                self.link(around.parameters[word.text], enumeration)
            elif word.text in self.declared.homes.get(enumeration, ()):
                self.gathered.add(self.declared.value(enumeration, word.text), where, text, word.span, whole=whole)

    def note_value(self, enumeration: str | None, where: Where, text: object) -> None:
        """Note that a whole text is a value of an enumeration, if it is."""
        if enumeration is not None and isinstance(text, SourceText) and self.has(enumeration, text):
            self.gathered.add(self.declared.value(enumeration, str(text)), where, text)

    def has(self, enumeration: str, value: str) -> bool:
        """Return whether an enumeration has a value."""
        return value in self.declared.homes.get(enumeration, ())

    def tie_values(self, enumeration: str | None, why: str) -> None:
        """Note that the names of an enumeration's values are not the model's alone."""
        for value in self.declared.homes.get(enumeration or "", ()):
            self.gathered.tie(self.declared.value(enumeration or "", value), why)

    def link(self, one: str | None, other: str | None) -> None:
        """Note that values of two enumerations are compared, or become one another."""
        if one is None or other is None or one == other:
            return
        values = set(self.declared.homes.get(one, ())) & set(self.declared.homes.get(other, ()))
        pairs = (frozenset({self.declared.value(one, each), self.declared.value(other, each)}) for each in values)
        self.gathered.links |= {pair for pair in pairs if len(pair) > 1}

    def note_domain(self, name: object, where: Where, text: SourceText | None = None, span: Span | None = None) -> None:
        """Note that an enumeration or a set is named, if it is: by a text, or at `span` of one."""
        if isinstance(name, SourceText) and text is None:
            text = name
        full = self.declared.full(where.around.resource, str(name))
        if text is None or full not in self.declared.homes:
            return
        whole = Span(0, len(text)) if span is None else span
        owner, dot, own = str(name).rpartition(".")
        if dot:
            resource = Span(whole.start, whole.start + len(owner))
            self.gathered.add(ModelPart("resource", None, owner), where, text, resource, whole=whole)
        self.gathered.add(self.declared.domain(full), where, text, Span(whole.end - len(own), whole.end), whole=whole)

    def note_table(self, kind: str, where: Where, text: SourceText, resource: str) -> None:
        """Note that a whole text is the name of a map or a relation, of the resource or of the station, if it is."""
        known: Container[str] = self.declared.maps if kind == "map" else self.declared.relations
        if f"{resource}.{text}" in known:
            self.gathered.add(ModelPart(kind, resource, str(text)), where, text)
        elif str(text) in known:
            self.gathered.add(ModelPart(kind, None, str(text)), where, text)

    def note_member(self, domain: object, where: Where, text: object) -> None:
        """Note that a whole text is a value of an enumeration or set, or a set of such values."""
        if isinstance(text, SourceText):
            of = self.declared.full(where.around.resource, str(domain))
            if self.has(of, text):
                self.note_value(of, where, text)
            else:
                self.note_domain(text, where)

    def _candidates(self, steps: tuple[NameStep, ...], resource: str | None) -> Iterator[Named]:
        names = [step.word.text for step in steps]
        if resource is not None:
            yield from self._own(resource, steps, 0)
        if len(names) == 1 and names[0] in self.declared.variables:
            yield self._variable(None, names[0], 0)
        elif len(names) == 1 and names[0] in self.declared.predicates:
            yield Named({0: ModelPart("predicate", None, names[0])}, (0, self.declared.predicates[names[0]]))
        elif len(names) == 1 and names[0] in (*self.declared.relations, *self.declared.maps):
            yield self._table(None, names[0], 0)
        elif is_activity(names) and names[1] in self.declared.operations:
            yield Named({1: ModelPart("operation", None, names[1])}, (1, self.declared.operations[names[1]]))
        elif names[0] in self.declared.resources:
            for own in self._own(names[0], steps, 1):
                yield own._replace(parts={0: ModelPart("resource", None, names[0]), **own.parts})

    def _own(self, resource: str, steps: tuple[NameStep, ...], first: int) -> Iterator[Named]:
        """Yield what the steps from `first` on name in a resource."""
        if first >= len(steps):
            return
        name, rest = steps[first].word.text, steps[first + 1 :]
        full = f"{resource}.{name}"
        if not rest and full in self.declared.variables:
            yield self._variable(resource, name, first)
        elif not rest and full in self.declared.predicates:
            yield Named({first: ModelPart("predicate", resource, name)}, (first, self.declared.predicates[full]))
        elif not rest and full in (*self.declared.relations, *self.declared.maps):
            yield self._table(resource, name, first)
        elif len(rest) == 1 and rest[0].word.text in FLAGS and full in self.declared.abilities:
            yield Named({first: ModelPart("ability", resource, name)}, (first, self.declared.abilities[full]))

    def _table(self, resource: str | None, name: str, index: int) -> Named:
        """A relation or a map."""
        full = name if resource is None else f"{resource}.{name}"
        if full in self.declared.relations:
            return Named({index: ModelPart("relation", resource, name)}, (index, self.declared.relations[full]))
        source, target = self.declared.maps[full]
        ranges = target if target in self.declared.homes else None
        return Named({index: ModelPart("map", resource, name)}, (index, source), ranges)

    def _variable(self, resource: str | None, name: str, index: int) -> Named:
        part = variable_of(resource, name)
        parameters = self.declared.variables[part.full].parameters
        return Named({index: part}, (index, parameters), self.declared.enumeration(resource, name))

    def _fits(self, named: Named, steps: tuple[NameStep, ...]) -> bool:
        """Return whether there are arguments where there must be some, and nowhere else."""
        at, parameters = named.arguments or (-1, {})
        wanted = [len(parameters) if index == at else 0 for index in range(len(steps))]
        return wanted == [len(step.arguments) for step in steps]


# The names in conditions, formulas and actions, with the values that stand beside what they are values of.


class Expressions:
    """Reads texts of the language; what they name is noted by `naming`. With `word`, only texts that hold it."""

    def __init__(self, naming: Naming, word: str | None = None) -> None:
        self.naming = naming
        self._word = word

    def condition(self, written: object, where: Where, *, is_formula: bool = False) -> None:
        """A predicate, or a formula over runs."""
        if (text := self._wanted(written)) is None:
            return
        try:
            tree = parse_formula(text) if is_formula else parse(text)
        except ExpressionError:
            self.naming.gathered.unread.append((where, text))
            return
        _Reading(self.naming, text, where, self._word).read(tree)

    def actions(self, written: object, where: Where) -> None:
        """A list of actions."""
        for index, each in enumerate(written if isinstance(written, list) else []):
            if (text := self._wanted(each)) is None:
                continue
            try:
                action = parse_assignment(text)
            except ExpressionError:
                self.naming.gathered.unread.append((where.to(index), text))
                continue
            _Reading(self.naming, text, where.to(index), self._word).assignment(action)

    def _wanted(self, written: object) -> SourceText | None:
        is_wanted = isinstance(written, SourceText) and (self._word is None or self._word in written)
        return written if is_wanted and isinstance(written, SourceText) else None


class _Reading:
    """One text. The order in which names are looked at is that of `language.names.scope` and `language.resolver`."""

    def __init__(self, naming: Naming, text: SourceText, where: Where, word: str | None) -> None:
        self._word = word
        self._naming = naming
        self._text = text
        self._where = where
        self._binders = 0  # so far in the text

    def assignment(self, action: Assignment) -> None:
        """Read what it writes, what that becomes, and when."""
        assert isinstance(action.target, Name)
        self._bind(action.binders)
        expected = self._name(action.target, None, writes=True)
        found = self.read(action.value, expected)
        self._naming.link(expected, found)
        if action.condition is not None:
            self.read(action.condition)

    def read(self, expression: Expression, expected: str | None = None) -> str | None:
        """Note all names; returns the enumeration over which the expression ranges, unless it is a value."""
        match expression:
            case Name():
                return self._name(expression, expected)
            case Comparison(_, left, right):
                self._compare(*((right, left) if self._is_value_first(left, right) else (left, right)))
            case Membership(left, options):
                enumeration = self.read(left)
                for option in options:
                    self._naming.link(enumeration, self.read(option, enumeration))
            case NamedMembership(left, domain):
                is_value = isinstance(left, Name) and not self._is_parameter(left) and self._found(left) is None
                of = self._naming.declared.full(self._where.around.resource, str(domain))
                self._naming.link(self.read(left, of if is_value else None), of)
                self._naming.note_domain(str(domain), self._where, self._text, domain.span)
            case Quantified(_, _, binders, where, body):
                around = self._where
                self._bind(binders)
                for part in (body,) if where is None else (where, body):
                    self.read(part)
                self._where = around
            case _:
                for part in children(expression):
                    self.read(part)
        return None

    def _bind(self, binders: tuple[Binder, ...]) -> None:
        """Note the words of a quantifier, which have a meaning from here on, and what they range over."""
        declared, around = self._naming.declared, self._where.around
        ranges, words = dict(around.parameters), dict(around.words)
        for binder in binders:
            if isinstance(binder.domain, Name):
                ranges[binder.word] = declared.full(around.resource, str(binder.domain))
                self._naming.note_domain(str(binder.domain), self._where, self._text, binder.domain.span)
            else:
                values = set(map(str, binder.domain))
                homes = [name for name in declared.homes if values <= declared.homes[name].keys()]
                ranges[binder.word] = homes[0] if homes else ""
                for value in binder.domain:
                    for part in {declared.value(home, str(value)) for home in homes}:
                        self._naming.gathered.add(part, self._where, self._text, value.span)
            entry = shown_path(self._where.path)
            part = ModelPart("word", f"{self._where.file}:{entry}#{self._binders}", binder.word)
            self._binders += 1
            words[binder.word] = part
            self._naming.gathered.add(
                part, self._where, self._text, Span(binder.span.start, binder.span.start + len(binder.word)),
                declares=True,
            )  # fmt: skip
            hidden = self._naming.find(Name((Component(binder.word),)), around)
            self._naming.gathered.hidden |= {(part, each) for each in (hidden.parts.values() if hidden else ())}
            same = (value_of(each, binder.word) for each in declared.values.get(binder.word, ()))
            self._naming.gathered.hidden |= {(part, each) for each in same}
        bound = replace(around, parameters=ranges, words=words)
        self._where = replace(self._where, around=bound)

    def _compare(self, first: Expression, second: Expression) -> None:
        enumeration = self.read(first)
        self._naming.link(enumeration, self.read(second, enumeration))

    def _name(self, name: Name, expected: str | None, *, writes: bool = False) -> str | None:
        word, around = str(name), self._where.around
        named = self._naming.find(name, around)
        is_value = expected is not None and name.is_word and self._naming.has(expected, word)
        if expected is not None and is_value and word not in around.parameters:
            value = self._naming.declared.value(expected, word)
            self._naming.gathered.add(value, self._where, self._text, name.span)
            if named is not None and named.enumeration is not None:
                self._naming.gathered.hidden.add((named.parts[max(named.parts)], value))
            return None
        if named is None and len(name.path) == 1 and (name.path[0].name in STEPS or name.path[0].name in ENDS):
            return self._in_order(name, expected)
        if self._word is None or self._word in word:
            steps = steps_of(name, self._text)
            named = named or self._naming.implied(steps, around)
            if named is not None:
                self._naming.note(named, steps, self._where, self._text, writes=writes)
                self._arguments(name, named, steps)
        return None if named is None else named.enumeration

    def _arguments(self, name: Name, named: Named, steps: tuple[NameStep, ...]) -> None:
        """The arguments that have a value themselves: variables, and names with arguments."""
        at, parameters = named.arguments or (-1, {})
        for index, (part, step) in enumerate(zip(name.path, steps, strict=True)):
            wanted = [*parameters.values()] if index == at else []
            for number, (argument, word) in enumerate(zip(part.arguments, step.arguments, strict=True)):
                enumeration = wanted[number] if number < len(wanted) else None
                self._argument(argument, word, enumeration)

    def _argument(self, argument: str | Name, word: NameWord, enumeration: str | None) -> str | None:
        """One argument, unless it is a parameter or a value; returns the enumeration over which it ranges."""
        if isinstance(argument, Name):
            found = self._name(argument, None)
        elif word.text in self._where.around.parameters:
            return self._where.around.parameters[word.text]
        elif enumeration is not None and self._naming.has(enumeration, word.text):
            return enumeration
        else:
            single = Name((Component(word.text),), word.span)
            found = None if self._found(single) is None else self._name(single, None)
        self._naming.link(enumeration, found)
        return found

    def _in_order(self, name: Name, expected: str | None) -> str | None:
        """`previous(x)` and `next(x)` range over what `x` does, `first(set)` and `last(set)` over the set."""
        words = steps_of(name, self._text)[0].arguments
        if len(words) != 1:
            return None
        [word], [argument] = words, name.path[0].arguments
        if name.path[0].name in ENDS:
            self._naming.note_domain(word.text, self._where, self._text, word.span)
            return self._naming.declared.full(self._where.around.resource, word.text)
        if word.text in self._where.around.parameters:
            self._naming.note_arguments(words, {"": ""}, self._where, self._text, name.span)
        found = self._argument(argument, word, None)
        if found is None:
            ordered = [each for each in self._naming.declared.ordered if self._naming.has(each, word.text)]
            for each in ordered:
                part = self._naming.declared.value(each, word.text)
                self._naming.gathered.add(part, self._where, self._text, word.span)
            return ordered[0] if ordered else None
        return found

    def _is_value_first(self, left: Expression, right: Expression) -> bool:
        """Return whether the left of a comparison is to be read as a value of what stands on its right."""
        if not isinstance(left, Name) or not left.is_word or self._is_parameter(left):
            return False  # values are single words
        other = self._found(right)
        if self._found(left) is None:
            unknown = isinstance(right, Name) and not self._is_parameter(right) and other is None
            return not unknown or (self._is_some_value(left) and not self._is_some_value(right))
        enumeration = None if other is None or self._is_parameter(right) else other.enumeration
        return enumeration is not None and self._naming.has(enumeration, str(left))

    def _found(self, expression: Expression) -> Named | None:
        if not isinstance(expression, Name):
            return None
        return self._naming.find(expression, self._where.around)

    def _is_parameter(self, expression: Expression) -> bool:
        return isinstance(expression, Name) and str(expression) in self._where.around.parameters

    def _is_some_value(self, expression: Expression) -> bool:
        return isinstance(expression, Name) and str(expression) in self._naming.declared.values


# The names of a record between the stages of a pipeline, and which of them are variables.

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_INDEX = re.compile(r"\[([^\[\]]*)\]")


class RecordName(NamedTuple):
    """A name in a record: the variable that it is, if it is one, and the enumeration over which it ranges."""

    part: ModelPart | None
    enumeration: str | None = None


Fields = dict[str, RecordName]


class Names:
    """The names of the record that a resource's pipeline has, as they change from stage to stage.

    `given` are all names that some stage of it gives: others of an incoming one are as the message has them. `kinds`
    are the enumerations of names that are no variables.
    """

    def __init__(
        self,
        naming: Naming,
        resource: str,
        incoming: bool,
        fields: Fields,
        given: frozenset[str],
        kinds: Mapping[str, str] | None = None,
    ) -> None:
        self.naming = naming
        self.resource = resource
        self.incoming = incoming
        self.fields = fields
        self.given = given
        self._kinds = kinds or {}

    def read(
        self, text: object, where: Where, at: int = 0, end: int | None = None, *, is_message: bool = False
    ) -> str | None:
        """Note what the path between `at` and `end` of a text names; returns the enumeration over which it ranges.

        `is_message` holds for what is made something else of: in an incoming message that is a field of it.
        """
        found = self._found(str(text)[at:end], is_message) if isinstance(text, SourceText) else None
        if found is None or not isinstance(text, SourceText):
            return None
        field, start, base = found
        if field.part is None:
            return field.enumeration
        span = Span(at + start, at + start + len(base))
        self.naming.gathered.add(field.part, where, text, span)
        rest = self._arguments(field.part, text, span.end, where)
        return field.enumeration if not text[rest:end].strip() else None

    def is_known(self, path: str) -> bool:
        """Return whether a path is of something else than a field of the message."""
        return self._found(path, False) is not None

    def enumeration(self, path: str) -> str | None:
        """The enumeration over which a path ranges."""
        found = self._found(path, False)
        return None if found is None else found[0].enumeration

    def give(self, text: object, where: Where, fixed: str | None = None) -> str | None:
        """Note the name that a stage gives; returns the enumeration over which that ranges."""
        if not isinstance(text, SourceText):
            return None
        match = _NAME.match(text)
        if not self.incoming or match is None:
            self.fields[str(text)] = RecordName(None)
            return None
        part = variable_of(self.resource, match[0])
        enumeration = self.naming.declared.enumeration(self.resource, match[0])
        if part.full not in self.naming.declared.variables:
            enumeration = self._kinds.get(match[0])
        self.naming.gathered.add(part, where, text, Span(0, match.end()), fixed=fixed, writes=True)
        self._arguments(part, text, match.end(), where)
        self.fields[match[0]] = RecordName(part, enumeration)
        return enumeration

    def _found(self, text: str, is_message: bool) -> tuple[RecordName, int, str] | None:
        """The field that a path begins with: where its own name begins in the path, and that name."""
        cuts = [match.start() for match in re.finditer(r"[.\[]", text)]
        for end in (len(text), *reversed(cuts)):
            key = text[:end]
            if key in self.fields:
                start = key.rfind(".") + 1
                return self.fields[key], start, key[start:]
        match = _NAME.match(text)
        if match is None or (self.incoming and (is_message or match[0] in self.given)):
            return None
        part = variable_of(self.resource, match[0])
        variable = self.naming.declared.variables.get(part.full)
        if variable is None or (self.incoming and variable.section != "measured"):
            return None
        return RecordName(part, self.naming.declared.enumeration(self.resource, match[0])), 0, match[0]

    def _arguments(self, part: ModelPart, text: SourceText, at: int, where: Where) -> int:
        """Note the arguments of a variable behind its name; returns where they end."""
        variable = self.naming.declared.variables.get(part.full)
        match = _INDEX.match(text, at)
        if variable is None or match is None or not variable.parameters:
            return at
        words = tuple(
            NameWord(word[0], Span(match.start(1) + word.start(), match.start(1) + word.end()))
            for word in _NAME.finditer(match[1])
        )
        self.naming.note_arguments(words, variable.parameters, where, text)
        return match.end()


# The names in expressions over records, with the values that stand beside what they are values of.


def read_calculation(names: Names, written: object, where: Where, expected: str | None = None) -> bool:
    """Note what an expression over a record names; `expected` is the enumeration of what it becomes.

    Returns whether it is a single field that no stage and no variable has given: a part of the message.
    """
    if not isinstance(written, SourceText):
        return False
    try:
        tree = parse_calculation(written)
    except ExpressionError:
        names.naming.gathered.unread.append((where, written))
        return False
    reading = _Calculation(names, written, where)
    is_message = _is_path(tree) and not names.is_known(written) and not reading.asks_a_table(tree)
    if expected is None or is_message:
        reading.read(tree)
    else:
        reading.become(tree, expected)
    return is_message


def _is_path(part: Expression) -> bool:
    return isinstance(part, Name | Selection)


class _Calculation:
    def __init__(self, names: Names, text: SourceText, where: Where) -> None:
        self._names = names
        self._text = text
        self._where = where
        self._done: set[int] = set()

    def asks_a_table(self, tree: Expression) -> bool:
        """Return whether it is what a map or a relation says."""
        return self._table(tree) is not None

    def become(self, tree: Expression, expected: str) -> None:
        """The whole, of which values of an enumeration are made."""
        if self._table(tree) is not None:
            self._names.naming.link(expected, self._type(tree))
            self.read(tree)
        elif _is_path(tree):
            self._names.naming.link(expected, self._name(tree))
        elif self._is_value(tree, expected):
            self._value(tree, expected)
        else:
            self.read(tree)

    def read(self, part: Expression) -> None:
        """All names; beside an enumeration a word is one of its values."""
        if isinstance(part, Selection) and (table := self._table(part)) is not None:
            self._tabulated(part, table)
            return
        if _is_path(part):
            if part.span.start not in self._done:
                self._name(part)
            return
        match part:
            case Comparison("==" | "!=", left, right):
                self._compare(left, right)
            case Membership(left, options):
                for option in options:
                    self._compare(left, option)
        for each in children(part):
            self.read(each)

    def _compare(self, left: Expression, right: Expression) -> None:
        one, other = self._type(left), self._type(right)
        naming = self._names.naming
        if one is not None and other is None and self._is_value(right, one):
            self._value(right, one)
        elif other is not None and one is None and self._is_value(left, other):
            self._value(left, other)
        else:
            naming.link(one, other)
            for kind, beside in ((one, right), (other, left)):
                if _is_path(beside) and self._type(beside) is None:
                    why = f"`{self._written(beside)}` is compared with them, and has values of its own"
                    naming.tie_values(kind, why)

    def _table(self, part: Expression) -> Named | None:
        """The map or relation that a part of the tree asks, unless a field has its name."""
        if not isinstance(part, Selection) or isinstance(part.at, str):
            return None
        written = self._written(part.whole)
        if self._names.is_known(written):
            return None
        path = tuple(Component(each.strip()) for each in written.split("."))
        path = (*path[:-1], Component(path[-1].name, tuple(map(str, range(len(part.at)))), not part.called))
        named = self._names.naming.find(Name(path), TextContext(self._names.resource))
        kind = "relation" if part.called else "map"
        return named if named is not None and named.parts[max(named.parts)].kind == kind else None

    def _tabulated(self, part: Selection, table: Named) -> None:
        """Note a map or a relation with its arguments."""
        naming, span = self._names.naming, part.whole.span
        for index, each in table.parts.items():
            is_last = index == max(table.parts)
            at = Span(span.end - len(each.name), span.end) if is_last else Span(span.start, span.start + len(each.name))
            naming.gathered.add(each, self._where, self._text, at, whole=span)
        self._done.add(part.span.start)
        _, parameters = table.arguments or (0, {})
        for argument, enumeration in zip(children(part)[1:], parameters.values(), strict=False):
            if self._type(argument) is None and self._is_value(argument, enumeration):
                self._value(argument, enumeration)
            else:
                self.read(argument)
                naming.link(enumeration, self._type(argument))

    def _is_value(self, part: Expression, enumeration: str) -> bool:
        is_text = isinstance(part, RecordConstant) and isinstance(part.value, str)
        return (is_text or _is_path(part)) and self._names.naming.has(enumeration, self._written(part).strip("'"))

    def _value(self, part: Expression, enumeration: str) -> None:
        self._done.add(part.span.start)
        quote = isinstance(part, RecordConstant)
        span = Span(part.span.start + quote, part.span.end - quote)
        value = self._names.naming.declared.value(enumeration, self._text[span.start : span.end])
        self._names.naming.gathered.add(value, self._where, self._text, span)

    def _type(self, part: Expression) -> str | None:
        if (table := self._table(part)) is not None:
            return table.enumeration
        return self._names.enumeration(self._written(part)) if _is_path(part) else None

    def _written(self, part: Expression) -> str:
        return self._text[part.span.start : part.span.end]

    def _name(self, path: Expression) -> str | None:
        """A path, and what its brackets hold: the instance of a variable is no path of its own."""
        noted = self._names.naming.gathered.occurrences
        before = len(noted)
        enumeration = self._names.read(self._text, self._where, path.span.start, path.span.end)
        self._done |= {path.span.start, *(each.span.start for each in noted[before:])}
        while isinstance(path, Selection):
            for inside in children(path)[1:]:
                self.read(inside)
            path = path.whole
        return enumeration
