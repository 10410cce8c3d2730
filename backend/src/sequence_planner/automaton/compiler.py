"""Compilation of expressions and of a whole automaton into Python functions for the compiled tick."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from operator import itemgetter
from typing import Any, NamedTuple, TypeVar

from sequence_planner.automaton.automaton import Ability, Automaton, State, reads, target
from sequence_planner.automaton.tick import Writes
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.evaluator import RELATIONS, Valuation, evaluate, holds
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Implies,
    Membership,
    Not,
    Or,
    Variable,
    conjunction,
    occurrences,
    variables,
)
from sequence_planner.language.types import BOOLEAN, Value

# Expressions as Python source over a dictionary `s`, in dual-rail form.
#
# Three truth values take two Python expressions, each plainly true or false: one for *certainly true*, the other for
# *certainly false*. Unknown is neither. So the connectives of Kleene become those of Python, `and` on one rail and `or`
# on the other, negation swaps the rails, and only the leaves ever look for None.

DEEPEST = 40  # of nested operators: Python nests at most 200 brackets, and an operator opens up to two
LONGEST = 20_000  # characters: an equality of two predicates repeats both of them


class TooComplex(Exception):
    """Python would not compile this, or only after very long."""


class Rails(NamedTuple):
    """Sources that are true when a predicate is certainly true, and when it is certainly false."""

    true: str
    false: str


def predicate_rails(expression: Expression, depth: int = 0) -> Rails:
    """The rails of a resolved predicate. Raises `TooComplex`; TypeError for what is no predicate over one state."""
    match expression:
        case Constant(value):
            return Rails(str(value is True), str(value is False))
        case Variable():
            name = _read(expression)
            return Rails(name, f"{name} is False")
        case Not(operand):
            true, false = _operand(operand, depth)
            return Rails(false, true)
        case And(operands):
            parts = [_operand(operand, depth) for operand in operands]
            return Rails(_joined("and", *(part.true for part in parts)), _joined("or", *(part.false for part in parts)))
        case Or(operands):
            parts = [_operand(operand, depth) for operand in operands]
            return Rails(_joined("or", *(part.true for part in parts)), _joined("and", *(part.false for part in parts)))
        case Implies(left, right):
            premise, conclusion = _operand(left, depth), _operand(right, depth)
            return Rails(_joined("or", premise.false, conclusion.true), _joined("and", premise.true, conclusion.false))
        case Comparison(relation, left, right):
            return _comparison(relation, left, right, depth)
        case Membership(left, options):
            return _membership(left, options, depth)
        case _:
            raise TypeError(f"no predicate over one state: {expression}")


def truth(expression: Expression) -> str:
    """The source of a predicate's truth value: True, False or None. Raises `TooComplex`."""
    true, false = predicate_rails(expression)
    return f"True if {true} else False if {false} else None"


def value(expression: Expression) -> str:
    """The source of an expression's value, None where it is unknown. Raises `TooComplex`."""
    if isinstance(expression, Constant | Variable):
        return _number(expression, 0)
    if isinstance(expression, Arithmetic):
        return f"{_number(expression, 0)} if {_known(expression)} else None"
    return truth(expression)


def _operand(expression: Expression, depth: int) -> Rails:
    if depth >= DEEPEST:
        raise TooComplex
    return predicate_rails(expression, depth + 1)


def _comparison(relation: str, left: Expression, right: Expression, depth: int) -> Rails:
    if _is_compound(left) or _is_compound(right):
        one, other = _operand(left, depth), _operand(right, depth)
        same = _joined("or", _joined("and", one.true, other.true), _joined("and", one.false, other.false))
        differ = _joined("or", _joined("and", one.true, other.false), _joined("and", one.false, other.true))
        return Rails(same, differ) if relation == "==" else Rails(differ, same)
    if isinstance(left, Constant):
        left, right, relation = right, left, _MIRRORED[relation]
    if relation in ("==", "!=") and isinstance(left, Variable) and isinstance(right, Constant):
        return _equality(left, right.value, relation)
    known, a, b = _known(left, right), _number(left, depth), _number(right, depth)
    return Rails(_joined("and", known, f"{a} {relation} {b}"), _joined("and", known, f"{a} {_OPPOSITE[relation]} {b}"))


_MIRRORED = {"==": "==", "!=": "!=", "<": ">", "<=": ">=", ">": "<", ">=": "<="}
_OPPOSITE = {"==": "!=", "!=": "==", "<": ">=", "<=": ">", ">": "<=", ">=": "<"}


def _equality(variable: Variable, constant: Value, relation: str) -> Rails:
    """The most frequent of all predicates, by one look at the variable on either rail."""
    name, literal = _read(variable), _literal(constant)
    same, differ = f"{name} == {literal}", f"{name} not in (None, {literal})"
    return Rails(same, differ) if relation == "==" else Rails(differ, same)


