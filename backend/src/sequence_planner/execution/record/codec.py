"""Codec of the run journal: execution events and typed values as JSON records, and back."""

from __future__ import annotations

import dataclasses
import types
from collections.abc import Callable, Mapping
from enum import Enum
from typing import Any, Final, Union, cast, get_args, get_origin, get_type_hints

from pydantic import JsonValue

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.execution.events import (
    Answered,
    Asked,
    ByOrderChanged,
    CalledOff,
    Confirmed,
    Corrected,
    CycleStopChanged,
    Event,
    Explained,
    Forced,
    ForceReleased,
    JobCommanded,
    JobForgotten,
    JobsSequenced,
    JobTaken,
    ModeChanged,
    OperatorPlanStarted,
    OperatorPlanStopped,
    ProductionStarted,
    ServiceChanged,
    SteppingChanged,
    StepTaken,
    Ticked,
    Unanswered,
)
from sequence_planner.execution.state import ExecutionState
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse_formula
from sequence_planner.language.printer import print_expression
from sequence_planner.language.resolver import resolve_formula
from sequence_planner.language.syntax import Expression, ExpressionError
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import PlanRequest, Proof

# When something asked of the journal cannot be told.

OTHER_VERSION: Final = "other-version"  # of the program has written it


class HistoryError(Exception):
    """A question to the journal that cannot be answered; the text says why, and `slug` names the kind for machines."""

    def __init__(self, slug: str, detail: str) -> None:
        super().__init__(slug, detail)
        self.slug = slug
        self.detail = detail

    def __str__(self) -> str:
        return self.detail


# Values as JSON documents and back, as the annotations of their classes say: a new field cannot be forgotten.
#
# A field that has its default is left out, so a field that is added to a class later is no reason why what was written
# before could not be read. What takes no part in comparison, such as a place in a text, is left out as well.

Encode = Callable[[Any], JsonValue]
Decode = Callable[[Any], Any]
# The names that fields have in the journal where the program has another, by their classes.
WRITTEN_AS: Final[Mapping[type, Mapping[str, str]]] = {
    ExecutionState: {"operator_plan": "errand", "last_operator_plan": "last_errand"},
    OperatorPlanStarted: {"operator_plan": "errand"},
}
_PRIMITIVES = (bool, int, float, str)
_MISSING = object()


class UnreadableError(ValueError):
    """A document says nothing that could have been written."""


@dataclasses.dataclass(frozen=True)
class Shape:
    """The way the values of one type are written and read. Reading raises `UnreadableError`."""

    encode: Encode
    decode: Decode


