"""Checks of guards and finishes by SAT: constant conditions, conflicting writes in one tick."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import partial, reduce
from itertools import combinations, islice
from math import prod

from pysat.solvers import Solver

from sequence_planner.analysis.checks.reachability import bits, cannot_be
from sequence_planner.analysis.checks.relaxed_reachability import Growth
from sequence_planner.analysis.checks.warning import (
    MOST_NAMED,
    ModelCondition,
    ModelWarning,
    described,
    listed,
    parts,
    place,
    quoted,
    shortened,
    told_together,
)
from sequence_planner.automaton.automaton import Ability, Automaton, Kind, State, target
from sequence_planner.automaton.dependencies import cone_of_influence
from sequence_planner.automaton.lifting.wording import phrase, wording_of
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import (
    FALSE,
    Arithmetic,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Membership,
    Variable,
    children,
    conjunction,
    conjuncts,
    occurrences,
    variables,
)
from sequence_planner.language.types import Value
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.symbolic import Reading, Symbol
from sequence_planner.synthesis.conflicts import conflicting_finishes
from sequence_planner.synthesis.transition_relation import MOST_BITS, NodeLimit, TooMuchError
from sequence_planner.texts.message import Message, message

# Whether there is any state that satisfies something, reachable or not: one question to a SAT solver.

MOST_COMBINATIONS = 100_000  # of the values in one comparison; beyond them a question is not asked
MOST_CONFLICTS = 50_000  # of the solver; beyond them a question is given up


class UndecidedError(Exception):
    """A question was given up: its answer would have taken too long."""


class SatisfiabilityQuestion:
    """A circuit over states of which only what is read exists."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._clauses: list[Sequence[int]] = []
        self.circuit = Circuit(self)
        self.reading = Reading(self.circuit)

    def add_clause(self, clause: Sequence[int]) -> None:
        """Take a clause of the circuit."""
        self._clauses.append(clause)

    def state(self) -> AnyState:
        """A state of any values; its flags follow from them."""
        state = AnyState(lambda name: self._flag(name, state) if self._is_flag(name) else self._any(self._type(name)))
        return state

    def with_old_flags(self) -> AnyState:
        """A state of any values whose flags may be anything, as if they were of any other state."""
        return AnyState(lambda name: self._any(self._type(name)))

    def sensed(self, before: AnyState) -> AnyState:
        """Return what a finish guard sees after `before`: new measured values, and all else as it was."""

        def made(name: str) -> Symbol:
            variable = self._automaton.variables.get(name)
            measured = variable is not None and variable.kind is Kind.MEASURED
            return self._any(self._type(name)) if measured else before[name]

        return AnyState(made)

    def after(self, actions: Sequence[Assignment], before: AnyState) -> AnyState:
        """The state after `actions`, all taken at once in `before`, and after synchronisation."""
        after = AnyState(lambda name: self._flag(name, after) if self._is_flag(name) else before[name])
        for action in actions:
            value = self.reading.symbol(action.value, before)
            if action.condition is not None:
                condition = self.reading.truth(action.condition, before).yes
                value = self.reading.chosen(condition, value, before[target(action)])
            after[target(action)] = value
        return after

    def models(self, *assumed: int) -> Iterator[frozenset[int] | None]:
        """For each literal of `assumed`, the literals that are true in a solution with it, or None.

        Raises `UndecidedError` when that is not known after `MOST_CONFLICTS`.
        """
        with Solver("minisat22", bootstrap_with=self._clauses) as solver:
            for literal in assumed:
                solver.conf_budget(MOST_CONFLICTS)
                answer = solver.solve_limited([literal])
                if answer is None:
                    raise UndecidedError
                yield frozenset(solver.get_model() or ()) if answer else None

    def model(self) -> frozenset[int] | None:
        """The literals that are true in a solution, or None if there is none. Raises `UndecidedError`."""
        return next(self.models(self.circuit.TRUE))

    def _is_flag(self, name: str) -> bool:
        return name in self._automaton.flag_predicates

    def _type(self, name: str) -> Sequence[Value]:
        return self._automaton.types[name].domain

    def _flag(self, name: str, state: AnyState) -> Symbol:
        truth = self.reading.truth(self._automaton.flag_predicates[name], state)
        return Symbol({False: truth.no, True: truth.yes})

    def _any(self, domain: Sequence[Value]) -> Symbol:
        circuit = self.circuit
        if len(domain) == 2:
            literal = circuit.fresh()
            return Symbol({domain[0]: -literal, domain[1]: literal})
        literals = {value: circuit.fresh() for value in domain}
        circuit.require(*literals.values())
        seen = Circuit.FALSE  # one of the values before
        for literal in literals.values():
            circuit.require(-literal, -seen)
            seen = circuit.disjunction((seen, literal))
        return Symbol(literals)


