"""A reader of the part of PDDL that is exported, and a search that shares nothing with ours: sets of facts, no more."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

Facts = frozenset[str]
Tree = Any  # a word, or a list of trees
Test = Callable[[Facts], bool]


@dataclass(frozen=True)
class Operator:
    """An action: where it is possible, and what facts come and go, each where its own condition holds."""

    name: str
    possible: Test
    effects: tuple[tuple[Test, str, bool], ...]

    def after(self, facts: Facts) -> Facts:
        """All effects at once; what comes wins over what goes (Fox and Long 2003)."""
        taken = [(fact, comes) for where, fact, comes in self.effects if where(facts)]
        gone = {fact for fact, comes in taken if not comes}
        return (facts - gone) | {fact for fact, comes in taken if comes}


class PddlProblem:
    """A domain with a problem of it."""

    def __init__(self, domain: str, problem: str) -> None:
        (declared,), (asked,) = _trees(domain), _trees(problem)
        sections = {section[0]: section for section in declared[2:] if section[0] != ":action"}
        self.constants = set(sections[":constants"][1:])
        self.predicates = {predicate[0]: len(predicate) - 1 for predicate in sections[":predicates"][1:]}
        self.operators = [self._operator(section) for section in declared[2:] if section[0] == ":action"]
        assert len({operator.name for operator in self.operators}) == len(self.operators)
        parts = {section[0]: section for section in asked[2:]}
        assert parts[":domain"][1] == declared[1][1]
        self.initial = frozenset(map(self._fact, parts[":init"][1:]))
        self._goal = self._test(parts[":goal"][1])

    def cheapest(self, costly: str) -> tuple[int, str] | None:
        """The fewest actions called `costly` that lead to the goal, and such a plan, an action on each line."""
        before: dict[Facts, tuple[Facts, str] | None] = {self.initial: None}
        best = {self.initial: 0}
        pending = deque([self.initial])
        done = set[Facts]()
        while pending:
            facts = pending.popleft()
            if facts in done:
                continue
            done.add(facts)
            if self._goal(facts):
                return best[facts], "\n".join(reversed(list(_way(before, facts))))
            for operator in self.operators:
                if operator.possible(facts):
                    after, price = operator.after(facts), best[facts] + (operator.name == costly)
                    if after not in best or price < best[after]:
                        best[after], before[after] = price, (facts, operator.name)
                        (pending.append if operator.name == costly else pending.appendleft)(after)
        return None

    def _operator(self, section: Tree) -> Operator:
        assert section[2:4] == [":parameters", []]
        assert section[4] == ":precondition"
        assert section[6] == ":effect"
        effects: list[tuple[Test, str, bool]] = []
        self._collect(section[7], lambda _: True, effects)
        return Operator(section[1], self._test(section[5]), tuple(effects))

    def _collect(self, tree: Tree, where: Test, effects: list[tuple[Test, str, bool]]) -> None:
        if tree[0] == "and":
            for part in tree[1:]:
                self._collect(part, where, effects)
        elif tree[0] == "when":
            self._collect(tree[2], self._test(tree[1]), effects)
        elif tree[0] == "not":
            effects.append((where, self._fact(tree[1]), False))
        else:
            effects.append((where, self._fact(tree), True))

    def _test(self, tree: Tree) -> Test:
        if tree[0] in ("and", "or"):
            parts = [self._test(part) for part in tree[1:]]
            if tree[0] == "and":
                return lambda facts: all(part(facts) for part in parts)
            return lambda facts: any(part(facts) for part in parts)
        if tree[0] == "not":
            inner = self._test(tree[1])
            return lambda facts: not inner(facts)
        fact = self._fact(tree)
        return lambda facts: fact in facts

    def _fact(self, tree: Tree) -> str:
        assert len(tree) - 1 == self.predicates[tree[0]]
        assert self.constants.issuperset(tree[1:])
        return " ".join(tree)


def _way(before: dict[Facts, tuple[Facts, str] | None], facts: Facts) -> Iterator[str]:
    while (step := before[facts]) is not None:
        facts, name = step
        yield f"({name})"


def _trees(text: str) -> list[Tree]:
    stack: list[list[Tree]] = [[]]
    for token in re.findall(r"[()]|[^\s()]+", text):
        if token == "(":
            stack.append([])
        elif token == ")":
            inner = stack.pop()
            stack[-1].append(inner)
        else:
            stack[-1].append(token)
    assert len(stack) == 1
    return stack[0]
