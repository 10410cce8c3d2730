"""What can be written at a place of a text."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from sequence_planner.workshop.language.chain import Chain, chain_at
from sequence_planner.workshop.language.choosing import complete_choice
from sequence_planner.workshop.language.completion import MOST_OPTIONS, Completion, Option, completion, option
from sequence_planner.workshop.language.field import Field, FieldKind
from sequence_planner.workshop.language.grammar import Beginning
from sequence_planner.workshop.language.lexicon import Lexicon
from sequence_planner.workshop.language.matching import NO_MATCH, likeness
from sequence_planner.workshop.language.names import Visible
from sequence_planner.workshop.language.naming import name_options, resource_steps
from sequence_planner.workshop.language.visible import Sight
from sequence_planner.workshop.language_view import NameKind

_EXPRESSIONS = (FieldKind.CONDITION, FieldKind.FORMULA, FieldKind.ACTION)
_MOST_NUMBERS = 20  # that are all worth an option
_CLOSERS = (")", "}", ",")

Ranked = tuple[int, Option]


def complete(lexicon: Lexicon, field: Field, text: str, offset: int) -> Completion:
    """What can be written in `text` at `offset`, in place of the name that is there."""
    if field.kind not in _EXPRESSIONS:
        return complete_choice(lexicon, field, text, offset)
    chain = chain_at(text, offset, field.kind is FieldKind.FORMULA)
    sight = Sight(lexicon, field)
    beginning = Beginning(text[: chain.start], field.kind, sight.scope)
    ranked = list(_options(sight, field, beginning, chain))
    ordered = [each for _, each in sorted(ranked, key=lambda pair: pair[0])]
    is_whole = chain.typed.isdecimal() or any(each.insert == chain.typed for each in ordered)
    closing = list(_closing(beginning, chain)) if is_whole else []
    # What closes stands in the text as well, so it must not be what there is no room for.
    return completion(chain.start, chain.end, [*ordered[: MOST_OPTIONS - len(closing)], *closing])


def _options(sight: Sight, field: Field, beginning: Beginning, chain: Chain) -> Iterator[Ranked]:
    typed = chain.typed
    if beginning.wants_target:
        yield from _names(sight, typed, lambda seen: _is_written(seen, field), 0)
        return
    words = [(rank, option(word, NameKind.KEYWORD)) for word in beginning.words() for rank in _fit(typed, word)]
    if not beginning.wants_name:
        yield from _numbers(beginning, typed)
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


def _names(sight: Sight, typed: str, wanted: Callable[[Visible], bool], taken: int) -> Iterator[Ranked]:
    steps = [] if "." in typed or "(" in typed or "[" in typed else resource_steps(sight, typed, wanted)
    room = MOST_OPTIONS - min(taken + len(steps) + 8, MOST_OPTIONS // 2)
    yield from name_options(sight, typed, wanted, room)
    yield from steps


def _is_written(seen: Visible, field: Field) -> bool:
    kinds = field.writing.kinds if field.writing else ()
    return seen.family.kind.value in [kind.value for kind in kinds]


def _values(expected: Type | None, typed: str) -> Iterator[Ranked]:
    """The values that can stand beside something of the expected type."""
    if expected is None or expected == BOOLEAN:
        return  # `true` and `false` are words of the language
    if isinstance(expected, IntegerRange) and len(expected.domain) > _MOST_NUMBERS:
        values: tuple[Value, ...] = (expected.minimum, expected.maximum)
    else:
        values = expected.domain
    for value in map(print_value, values):
        yield from ((rank, option(value, NameKind.VALUE, expected)) for rank in _fit(typed, value))


def _all_values(sight: Sight, typed: str) -> Iterator[Ranked]:
    """The values of all enumerations: one may stand first, as in `home == pose`."""
    for value, name in sight.values():
        rank = likeness(typed, value)
        if rank < 3:
            yield rank + 1, option(value, NameKind.VALUE, name)


def _numbers(beginning: Beginning, typed: str) -> Iterator[Ranked]:
    """The numbers behind a minus."""
    if beginning.fits("1"):
        for number in range(1, 10):
            yield from ((rank, option(str(number), NameKind.VALUE)) for rank in _fit(typed, str(number)))


def _closing(beginning: Beginning, chain: Chain) -> Iterator[Option]:
    """What can stand directly behind a name, with the name."""
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