class AnyState(dict[str, Symbol]):
    """The values of a state, each made when it is first read."""

    def __init__(self, made: Callable[[str], Symbol]) -> None:
        super().__init__()
        self._made = made

    def __missing__(self, name: str) -> Symbol:
        self[name] = self._made(name)
        return self[name]

    def valuation(self, model: frozenset[int]) -> State:
        """Return what has been read of this state, as it is in a solution."""
        return {
            name: next((value for value, literal in symbol.literals.items() if _holds(literal, model)), None)
            for name, symbol in self.items()
        }


def _holds(literal: int, model: frozenset[int]) -> bool:
    return literal in model if literal > 0 else -literal not in model


def satisfying(automaton: Automaton, predicate: Expression) -> State | None:
    """A state, of any values, in which `predicate` holds, or None if there is none. Raises `UndecidedError`."""
    question = SatisfiabilityQuestion(automaton)
    state = question.state()
    question.circuit.require(question.reading.truth(predicate, state).yes)
    model = question.model()
    return None if model is None else state.valuation(model)


def differ(automaton: Automaton, one: Expression, other: Expression) -> bool:
    """Return whether there is a state, of any values, in which one of two predicates holds and the other does not.

    Raises `UndecidedError`.
    """
    question = SatisfiabilityQuestion(automaton)
    state, circuit = question.state(), question.circuit
    first, second = (question.reading.truth(each, state) for each in (one, other))
    either = (first.yes, second.no), (first.no, second.yes)
    circuit.require(circuit.disjunction(tuple(circuit.conjunction(each) for each in either)))
    return question.model() is not None


def can_be_asked(automaton: Automaton, *expressions: Expression) -> bool:
    """Return whether `expressions`, and the predicates of the flags that they read, are small enough for a circuit."""
    seen: set[str] = set()
    pending = list(expressions)
    while pending:
        expression = pending.pop()
        match expression:
            case Variable(name) if name in automaton.flag_predicates and name not in seen:
                seen.add(name)
                pending.append(automaton.flag_predicates[name])
            case Comparison(_, Variable(), Constant()):
                continue
            case Comparison() | Arithmetic() | Membership():
                if prod({v.name: len(v.type.domain) for v in occurrences(expression)}.values()) > MOST_COMBINATIONS:
                    return False
            case _:
                pending.extend(children(expression))
    return True


Shape = tuple[object, ...]


def shape(automaton: Automaton, expression: Expression) -> Shape:
    """Return what makes the answer about `expression`: two with the same shape differ in the names of variables
    alone.
    """
    numbers: dict[str, int] = {}

    def of(part: Expression) -> Shape:
        match part:
            case Constant(value):
                return (type(value), value)
            case Variable(name):
                if name in numbers:
                    return (numbers[name],)
                numbers[name] = len(numbers)
                if name in automaton.variables:
                    return (automaton.variables[name].kind, part.type)
                return ("flag", of(automaton.flag_predicates[name]))
            case Comparison(operator) | Arithmetic(operator):
                return (operator, *map(of, children(part)))
            case _:
                return (type(part), *map(of, children(part)))

    return of(expression)


# Two finishes in one tick that would write different values to one variable: neither would be applied.
#
# First a solver looks for any values with which that happens after a state that no specification forbids, and
# `reachability` tries to prove that they never come about. Then it is computed over what matters which states the
# station can reach, so that the state reported is a reachable one. Where there are too many of them, it is said that
# it is not shown to be unreachable.

MOST_EFFORT = 5_000_000  # nodes for each pair, see `synthesis.transition_relation`
MOST_REPORTED = 3  # pairs for each variable
MOST_TRIED = 50  # pairs for each variable: beyond them, conflicts of many finishes over one variable are not looked for


