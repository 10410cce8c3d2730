"""What is wrong with a name or a quantifier that is written well, but can only have been meant otherwise."""

from __future__ import annotations

from typing import NamedTuple

from sequence_planner.language.shorthand.vocabulary import Vocabulary
from sequence_planner.language.syntax import Binder, Expression, ExpressionError, Name, Quantified, Span
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, described

# Numbers in quantifiers.


class DecidedNumber(NamedTuple):
    """That a quantifier always holds, or never, because of its number alone; and why."""

    always: bool
    message: str


def decided_by_number(quantified: Quantified, vocabulary: Vocabulary) -> DecidedNumber | None:
    """Whether the number of a quantifier leaves anything to what it is about; None if it does, or has none.

    What `where` chooses does not count: it may choose otherwise in another state, or for another value around it.
    """
    number = quantified.number
    if number is None:
        return None
    choices = 1
    for binder in quantified.binders:
        choices *= _values(binder, vocabulary)
    if number > choices and quantified.quantifier in ("exactly", "at least"):
        return DecidedNumber(False, f"{_there_are(choices, quantified)}, so this never holds: write a smaller number")
    if number >= choices and quantified.quantifier == "at most":
        return DecidedNumber(True, f"{_there_are(choices, quantified)}, so this always holds: write a smaller number")
    if number == 0 and quantified.quantifier == "at least":
        return DecidedNumber(True, "`at least 0` always holds: write a larger number, or leave it out")
    return None


def _values(binder: Binder, vocabulary: Vocabulary) -> int:
    if isinstance(binder.domain, Name):
        return len(vocabulary.domains[str(binder.domain)].values)
    return len(set(map(str, binder.domain)))


def _there_are(choices: int, quantified: Quantified) -> str:
    how_many = f"there are {choices} " if choices != 1 else "there is 1 "
    if len(quantified.binders) > 1:
        return f"{how_many}{'choices' if choices != 1 else 'choice'} of values"
    [binder] = quantified.binders
    what = "values" if choices != 1 else "value"
    domain = f"`{binder.domain}`" if isinstance(binder.domain, Name) else "these"
    return f"{how_many}{what} of {domain}"


# Names that are called as what they are not.


def other_form(name: Name, vocabulary: Vocabulary, prefixes: tuple[str, ...]) -> str | None:
    """What a name is that is written as if it were something else, and how it is written; None if it is nothing."""
    written = ".".join(part.name for part in name.path)
    last = name.path[-1]
    inside = ", ".join(map(str, last.arguments))
    if written in vocabulary.maps:
        if len(last.arguments) == 2 and not last.indexed:
            first, second = last.arguments
            return f"`{written}` is a map: write `{written}[{first}] == {second}`"
        return f"`{written}` is a map: write `{written}[{inside if len(last.arguments) == 1 else '…'}]`"
    if written in vocabulary.relations:
        pair = inside if len(last.arguments) == 2 else f"{inside}, …" if last.arguments else "…, …"
        return f"`{written}` is a relation between two values: write `{written}({pair})`"
    if last.indexed and any(prefix + written in vocabulary.predicates for prefix in (*prefixes, "")):
        return f"`{written}` is a predicate: write `{written}({inside})`"
    return None


def not_among(word: str, name: Name, type_: EnumerationType, vocabulary: Vocabulary) -> str | None:
    """What is wrong with an argument that is a set, or a value of something else; None if it is neither."""
    head = name.path[-1].name
    if word in vocabulary.domains:
        one = _free_word(word, vocabulary)
        arguments = ", ".join(one if str(each) == word else str(each) for each in name.path[-1].arguments)
        opening, closing = "[]" if name.path[-1].indexed else "()"
        before = "".join(f"{part}." for part in name.path[:-1])
        return (
            f"`{word}` is a set, and one value stands here: write "
            f"`all {one} in {word}: {before}{head}{opening}{arguments}{closing}`"
        )
    if any(word in domain.values for domain in vocabulary.domains.values()):
        return f"`{head}` is about {described(type_)}, and `{word}` is none of them"
    return None


def _free_word(word: str, vocabulary: Vocabulary) -> str:
    """A word for one value of a set that is no value itself."""
    values = {value for domain in vocabulary.domains.values() for value in domain.values}
    return next((each for each in (word[:1], f"one_{word}") if each not in values), f"each_{word}")


# Values of a type that does not fit.


def unfit(expected: Type, found: Type, expression: Expression) -> ExpressionError:
    """An expression of another type than the one expected there."""
    message = f"expected {described(expected)}, found {described(found)}{hint_of_truth(expected, found)}"
    return ExpressionError(message, expression.span)


def hint_of_truth(expected: Type, found: Type) -> str:
    """Say what to write for 0 and 1 where a truth value is meant."""
    if expected != BOOLEAN or found not in (IntegerRange(0, 0), IntegerRange(1, 1)):
        return ""
    return "; write true" if found == IntegerRange(1, 1) else "; write false"


def unordered(written: str, type_: Type, span: Span) -> ExpressionError:
    """A value of an enumeration whose values have no order."""
    message = f"`{written}` is {described(type_)}, which has no order: declare its enumeration with `ordered: true`"
    return ExpressionError(message, span)
