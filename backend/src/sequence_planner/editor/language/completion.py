"""Code completion for guards and actions: cursor context, grammar, name lookup and ranking."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from sequence_planner.automaton.declarations import OPERATION
from sequence_planner.editor.language.families import SHORT, Visible, stub
from sequence_planner.editor.language.field import FieldKind, TextField
from sequence_planner.editor.language.quantifiers import QuantifierPart, Quantifiers, quantifiers_before
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.scope import Lexicon, VisibleNames, abilities
from sequence_planner.language.lexer import INFIX_LETTERS, KEYWORDS, PREFIX_LETTERS, Token, tokens
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import can_go_on, parse
from sequence_planner.language.printer import print_value
from sequence_planner.language.resolver import expression_type
from sequence_planner.language.syntax import Component, ExpressionError, Name, Span
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

# The name that is being written at a place of a text: `robot.move(ho` before it, `me).done` behind it.

_WORD = r"[A-Za-z_][A-Za-z0-9_]*"
_ARGUMENTS = r"(?:\([\w\s,]*\)|\[[\w\s,]*\])"
_WHOLE = re.compile(rf"{_WORD}{_ARGUMENTS}?(?:\.{_WORD}{_ARGUMENTS}?)*|[0-9]+")
_UNFINISHED = re.compile(
    rf"(?<![A-Za-z0-9_.])(?:(?:{_WORD}{_ARGUMENTS}?\.)*(?:{_WORD}(?:[(\[][\w\s,]*[)\]]?)?)?|[0-9]+)\Z"
)
_REST = re.compile(r"[A-Za-z0-9_]*")
_FURTHEST = 400  # characters in which a name is looked for


class DottedName(NamedTuple):
    """The beginning and the end of the name, and what of it stands before the place."""

    start: int
    end: int
    typed: str


def chain_at(text: str, offset: int, temporal: bool = False) -> DottedName:
    """The name at `offset`, empty where none is; in a `temporal` text a letter before a bracket is no name."""
    floor = max(0, offset - _FURTHEST)
    found = _UNFINISHED.search(text[floor:offset])
    typed = "" if found is None else _behind_words(found[0], temporal)
    start = offset - len(typed)
    whole = whole_at(text, start, temporal)
    end = whole if whole >= offset else offset + len(_matched(text, offset))
    return DottedName(start, end, typed)


def whole_at(text: str, start: int, temporal: bool = False) -> int:
    """Return where the name or number that begins at `start` ends."""
    found = _WHOLE.match(text, start)
    if found is None:
        return start
    head = _matched(text, start)
    return start + len(head) if _is_no_name(head, temporal) and found[0] != head else found.end()


def word_at(text: str, offset: int) -> Span:
    """The letters and digits around `offset`."""
    start = offset
    while start > 0 and _matched(text, start - 1):
        start -= 1
    return Span(start, offset + len(_matched(text, offset)))


def _behind_words(typed: str, temporal: bool) -> str:
    """Return what is left of `typed` behind words of the language that stand before a bracket, as in `not(a`."""
    head = _matched(typed, 0)
    behind = typed[len(head) :]
    if behind[:1] == "(" and _is_no_name(head, temporal) and ")" not in behind:
        return _behind_words(behind[1:].lstrip(), temporal)
    return typed


def _is_no_name(word: str, temporal: bool) -> bool:
    return word in KEYWORDS or (temporal and word in PREFIX_LETTERS | INFIX_LETTERS)


def _matched(text: str, at: int) -> str:
    found = _REST.match(text, at)
    return "" if found is None else found[0]


# What can be written at a place of a text.

MOST_OPTIONS = 100


@dataclass(frozen=True)
class Option:
    """One thing that can be written: `label` is what is shown, `insert` what is written, `detail` its type or so.

    What ends in a dot or an opening bracket stands for all that begins so.
    """

    label: str
    insert: str
    kind: NameKind
    detail: str = ""


@dataclass(frozen=True)
class Completion:
    """Options for the text between `start` and `end`, the most useful first."""

    start: int
    end: int
    options: tuple[Option, ...]


def completion(start: int, end: int, options: Iterable[Option]) -> Completion:
    """The first of `options`, each once."""
    different = {option.insert: option for option in reversed(list(options))}
    return Completion(start, end, tuple(reversed(different.values()))[:MOST_OPTIONS])


def option(text: str, kind: NameKind, detail: object = "") -> Option:
    """An option that is written as it is shown."""
    return Option(text, text, kind, str(detail))


# What the grammar allows behind the beginning of a text: the parser itself is asked.

EQUALITIES = ("==", "!=")
ORDERS = ("<", "<=", ">", ">=")
JUNCTIONS = ("and", "or", "implies")
# Where there are sets: "count" is a number, and stands where one does.
_QUANTIFIERS = ("all", "any", "none", "exactly", "at least", "at most")
_OF_QUANTIFIERS = ("in", ",", "where", ":")
_CLOSING = {")": "(", "}": "{", "]": "["}
_LAST = re.compile(r"(\w+|\S)\s*\Z")
_BEFORE_OPERAND = frozenset({*JUNCTIONS, "not", "if", "in"})
_BOUNDS = frozenset({*EQUALITIES, *ORDERS, *JUNCTIONS, "not", "in", "if", ":=", "{", ","})


@dataclass(frozen=True)
class TextBefore:
    """The text before a place, and what names mean in it."""

    text: str
    kind: FieldKind
    scope: NameScope
    quantifiers: Quantifiers
    _fitting: dict[str, bool] = field(default_factory=dict, compare=False, repr=False)

    def fits(self, word: str) -> bool:
        """Return whether `word` can stand next, if the right words follow."""
        if word not in self._fitting:
            is_action, is_formula = self.kind is FieldKind.ACTION, self.kind is FieldKind.FORMULA
            self._fitting[word] = can_go_on(f"{self.text} {word}", is_action, is_formula)
        return self._fitting[word]

    @cached_property
    def tokens(self) -> tuple[Token, ...]:
        """Its words, if they are words of the language."""
        return words_of(self.text)

    @cached_property
    def binds(self) -> bool:
        """True if the word of a quantifier stands next."""
        if self.quantifiers.expected is not QuantifierPart.WORD or not self.fits("x in y"):
            return False
        is_variable = self.scope.find(Name((Component(self.tokens[-1].text),))) is not None
        return not is_variable or self.tokens[-1].kind in (",", "number")

    @cached_property
    def wants_name(self) -> bool:
        """True if a name can stand next; where what is before makes no sense, as far as its last word tells."""
        if self._is_broken:
            last = _LAST.search(self.text)
            return last is None or last[1] in _BEFORE_OPERAND or not (last[1][-1].isalnum() or last[1] in ")]}_")
        return self.fits("x")

    @cached_property
    def wants_target(self) -> bool:
        """True if the variable that an action writes can stand next."""
        if self.kind is not FieldKind.ACTION or not self.text.strip():
            return self.kind is FieldKind.ACTION
        kinds = [token.kind for token in self.tokens]
        return bool(kinds) and kinds[-1] == ":" and ":=" not in kinds

    @cached_property
    def wants_set(self) -> bool:
        """True if values in braces can stand next, or the name of a set of them."""
        return bool(self.tokens) and self.tokens[-1].kind == "in" and not self._is_broken

    def words(self) -> list[str]:
        """The operators and other words of the language that can stand next."""
        if self.wants_target:
            return [] if self.tokens or not self.scope.vocabulary.domains else ["all"]
        if self.wants_set:
            return ["{"]
        if self._is_broken:
            return ["not", "true", "false"] if self.wants_name else [*EQUALITIES, "in", *JUNCTIONS]
        return self._beginning_words() if self.wants_name else self._joining_words()

    def _beginning_words(self) -> list[str]:
        """Return what an operand can begin with, beside names."""
        expected = self.expected()
        found = ["not"] if self.fits("not") else []
        if expected is None or expected == BOOLEAN:
            found += (word for word in ("true", "false") if self.fits(word))
        if self.kind is FieldKind.FORMULA and "not" in found:
            found += sorted(PREFIX_LETTERS)
        if isinstance(expected, IntegerRange) and self.fits("-"):
            found.append("-")
        if self.scope.vocabulary.domains and self.fits("all x in y"):
            if expected is None or expected == BOOLEAN:
                found += _QUANTIFIERS
            if expected is None or isinstance(expected, IntegerRange):
                found.append("count")
        return [*found, "("] if self.fits("(") else found

    def _joining_words(self) -> list[str]:
        """Return what can stand behind an operand."""
        begin = self._begin_before(len(self.tokens))
        operand = self._type_before(len(self.tokens))
        if begin and self.tokens[begin - 1].kind == ":=":
            target = self._type_before(begin - 1)
            if target is not None and target != BOOLEAN:  # what it is compared with, or joined to, is no value of it
                signs = ("+", "-", "if") if isinstance(target, IntegerRange) else ("if",)
                return [sign for sign in signs if self.fits(sign)]
        is_compared = begin > 0 and self.tokens[begin - 1].kind in (*EQUALITIES, *ORDERS)
        compares, is_truth = self.fits("==") and not is_compared, operand is None or operand == BOOLEAN
        is_number = operand is None or isinstance(operand, IntegerRange)
        is_ordered = is_number or (operand is not None and self.scope.vocabulary.order_of(operand) is not None)
        found: list[str] = []
        if (is_truth or not compares) and self.fits("and"):
            found += JUNCTIONS
            if self.kind is FieldKind.FORMULA and self.fits("U"):
                found += sorted(INFIX_LETTERS)
        if compares:
            found += (*EQUALITIES, *(ORDERS if is_ordered else ()), *(("in",) if operand != BOOLEAN else ()))
        if is_number and self.fits("+"):
            found += ["+", "-"]
        if self.tokens and self.tokens[-1].text == "at":
            found += [word for word in ("least", "most") if self.fits(f"{word} 1 x in y")]
        further = (":=", "if", "{", ")", "]", "}", ",", *_OF_QUANTIFIERS)
        return list(dict.fromkeys((*found, *(word for word in further if self.fits(word)))))

    def expected(self) -> Type | None:
        """The type of what stands next beside an operator, as far as the other side tells it."""
        if not self.tokens:
            return None
        last = self.tokens[-1].kind
        if last in EQUALITIES or last == ":=":
            return self._type_before(len(self.tokens) - 1)
        if last in (*ORDERS, "+", "-"):
            return self._type_before(len(self.tokens) - 1) or IntegerRange(0, 0)
        if last in ("{", ","):
            opening = self._opening(len(self.tokens))
            if opening and self.tokens[opening - 1].kind == "in":
                return self._type_before(opening - 1)
        return None

    @cached_property
    def _is_broken(self) -> bool:
        return bool(self.text.strip()) and not any(
            self.fits(word) for word in ("x", "and", ")", "}", ":=", "{", "1", *_OF_QUANTIFIERS)
        )

    def _opening(self, at: int) -> int | None:
        """The bracket that is open before the word `at`."""
        depth = 0
        for index in range(at - 1, -1, -1):
            kind = self.tokens[index].kind
            if kind in _CLOSING:
                depth += 1
            elif kind in _CLOSING.values():
                if depth == 0:
                    return index
                depth -= 1
        return None

    def _begin_before(self, at: int) -> int:
        """The first word of the operand that ends before the word `at`."""
        begin, depth = at, 0
        while begin > 0:
            kind = self.tokens[begin - 1].kind
            if kind in _CLOSING:
                depth += 1
            elif kind in _CLOSING.values():
                depth -= 1
            if depth < 0 or (depth == 0 and (kind in _BOUNDS or begin - 1 in self.quantifiers.signs)):
                break
            begin -= 1
        return begin

    def _type_before(self, at: int) -> Type | None:
        """The type of that operand."""
        begin = self._begin_before(at)
        if begin == at:
            return None
        written = self.text[self.tokens[begin].start : self.tokens[at - 1].end]
        try:
            return expression_type(parse(written), self.scope)
        except ExpressionError:
            return None


def words_of(text: str) -> tuple[Token, ...]:
    """The words of a text, if they are words of the language."""
    try:
        return tuple(tokens(text)[:-1])
    except ExpressionError:
        return ()


# How well a name fits what has been typed of it.

NO_MATCH = 9
_BEFORE = re.compile(r"[.(\[]")


def likeness(typed: str, name: str) -> int:
    """0 for names that begin with what is typed, more for those that merely contain it, `NO_MATCH` for others."""
    if name.startswith(typed):
        return 0
    low, lower = typed.lower(), name.lower()
    if lower.startswith(low):
        return 1
    at = lower.find(low)
    if at > 0:
        return 2 if lower[at - 1] in "._([" else 3
    if len(low) > 1 and "." not in low and any(_contains_in_order(low, part) for part in _BEFORE.split(lower)):
        return 4
    return NO_MATCH


def _contains_in_order(letters: str, text: str) -> bool:
    if text[:1] != letters[:1]:
        return False
    at = -1
    for letter in letters:
        at = text.find(letter, at + 1)
        if at < 0:
            return False
    return True


# What can be written where that is one name of few: types, enumerations, abilities, operations, acknowledgements.

_MOST_NUMBERS = 100


def complete_choice(lexicon: Lexicon, field: TextField, text: str, offset: int) -> Completion:
    """The names that can stand in place of the whole text, those first that fit what is typed before `offset`."""
    typed = text[:offset].strip()
    ranked = [(likeness(typed, each.label), each) for each in _choices(lexicon, field)]
    fitting = sorted((pair for pair in ranked if pair[0] < NO_MATCH), key=lambda pair: pair[0])
    return completion(0, len(text), [each for _, each in fitting])


def _choices(lexicon: Lexicon, field: TextField) -> Iterator[Option]:
    match field.kind:
        case FieldKind.TYPE:
            yield option(str(BOOLEAN), NameKind.ENUMERATION, "false, true")
            yield from _enumerations(lexicon, lexicon.declarations.enumerations, field.resource)
        case FieldKind.ENUMERATION:
            yield from _enumerations(lexicon, lexicon.declarations.enumerations, field.resource)
        case FieldKind.INITIAL:
            if field.type is not None:
                few = not isinstance(field.type, IntegerRange) or len(field.type.domain) <= _MOST_NUMBERS
                for value in field.type.domain if few else ():
                    yield option(print_value(value), NameKind.VALUE, field.type)
        case FieldKind.MEMBER:
            for value in () if field.type is None else field.type.domain:
                yield option(print_value(value), NameKind.VALUE, field.type)
            chosen = {name: lexicon.declarations.enumerations[name] for name in field.choices}
            yield from _enumerations(lexicon, chosen, field.resource)
        case FieldKind.ABILITY:
            yield from _abilities(lexicon, field)
        case FieldKind.OPERATION:
            for name in field.choices:
                yield option(name, NameKind.OPERATION)
        case FieldKind.ACKNOWLEDGEMENT:
            for family in lexicon.families:
                if family.owner == field.resource and family.kind is NameKind.MEASURED and family.type == BOOLEAN:
                    for name in family.instances(lexicon.declarations.enumerations):
                        yield option(name.removeprefix(f"{field.resource}."), NameKind.MEASURED, BOOLEAN)


def _enumerations(
    lexicon: Lexicon, enumerations: Mapping[str, EnumerationType], resource: str | None
) -> Iterator[Option]:
    sets = lexicon.sets
    for name, type_ in enumerations.items():
        short = name.removeprefix(f"{resource}.")
        yield option(short, NameKind.SET if name in sets else NameKind.ENUMERATION, type_)


def _abilities(lexicon: Lexicon, field: TextField) -> Iterator[Option]:
    """Each ability, and those with parameters one by one as well."""
    sight = VisibleNames(lexicon, field)
    for seen in abilities(sight.families):
        title = seen.family.title or ""
        if seen.family.arguments:
            yield option(seen.family.name, NameKind.ABILITY, title)
        for form in sight.forms(seen):
            yield option(form.removesuffix(seen.family.suffix), NameKind.ABILITY, title)


# The names that can be written at a place, as many as there is room for: where there are more, their beginnings.

_LEVELS = 5
_MOST_INSTANCES = 8  # of one declaration that are written out before its bracket is typed
_NO_VARIABLES = (NameKind.FLAG, NameKind.ACTIVITY)
_BRACKET = re.compile(r"[(\[]")
_ARGUMENT = re.compile(r"(.*[(\[,]\s*)\w*[)\]]?", re.DOTALL)
Match = tuple[int, Visible, bool]  # how well a family fits what is typed, and whether it is its full name that does


def name_options(
    sight: VisibleNames, typed: str, wanted: Callable[[Visible], bool], room: int = MOST_OPTIONS
) -> list[tuple[int, Option]]:
    """The `wanted` families whose names fit what is typed, each with how well it does, the nearest first."""
    bracket = _BRACKET.search(typed)
    if bracket is not None:
        return [(0, each) for each in _with_arguments(sight, typed, wanted)]
    matches = sorted(_matches(sight, typed, wanted), key=lambda match: (match[0], match[1].distance))
    for level in range(_LEVELS):
        found = _at_level(sight, matches, typed, level, room)
        if len(found) <= room:
            return found
    return found


def resource_steps(sight: VisibleNames, typed: str, wanted: Callable[[Visible], bool]) -> list[tuple[int, Option]]:
    """The resources, as the beginnings of their full names."""
    owners = dict.fromkeys(seen.family.step for seen in sight.families if wanted(seen))
    ranked = ((likeness(typed, owner), owner) for owner in owners if owner)
    return sorted(
        ((rank, _step_option(owner)) for rank, owner in ranked if rank < NO_MATCH),
        key=lambda each: each[0],
    )


def _matches(sight: VisibleNames, typed: str, wanted: Callable[[Visible], bool]) -> Iterator[Match]:
    for seen in sight.families:
        if wanted(seen):
            short = likeness(typed, seen.short)
            long = likeness(typed, seen.long) if short and seen.own else NO_MATCH
            if short < NO_MATCH or long < NO_MATCH:
                yield min(short, long), seen, long < short


def _at_level(sight: VisibleNames, matches: list[Match], typed: str, level: int, room: int) -> list[tuple[int, Option]]:
    """The options where `level` 0 writes all out but long lists of arguments, 1 leaves out the arguments of other
    resources, 2 all arguments, 3 what is no variable of other resources, and 4 all that other resources have.
    """
    found: dict[str, tuple[int, Option]] = {}
    for rank, seen, long in matches:
        family = seen.family
        is_far = not seen.own and family.step and not typed.startswith(family.step)
        if is_far and (level == 4 or (level == 3 and family.kind in _NO_VARIABLES)):
            if family.step not in found:
                found[family.step] = rank, _step_option(family.step)
        elif family.arguments and level and (level > 1 or not seen.own):
            beginning = stub(seen, long)
            found.setdefault(beginning, (rank, option(beginning, family.kind, "…")))
        else:
            forms = list(sight.forms(seen, long))
            if len(forms) > _MOST_INSTANCES:
                forms = [form for form in forms[:_MOST_INSTANCES] if sight.has_parameter(form)]
                found.setdefault(stub(seen, long), (rank, option(stub(seen, long), family.kind, "…")))
            for form in forms:
                found.setdefault(form, (rank, option(form, family.kind, family.type)))
            if family.arguments and any(True for _ in sight.indices(family, 0)):
                found.setdefault(stub(seen, long), (rank, option(stub(seen, long), family.kind, "…")))
        if len(found) > room:
            break
    return list(found.values())


def _with_arguments(sight: VisibleNames, typed: str, wanted: Callable[[Visible], bool]) -> Iterator[Option]:
    """The names that begin with what is typed, which has arguments, or the beginning of some."""
    head = typed[: typed.index(next(sign for sign in typed if sign in "(["))]
    begun = _bare(typed)
    for seen in sight.families:
        if not wanted(seen):
            continue
        if not seen.family.arguments:
            if seen.family.kind in SHORT and "(" in seen.short and _bare(seen.short).startswith(begun):
                yield option(seen.short, seen.family.kind, seen.family.type)
            continue
        long = seen.family.name == head
        if long or (seen.own and seen.family.name.endswith(f".{head}") and seen.short.startswith(head)):
            single = list(_single_arguments(sight, typed, seen))
            forms = (form for form in sight.forms(seen, long) if _bare(form).startswith(begun))
            whole = (option(form, seen.family.kind, seen.family.type) for form in forms)
            many = seen.family.kind in SHORT and len(seen.family.arguments) > 1
            yield from (*single, *whole) if many else (*whole, *single)


def _single_arguments(sight: VisibleNames, typed: str, seen: Visible) -> Iterator[Option]:
    """What is typed of a name, with all that can stand as the argument that is being typed."""
    found = _ARGUMENT.fullmatch(typed)
    index = typed.count(",")
    if found is None or index >= len(seen.family.arguments):
        return
    done, begun = found[1], _bare(typed)
    is_last = index + 1 == len(seen.family.arguments)
    closing = f"{']' if seen.family.indexed else ')'}{seen.family.suffix}" if is_last else ","
    type_ = sight.enumerations[seen.family.arguments[index]]
    fitting = [name for name, each in sight.parameters.items() if not set(each.values).isdisjoint(type_.values)]
    for word in dict.fromkeys((*fitting, *sight.indices(seen.family, index), *type_.values)):
        written = f"{done}{word}{'' if word[-1] in '([' else closing}"
        if _bare(written).startswith(begun):
            yield option(written, seen.family.kind, seen.family.type)


def _bare(text: str) -> str:
    return re.sub(r"\s", "", text).lower()


def _step_option(step: str) -> Option:
    return option(step, NameKind.OPERATION if step == f"{OPERATION}." else NameKind.RESOURCE)


# What can be written at a place of a text.

_EXPRESSIONS = (FieldKind.CONDITION, FieldKind.FORMULA, FieldKind.ACTION)
_MOST_OPTIONS = 20  # that are all worth an option
_CLOSERS = (")", "]", "}", ",", ":")

Ranked = tuple[int, Option]


def complete(lexicon: Lexicon, field: TextField, text: str, offset: int) -> Completion:
    """Return what can be written in `text` at `offset`, in place of the name that is there."""
    if field.kind not in _EXPRESSIONS:
        return complete_choice(lexicon, field, text, offset)
    chain = chain_at(text, offset, field.kind is FieldKind.FORMULA)
    before = text[: chain.start]
    quantifiers = quantifiers_before(words_of(before))
    sight = VisibleNames(lexicon, field, quantifiers.bound)
    beginning = TextBefore(before, field.kind, sight.scope, quantifiers)
    ranked = list(_options(sight, field, beginning, chain))
    ordered = [each for _, each in sorted(ranked, key=lambda pair: pair[0])]
    is_whole = chain.typed.isdecimal() or any(each.insert == chain.typed for each in ordered)
    closing = list(_closing(beginning, chain)) if is_whole else []
    # What closes stands in the text as well, so it must not be what there is no room for.
    return completion(chain.start, chain.end, [*ordered[: MOST_OPTIONS - len(closing)], *closing])


def _options(sight: VisibleNames, field: TextField, beginning: TextBefore, chain: DottedName) -> Iterator[Ranked]:
    typed = chain.typed
    words = [(rank, option(word, NameKind.KEYWORD)) for word in beginning.words() for rank in _fit(typed, word)]
    if beginning.wants_target:
        yield from _names(sight, typed, lambda seen: _is_written(seen, field), 0)
        yield from words
        return
    if beginning.binds:
        yield from ((0, each) for each in _binders(sight, typed))
        return
    if beginning.quantifiers.expected is QuantifierPart.VALUE:
        yield from _values_of_one(sight, beginning.quantifiers.values, typed)
        return
    if not beginning.wants_name:
        yield from _numbers(beginning, typed)
        yield from words
        return
    if beginning.wants_set:
        for each in _enumerations(sight.lexicon, sight.enumerations, field.resource):
            yield from ((rank, each) for rank in _fit(typed, each.label))
        yield from words
        return
    expected = beginning.expected()
    yield from _values(expected, typed)
    for parameter, type_ in sight.parameters.items():
        if expected is None or _overlap(type_, expected):
            yield from ((rank, option(parameter, NameKind.PARAMETER, type_)) for rank in _fit(typed, parameter))
    if expected is None or expected == BOOLEAN:
        for flag in sight.flags():
            yield from ((rank, option(flag, NameKind.FLAG, BOOLEAN)) for rank in _fit(typed, flag))
    yield from _names(sight, typed, lambda seen: expected is None or _overlap(seen.family.type, expected), len(words))
    yield from words
    if expected is None and typed:
        yield from _all_values(sight, typed)


def _names(sight: VisibleNames, typed: str, wanted: Callable[[Visible], bool], taken: int) -> Iterator[Ranked]:
    steps = [] if "." in typed or "(" in typed or "[" in typed else resource_steps(sight, typed, wanted)
    room = MOST_OPTIONS - min(taken + len(steps) + 8, MOST_OPTIONS // 2)
    yield from name_options(sight, typed, wanted, room)
    yield from steps


def _is_written(seen: Visible, field: TextField) -> bool:
    kinds = field.writing.kinds if field.writing else ()
    return seen.family.kind.value in [kind.value for kind in kinds]


def _values(expected: Type | None, typed: str) -> Iterator[Ranked]:
    """The values that can stand beside something of the expected type."""
    if expected is None or expected == BOOLEAN:
        return  # `true` and `false` are words of the language
    if isinstance(expected, IntegerRange) and len(expected.domain) > _MOST_OPTIONS:
        values: tuple[Value, ...] = (expected.minimum, expected.maximum)
    else:
        values = expected.domain
    for value in map(print_value, values):
        yield from ((rank, option(value, NameKind.VALUE, expected)) for rank in _fit(typed, value))


def _all_values(sight: VisibleNames, typed: str) -> Iterator[Ranked]:
    """The values of all enumerations: one may stand first, as in `home == pose`."""
    for value, name in sight.values():
        rank = likeness(typed, value)
        if rank < 3:
            yield rank + 1, option(value, NameKind.VALUE, name)


def _binders(sight: VisibleNames, typed: str) -> Iterator[Option]:
    """A word for each set that a quantifier can be about: what is typed, or the first letter that is free."""
    letters = "".join(map(chr, range(ord("a"), ord("z") + 1)))
    taken = {*sight.parameters, *(value for value, _ in sight.values()), *(seen.short for seen in sight.families)}
    for full, type_ in sight.enumerations.items():
        name = full.removeprefix(f"{sight.resource}.")
        start = letters.find(name[0].lower())
        free = (each for each in letters[start:] + letters[:start] if each not in taken)
        word = typed or next(free, "each")
        yield option(f"{word} in {name}", NameKind.PARAMETER, type_)


def _values_of_one(sight: VisibleNames, written: tuple[str, ...], typed: str) -> Iterator[Ranked]:
    """The values of each enumeration that has all those written so far."""
    for value, name in sight.values():
        if value not in written and set(written) <= set(sight.enumerations[name].values):
            yield from ((rank, option(value, NameKind.VALUE, name)) for rank in _fit(typed, value))


def _numbers(beginning: TextBefore, typed: str) -> Iterator[Ranked]:
    """The numbers behind a minus."""
    if beginning.fits("1"):
        for number in range(1, 10):
            yield from ((rank, option(str(number), NameKind.VALUE)) for rank in _fit(typed, str(number)))


def _closing(beginning: TextBefore, chain: DottedName) -> Iterator[Option]:
    """Yield what can stand directly behind a name, with the name."""
    for sign in _CLOSERS:
        if beginning.fits(chain.typed + sign):
            yield option(chain.typed + sign, NameKind.KEYWORD)


def _fit(typed: str, word: str) -> Iterator[int]:
    if (rank := likeness(typed, word)) < NO_MATCH:
        yield rank


def _overlap(one: Type, other: Type) -> bool:
    if isinstance(one, EnumerationType) and isinstance(other, EnumerationType):
        return not set(one.values).isdisjoint(other.values)
    return type(one) is type(other)
