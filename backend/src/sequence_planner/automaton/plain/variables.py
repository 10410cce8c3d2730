"""Variables of a plain automaton, with names that expressions can read."""

from __future__ import annotations

import re
from collections.abc import Iterable

from sequence_planner.automaton.declarations import MOST_VALUES
from sequence_planner.language.lexer import KEYWORDS, MOST_DIGITS
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Place, Type
from sequence_planner.model.efa_document import DomainDocument, PlainModel, RangeDocument
from sequence_planner.model.source import Finding, SourceText

_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def declared_types(model: PlainModel, findings: list[Finding]) -> dict[str, Type]:
    """The type of each variable; what is wrong with a name or a domain is added to `findings`.

    A variable may be a word or several joined by dots; a value is a word.
    """
    types: dict[str, Type] = {}
    for name, domain in model.content.variables.items():
        if not all(map(_is_word, name.split("."))):
            findings.append(_unreadable("variable", name))
        elif (type_ := _type(model, name, domain, findings)) is not None:
            types[str(name)] = type_
    return types


def unlimited(type_: Type) -> Type:
    """The type, or all integers: an update beyond a range is no mistake, and disables its transition."""
    limit = 10 ** (2 * MOST_DIGITS)
    return IntegerRange(-limit, limit) if isinstance(type_, IntegerRange) else type_


def unknown_variable(name: SourceText, types: Iterable[str]) -> Finding:
    """The finding where a variable is written that is not declared."""
    return Finding(name.place, f"unknown variable `{name}`{suggestion(name, types)}")


def _is_word(text: str) -> bool:
    return _WORD.fullmatch(text) is not None and text not in KEYWORDS


def _unreadable(what: str, name: SourceText) -> Finding:
    readable = re.sub(r"[^A-Za-z0-9_]", "_", name)
    if not _is_word(readable):
        readable = f"{what[0]}_{readable}"
    message = (
        f"expressions cannot read the {what} `{name}`: a name has letters, digits and `_`, begins with no digit and is "
        f"no word of the language; rename it everywhere, for example to `{readable}`"
    )
    return Finding(name.place, message)


def _type(model: PlainModel, name: SourceText, domain: DomainDocument, findings: list[Finding]) -> Type | None:
    place = model.source.place_of_value(("variables", str(name)))
    if isinstance(domain, SourceText):
        if domain == "bool":
            return BOOLEAN
        findings.append(
            Finding(place, f'unknown domain `{domain}`: write "bool", a list of values, or {{"min": 0, "max": 3}}')
        )
        return None
    if isinstance(domain, RangeDocument):
        if (wrong := _wrong_range(domain.least, domain.most)) is not None:
            findings.append(Finding(place, wrong))
            return None
        return IntegerRange(domain.least, domain.most)
    return _listed(name, domain, place, findings)


def _wrong_range(least: int, most: int) -> str | None:
    if least > most:
        return f"the range {least}..{most} is empty: write the smaller number as min"
    if most - least >= MOST_VALUES:
        return f"the range {least}..{most} has more than {MOST_VALUES} values: use a coarser measure"
    if max(-least, most) >= 10**MOST_DIGITS:
        return f"integers have at most {MOST_DIGITS} digits"
    return None


def _listed(
    name: SourceText, domain: list[SourceText | int], place: Place, findings: list[Finding]
) -> EnumerationType | None:
    words = [value for value in domain if isinstance(value, SourceText)]
    if len(words) < len(domain):
        message = 'a list of values holds names; write integers as a range, such as {"min": 0, "max": 3}'
        findings.append(Finding(place, message))
        return None
    for index, word in enumerate(words):
        if not _is_word(word):
            findings.append(_unreadable("value", word))
        elif word in words[:index]:
            findings.append(Finding(word.place, f"duplicate value `{word}` of `{name}`"))
    return EnumerationType(tuple(map(str, words)))
