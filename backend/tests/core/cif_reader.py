"""Reads the part of the language CIF that exports use, and refuses all else: names that are not declared, types that do
not match, and operators whose binding a reader would have to know.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

Value = bool | int | str
State = Mapping[str, Value]
Meaning = Callable[[State], Value]
# `bool`, `int`, or the name of an enumeration.
Typed = tuple[str, Meaning]

TOKEN = re.compile(r"\s*(?:(\$?[A-Za-z_][A-Za-z0-9_]*)|(0|[1-9][0-9]*)|(:=|!=|<=>|<=|>=|=>|\.\.|[-+<>=,;:()\[\]]))")
RESERVED = frozenset(
    (
        *("any", "automaton", "bool", "controllable", "disc", "do", "edge", "end", "enum", "false", "in", "initial"),
        *("int", "invariant", "location", "marked", "not", "and", "or", "plant", "requirement", "true"),
        *("uncontrollable", "when"),
    )
)
SIGNS: Mapping[str, Callable[[int, int], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


@dataclass(frozen=True)
class Edge:
    event: str
    guard: Meaning
    updates: Mapping[str, Meaning]

    def after(self, state: State) -> State | None:
        return {**state, **{n: value(state) for n, value in self.updates.items()}} if self.guard(state) else None


@dataclass
class Specification:
    """What a text declares; `initial_values` are None where a variable begins with any value."""

    enumerations: dict[str, list[str]] = field(default_factory=dict)
    events: dict[str, bool] = field(default_factory=dict)  # whether it is controllable
    domains: dict[str, tuple[Value, ...]] = field(default_factory=dict)
    types: dict[str, str] = field(default_factory=dict)
    initial_values: dict[str, Value | None] = field(default_factory=dict)
    invariants: list[Meaning] = field(default_factory=list)
    initial: Meaning = lambda _: True
    marked: Meaning = lambda _: True
    edges: list[Edge] = field(default_factory=list)


def read_cif(text: str) -> Specification:
    text.encode("ascii")
    lines = [line for line in text.split("\n") if not line.strip().startswith("//")]
    return _Reader("\n".join(lines)).specification()


class _Reader:
    def __init__(self, text: str) -> None:
        self._tokens: list[str] = []
        end = 0
        while text[end:].strip():
            match = TOKEN.match(text, end)
            assert match is not None, text[end : end + 40]
            self._tokens.append(match[0].strip())
            end = match.end()
        self._tokens.append("")
        self._at = 0
        self._found = Specification()
        self._names: set[str] = set()

    def specification(self) -> Specification:
        found = self._found
        while self._take_if("enum"):
            name = self._declare()
            self._expect("=")
            literals = [self._declare()]
            while self._take_if(","):
                literals.append(self._declare())
            found.enumerations[name] = literals
            self._expect(";")
        while self._next in ("controllable", "uncontrollable"):
            controllable = self._take() == "controllable"
            found.events[self._declare()] = controllable
            self._expect(";")
        self._expect("plant", "automaton")
        self._declare()
        self._expect(":")
        while self._take_if("disc"):
            self._variable()
        while self._take_if("requirement"):
            self._expect("invariant")
            found.invariants.append(self._predicate())
            self._expect(";")
        self._expect("location", ":", "initial")
        found.initial = self._predicate_or_true()
        self._expect("marked")
        found.marked = self._predicate_or_true()
        while self._take_if("edge"):
            found.edges.append(self._edge())
        self._expect("end", "")
        assert {edge.event for edge in found.edges} == set(found.events)
        return found

    @property
    def _next(self) -> str:
        return self._tokens[self._at]

    def _take(self) -> str:
        self._at += 1
        return self._tokens[self._at - 1]

    def _take_if(self, token: str) -> bool:
        found = self._next == token
        self._at += found
        return found

    def _expect(self, *tokens: str) -> None:
        for token in tokens:
            assert self._take() == token, (token, self._tokens[self._at - 5 : self._at + 5])

    def _name(self) -> str:
        name = self._take()
        assert re.match(r"[$A-Za-z_]", name), name
        assert name not in RESERVED, name
        return name.removeprefix("$")

    def _declare(self) -> str:
        name = self._name()
        assert name not in self._names, f"{name} twice"
        self._names.add(name)
        return name

    def _variable(self) -> None:
        found, type_ = self._found, self._take()
        domain: tuple[Value, ...]
        if type_ == "int":
            self._expect("[")
            least = int(self._take())
            self._expect("..")
            domain = tuple(range(least, int(self._take()) + 1))
            self._expect("]")
        else:
            type_ = type_.removeprefix("$")
            domain = (False, True) if type_ == "bool" else tuple(found.enumerations[type_])
        assert domain
        name = self._declare()
        found.types[name], found.domains[name] = type_, domain
        if self._take_if("in"):
            self._expect("any")
            found.initial_values[name] = None
        else:
            self._expect("=")
            kind, value = self._expression()
            assert kind == type_
            found.initial_values[name] = value({})
            assert value({}) in domain
        self._expect(";")

    def _edge(self) -> Edge:
        event = self._name()
        assert event in self._found.events
        guard: Meaning = self._predicate() if self._take_if("when") else lambda _: True
        updates: dict[str, Meaning] = {}
        if self._take_if("do"):
            while True:
                name = self._name()
                assert name not in updates
                self._expect(":=")
                kind, updates[name] = self._expression()
                assert kind == self._found.types[name]
                if not self._take_if(","):
                    break
        self._expect(";")
        return Edge(event, guard, updates)

    def _predicate_or_true(self) -> Meaning:
        if self._take_if(";"):
            return lambda _: True
        predicate = self._predicate()
        self._expect(";")
        return predicate

    def _predicate(self) -> Meaning:
        kind, meaning = self._expression()
        assert kind == "bool"
        return meaning

    def _expression(self) -> Typed:
        """Operands of `=>` and `<=>` are atoms, so that their binding does not matter, and neither does mixing."""
        start = self._at
        left = self._several()
        if self._next not in ("=>", "<=>"):
            return left
        assert self._is_atom(start), self._tokens[start : self._at]
        sign, start = self._take(), self._at
        right = self._several()
        assert self._is_atom(start), self._tokens[start : self._at]
        (one, first), (other, second) = left, right
        assert one == other == "bool"
        if sign == "=>":
            return "bool", lambda s: not first(s) or second(s)
        return "bool", lambda s: first(s) == second(s)

    def _is_atom(self, start: int) -> bool:
        return self._at == start + 1 or (self._tokens[start], self._tokens[self._at - 1]) == ("(", ")")

    def _several(self) -> Typed:
        """All `and` or all `or`: their mixture needs brackets."""
        parts = [self._relation()]
        sign = self._next
        while sign in ("and", "or") and self._take_if(sign):
            parts.append(self._relation())
        if len(parts) == 1:
            return parts[0]
        assert all(kind == "bool" for kind, _ in parts)
        assert self._next not in ("and", "or")
        every = all if sign == "and" else any
        return "bool", lambda s: every([meaning(s) for _, meaning in parts])

    def _relation(self) -> Typed:
        if self._take_if("not"):
            kind, meaning = self._atom()
            assert kind == "bool"
            assert self._next not in ("=", "!=", *SIGNS)
            return "bool", lambda s: not meaning(s)
        one, first = self._sum()
        sign = self._next
        if sign not in ("=", "!=", *SIGNS):
            return one, first
        self._take()
        other, second = self._sum()
        assert one == other != "bool"
        assert self._next not in ("=", "!=", *SIGNS)
        if sign in SIGNS:
            assert one == "int"
            return "bool", lambda s: SIGNS[sign](int(first(s)), int(second(s)))
        return "bool", lambda s: (first(s) == second(s)) == (sign == "=")

    def _sum(self) -> Typed:
        kind, total = self._atom()
        while self._next in ("+", "-"):
            sign = self._take()
            other, value = self._atom()
            assert kind == other == "int"
            total = _added(total, value, 1 if sign == "+" else -1)
        return kind, total

    def _atom(self) -> Typed:
        if self._take_if("("):
            inside = self._expression()
            self._expect(")")
            return inside
        if self._next in ("true", "false"):
            truth = self._take() == "true"
            return "bool", lambda _: truth
        if self._next.isdigit():
            number = int(self._take())
            return "int", lambda _: number
        name = self._name()
        for enumeration, literals in self._found.enumerations.items():
            if name in literals:
                return enumeration, lambda _: name
        return self._found.types[name], lambda s: s[name]


def _added(total: Meaning, value: Meaning, sign: int) -> Meaning:
    return lambda s: int(total(s)) + sign * int(value(s))
