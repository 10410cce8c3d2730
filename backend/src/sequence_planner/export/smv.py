"""Questions in the language of the model checkers NuSMV and nuXmv.

Each step of the module takes one action, which the input `action` chooses. The invariant says that the goals are not
all reached: a counterexample is a plan, and where it is proven there is none. Source: the NuSMV 2.6 user manual, 2.1 to
2.4.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from sequence_planner.export.efa import different, word
from sequence_planner.export.sequential import ConditionalUpdate, Move, Sequential
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Arithmetic,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
)
from sequence_planner.language.types import BooleanType, IntegerRange, Type, Value

# Words of the language, which no name can be.
_WORDS = """
MODULE DEFINE MDEFINE CONSTANTS VAR IVAR FROZENVAR INIT TRANS INVAR SPEC CTLSPEC LTLSPEC PSLSPEC COMPUTE NAME
INVARSPEC FAIRNESS JUSTICE COMPASSION ISA ASSIGN CONSTRAINT SIMPWFF CTLWFF LTLWFF PSLWFF COMPWFF IN MIN MAX MIRROR
PRED PREDICATES process array of boolean integer real word word1 bool signed unsigned extend resize sizeof uwconst
swconst EX AX EF AF EG AG E F O G H X Y Z A U S V T BU EBF ABF EBG ABG case esac mod next init union in xor xnor
self TRUE FALSE count abs max min action
"""
_RESERVED = frozenset(_WORDS.split())


def smv_text(question: Sequential) -> str:
    """The question as a module."""
    return "\n".join((*_Writer(question).lines(), ""))


class _Writer:
    def __init__(self, question: Sequential) -> None:
        self._question = question
        self._variables = different(question.types, word, _RESERVED)
        values = dict.fromkeys(v for t in question.types.values() for v in t.domain if isinstance(v, str))
        taken = _RESERVED | frozenset(self._variables.values())
        self._values = different(values, lambda value: f"v_{word(value)}", taken)
        taken |= frozenset(self._values.values())
        self._actions = different(((a.move, a.name) for a in question.actions), _action_word, taken)

    def lines(self) -> Iterator[str]:
        """The text, line by line."""
        question = self._question
        yield f"-- {' '.join(question.title.split())}"
        yield "MODULE main"
        yield "IVAR"
        yield f"  action : {{{', '.join(self._actions.values())}}};"
        yield "VAR"
        yield from (f"  {self._variables[name]} : {self._domain(type_)};" for name, type_ in question.types.items())
        yield "ASSIGN"
        for name, value in question.initial.items():
            yield f"  init({self._variables[name]}) := {self._value(value)};"
        written: dict[str, list[tuple[str, ConditionalUpdate]]] = defaultdict(list)
        for action in question.actions:
            for update in action.updates:
                written[update.variable].append((self._actions[action.move, action.name], update))
        for name in question.types:
            yield from self._next(name, written[name])
        for action in question.actions:
            guard = self._expression(action.guard)
            yield f"TRANS action = {self._actions[action.move, action.name]} -> {guard};"
        yield f"INVARSPEC !{self._expression(question.goal)};"

    def _next(self, name: str, written: list[tuple[str, ConditionalUpdate]]) -> Iterator[str]:
        """Yield what the actions make of a variable; what becomes true wins over what becomes false."""
        yield f"  next({self._variables[name]}) := case"
        for action, update in sorted(written, key=lambda each: each[1].value is False):
            where = "" if update.condition == TRUE else f" & {self._expression(update.condition)}"
            yield f"    action = {action}{where} : {self._value(update.value)};"
        yield f"    TRUE : {self._variables[name]};"
        yield "  esac;"

    def _domain(self, type_: Type) -> str:
        if isinstance(type_, IntegerRange):
            return f"{type_.minimum}..{type_.maximum}"
        return "boolean" if isinstance(type_, BooleanType) else f"{{{', '.join(map(self._value, type_.domain))}}}"

    def _value(self, value: Value) -> str:
        if isinstance(value, bool):
            return "TRUE" if value else "FALSE"
        return str(value) if isinstance(value, int) else self._values[value]

    def _expression(self, expression: Expression) -> str:
        """With a pair of brackets around everything that has parts."""
        part = self._expression
        match expression:
            case Constant(value):
                return self._value(value)
            case Variable(name):
                return self._variables[name]
            case Not(operand):
                return f"(!{part(operand)})"
            case And(operands):
                return f"({' & '.join(map(part, operands))})"
            case Or(operands):
                return f"({' | '.join(map(part, operands))})"
            case Implies(left, right):
                return f"({part(left)} -> {part(right)})"
            case Comparison(operator, left, right):
                return f"({part(left)} {'=' if operator == '==' else operator} {part(right)})"
            case Arithmetic(operator, left, right):
                return f"({part(left)} {operator} {part(right)})"
            case Membership(left, options):
                return f"({part(left)} in {{{', '.join(map(part, options))}}})"
        raise TypeError(f"no predicate: {expression}")


def _action_word(key: tuple[Move, str]) -> str:
    move, name = key
    return f"{move}_{word(name)}" if name else str(move)