def _membership(left: Expression, options: tuple[Expression, ...], depth: int) -> Rails:
    constants = [_literal(option.value) for option in options if isinstance(option, Constant)]
    if isinstance(left, Variable) and constants and len(constants) == len(options):
        listed = ", ".join(constants)
        return Rails(f"{_read(left)} in ({listed},)", f"{_read(left)} not in (None, {listed})")
    if not options:
        return Rails("False", f"({value(left)}) is not None")
    parts = [_comparison("==", left, option, depth) for option in options]
    return Rails(_joined("or", *(part.true for part in parts)), _joined("and", *(part.false for part in parts)))


def _number(expression: Expression, depth: int) -> str:
    """The value of what is no compound predicate, given that its variables are known."""
    match expression:
        case Constant(constant):
            return _literal(constant)
        case Variable():
            return _read(expression)
        case Arithmetic(sign, left, right):
            if depth >= DEEPEST:
                raise TooComplex
            return f"({_number(left, depth + 1)} {sign} {_number(right, depth + 1)})"
        case _:
            raise TypeError(f"no value over one state: {expression}")


def _known(*expressions: Expression) -> str:
    names = dict.fromkeys(_read(variable) for expression in expressions for variable in occurrences(expression))
    return _joined("and", *(f"{name} is not None" for name in names))


def _is_compound(expression: Expression) -> bool:
    return not isinstance(expression, Constant | Variable | Arithmetic)


def _joined(connective: str, *parts: str) -> str:
    """`parts` as one operand; without any, they all hold."""
    if sum(map(len, parts)) > LONGEST:
        raise TooComplex
    if len(parts) < 2:
        return parts[0] if parts else "True"
    return f"({f' {connective} '.join(parts)})"


def _read(variable: Variable) -> str:
    return f"s[{_literal(variable.name)}]"


def _literal(constant: Value) -> str:
    return repr(str(constant)) if isinstance(constant, str) else repr(constant)


# Python functions from expressions: few calls of the compiler for many of them.

Function = Callable[[Valuation], Any]
Predicate = Callable[[Valuation], object]  # of a true result, if it certainly holds, and else of a false one
Truth = Callable[[Valuation], bool | None]
Evaluation = Callable[[Valuation], Value | None]

_BATCH = 100  # sources for one call of the compiler: many more take longer per source, and so do many fewer