class Shapes:
    """The shapes of all types that occur; `own` are those that are not made of their annotations.

    The classes in `dropped` are not written: their place is taken by None.
    """

    def __init__(self, own: Mapping[Any, Shape] | None = None, dropped: tuple[type, ...] = ()) -> None:
        self._known: dict[Any, Shape] = dict(own or {})
        self._dropped = dropped

    def shape(self, form: Any) -> Shape:  # noqa: ANN401 - what annotations are is no type
        """The shape of a type, such as `Mapping[str, int | None]` or a class of immutable values."""
        known = self._known.get(form)
        if known is None:
            # A type may be made of itself, as expressions are: what refers to it looks it up when it is used.
            later = Shape(lambda value: made.encode(value), lambda document: made.decode(document))  # noqa: PLW0108
            self._known[form] = later
            known = made = self._known[form] = self._made(form)
        return known

    def _made(self, form: Any) -> Shape:  # noqa: ANN401
        origin = get_origin(form)
        if origin in (Union, types.UnionType):
            return self._one_of(get_args(form))
        if origin in (frozenset, set):
            return self._some(form, sort=True)
        if origin in (tuple, list):
            return self._tuple(form) if origin is tuple and Ellipsis not in get_args(form) else self._some(form)
        if origin is not None and issubclass(origin, Mapping):
            return self._mapping(*get_args(form))
        if isinstance(form, type) and issubclass(form, tuple):  # with names for its parts
            parts = self.shape(tuple[tuple(get_type_hints(form).values())])  # type: ignore[misc]
            return Shape(parts.encode, lambda document: form(*parts.decode(document)))
        if form in self._dropped:
            return Shape(lambda value: None, lambda document: None)
        if form in _PRIMITIVES or form is type(None):
            return _primitive((form,))
        if isinstance(form, type) and issubclass(form, Enum):
            return Shape(lambda value: value.value, lambda document: _guarded(form, document))
        if isinstance(form, type) and (issubclass(form, Immutable) or dataclasses.is_dataclass(form)):
            return self._record(form)
        raise TypeError(f"{form!r} has no shape")

    def _one_of(self, forms: tuple[Any, ...]) -> Shape:
        """A choice: of primitive values as they are, of one class beside None, or of classes by their names."""
        some = tuple(form for form in forms if form is not type(None))
        optional = len(some) < len(forms)
        if set(some) <= set(_PRIMITIVES):
            return _primitive(forms)
        union: Any = Union[some]  # noqa: UP007 - of a number of members that is known here only
        inner = self.shape(union) if optional or len(some) == 1 else self._by_name(some)
        if not optional:
            return inner
        return Shape(
            lambda value: None if value is None else inner.encode(value),
            lambda document: None if document is None else inner.decode(document),
        )

    def _by_name(self, classes: tuple[Any, ...]) -> Shape:
        named = {each.__name__: self.shape(each) for each in classes}

        def encode(value: Any) -> JsonValue:  # noqa: ANN401
            name = type(value).__name__
            return [name, named[name].encode(value)]

        def decode(document: Any) -> Any:  # noqa: ANN401
            match document:
                case [str(name), content] if name in named:
                    return named[name].decode(content)
            raise UnreadableError(f"`{document}` is none of {', '.join(named)}")

        return Shape(encode, decode)

    def _some(self, form: Any, sort: bool = False) -> Shape:  # noqa: ANN401
        make, inner = get_origin(form), self.shape(get_args(form)[0])

        def encode(value: Any) -> JsonValue:  # noqa: ANN401
            return [inner.encode(each) for each in (sorted(value) if sort else value)]

        return Shape(encode, lambda document: make(inner.decode(each) for each in _expected(list, document)))

    def _tuple(self, form: Any) -> Shape:  # noqa: ANN401
        parts = tuple(map(self.shape, get_args(form)))

        def decode(document: Any) -> Any:  # noqa: ANN401
            if len(_expected(list, document)) != len(parts):
                raise UnreadableError(f"`{document}` has not {len(parts)} parts")
            return tuple(part.decode(each) for part, each in zip(parts, document, strict=True))

        return Shape(lambda value: [part.encode(each) for part, each in zip(parts, value, strict=True)], decode)

    def _mapping(self, key: Any, value: Any) -> Shape:  # noqa: ANN401
        """An object with its names in order, whatever order they came in; or pairs, where the keys are no texts."""
        inner = self.shape(value)
        if key is str:
            return Shape(
                lambda mapping: {name: inner.encode(mapping[name]) for name in sorted(mapping)},
                lambda document: {name: inner.decode(each) for name, each in _expected(dict, document).items()},
            )
        pairs = self.shape(tuple[tuple[key, value], ...])
        return Shape(
            lambda mapping: pairs.encode(sorted(mapping.items(), key=lambda pair: pair[0])),
            lambda document: dict(pairs.decode(document)),
        )

    def _record(self, form: type) -> Shape:
        """The fields of a class that are not as their default is."""
        hints = get_type_hints(form)
        written_as = WRITTEN_AS.get(form, {})
        names = {name: written_as.get(name, name) for name in _fields(form)}
        fields = {names[name]: (name, self.shape(hints[name]), default) for name, default in _fields(form).items()}

        def encode(value: Any) -> JsonValue:  # noqa: ANN401
            document: dict[str, JsonValue] = {}
            for written_name, (name, shape, default) in fields.items():
                content = getattr(value, name)
                if default is not _MISSING and content == default:
                    continue
                written = shape.encode(content)
                if written is not None or default is not None:  # what is dropped is as if it had never been there
                    document[written_name] = written
            return document

        def decode(document: Any) -> Any:  # noqa: ANN401
            if unknown := _expected(dict, document).keys() - fields.keys():
                raise UnreadableError(f"a {form.__name__} has no {', '.join(sorted(unknown))}")
            if missing := {name for name, (_, _, default) in fields.items() if default is _MISSING} - document.keys():
                raise UnreadableError(f"a {form.__name__} needs {', '.join(sorted(missing))}")
            return form(**{fields[each][0]: fields[each][1].decode(content) for each, content in document.items()})

        return Shape(encode, decode)


