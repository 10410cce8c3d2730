"""A tick encoded once and put down again leads exactly where the reference tick leads."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

from hypothesis import given

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.tick import supervised_start
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.sat.flattening import flattened
from sequence_planner.planning.sat.solver import Circuit, Solver
from sequence_planner.planning.sat.start_order import sweep_order
from sequence_planner.planning.sat.unrolling import Recorder, Unrolling
from sequence_planner.process.budget import Budget
from support.examples import examples

from .choices import Choices, made_by
from .explicit import outcomes
from .random_problems import Problem, problem

Key = tuple[Value | None, ...]


def key(station: Automaton, state: State) -> Key:
    return tuple(state[name] for name in station.types)


def after_ticks(given_: Problem, number: int) -> set[Key]:
    """All states after step 3 of so many ticks, by the reference."""
    station = given_.automaton
    helpful = [effect for effect in station.effects if not effect.fault]
    layer = {key(station, given_.state): given_.state}
    for last in range(number):
        settled = [(before, after) for before in layer.values() for after in outcomes(station, before, helpful)]
        if last == number - 1:
            return {key(station, after) for _, after in settled}
        layer = {key(station, end): end for before, after in settled for end in ends(given_, before, after)}
    return set()


def ends(given_: Problem, published: State, settled: State) -> list[State]:
    """All states at the end of the tick, with whatever starts."""
    station = given_.automaton
    found = {(key(station, settled), frozenset[str]()): settled}
    pending = list(found.items())
    while pending:
        (_, taken), state = pending.pop()
        for ability in station.abilities.values():
            if ability.restart or ability.name in taken:
                continue
            after = supervised_start(station, given_.supervisor, published, state, ability)
            if after is not None and (reached := (key(station, after), taken | {ability.name})) not in found:
                found[reached] = after
                pending.append((reached, after))
    return list(found.values())


def unrolled(given_: Problem, number: int) -> set[Key]:
    """The same by the solver: every model is noted, and excluded."""
    station, supervisor, state = given_.automaton, given_.supervisor, given_.state
    unknown = frozenset(name for name in station.types if state[name] is None)
    budget, inside = Budget.seconds(60), supervisor.safe.includes(state)
    unrolling = Unrolling(
        station, supervisor, sweep_order(station, supervisor), unknown, inside, {}, frozenset(), budget
    )
    unrolling.extend(number, budget)
    position = unrolling.ticks[number - 1].synchronised
    symbols = [position[name].literals for name in station.types]
    found: set[Key] = set()
    assumptions = unrolling.given(state, Circumstances())
    while unrolling.solver.solve(assumptions, budget):
        true = {*unrolling.solver.model(), Circuit.TRUE}
        values = [next(((v, one) for v, one in literals.items() if one in true), None) for literals in symbols]
        found.add(tuple(None if each is None else each[0] for each in values))
        different = [-each[1] for each in values if each is not None]
        different += [
            one for literals, each in zip(symbols, values, strict=True) if each is None for one in literals.values()
        ]
        unrolling.solver.add_clause([literal for literal in different if literal != Circuit.FALSE])
    return found


def questions(choices: Choices) -> Problem:
    """A problem, from a state that may have unknown values."""
    return problem(choices, unknown=choices.chance(3))


@examples(80)
@given(made_by(questions))
def test_runs_of_three_ticks_lead_where_the_reference_leads(given_: Problem) -> None:
    for number in (1, 2, 3):
        assert unrolled(given_, number) == after_ticks(given_, number)


def numbers(choices: Choices) -> tuple[list[bool], int]:
    """Some truth values, and how many of them are not too many."""
    return [choices.chance(2) for _ in range(choices.number(1, 9))], choices.number(0, 9)


@examples(100)
@given(made_by(numbers))
def test_a_counter_says_when_there_are_too_many(given_: tuple[list[bool], int]) -> None:
    values, most = given_
    solver = Solver()
    circuit = Circuit(solver)
    literals = [circuit.fresh() for _ in values]
    too_many = circuit.exceeding(literals, most)
    assumed = [literal if value else -literal for literal, value in zip(literals, values, strict=True)]
    assert solver.solve([*assumed, too_many], Budget.seconds(60)) is (len(values) > most)
    assert solver.solve([*assumed, -too_many], Budget.seconds(60)) is (sum(values) <= most)
    solver.close()


@examples(30)
@given(made_by(lambda choices: [choices.chance(2) for _ in range(choices.number(1, 6))]))
def test_at_most_one_is_at_most_one(values: list[bool]) -> None:
    solver = Solver()
    circuit = Circuit(solver)
    literals = [circuit.fresh() for _ in values]
    circuit.at_most_one(literals)
    assumed = [literal if value else -literal for literal, value in zip(literals, values, strict=True)]
    assert solver.solve(assumed, Budget.seconds(60)) is (sum(values) <= 1)
    solver.close()


class Gates(NamedTuple):
    """Gates over inputs and gates before them, clauses over all of these, and the one that is asked for besides.

    All by their places, counted from 1 and negative for the opposite.
    """

    inputs: int
    parts: list[tuple[int, ...]]
    clauses: list[tuple[int, ...]]
    asked: int


def gates(choices: Choices) -> Gates:
    """Some, of which many stand in few clauses."""

    def places(top: int, least: int) -> tuple[int, ...]:
        some = [choices.number(1, top) for _ in range(choices.number(least, 3))]
        return tuple(-place if choices.chance(2) else place for place in some)

    inputs = choices.number(1, 4)
    top = inputs + choices.number(1, 8)
    parts = [places(before, 2) for before in range(inputs, top)]
    clauses = [places(top, 1) for _ in range(choices.number(0, 4))]
    return Gates(inputs, parts, clauses, choices.number(1, top))


@examples(300)
@given(made_by(gates))
def test_clauses_over_gates_mean_the_same_when_they_are_flattened(given_: Gates) -> None:
    recorder = Recorder()
    circuit = Circuit(recorder, later=True)
    literals = [circuit.fresh() for _ in range(given_.inputs)]
    inputs = circuit.top

    def at(place: int) -> int:
        return literals[place - 1] if place > 0 else -literals[-place - 1]

    for parts in given_.parts:
        literals.append(circuit.conjunction(map(at, parts)))
    for clause in given_.clauses:
        circuit.require(*map(at, clause))
    solver, asked = Solver(), at(given_.asked)
    solver.add_clauses(flattened(recorder.clauses, circuit.gates, inputs, {abs(asked)}))
    for values in product((False, True), repeat=given_.inputs):
        truths = list(values)
        for parts in given_.parts:
            truths.append(all(truths[abs(part) - 1] is (part > 0) for part in parts))
        met = all(any(truths[abs(place) - 1] is (place > 0) for place in clause) for clause in given_.clauses)
        assumed = [literal if value else -literal for literal, value in zip(literals, values, strict=False)]
        for literal, truth in ((asked, truths[given_.asked - 1]), (-asked, not truths[given_.asked - 1])):
            assert solver.solve([*assumed, literal], Budget.seconds(60)) is (met and truth)
    solver.close()


def test_a_gate_that_stands_in_few_clauses_is_replaced_by_its_parts() -> None:
    recorder = Recorder()
    circuit = Circuit(recorder, later=True)
    one, other, third = (circuit.fresh() for _ in range(3))
    inputs, gate = circuit.top, circuit.both(one, other)
    circuit.require(gate, third)
    circuit.require(-gate, -third)
    found = flattened(recorder.clauses, circuit.gates, inputs, set())
    expected = {(Circuit.TRUE,), (one, third), (other, third), (-one, -other, -third)}
    assert {tuple(sorted(clause, key=abs)) for clause in found} == expected
    assert len(flattened(recorder.clauses, circuit.gates, inputs, {gate})) == len(recorder.clauses) + 3
