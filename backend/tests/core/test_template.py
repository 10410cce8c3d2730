"""A tick encoded once and put down again leads exactly where the reference tick leads."""

from __future__ import annotations

from hypothesis import given

from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.automaton.tick import supervised_start
from sequence_planner.expressions.types import Value
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.plan import Circumstances
from sequence_planner.planning.sat.circuit import Circuit
from sequence_planner.planning.sat.solver import Solver
from sequence_planner.planning.sat.sweep import sweep_order
from sequence_planner.planning.sat.unrolling import Unrolling

from .budget import examples
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


def gates(choices: Choices) -> tuple[list[tuple[int, ...]], list[bool]]:
    """Gates over inputs and gates before them, by their places counted from 1, and the values of the inputs."""
    values = [choices.chance(2) for _ in range(choices.number(1, 4))]
    made: list[tuple[int, ...]] = []
    for top in range(len(values), len(values) + choices.number(1, 8)):
        parts = [choices.number(1, top) for _ in range(choices.number(2, 3))]
        made.append(tuple(-part if choices.chance(2) else part for part in parts))
    return made, values


@examples(100)
@given(made_by(gates))
def test_literals_that_are_defined_later_can_be_true_exactly_where_they_are(
    given_: tuple[list[tuple[int, ...]], list[bool]],
) -> None:
    made, values = given_
    solver = Solver()
    circuit = Circuit(solver, later=True)
    literals = [circuit.fresh() for _ in values]
    inputs, truths = circuit.top, list(values)

    def at(place: int) -> int:
        return literals[place - 1] if place > 0 else -literals[-place - 1]

    for parts in made:
        literals.append(circuit.conjunction(map(at, parts)))
        truths.append(all(truths[abs(part) - 1] is (part > 0) for part in parts))
    assumed = [literal if value else -literal for literal, value in zip(literals, values, strict=False)]
    for asked, truth in ((literals[-1], truths[-1]), (-literals[-1], not truths[-1])):
        solver.add_clauses(circuit.definitions([asked], inputs))
        assert solver.solve([*assumed, asked], Budget.seconds(60)) is truth
    solver.close()
