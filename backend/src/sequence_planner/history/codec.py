"""What happens to an execution as records of the journal, and back.

The `kind` of a record is the name of the happening's class, as in `mode-changed`; its content is a JSON document of the
happening's fields. A tick is written as what is different from the tick before: `TickBook` knows that one.
Predicates are written as the model's language prints them, and are resolved again in the names of the station.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final, get_args

from pydantic import JsonValue

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.control.happenings import Happening, Ticked
from sequence_planner.control.moment import Moment
from sequence_planner.expressions.parser import parse_formula
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.resolution import Scope, resolve_formula
from sequence_planner.expressions.syntax import Expression, ExpressionError
from sequence_planner.expressions.types import Value
from sequence_planner.history.shapes import Shape, Shapes, UnreadableError
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.plan import PlanRequest, Proof

Document = dict[str, Any]  # of JSON


def kind_of(happening: type) -> str:
    """The kind of the records of a class of happenings: `ModeChanged` is `mode-changed`."""
    return re.sub(r"(?<!^)(?=[A-Z])", "-", happening.__name__).lower()


KINDS: Final[Mapping[str, type]] = {kind_of(each): each for each in get_args(Happening)}
TICKED: Final = kind_of(Ticked)
BEGUN: Final = "begun"
SNAPSHOT: Final = "snapshot"
_MOST_TEXTS: Final = 10_000  # of predicates that are kept


class Codec:
    """Writes and reads values of one station. Reading raises `UnreadableError`."""

    def __init__(self, automaton: Automaton) -> None:
        self._predicates = _Predicates(automaton)
        self._trees = Shapes().of(Expression)
        own = {Expression: Shape(self._written, self._expression), State: Shape(dict, _state)}
        self._shapes = Shapes(own, dropped=(Proof,))
        request = self._shapes.of(PlanRequest)
        own[PlanRequest] = Shape(lambda value: request.encode(_without_deadline(value)), request.decode)
        self._shapes = Shapes(own, dropped=(Proof,))

    def encode(self, form: Any, value: object) -> JsonValue:  # noqa: ANN401 - what annotations are is no type
        """The document of a value of the type `form`."""
        return self._shapes.of(form).encode(value)

    def decode(self, form: Any, document: JsonValue) -> Any:  # noqa: ANN401
        """The value of the type `form` that a document has."""
        return self._shapes.of(form).decode(document)

    def happening(self, kind: str, content: Mapping[str, JsonValue]) -> Happening:
        """What a record says that has happened, no tick. Raises `UnreadableError`."""
        happening: Happening = self.decode(KINDS[kind], content.get("what", {}))
        return happening

    def content(self, happening: Happening) -> Document:
        """What a record says of what has happened, no tick."""
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
    """What a tick is given, but for when it is."""

    measured: Mapping[str, Value | None] = {}
    obstacles: tuple[str, ...] = ()
    silent: frozenset[str] = frozenset()


class TickBook:
    """Writes ticks as what is different from the one before, and reads them so."""

    def __init__(self, senses: Senses | None = None) -> None:
        self.senses = senses or Senses()  # of the last tick

    def content(self, tick: Ticked) -> Document:
        """What a record says of a tick, which is the last one from now on."""
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
        return Ticked(measured, obstacles, silent, Moment(epoch, monotonic))


def _without_deadline(request: PlanRequest) -> PlanRequest:
    """How long an answer might take is nothing that anything follows from."""
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
        self._scope = Scope(automaton.types)
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