class Compiler:
    """Compiles expressions that will be evaluated in states with the keys `names`.

    What Python cannot compile, because it nests too deeply or is too long, is interpreted instead.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self._keys = {name: name for name in names}

    def predicates(self, expressions: Iterable[Expression]) -> list[Predicate]:
        """For each expression, whether it certainly holds."""
        return self._functions(expressions, lambda expression: predicate_rails(expression).true, holds)

    def truths(self, expressions: Iterable[Expression]) -> list[Truth]:
        """For each expression its truth: True, False or None."""
        return self._functions(expressions, truth, evaluate)

    def values(self, expressions: Iterable[Expression]) -> list[Evaluation]:
        """For each expression its value, or None while it is unknown."""
        return self._functions(expressions, value, evaluate)

    def _functions(
        self,
        expressions: Iterable[Expression],
        source: Callable[[Expression], str],
        interpreter: Callable[[Expression, Valuation], object],
    ) -> list[Function]:
        """The functions in the order of their expressions; the same source is compiled once."""
        wanted: list[str | Function] = []
        for expression in expressions:
            try:
                wanted.append(source(expression))
            except TooComplex:
                wanted.append(partial(interpreter, expression))
        sources = list(dict.fromkeys(each for each in wanted if isinstance(each, str)))
        compiled: dict[str, Function] = {}
        for start in range(0, len(sources), _BATCH):
            batch = sources[start : start + _BATCH]
            compiled |= zip(batch, self._compiled(batch), strict=True)
        return [compiled[each] if isinstance(each, str) else each for each in wanted]

    def _compiled(self, sources: Sequence[str]) -> list[Function]:
        functions = eval(f"[{','.join(f'lambda s: {source}' for source in sources)}]", {"__builtins__": {}})
        for function in functions:
            # Looking up the very string that is the key takes half as long as looking up one that equals it.
            code = function.__code__
            function.__code__ = code.replace(co_consts=tuple(_same(self._keys, each) for each in code.co_consts))
        return list(functions)


def _same(keys: Mapping[str, str], constant: object) -> object:
    return keys.get(constant, constant) if isinstance(constant, str) else constant


# Python functions from expressions without the compiler: made at once, and half as fast as compiled ones.


class Closures:
    """Makes functions as `Compiler` does, for states with any keys."""

    def predicates(self, expressions: Iterable[Expression]) -> list[Predicate]:
        """For each expression, whether it certainly holds."""
        return list(map(closure, expressions))

    def truths(self, expressions: Iterable[Expression]) -> list[Truth]:
        """For each expression its truth: True, False or None."""
        return list(map(closure, expressions))

    def values(self, expressions: Iterable[Expression]) -> list[Evaluation]:
        """For each expression its value, or None while it is unknown."""
        return list(map(closure, expressions))


def closure(expression: Expression) -> Function:
    """The value of a resolved expression as a function of the state, None where it is unknown."""
    match expression:
        case Constant(value):
            return lambda _: value
        case Variable(name):
            return itemgetter(name)
        case Not(operand):
            return partial(_negated, closure(operand))
        case And(operands):
            return partial(_decided, tuple(map(closure, operands)), False)
        case Or(operands):
            return partial(_decided, tuple(map(closure, operands)), True)
        case Comparison("==" | "!=" as relation, Variable(name), Constant(value)):
            return partial(_equal if relation == "==" else _differs, name, value)
        case Membership(Variable(name), options) if all(isinstance(option, Constant) for option in options):
            return partial(_among, name, frozenset(o.value for o in options if isinstance(o, Constant)))
        case Comparison(relation, left, right):
            return partial(_compared, RELATIONS[relation], closure(left), closure(right))
    return partial(evaluate, expression)


def _negated(operand: Function, state: Valuation) -> bool | None:
    truth: bool | None = operand(state)
    return None if truth is None else not truth


def _decided(operands: Sequence[Function], decisive: bool, state: Valuation) -> bool | None:
    """`decisive` if it is the truth of any operand, and else unknown if that of one is."""
    unknown = False
    for operand in operands:
        truth: bool | None = operand(state)
        if truth is decisive:
            return decisive
        if truth is None:
            unknown = True
    return None if unknown else not decisive


def _equal(name: str, value: Value, state: Valuation) -> bool | None:
    found = state[name]
    return None if found is None else found == value


def _differs(name: str, value: Value, state: Valuation) -> bool | None:
    found = state[name]
    return None if found is None else found != value


def _compared(relation: Callable[[Any, Any], bool], left: Function, right: Function, state: Valuation) -> bool | None:
    one, other = left(state), right(state)
    return None if one is None or other is None else bool(relation(one, other))


def _among(name: str, values: frozenset[Value], state: Valuation) -> bool | None:
    found = state[name]
    return None if found is None else found in values


# An automaton made ready for its compiled tick: its predicates as functions, and what reads what.

F = TypeVar("F")


class Dependants(NamedTuple):
    """The things that must be looked at again when a variable or a flag has changed.

    `flags` come by their level: a flag reads flags of lower levels only, and waits until these are known.
    """

    flags: tuple[tuple[int, tuple[str, ...]], ...]
    finishes: tuple[str, ...]
    operations: tuple[str, ...]
    starts: tuple[str, ...]
    effects: tuple[str, ...]


class Actions(Immutable):
    """Actions taken at once: what they always write, or else the target, condition and value of each."""

    always: Writes | None
    each: tuple[tuple[str, Truth, Evaluation], ...]

    def writes(self, state: State) -> Writes | None:
        """Return what they write in `state`, not to be changed; None when an unknown value leaves it undetermined."""
        if self.always is not None:
            return self.always
        written: Writes = {}
        for name, condition, evaluated in self.each:
            applies = condition(state)
            if applies is None:
                return None
            if not applies:
                continue
            value = evaluated(state)
            if value is None:
                return None
            written[name] = value
        return written


class CompiledTick:
    """The tables of one automaton, made once for all its runs, which never change them.

    `hot` ones are compiled for many runs; the others are made ten times as quickly and step half as fast. Abilities
    whose flag `enabled` the automaton does not have go by its predicate alone.
    """

    def __init__(self, automaton: Automaton, hot: bool = True) -> None:
        abilities, operations = automaton.abilities, automaton.operations
        finishing = {a.name: a.finish_guard for a in abilities.values() if a.finish_guard is not None}
        self.automaton = automaton
        self.names = tuple(map(str, automaton.initial_valuation))
        self.position = {name: number for number, name in enumerate(abilities)}
        flag_reads = {flag.name: _reads(flag.predicate) for flag in automaton.flags}
        self.level = _levels(flag_reads)
        self.dependants = _dependants(automaton, self.names, flag_reads, self.level)
        compiler: Compiler | Closures = Compiler(self.names) if hot else Closures()
        self.flags = _by_name(compiler.truths, automaton.flag_predicates)
        self.finish_guards = _by_name(compiler.predicates, finishing)
        self.finish_actions = _actions(compiler, {name: abilities[name].finish_actions for name in finishing})
        self.goals = _by_name(compiler.truths, {o.name: o.goal for o in operations.values()})
        self.preconditions = _by_name(compiler.predicates, {o.name: o.precondition for o in operations.values()})
        self.activities = tuple((o.name, o.activity) for o in operations.values() if o.activity in automaton.variables)
        start_guards = {a.name: _start_guard(automaton, a) for a in abilities.values()}
        self.start_guards = _by_name(compiler.predicates, start_guards)
        self.start_actions = _actions(compiler, {a.name: a.start_actions for a in abilities.values()})
        effects = {effect.name: effect for effect in automaton.effects if not effect.fault}
        self.effect_guards = _by_name(compiler.predicates, {name: e.guard for name, e in effects.items()})
        self.effect_actions = _actions(compiler, {name: e.actions for name, e in effects.items()})

    def __deepcopy__(self, memo: object) -> CompiledTick:
        return self


def _start_guard(automaton: Automaton, ability: Ability) -> Expression:
    """Return what must hold for a start, the supervisor apart: the flag `enabled`, its predicate and the written
    guard.
    """
    enabled = ability.flag("enabled")
    flags = (Variable(enabled, BOOLEAN),) if enabled in automaton.flag_predicates else ()
    return conjunction(*flags, ability.enabled, ability.start_guard)


def _by_name(
    compiled: Callable[[Iterable[Expression]], list[F]], expressions: Mapping[str, Expression]
) -> dict[str, F]:
    return dict(zip(expressions, compiled(expressions.values()), strict=True))


def _actions(compiler: Compiler | Closures, actions: Mapping[str, Sequence[Assignment]]) -> dict[str, Actions]:
    conditions = compiler.truths(a.condition or TRUE for each in actions.values() for a in each)
    values = compiler.values(a.value for each in actions.values() for a in each)
    functions = zip(conditions, values, strict=True)
    return {
        name: Actions(_constants(each), tuple((target(action), *next(functions)) for action in each))
        for name, each in actions.items()
    }


def _constants(actions: Sequence[Assignment]) -> Writes | None:
    """Return what `actions` write, if it is the same in every state."""
    written: Writes = {}
    for action in actions:
        if action.condition is not None or not isinstance(action.value, Constant):
            return None
        written[target(action)] = action.value.value
    return written


def _reads(*expressions: Expression) -> frozenset[str]:
    return frozenset(name for expression in expressions for name in variables(expression))


def _levels(flag_reads: Mapping[str, frozenset[str]]) -> dict[str, int]:
    """The level of each flag: one more than the highest of the flags it reads."""
    levels: dict[str, int] = {}
    for flag, read in flag_reads.items():
        levels[flag] = 1 + max((levels[name] for name in read if name in levels), default=-1)
    return levels


def _dependants(
    automaton: Automaton, names: Iterable[str], flag_reads: Mapping[str, frozenset[str]], level: Mapping[str, int]
) -> dict[str, Dependants]:
    flags, finishes, operations, starts, effects = (defaultdict[str, list[str]](list) for _ in range(5))
    for flag, read in flag_reads.items():
        _note(flags, flag, read)
    for ability in automaton.abilities.values():
        enabled = ability.flag("enabled")
        own = {enabled} & flag_reads.keys()
        _note(starts, ability.name, _reads(ability.enabled, ability.start_guard) | own)
        if ability.finish_guard is not None:
            # What it writes as well: while its guard holds, it writes that again after anybody else has.
            touched = (each for action in ability.finish_actions for each in (target(action), *reads(action)))
            _note(finishes, ability.name, _reads(ability.finish_guard).union(touched))
    for operation in automaton.operations.values():
        _note(operations, operation.name, _reads(operation.goal, operation.precondition))
    for effect in automaton.effects:
        if not effect.fault:
            touched = (each for action in effect.actions for each in (target(action), *reads(action)))
            _note(effects, effect.name, _reads(effect.guard).union(touched))
    return {
        name: Dependants(
            _by_level(flags[name], level),
            tuple(finishes[name]),
            tuple(operations[name]),
            tuple(starts[name]),
            tuple(effects[name]),
        )
        for name in names
    }


def _note(readers: dict[str, list[str]], reader: str, names: Iterable[str]) -> None:
    for name in names:
        readers[name].append(reader)


def _by_level(flags: Iterable[str], level: Mapping[str, int]) -> tuple[tuple[int, tuple[str, ...]], ...]:
    by_level = defaultdict[int, list[str]](list)
    for flag in flags:
        by_level[level[flag]].append(flag)
    return tuple((number, tuple(members)) for number, members in by_level.items())
