"""Plain automata straight from their documents: plain sets of states, and each transition taken as it is written.

It knows nothing of grounding, of a cone of influence or of columns, so that agreement means something.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse
from sequence_planner.language.resolver import resolve_assignment, resolve_predicate
from sequence_planner.language.syntax import Assignment, Component, Name
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value

Key = tuple[Value, ...]
Test = Callable[[Key], bool]


def type_of(domain: object) -> Type:
    if isinstance(domain, dict):
        return IntegerRange(domain["min"], domain["max"])
    return EnumerationType(tuple(domain)) if isinstance(domain, list) else BOOLEAN


@dataclass(frozen=True)
class ExplicitPlain:
    """All states of a document that has every entry, with what can happen in each."""

    document: Mapping[str, Any]

    @cached_property
    def types(self) -> dict[str, Type]:
        return {name: type_of(domain) for name, domain in self.document["variables"].items()}

    def valuation(self, key: Key) -> dict[str, Value]:
        return dict(zip(self.types, key, strict=True))

    def _test(self, text: str) -> Test:
        predicate = resolve_predicate(parse(text), NameScope(self.types))
        return lambda key: evaluate(predicate, self.valuation(key)) is True

    def _where(self, *texts: str) -> frozenset[Key]:
        tests = [self._test(text) for text in texts]
        return frozenset(key for key in self.states if any(test(key) for test in tests))

    @cached_property
    def states(self) -> frozenset[Key]:
        """Those that satisfy the invariant: there are no others."""
        exists = self._test(self.document["invariant"])
        return frozenset(key for key in product(*(type_.domain for type_ in self.types.values())) if exists(key))

    @cached_property
    def initial(self) -> frozenset[Key]:
        return self._where(self.document["initial"])

    @cached_property
    def steps(self) -> dict[bool, dict[Key, set[Key]]]:
        """Where each state can go, by whether that is controllable."""
        found: dict[bool, dict[Key, set[Key]]] = {kind: {key: set() for key in self.states} for kind in (False, True)}
        for transition in self.document["transitions"]:
            for key, after in self.taken(transition).items():
                found[transition["controllable"]][key].add(after)
        return found

    def taken(self, transition: Mapping[str, Any]) -> dict[Key, Key]:
        """Where one transition leads, from each state in which it is enabled."""
        guard = self._test(transition["guard"])
        found: dict[Key, Key] = {}
        for key in filter(guard, self.states):
            after = {**self.valuation(key)}
            for name, update in transition["set"].items():
                after[name] = self._value(name, update, key)
            if (target := tuple(after.values())) in self.states:  # neither out of range nor outside the invariant
                found[key] = target
        return found

    def _value(self, name: str, update: bool | int | str, key: Key) -> Value:
        if not isinstance(update, str):
            return update
        action = resolve_assignment(Assignment(Name((Component(name),)), parse(update)), NameScope(self.types))
        value = evaluate(action.value, self.valuation(key))
        assert value is not None
        return value

    @cached_property
    def safe(self) -> frozenset[Key]:
        """The greatest set without forbidden states that nothing uncontrollable leaves, and that can reach a marked
        state inside.
        """
        marked = self._where(self.document["marked"])
        safe = self.states - self._where(*self.document["forbidden"])
        while True:
            closed = frozenset(key for key in safe if self.steps[False][key] <= safe)
            kept = set(closed & marked)
            while more := {k for k in closed - kept if (self.steps[False][k] | self.steps[True][k]) & kept}:
                kept |= more
            if kept == safe:
                return safe
            safe = frozenset(kept)

    def distances(self, begin: Iterable[Key], supervised: bool) -> dict[Key, int]:
        """How many transitions away each state is that can be reached from `begin`, with or without the supervisor."""
        found = dict.fromkeys(begin, 0)
        layer = set(found)
        while layer:
            following: set[Key] = set()
            for key in layer:
                allowed = self.steps[True][key] & self.safe if supervised and key in self.safe else set[Key]()
                following |= self.steps[False][key] | (allowed if supervised else self.steps[True][key])
            layer = following - found.keys()
            found |= dict.fromkeys(layer, max(found.values()) + 1)
        return found
