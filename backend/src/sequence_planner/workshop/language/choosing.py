"""What can be written where that is one name of few: types, enumerations, abilities, operations, acknowledgements."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.types import BOOLEAN, IntegerRange
from sequence_planner.workshop.language.completion import Completion, Option, completion, option
from sequence_planner.workshop.language.field import Field, FieldKind
from sequence_planner.workshop.language.lexicon import Lexicon
from sequence_planner.workshop.language.matching import NO_MATCH, likeness
from sequence_planner.workshop.language.visible import Sight, abilities
from sequence_planner.workshop.language_view import NameKind

_MOST_NUMBERS = 100


def complete_choice(lexicon: Lexicon, field: Field, text: str, offset: int) -> Completion:
    """The names that can stand in place of the whole text, those first that fit what is typed before `offset`."""
    typed = text[:offset].strip()
    ranked = [(likeness(typed, each.label), each) for each in _choices(lexicon, field)]
    fitting = sorted((pair for pair in ranked if pair[0] < NO_MATCH), key=lambda pair: pair[0])
    return completion(0, len(text), [each for _, each in fitting])


def _choices(lexicon: Lexicon, field: Field) -> Iterator[Option]:
    match field.kind:
        case FieldKind.TYPE:
            yield option(str(BOOLEAN), NameKind.ENUMERATION, "false, true")
            yield from _enumerations(lexicon)
        case FieldKind.ENUMERATION:
            yield from _enumerations(lexicon)
        case FieldKind.INITIAL:
            if field.type is not None:
                few = not isinstance(field.type, IntegerRange) or len(field.type.domain) <= _MOST_NUMBERS
                for value in field.type.domain if few else ():
                    yield option(print_value(value), NameKind.VALUE, field.type)
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


def _enumerations(lexicon: Lexicon) -> Iterator[Option]:
    for name, type_ in lexicon.declarations.enumerations.items():
        yield option(name, NameKind.ENUMERATION, type_)


def _abilities(lexicon: Lexicon, field: Field) -> Iterator[Option]:
    """Each ability, and those with parameters one by one as well."""
    sight = Sight(lexicon, field)
    for seen in abilities(sight.families):
        title = seen.family.title or ""
        if seen.family.arguments:
            yield option(seen.family.name, NameKind.ABILITY, title)
        for form in sight.forms(seen):
            yield option(form.removesuffix(seen.family.suffix), NameKind.ABILITY, title)