def check_conflicts(automaton: Automaton) -> Iterator[ModelWarning]:
    """The pairs of abilities whose finishes conflict, with a state in which they do."""
    writers: dict[str, list[tuple[Ability, Assignment]]] = defaultdict(list)
    for ability in automaton.abilities.values():
        for action in ability.finish_actions if ability.finish_guard is not None else ():
            writers[target(action)].append((ability, action))
    seen: set[tuple[str, str]] = set()
    for variable, written in writers.items():
        if len(written) < 2 or _one_value([action for _, action in written]):
            continue
        reported = 0
        for one, other, witness in islice(_possible(automaton, variable, written), MOST_TRIED):
            warning = None
            if (one.name, other.name) not in seen:
                warning = _confirmed(automaton, variable, one, other, witness)
            if warning is not None:
                seen.add((one.name, other.name))
                reported += 1
                yield warning
            if reported == MOST_REPORTED:
                break


def _one_value(actions: Sequence[Assignment]) -> bool:
    """Return whether all write the same, whatever the state that all of them read."""
    return all(action.value == actions[0].value for action in actions)


def _possible(
    automaton: Automaton, variable: str, written: Sequence[tuple[Ability, Assignment]]
) -> Iterator[tuple[Ability, Ability, State]]:
    """Pairs that conflict over `variable` with some values, each with what they see then."""
    question = SatisfiabilityQuestion(automaton)
    circuit, reading = question.circuit, question.reading
    before = question.state()
    state = question.sensed(before)
    for specification in automaton.specifications.values():
        if can_be_asked(automaton, specification.forbidden):
            circuit.require(-reading.truth(specification.forbidden, before).yes)
    values: dict[object, list[int]] = defaultdict(list)
    chosen: dict[str, int] = {}  # of which writers we speak, so that one pair after the other can be ruled out
    for ability, action in written:
        assert ability.finish_guard is not None
        conditions = [ability.finish_guard, *(() if action.condition is None else (action.condition,))]
        if not can_be_asked(automaton, *conditions, action.value):
            continue
        chosen[ability.name] = circuit.fresh()
        for condition in conditions:
            circuit.require(-chosen[ability.name], reading.truth(condition, state).yes)
        for value, literal in reading.symbol(action.value, state).literals.items():
            values[value].append(circuit.conjunction((chosen[ability.name], literal)))
    two, before_it = [], Circuit.FALSE  # a value is written, and one of those before it as well
    for literals in values.values():
        written_now = circuit.disjunction(literals)
        two.append(circuit.conjunction((written_now, before_it)))
        before_it = circuit.disjunction((written_now, before_it))
    circuit.require(*two)
    by_name = {ability.name: (ability, action) for ability, action in written}
    while (model := _decided(question)) is not None:
        seen = state.valuation(model)
        values_now = {name: evaluate(by_name[name][1].value, seen) for name in chosen if chosen[name] in model}
        one, other = next((a, b) for a, b in combinations(values_now, 2) if values_now[a] != values_now[b])
        yield by_name[one][0], by_name[other][0], seen
        circuit.require(-chosen[one], -chosen[other])


def _decided(question: SatisfiabilityQuestion) -> frozenset[int] | None:
    """A solution; None if there is none, or none is found with reasonable effort."""
    try:
        return question.model()
    except UndecidedError:
        return None


def _confirmed(
    automaton: Automaton, variable: str, one: Ability, other: Ability, witness: State
) -> ModelWarning | None:
    """The warning, with a reachable state if there are few enough to look at; none if no such state is reachable."""
    actions = [next(a for a in ability.finish_actions if target(a) == variable) for ability in (one, other)]
    conditions = [
        each
        for ability, action in zip((one, other), actions, strict=True)
        for each in (ability.finish_guard, action.condition)
        if each is not None
    ]
    if cannot_be(automaton, conditions):
        return None
    own = [*conditions, *(action.value for action in actions)]
    read = dict.fromkeys(name for each in own for name in variables(each))
    cone = cone_of_influence(automaton, [*own, Variable(variable, automaton.variables[variable].type)])
    trace = None
    try:
        if bits(automaton, cone) > MOST_BITS:
            raise TooMuchError
        found = conflicting_finishes(automaton, cone, (one.name, other.name), variable, NodeLimit(MOST_EFFORT))
        if found is None:
            return None
        how, seen, trace = message("found.write-conflict.meet"), found.seen, found.trace
    except TooMuchError:
        how, seen = message("found.write-conflict.may-meet"), witness
    values = described(seen, read)
    said = message("found.write-conflict", one=one.name, other=other.name, variable=variable, how=how, values=values)
    return ModelWarning(place(automaton, f"{other.name}.finish", other.name), "write-conflict", said, trace)