def _fields(form: type) -> dict[str, object]:
    """The fields of a class, each with its default, or `_MISSING`."""
    if issubclass(form, Immutable):
        return {name: vars(form).get(name, _MISSING) for name in form._compared}
    found: dict[str, object] = {}
    for field in dataclasses.fields(cast(Any, form)):
        made = _MISSING if field.default_factory is dataclasses.MISSING else field.default_factory()
        found[field.name] = made if field.default is dataclasses.MISSING else field.default
    return found


def _primitive(forms: tuple[Any, ...]) -> Shape:
    allowed = (*forms, int) if float in forms else forms  # a whole number of seconds is read back as written

    def decode(document: Any) -> Any:  # noqa: ANN401
        if type(document) not in allowed:
            raise UnreadableError(f"`{document}` is none of {', '.join(each.__name__ for each in forms)}")
        return document

    return Shape(lambda value: value, decode)


def _expected(kind: type, document: Any) -> Any:  # noqa: ANN401
    if not isinstance(document, kind):
        raise UnreadableError(f"`{document}` should be a {kind.__name__}")
    return document


def _guarded(form: type[Enum], document: object) -> Enum:
    try:
        return form(document)
    except ValueError as error:
        raise UnreadableError(str(error)) from None


# What happens to an execution as records of the journal, and back.
#
# The `kind` of a record says of which class the event is, by a word that stays; its content is a JSON document of the
# event's fields. A tick is written as what is different from the tick before: `TickBook` knows that one.
# Predicates are written as the model's language prints them, and are resolved again in the names of the station.

Document = dict[str, Any]  # of JSON


KINDS: Final[Mapping[str, type]] = {
    "ticked": Ticked,
    "asked": Asked,
    "answered": Answered,
    "unanswered": Unanswered,
    "explained": Explained,
    "production-started": ProductionStarted,
    "mode-changed": ModeChanged,
    "called-off": CalledOff,
    "cycle-stop-changed": CycleStopChanged,
    "stepping-changed": SteppingChanged,
    "step-taken": StepTaken,
    "service-changed": ServiceChanged,
    "corrected": Corrected,
    "confirmed": Confirmed,
    "forced": Forced,
    "force-released": ForceReleased,
    "errand-taken": OperatorPlanStarted,
    "errand-stopped": OperatorPlanStopped,
    "by-order-changed": ByOrderChanged,
    "job-taken": JobTaken,
    "jobs-sequenced": JobsSequenced,
    "job-commanded": JobCommanded,
    "job-forgotten": JobForgotten,
}
_KIND_OF: Final = {happening: kind for kind, happening in KINDS.items()}


def kind_of(happening: type) -> str:
    """The kind of the records of a class of events."""
    return _KIND_OF[happening]


TICKED: Final = kind_of(Ticked)
BEGUN: Final = "begun"
SNAPSHOT: Final = "snapshot"
_MOST_TEXTS: Final = 10_000  # of predicates that are kept


class Codec:
    """Writes and reads values of one station. Reading raises `UnreadableError`."""

    def __init__(self, automaton: Automaton) -> None:
        self._predicates = _Predicates(automaton)
        self._trees = Shapes().shape(Expression)
        own = {Expression: Shape(self._written, self._expression), State: Shape(dict, _state)}
        self._shapes = Shapes(own, dropped=(Proof,))
        request = self._shapes.shape(PlanRequest)
        own[PlanRequest] = Shape(lambda value: request.encode(_without_deadline(value)), request.decode)
        self._shapes = Shapes(own, dropped=(Proof,))

    def encode(self, form: Any, value: object) -> JsonValue:  # noqa: ANN401 - what annotations are is no type
        """The document of a value of the type `form`."""
        return self._shapes.shape(form).encode(value)

    def decode(self, form: Any, document: JsonValue) -> Any:  # noqa: ANN401
        """The value of the type `form` that a document has."""
        return self._shapes.shape(form).decode(document)

    def happening(self, kind: str, content: Mapping[str, JsonValue]) -> Event:
        """Return what a record says that has happened, no tick. Raises `UnreadableError`."""
        happening: Event = self.decode(KINDS[kind], content.get("what", {}))
        return happening

    def content(self, happening: Event) -> Document:
        """Return what a record says of what has happened, no tick."""
        return {"what": self.encode(type(happening), happening)}

    def _written(self, expression: Expression) -> JsonValue:
        """Its text; or the tree, where the text would be read otherwise, as a value has the name of a variable."""
        text = self._predicates.text(expression)
        return self._trees.encode(expression) if text is None else text

    def _expression(self, document: JsonValue) -> Expression:
        if isinstance(document, str):
            return self._predicates.read(document)
        expression: Expression = self._trees.decode(document)
        return expression


