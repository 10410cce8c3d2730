"""What is wrong with a name or a quantifier that is written well, but can only have been meant otherwise."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, NamedTuple

from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.shorthand.vocabulary import Vocabulary
from sequence_planner.language.suggestions import beginning_with, meant, nearest, nearest_of
from sequence_planner.language.syntax import Binder, Name, Quantified
from sequence_planner.language.types import EnumerationType, described

if TYPE_CHECKING:
    from sequence_planner.language.resolver import NameScope

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


# Names that nothing has.


def what_was_meant(name: Name, scope: NameScope, values: Iterable[str]) -> str:
    """Say what to write in place of an unknown name, as far as that can be guessed."""
    word = str(name)
    if word.lower() in KEYWORDS:
        return f"; write {word.lower()}"
    if (last := name.path[-1].name) in values:
        return f"; did you mean `{last}`?"
    begun = dict.fromkeys((*scope.short(word + "."), *beginning_with(word + ".", scope.names)))
    flags = [other for other in begun if "." not in other[len(word) + 1 :]]
    if 0 < len(flags) < 4:  # an ability or operation, and no resource
        return f"; write {' or '.join(flags)}"
    own = [*values, *scope.short(), *scope.parameters, *scope.vocabulary.names_beside(scope.prefixes)]
    if near := _suggestion_of(word, own, scope.names, 0.7):
        return near
    if values:
        return _suggestion_of(word, own, scope.names, 0.5) or f"; write one of {', '.join(values)}"
    owners = [
        other for other, type_ in scope.variables.items() if isinstance(type_, EnumerationType) and word in type_.values
    ]
    for prefix in (*scope.prefixes, ""):
        if (owner := next((other for other in owners if other.startswith(prefix)), None)) is not None:
            return f"; a value stands beside its variable, as in `{owner.removeprefix(prefix)} == {word}`"
    return _suggestion_of(word, own, scope.names, 0.5)


def _suggestion_of(word: str, own: Collection[str], names: tuple[str, ...], likeness: float) -> str:
    return meant(word, [*own, *names], nearest(word, own, likeness), nearest_of(word, names, likeness))