# Conditions that cannot hold, or always do: by their own words, or because nothing ever brings them about.
#
# Of the instances of something with parameters, all are reported under one name. When only some cannot hold but most
# can, they are named, except those with one argument twice (`carry(left, left)`); when most cannot, the parameters are
# seen as choosing which instances there are. What only follows from another finding is left out, and so is what was
# written as `true` or `false`, or became so by the values of its parameters.


def check_guards(automaton: Automaton) -> Iterator[ModelWarning]:
    """All conditions of `automaton` that are no conditions."""
    everything = list(parts(automaton))
    written = [part for part in everything if not isinstance(part.expression, Constant)]
    reporting = _Reporting(automaton, everything)
    never, always = _constant(automaton, written)

    def holding(part: ModelCondition) -> tuple[str, str]:
        return "always-holds", message("found.always-holds", condition=quoted(automaton, part.expression))

    contradictions = _Contradictions(automaton)
    yield from reporting.warnings(always, holding, some=False)
    yield from reporting.warnings(never, contradictions.of)
    reporting.dead |= {part.name for part in never}
    for growth in (Growth(automaton, any_measurement=True), Growth(automaton, any_measurement=False)):
        left = [part for part in written if part.name not in reporting.dead]
        stuck = [part for part in left if not growth.may(part.expression)]
        yield from reporting.warnings(growth.roots(stuck, reporting.dead), partial(_stuck, automaton, growth))
        reporting.dead |= {part.name for part in stuck}


def check_alarms(automaton: Automaton) -> Iterator[ModelWarning]:
    """Alarms that are always there, and those that never are, even where that was written as `true` or `false`."""
    alarms = automaton.alarms
    never, always = _constant(automaton, [ModelCondition(name, "when", each.when) for name, each in alarms.items()])
    for comes, found in (("always", always), ("never", never)):
        for part in found:
            said = message(f"found.alarm-{comes}", alarm=part.key, condition=quoted(automaton, part.expression))
            yield ModelWarning(alarms[part.key].place, f"{comes}-holds", said)


MOST_TOLD = 200  # instances of which it is looked whether the same is said


class _Reporting:
    """Chooses what is said of many instances. `dead` are the parts that never hold, by name."""

    def __init__(self, automaton: Automaton, everything: Iterable[ModelCondition]) -> None:
        self._automaton = automaton
        self._families: dict[str, list[ModelCondition]] = defaultdict(list)
        self.dead: set[str] = set()
        for part in everything:
            self._families[part.family].append(part)
            if part.expression == FALSE:
                self.dead.add(part.name)

    def warnings(
        self,
        found: Collection[ModelCondition],
        said: Callable[[ModelCondition], tuple[str, str]],
        some: bool = True,
    ) -> Iterator[ModelWarning]:
        """Yield what is `said` of each part that is `found`, its kind and the message, once for all instances.

        With `some` also of families of which only some are found.
        """
        for members, is_all in self._worth_saying(found, some):
            first = members[0]
            kind, words = said(first)
            where = place(self._automaton, first.key, first.key.rpartition(".")[0])
            told = told_together(self._automaton, {part.key: said(part)[1] for part in members[:MOST_TOLD]})
            if len(members) > 1 and [len(each.members) for each in told] == [len(members)]:
                yield ModelWarning(where, kind, told[0].message, members=told[0].members)
            elif is_all:
                yield ModelWarning(where, kind, words)
            else:
                names = listed([each.key for each in members])
                yield ModelWarning(where, kind, message("found.of", names=names, what=words))

    def _worth_saying(
        self, found: Collection[ModelCondition], some: bool
    ) -> Iterator[tuple[Sequence[ModelCondition], bool]]:
        """Those instances of each family that are meant, and whether all of it are found."""
        of_family: dict[str, list[ModelCondition]] = defaultdict(list)
        found_names = {part.name for part in found}
        for part in found:
            if not any(need in self.dead or need in found_names for need in part.needs):
                of_family[part.family].append(part)
        for family, members in of_family.items():
            written = self._families[family]
            named = [part for part in members if not part.repeats_an_argument]
            if len(members) == len(written):
                yield named or members, True
            elif some and 2 * len(members) < len(written) and named:
                yield named, False