class Senses(Immutable):
    """The things that a tick is given, but for when it is."""

    measured: Mapping[str, Value | None] = {}
    obstacles: tuple[str, ...] = ()
    silent: frozenset[str] = frozenset()


class TickBook:
    """Writes ticks as what is different from the one before, and reads them so."""

    def __init__(self, senses: Senses | None = None) -> None:
        self.senses = senses or Senses()  # of the last tick

    def content(self, tick: Ticked) -> Document:
        """Return what a record says of a tick, which is the last one from now on."""
        before, self.senses = self.senses, Senses(dict(tick.measured), tick.obstacles, tick.silent)
        content: Document = {"now": [tick.now.epoch, tick.now.monotonic]}
        if before.measured.keys() != self.senses.measured.keys():
            content["all"] = dict(self.senses.measured)
        elif changed := {
            name: value for name, value in self.senses.measured.items() if not _same(value, before.measured[name])
        }:
            content["measured"] = dict(changed)
        if tick.obstacles != before.obstacles:
            content["obstacles"] = list(tick.obstacles)
        if tick.silent != before.silent:
            content["silent"] = sorted(tick.silent)
        return content

    def tick(self, content: Mapping[str, Any]) -> Ticked:
        """The tick of a record, which is the last one from now on. Raises `UnreadableError`."""
        try:
            last = self.senses
            measured = content["all"] if "all" in content else {**last.measured, **content.get("measured", {})}
            obstacles = tuple(content["obstacles"]) if "obstacles" in content else last.obstacles
            silent = frozenset(content["silent"]) if "silent" in content else last.silent
            epoch, monotonic = content["now"]
        except (KeyError, TypeError, ValueError) as error:
            raise UnreadableError(f"a tick cannot be read: {error!r}") from None
        self.senses = Senses(measured, obstacles, silent)
        return Ticked(measured, obstacles, silent, Timestamp(epoch, monotonic))


def _without_deadline(request: PlanRequest) -> PlanRequest:
    """Leave out how long an answer might take, which is nothing that anything follows from."""
    return replace(request, deadline=vars(PlanRequest)["deadline"])


def _state(document: object) -> State:
    """Its variables and flags stay in the order in which they are."""
    if not isinstance(document, dict):
        raise UnreadableError(f"`{document}` is no state")
    return document


def _same(value: Value | None, other: Value | None) -> bool:
    return value is other or (value == other and type(value) is type(other))


class _Predicates:
    """Predicates and formulas as texts, and what was read of these so far."""

    def __init__(self, automaton: Automaton) -> None:
        self._scope = NameScope(automaton.types)
        self._read: dict[str, Expression] = {}
        self._texts: dict[int, tuple[Expression, str | None]] = {}  # by identity: to compare trees takes longer

    def text(self, expression: Expression) -> str | None:
        """The text from which the same is read again; None where there is none."""
        known = self._texts.get(id(expression))
        if known is None or known[0] is not expression:
            text = print_expression(expression)
            try:
                same = self.read(text) == expression
            except UnreadableError:
                same = False
            if len(self._texts) >= _MOST_TEXTS:
                self._texts.clear()
            known = self._texts[id(expression)] = expression, text if same else None
        return known[1]

    def read(self, text: str) -> Expression:
        if text not in self._read:
            if len(self._read) >= _MOST_TEXTS:
                self._read.clear()
            try:
                self._read[text] = resolve_formula(parse_formula(text), self._scope)
            except ExpressionError as error:
                raise UnreadableError(f"`{text}` says nothing at this station: {error.message}") from None
        return self._read[text]
