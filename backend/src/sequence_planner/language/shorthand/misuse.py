"""What is wrong with a name or a quantifier that is written well, but can only have been meant otherwise."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from sequence_planner.language.shorthand.vocabulary import Vocabulary
from sequence_planner.language.syntax import Binder, Expression, ExpressionError, Name, Quantified, Span
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, described
from sequence_planner.texts.late import message

if TYPE_CHECKING:
    from sequence_planner.texts.message import Message

# Numbers in quantifiers.


class DecidedNumber(NamedTuple):
    """That a quantifier always holds, or never, because of its number alone; and why."""

    always: bool
    message: Message


def decided_by_number(
    quantified: Quantified, vocabulary: Vocabulary, prefixes: tuple[str, ...] = ()
) -> DecidedNumber | None:
    """Whether the number of a quantifier leaves anything to what it is about; None if it does, or has none, or nobody
    knows what it is about. Names under one of `prefixes` need none.

    What `where` chooses does not count: it may choose otherwise in another state, or for another value around it.
    """
    number = quantified.number
    if number is None:
        return None
    choices = 1
    for binder in quantified.binders:
        if (values := _values(binder, vocabulary, prefixes)) is None:
            return None
        choices *= values
    if number > choices and quantified.quantifier in ("exactly", "at least"):
        return DecidedNumber(False, message("wrong.number-never", there=_there_are(choices, quantified)))
    if number >= choices and quantified.quantifier == "at most":
        return DecidedNumber(True, message("wrong.number-always", there=_there_are(choices, quantified)))
    if number == 0 and quantified.quantifier == "at least":
        return DecidedNumber(True, message("wrong.number-zero"))
    return None


def _values(binder: Binder, vocabulary: Vocabulary, prefixes: tuple[str, ...]) -> int | None:
    if isinstance(binder.domain, Name):
        named = vocabulary.domain_named(str(binder.domain), prefixes)
        return None if named is None else len(vocabulary.domains[named].values)
    return len(set(map(str, binder.domain)))


def _there_are(choices: int, quantified: Quantified) -> Message:
    first, *others = quantified.binders
    if others:
        return message("wrong.number.choices", count=choices)
    if isinstance(first.domain, Name):
        return message("wrong.number.values", count=choices, set=str(first.domain))
    return message("wrong.number.these", count=choices)


# Names that are called as what they are not.


def other_form(name: Name, vocabulary: Vocabulary, prefixes: tuple[str, ...]) -> str | None:
    """What a name is that is written as if it were something else, and how it is written; None if it is nothing."""
    written = ".".join(part.name for part in name.path)
    last = name.path[-1]
    inside = ", ".join(map(str, last.arguments))
    if written in vocabulary.maps:
        if len(last.arguments) == 2 and not last.indexed:
            first, second = last.arguments
            return message("wrong.is-map", name=written, form=f"{written}[{first}] == {second}")
        form = f"{written}[{inside if len(last.arguments) == 1 else '…'}]"
        return message("wrong.is-map", name=written, form=form)
    if written in vocabulary.relations:
        pair = inside if len(last.arguments) == 2 else f"{inside}, …" if last.arguments else "…, …"
        return message("wrong.is-relation-between", name=written, form=f"{written}({pair})")
    if last.indexed and any(prefix + written in vocabulary.predicates for prefix in (*prefixes, "")):
        return message("wrong.is-predicate", name=written, form=f"{written}({inside})")
    return None


def not_among(
    word: str, name: Name, type_: EnumerationType, vocabulary: Vocabulary, prefixes: tuple[str, ...] = ()
) -> str | None:
    """What is wrong with an argument that is a set, or a value of something else; None if it is neither."""
    head = name.path[-1].name
    if vocabulary.domain_named(word, prefixes) is not None:
        one = _free_word(word, vocabulary)
        arguments = ", ".join(one if str(each) == word else str(each) for each in name.path[-1].arguments)
        opening, closing = "[]" if name.path[-1].indexed else "()"
        before = "".join(f"{part}." for part in name.path[:-1])
        form = f"all {one} in {word}: {before}{head}{opening}{arguments}{closing}"
        return message("wrong.set-for-value", name=word, form=form)
    if any(word in domain.values for domain in vocabulary.domains.values()):
        return message("wrong.not-about", name=head, type=described(type_), value=word)
    return None


def _free_word(word: str, vocabulary: Vocabulary) -> str:
    """A word for one value of a set that is no value itself."""
    values = {value for domain in vocabulary.domains.values() for value in domain.values}
    return next((each for each in (word[:1], f"one_{word}") if each not in values), f"each_{word}")


# Values of a type that does not fit.


def unfit(expected: Type, found: Type, expression: Expression) -> ExpressionError:
    """An expression of another type than the one expected there."""
    wanted, hint = described(expected), hint_of_truth(expected, found)
    return ExpressionError(message("wrong.expected", wanted=wanted, found=described(found), hint=hint), expression.span)


def hint_of_truth(expected: Type, found: Type) -> str:
    """Say what to write for 0 and 1 where a truth value is meant."""
    if expected != BOOLEAN or found not in (IntegerRange(0, 0), IntegerRange(1, 1)):
        return ""
    return message("hint.write", what="true" if found == IntegerRange(1, 1) else "false")


def unordered(written: str, type_: Type, span: Span) -> ExpressionError:
    """A value of an enumeration whose values have no order."""
    return ExpressionError(message("wrong.no-order", name=written, type=described(type_)), span)
