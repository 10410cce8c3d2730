"""A reader of the modules that are exported, in the few forms they have, and a search in them."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any

Values = Mapping[str, Any]
Read = Callable[[Values], Any]

_TOKENS = re.compile(r"-?\d+\.\.-?\d+|\d+|[A-Za-z_][\w$#-]*|->|!=|<=|>=|[-+!&|=<>(){},]")
_BINARY: Mapping[str, Callable[[Any, Any], Any]] = {
    "&": lambda a, b: a and b,
    "|": lambda a, b: a or b,
    "->": lambda a, b: not a or b,
    "=": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "in": lambda a, b: a in b,
}


class Module:
    """The module of a text: its variables with their domains, what each action does, and what shall never be."""

    def __init__(self, text: str) -> None:
        (inputs,) = re.findall(r"^  action : \{(.*)\};$", text, re.MULTILINE)
        self.actions: list[str] = inputs.split(", ")
        declared = re.findall(r"^  (\S+) : (.*);$", text.partition("VAR\n")[2].partition("\nVAR\n")[2], re.MULTILINE)
        self.domains = {name: _domain(written) for name, written in declared}
        initial = dict(re.findall(r"^  init\((\S+)\) := (.*);$", text, re.MULTILINE))
        self.initial = {name: _read(initial[name])({}) for name in self.domains}
        cases = re.findall(r"^  next\((\S+)\) := case\n((?:    .*\n)*)  esac;$", text, re.MULTILINE)
        assert [name for name, _ in cases] == list(self.domains)
        self._next = {name: [_case(line) for line in lines.splitlines()] for name, lines in cases}
        self._possible = [_read(each) for each in re.findall(r"^TRANS (.*);$", text, re.MULTILINE)]
        (invariant,) = re.findall(r"^INVARSPEC (.*);$", text, re.MULTILINE)
        self._invariant = _read(invariant)

    def after(self, values: Values, action: str) -> Values | None:
        """The values after an action, or None where it is not possible."""
        given = {**values, "action": action}
        if not all(possible(given) for possible in self._possible):
            return None
        after = {name: next(value(given) for where, value in self._next[name] if where(given)) for name in values}
        assert all(after[name] in domain for name, domain in self.domains.items())
        return after

    def cheapest(self, costly: str) -> int | None:
        """The fewest actions called `costly` on a way to a state that violates the invariant."""
        names = list(self.domains)
        first = tuple(self.initial[name] for name in names)
        best, pending, done = {first: 0}, deque([first]), set[tuple[Any, ...]]()
        while pending:
            key = pending.popleft()
            if key in done:
                continue
            done.add(key)
            values = dict(zip(names, key, strict=True))
            if not self._invariant(values):
                return best[key]
            for action in self.actions:
                after = self.after(values, action)
                if after is not None:
                    found, price = tuple(after.values()), best[key] + (action == costly)
                    if price < best.get(found, price + 1):
                        best[found] = price
                        (pending.append if action == costly else pending.appendleft)(found)
        return None


def _domain(written: str) -> list[Any]:
    if written == "boolean":
        return [False, True]
    if written.startswith("{"):
        return written[1:-1].split(", ")
    least, most = map(int, written.split(".."))
    return list(range(least, most + 1))


def _case(line: str) -> tuple[Read, Read]:
    case = re.fullmatch(r"    (.*) : (.*);", line)
    assert case is not None, line
    where, value = case.groups()
    return _read(where), _read(value)


def _read(text: str) -> Read:
    tokens = _TOKENS.findall(text)
    assert "".join(tokens) == text.replace(" ", "")
    tokens.append("")
    read = _operators(tokens)
    assert tokens == [""]
    return read


def _operators(tokens: list[str]) -> Read:
    """Operators from left to right: what is mixed has brackets, but for `action = a &` and `action = a ->`."""
    left = _operand(tokens)
    while (sign := tokens[0]) in _BINARY:
        tokens.pop(0)
        left = _joined(_BINARY[sign], left, _operand(tokens))
    return left


def _joined(operation: Callable[[Any, Any], Any], left: Read, right: Read) -> Read:
    return lambda values: operation(left(values), right(values))


def _operand(tokens: list[str]) -> Read:
    token = tokens.pop(0)
    if token == "(":
        inner = _operators(tokens)
        assert tokens.pop(0) == ")"
        return inner
    if token == "!":
        operand = _operand(tokens)
        return lambda values: not operand(values)
    if token == "{":
        options = [_operand(tokens)]
        while tokens.pop(0) == ",":
            options.append(_operand(tokens))
        return lambda values: [option(values) for option in options]
    if token == "-":
        number = int(tokens.pop(0))
        return lambda _: -number
    if token.isdigit():
        return lambda _: int(token)
    if token in ("TRUE", "FALSE"):
        return lambda _: token == "TRUE"
    return lambda values: values.get(token, token)
