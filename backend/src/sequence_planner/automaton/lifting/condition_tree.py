"""A condition as a tree of its parts in a state, down to the comparisons that decide whether it holds."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from typing import NamedTuple

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.lifting.wording import ToldPart, phrase, wording_of
from sequence_planner.language.evaluator import evaluate, greatest, least
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    And,
    Comparison,
    Expression,
    Implies,
    Membership,
    Name,
    Not,
    Or,
    Quantified,
    Variable,
    conjuncts,
)


class TreeKind(StrEnum):
    """How the truth of a part follows from its own parts."""

    ALL = "all"
    ANY = "any"
    NOT = "not"
    IMPLIES = "implies"
    SAME = "same"  # a name for its only part: a predicate of the model, or a flag
    LEAF = "leaf"


class ConditionTree(NamedTuple):
    """A part of a condition. `text` is how the model says it, and `predicate` the one of its predicates that has a name
    for it.

    `holds` is None as long as unknown values leave it open. It `decides` if the whole is as it is because of it: the
    whole stays so whatever all other leaves were, and would not if all leaves that decide were otherwise. `wanted` is
    what it would have to be for the whole to hold.
    """

    kind: TreeKind
    condition: Expression
    text: str
    holds: bool | None
    decides: bool
    wanted: bool
    predicate: str | None = None
    parts: tuple[ConditionTree, ...] = ()

    def combined(self) -> bool | None:
        """What follows for it from its parts. A leaf has none, and is what it is."""
        truths = [part.holds for part in self.parts]
        match self.kind:
            case TreeKind.ALL:
                return least(truths)
            case TreeKind.ANY:
                return greatest(truths)
            case TreeKind.NOT:
                return _denied(truths[0])
            case TreeKind.IMPLIES:
                return greatest((_denied(truths[0]), truths[1]))
            case TreeKind.SAME:
                return truths[0]
            case TreeKind.LEAF:
                return self.holds


def condition_tree(automaton: Automaton, condition: Expression, state: State, *, wanted: bool = True) -> ConditionTree:
    """The tree of a ground condition in a state whose flags follow from its variables, and which is to be `wanted`."""
    return _Planting(automaton, state).tree(condition, decides=True, wanted=wanted)


def _denied(truth: bool | None) -> bool | None:
    return None if truth is None else not truth


class _Planting:
    """Makes trees of conditions in one state."""

    def __init__(self, automaton: Automaton, state: State) -> None:
        self._automaton, self._state = automaton, state
        self._wording = wording_of(automaton)

    def tree(self, condition: Expression, *, decides: bool, wanted: bool) -> ConditionTree:
        truth = self._truth(condition)
        told = self._wording.told_parts(condition)
        words = told[0].words if len(told) == 1 else None
        predicate = self._predicate(words)
        kind, parts = self._parts(condition, told, words, truth)
        planted: tuple[ConditionTree, ...]
        if kind is TreeKind.LEAF and predicate is not None:
            below = ConditionTree(kind, condition, print_expression(condition), truth, decides, wanted)
            kind, planted = TreeKind.SAME, (below,)
        else:
            planted = tuple(
                self.tree(part, decides=decides and self._truth(part) is asked, wanted=should)
                for part, asked, should in _asked(kind, parts, truth, wanted)
            )
        return ConditionTree(kind, condition, phrase(*told), truth, decides, wanted, predicate, planted)

    def _truth(self, condition: Expression) -> bool | None:
        truth = evaluate(condition, self._state)
        assert truth is None or isinstance(truth, bool)
        return truth

    def _predicate(self, words: Expression | None) -> str | None:
        """The predicate that has a name for a part, or for its contrary, with its arguments."""
        call = words.operand if isinstance(words, Not) else words
        if not isinstance(call, Name):
            return None
        without = ".".join(part.name for part in call.path)
        return str(call) if without in self._automaton.vocabulary.predicates else None

    def _parts(
        self, condition: Expression, told: tuple[ToldPart, ...], words: Expression | None, truth: bool | None
    ) -> tuple[TreeKind, tuple[Expression, ...]]:
        """How a condition is put together, and of what."""
        match condition:
            case And() if len(told) > 1:
                together = tuple(part.condition for part in told)
                same = least(map(self._truth, together)) is truth  # unknown values can make a difference
                return TreeKind.ALL, together if same else tuple(conjuncts(condition))
            case And() | Or() if self._is_one(words):
                return TreeKind.LEAF, ()
            case And():
                return TreeKind.ALL, tuple(conjuncts(condition))
            case Or(operands):
                return TreeKind.ANY, operands
            case Implies(left, right):
                return TreeKind.IMPLIES, (left, right)
            case Not(Variable(name)) if name in self._automaton.flag_predicates:
                return TreeKind.NOT, (self._automaton.flag_predicates[name],)
            case Not(operand) if not isinstance(operand, Variable | Comparison | Membership):
                return TreeKind.NOT, (operand,)
            case Variable(name) if name in self._automaton.flag_predicates:
                return TreeKind.SAME, (self._automaton.flag_predicates[name],)
        return TreeKind.LEAF, ()

    def _is_one(self, words: Expression | None) -> bool:
        """Return whether the model has words for all of it that relate values: `a == b`, `is_next(a, b)`."""
        said = words.operand if isinstance(words, Not) else words
        if isinstance(said, Name):
            return self._predicate(said) is None
        return said is not None and not isinstance(said, And | Or | Implies | Quantified | Not)


def _asked(
    kind: TreeKind, parts: Iterable[Expression], truth: bool | None, wanted: bool
) -> Iterable[tuple[Expression, bool | None, bool]]:
    """Each part with the truth with which it decides, and what it would have to be."""
    for place, part in enumerate(parts):
        turned = kind is TreeKind.NOT or (kind is TreeKind.IMPLIES and place == 0)
        yield part, _denied(truth) if turned else truth, wanted is not turned