def _constant(
    automaton: Automaton, written: Iterable[ModelCondition]
) -> tuple[list[ModelCondition], list[ModelCondition]]:
    """The parts that hold for no values of their variables, and those that hold for all."""
    never: list[ModelCondition] = []
    always: list[ModelCondition] = []
    answers: dict[tuple[bool, Shape], tuple[bool, bool]] = {}
    for part in written:
        key = (part.old_flags, shape(automaton, part.expression))
        if key not in answers:
            answers[key] = _can_hold_and_fail(automaton, part)
        holds, fails = answers[key]
        if not holds:
            never.append(part)
        elif not fails:
            always.append(part)
    return never, always


def _can_hold_and_fail(automaton: Automaton, part: ModelCondition) -> tuple[bool, bool]:
    """Return whether some state satisfies a part, and whether some does not; both where it is too hard to tell."""
    if not can_be_asked(automaton, part.expression):
        return True, True
    question = SatisfiabilityQuestion(automaton)
    before = question.state()
    literal = question.reading.truth(part.expression, question.sensed(before) if part.old_flags else before).yes
    try:
        holds, fails = question.models(literal, -literal)
    except UndecidedError:
        return True, True
    return holds is not None, fails is not None


class _Contradictions:
    """Words of conditions that exclude each other. Those found last are tried first, as instances are alike."""

    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._before: tuple[int, ...] = ()

    def of(self, part: ModelCondition) -> tuple[str, str]:
        """Say what is wrong with a part that never holds."""
        return "never-holds", message("found.meant", what=self._excluding(part), so=part.so)

    def _excluding(self, part: ModelCondition) -> Message:
        wording = wording_of(self._automaton)
        words = [each for piece in conjuncts(part.expression) for each in wording.told_parts(piece)]
        few = [*((at,) for at in range(len(words))), *combinations(range(len(words)), 2)]
        for numbers in sorted(few, key=lambda each: each != self._before):
            some = [words[at] for at in numbers]
            piece = conjunction(*(each.condition for each in some))
            if _constant(self._automaton, [ModelCondition(part.key, part.what, piece, old_flags=part.old_flags)])[0]:
                self._before = numbers
                if len(some) > 1:
                    one, other = (shortened(phrase(each)) for each in some)
                    return message("found.meant.exclude", one=one, other=other)
                said = shortened(phrase(*some))
                if some[0].words == some[0].condition:
                    return message("found.meant.never", condition=said)
                meaning = shortened(print_expression(piece))
                return message("found.meant.never-that-is", condition=said, meaning=meaning)
        return message("found.meant.never", condition=quoted(self._automaton, part.expression))


def _stuck(automaton: Automaton, growth: Growth, part: ModelCondition) -> tuple[str, str]:
    """Return what is said of a part that nothing brings about."""
    lacking = list(_lacking(automaton, growth, part.expression)) or [quoted(automaton, part.expression)]
    condition = reduce(lambda most, last: message("list.and", most=most, last=last), lacking[:MOST_NAMED])
    if len(lacking) > MOST_NAMED:
        condition = message("found.more", names=condition, count=len(lacking) - MOST_NAMED, rest=lacking[MOST_NAMED:])
    if growth.any_measurement:
        return "unreachable", message("found.unreachable", condition=condition, so=part.so)
    if part.what == "effect's condition":
        return "effect-never-happens", message("found.effect-never-happens", condition=condition)
    return "nothing-brings-about", message("found.nothing-brings-about", condition=condition, so=part.so)


def _lacking(automaton: Automaton, growth: Growth, condition: Expression) -> Iterator[str]:
    """The words of a condition that nothing brings about; of a name for several those of them, unless all are."""
    for told in wording_of(automaton).told_parts(condition):
        pieces = list(conjuncts(told.condition))
        left = [each for each in pieces if not growth.may(each)]
        if len(left) < len(pieces):
            yield from (quoted(automaton, each) for each in left)
        elif left:
            yield shortened(phrase(told))
