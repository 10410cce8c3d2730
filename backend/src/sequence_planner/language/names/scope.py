"""The meaning of names at one place of a model, and what is said of a name that means nothing there.

A name is looked up in this order: a parameter of the construct, then relative to its ability and its resource, then in
the whole station.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from functools import cached_property, reduce

from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.lexer import KEYWORDS, PREFIX_LETTERS
from sequence_planner.language.names.suggestions import beginning_with, meant, nearest, nearest_of
from sequence_planner.language.parser import temporal_refused
from sequence_planner.language.shorthand.misuse import other_form
from sequence_planner.language.shorthand.vocabulary import NO_VOCABULARY, Vocabulary
from sequence_planner.language.syntax import Component, ExpressionError, Name, Span, UnusableError, Variable
from sequence_planner.language.types import EnumerationType, Type
from sequence_planner.texts.late import message

# What is asked of the order of an enumeration.
STEPS = {"previous": -1, "next": 1}
ENDS = {"first": 0, "last": -1}


class NameScope(Immutable):
    """The meaning of names at one place of a model.

    `variables` maps full names to types; `prefixes` are tried in order before the bare name (such as
    `nutrunner.run_nut.` and `nutrunner.`); `parameters` maps a parameter to its value and the enumeration it is of.
    Names that begin with what is `unsuggested` are found, and never what somebody may have meant.
    """

    variables: Mapping[str, Type]
    prefixes: tuple[str, ...] = ()
    parameters: Mapping[str, tuple[str, EnumerationType]] = {}
    vocabulary: Vocabulary = NO_VOCABULARY
    copies: int = 1
    """How often what is resolved here is written out, by the quantifiers around it."""
    unsuggested: str | None = None

    def binding(self, parameters: Mapping[str, tuple[str, EnumerationType]], copies: int = 1) -> NameScope:
        """The same with further parameters."""
        return replace(self, parameters={**self.parameters, **parameters}, copies=self.copies * copies)

    def not_suggesting(self, beginning: str) -> NameScope:
        """The same, where no name that begins so is told to be meant."""
        return replace(self, unsuggested=beginning)

    def substitute(self, name: Name) -> Name:
        """`name` with the parameters among its arguments replaced by their values."""
        if not self.parameters or name.is_word:
            return name
        parts = tuple(
            Component(part.name, tuple(self._argument(word) for word in part.arguments), part.indexed)
            for part in name.path
        )
        return Name(parts, name.span)

    def find(self, name: Name) -> Variable | None:
        """The variable of that name, or None."""
        found = self._full(name)
        return None if found is None else Variable(found, self.variables[found], name.span)

    def type_of(self, name: Name) -> Type | None:
        """The type of the variable of that name, or None."""
        found = self._full(name)
        return None if found is None else self.variables[found]

    def _full(self, name: Name) -> str | None:
        """The full name of the variable of that name, looked for once; None where there is none."""
        written = str(name)
        try:
            return self._fulls[written]
        except KeyError:
            text = str(self.substitute(name))
            full = (each for prefix in (*self.prefixes, "") if (each := prefix + text) in self.variables)
            return self._fulls.setdefault(written, next(full, None))

    @cached_property
    def _fulls(self) -> dict[str, str | None]:
        return {}

    def _argument(self, word: str | Name) -> str | Name:
        return self.parameters[word][0] if isinstance(word, str) and word in self.parameters else word

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The full names of all variables that somebody may have meant."""
        if self.unsuggested is None:
            return tuple(self.variables)
        return tuple(name for name in self.variables if not name.startswith(self.unsuggested))

    def short(self, beginning: str = "") -> list[str]:
        """Return what names that begin so are here without a prefix."""
        found = ((prefix, beginning_with(prefix + beginning, self.names)) for prefix in self.prefixes)
        return [name.removeprefix(prefix) for prefix, names in found for name in names]


# Names that mean nothing.


def require_usable(name: str, span: Span, scope: NameScope) -> None:
    """Raise `UnusableError` for a name that is declared wrongly."""
    if any(prefix + name in scope.vocabulary.unusable for prefix in (*scope.prefixes, "")):
        raise UnusableError(message("wrong.means-nothing", name=name), span)


def unknown_name(name: Name, scope: NameScope, values: Iterable[str]) -> ExpressionError:
    """The error of a name that is neither a variable nor one of `values`, with what was probably meant."""
    first = name.path[0]
    require_usable(".".join(part.name for part in name.path), name.span, scope)
    if len(name.path) == 1 and first.name in PREFIX_LETTERS and first.arguments and not first.indexed:
        return temporal_refused(first.name, name.span)
    if (said := other_form(name, scope.vocabulary, scope.prefixes)) is not None:
        return ExpressionError(said, name.span)
    hint = _meant(name, scope, values)
    said = message("wrong.unknown-name" if values else "wrong.unknown-variable", name=str(name), hint=hint)
    return ExpressionError(said, name.span)


def _meant(name: Name, scope: NameScope, values: Iterable[str]) -> str:
    """Say what to write in place of an unknown name, as far as that can be guessed."""
    word = str(name)
    if word.lower() in KEYWORDS:
        return message("hint.write", what=word.lower())
    if (last := name.path[-1].name) in values:
        return message("hint.meant", name=last)
    begun = dict.fromkeys((*scope.short(word + "."), *beginning_with(word + ".", scope.names)))
    flags = [other for other in begun if "." not in other[len(word) + 1 :]]
    if 0 < len(flags) < 4:  # an ability or operation, and no resource
        return message("hint.write", what=reduce(lambda most, each: message("list.or", most=most, last=each), flags))
    own = [*values, *scope.short(), *scope.parameters, *scope.vocabulary.names_beside(scope.prefixes)]
    if near := _suggestion_of(word, own, scope.names, 0.7):
        return near
    if values:
        near = _suggestion_of(word, own, scope.names, 0.5)
        return near or message("hint.one-of", values=", ".join(values))
    owners = [
        other for other, type_ in scope.variables.items() if isinstance(type_, EnumerationType) and word in type_.values
    ]
    for prefix in (*scope.prefixes, ""):
        if (owner := next((other for other in owners if other.startswith(prefix)), None)) is not None:
            return message("hint.beside-variable", variable=owner.removeprefix(prefix), value=word)
    return _suggestion_of(word, own, scope.names, 0.5)


def _suggestion_of(word: str, own: Collection[str], names: tuple[str, ...], likeness: float) -> str:
    return meant(word, [*own, *names], nearest(word, own, likeness), nearest_of(word, names, likeness))
