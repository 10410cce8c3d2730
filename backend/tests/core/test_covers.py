"""Covers: they hold what they must and nothing of what they must not, in as few words as there are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import combinations, product

from hypothesis import given

from sequence_planner.language.evaluator import holds
from sequence_planner.language.names.scope import NameScope
from sequence_planner.language.parser import parse
from sequence_planner.language.printer import print_expression
from sequence_planner.language.resolver import resolve_predicate
from sequence_planner.language.types import BOOLEAN, EnumerationType, IntegerRange, Type, Value
from sequence_planner.synthesis.bdd import Diagrams, Function
from sequence_planner.synthesis.guards import Cube, count_literals, cover, single, worded
from sequence_planner.synthesis.hitting import least_hitting
from sequence_planner.synthesis.transition_relation import NodeLimit
from support.examples import examples

from .choices import Choices, made_by

TYPES: tuple[Type, ...] = (
    BOOLEAN,
    EnumerationType(("p", "q", "r")),
    IntegerRange(-1, 1),
    EnumerationType(("q", "r", "s", "t", "u")),
    IntegerRange(0, 6),
)
MANY = 1_000
ENOUGH = 10**9  # nodes
State = tuple[Value, ...]


@dataclass(frozen=True)
class Problem:
    """States that must be held, and states that must not be."""

    types: dict[str, Type]
    on: frozenset[State]
    off: frozenset[State]

    @property
    def domains(self) -> list[tuple[Value, ...]]:
        return [type_.domain for type_ in self.types.values()]

    def diagrams(self) -> Diagrams:
        return Diagrams({name: type_.domain for name, type_ in self.types.items()}, cache=1 << 10)

    def solved(self, diagrams: Diagrams) -> tuple[Cube, ...]:
        on, off = self.function(diagrams, self.on), self.function(diagrams, self.off)
        cubes = cover(diagrams, on, off, NodeLimit(ENOUGH), MANY)
        assert cubes is not None
        return cubes

    def function(self, diagrams: Diagrams, states: Iterable[State]) -> Function:
        return diagrams.disjunction(diagrams.states(dict(zip(self.types, state, strict=True))) for state in states)

    def held(self, cube: Cube) -> set[State]:
        values = [[v for p, v in enumerate(d) if m >> p & 1] for d, m in zip(self.domains, cube, strict=True)]
        return set(product(*values))

    def wider(self, cube: Cube) -> Iterator[Cube]:
        """The cubes that allow one more value of one variable."""
        for axis, domain in enumerate(self.domains):
            for position in range(len(domain)):
                if not cube[axis] >> position & 1:
                    yield (*cube[:axis], cube[axis] | 1 << position, *cube[axis + 1 :])

    def without_a_literal(self, cube: Cube) -> Iterator[Cube]:
        """The cubes that leave one more variable open."""
        for axis, domain in enumerate(self.domains):
            if cube[axis] != (whole := (1 << len(domain)) - 1):
                yield (*cube[:axis], whole, *cube[axis + 1 :])

    def literals(self, cubes: Iterable[Cube]) -> int:
        return sum(m != (1 << len(d)) - 1 for cube in cubes for m, d in zip(cube, self.domains, strict=True))


def problem(most_states: int) -> Callable[[Choices], Problem]:
    def make(choices: Choices) -> Problem:
        types: dict[str, Type] = {}
        states = 1
        for number in range(choices.number(1, 4)):
            type_ = choices.pick(TYPES)
            states *= len(type_.domain)
            if states <= most_states:
                types[f"x{number}"] = type_
        every = list(product(*(type_.domain for type_ in types.values())))
        split = choices.pick((2, 3, 5))
        sides = {state: choices.number(0, split - 1) for state in every}
        on = frozenset(state for state in every if sides[state] == 0)
        off = frozenset(state for state in every if sides[state] == 1)
        first, last = every[0], every[-1]
        return Problem(types, (on | {first}) - {last}, (off | {last}) - {first})

    return make


@examples(100)
@given(made_by(problem(48)))
def test_a_cover_holds_all_that_it_must_and_nothing_that_it_must_not(problem: Problem) -> None:
    held = [problem.held(cube) for cube in problem.solved(problem.diagrams())]
    assert problem.on <= set[State]().union(*held)
    assert problem.off.isdisjoint(set[State]().union(*held))


@examples(150)
@given(made_by(lambda choices: (problem(48)(choices), choices.number(0, 4_000), choices.number(1, 20))))
def test_a_cover_found_with_little_effort_is_as_right(given_: tuple[Problem, int, int]) -> None:
    problem, effort, literals = given_
    diagrams = problem.diagrams()
    on, off = problem.function(diagrams, problem.on), problem.function(diagrams, problem.off)
    for find in (cover, single, partial(single, widest=False)):
        cubes = find(diagrams, on, off, NodeLimit(effort), literals)
        if cubes is not None:
            held = [problem.held(cube) for cube in cubes]
            assert problem.on <= set[State]().union(*held)
            assert problem.off.isdisjoint(set[State]().union(*held))
            for cube, own in zip(cubes, held, strict=True):
                assert all(problem.held(wider) & problem.off for wider in problem.without_a_literal(cube))
                others = (other for other in held if other != own)
                assert not problem.on <= set[State]().union(*others)


@examples(100)
@given(made_by(problem(48)))
def test_a_single_cube_is_found_wherever_there_is_one(problem: Problem) -> None:
    diagrams = problem.diagrams()
    on, off = problem.function(diagrams, problem.on), problem.function(diagrams, problem.off)
    around = tuple(
        sum(1 << position for position, value in enumerate(domain) if any(state[axis] == value for state in problem.on))
        for axis, domain in enumerate(problem.domains)
    )
    there_is = problem.held(around).isdisjoint(problem.off)
    assert (single(diagrams, on, off, NodeLimit(ENOUGH), MANY) is not None) == there_is
    assert not there_is or len(problem.solved(diagrams)) == 1


@examples(100)
@given(made_by(problem(48)))
def test_no_literal_can_be_widened_or_left_out_and_no_cube_be_left_out(problem: Problem) -> None:
    cubes = problem.solved(problem.diagrams())
    for cube in cubes:
        assert all(problem.held(wider) & problem.off for wider in problem.wider(cube))
        others = (problem.held(other) for other in cubes if other != cube)
        assert not problem.on <= set[State]().union(*others)


@examples(60)
@given(made_by(problem(16)))
def test_a_small_cover_has_the_fewest_literals_of_all(problem: Problem) -> None:
    every = product(*(range(1, 1 << len(domain)) for domain in problem.domains))
    useful: dict[frozenset[State], int] = {}  # which states cubes hold, and the fewest literals of those that do
    for cube in every:
        if (held := problem.held(cube)).isdisjoint(problem.off) and (some := problem.on & held):
            useful[some] = min(useful.get(some, MANY), problem.literals([cube]))
    # The fewest literals for each set of states, built up cube by cube.
    fewest = {frozenset[State](): 0}
    for state in problem.on:
        extended: dict[frozenset[State], int] = {}
        for begun, literals in fewest.items():
            for added, more in [(frozenset[State](), 0)] if state in begun else useful.items():
                if state in begun or state in added:
                    extended[begun | added] = min(extended.get(begun | added, MANY), literals + more)
        fewest = extended
    assert problem.literals(problem.solved(problem.diagrams())) == fewest[problem.on]


@examples(80)
@given(made_by(problem(48)))
def test_what_is_said_of_a_cover_is_what_it_holds_and_what_is_denied_is_the_rest(problem: Problem) -> None:
    diagrams = problem.diagrams()
    cubes = problem.solved(diagrams)
    held = set[State]().union(*map(problem.held, cubes))
    for allowed in (True, False):
        said = worded(problem.types, diagrams, cubes, allowed)
        assert resolve_predicate(parse(print_expression(said)), NameScope(problem.types)) == said
        for state in product(*problem.domains):
            assert holds(said, dict(zip(problem.types, state, strict=True))) == ((state in held) == allowed)
        assert count_literals(said) >= problem.literals(cubes)  # more only where a range has two ends


def said_of(type_: Type, *values: Value) -> str:
    diagrams = Diagrams({"x": type_.domain}, cache=1 << 10)
    cube = (sum(1 << type_.domain.index(value) for value in values),)
    return print_expression(worded({"x": type_}, diagrams, [cube], allowed=True))


def test_values_are_said_in_the_shortest_way() -> None:
    pose = EnumerationType(("home", "above", "pair", "unknown", "lost"))
    assert said_of(BOOLEAN, True) == "x"
    assert said_of(BOOLEAN, False) == "not x"
    assert said_of(pose, "pair") == "x == pair"
    assert said_of(pose, "home", "above") == "x in {home, above}"
    assert said_of(pose, "home", "above", "lost") == "not x in {pair, unknown}"
    assert said_of(pose, "home", "above", "unknown", "lost") == "x != pair"
    count = IntegerRange(0, 9)
    assert said_of(count, 0, 1, 2) == "x <= 2"
    assert said_of(count, *range(4, 10)) == "x >= 4"
    assert said_of(count, 3, 4, 5) == "x in {3, 4, 5}"
    assert said_of(count, *range(2, 8)) == "x >= 2 and x <= 7"
    assert said_of(count, *(n for n in range(10) if n != 4)) == "x != 4"


def test_a_cover_that_takes_far_too_many_words_is_none() -> None:
    """The parity of six truth values has 32 terms of 6 literals."""
    bits = {f"x{number}": BOOLEAN for number in range(6)}
    states = list(product((False, True), repeat=6))
    odd = Problem(
        dict(bits), frozenset(s for s in states if sum(s) % 2), frozenset(s for s in states if not sum(s) % 2)
    )
    diagrams = odd.diagrams()
    on, off = odd.function(diagrams, odd.on), odd.function(diagrams, odd.off)
    assert cover(diagrams, on, off, NodeLimit(ENOUGH), 60) is None
    assert odd.literals(cover(diagrams, on, off, NodeLimit(ENOUGH), MANY) or ()) == 32 * 6


def family(choices: Choices) -> tuple[list[list[int]], list[set[int]]]:
    size = choices.number(1, 6)
    criteria = [[choices.number(0, 3) for _ in range(size)] for _ in range(choices.number(1, 2))]
    return criteria, [set(choices.different(range(size), 1, 4)) for _ in range(choices.number(0, 8))]


@examples(300)
@given(made_by(family))
def test_the_set_that_meets_all_is_the_least_by_one_criterion_after_the_other(
    given_: tuple[list[list[int]], list[set[int]]],
) -> None:
    criteria, sets = given_
    members = range(len(criteria[0]))

    def missed(chosen: frozenset[int]) -> set[int] | None:
        return next((each for each in sets if each.isdisjoint(chosen)), None)

    def rank(chosen: Iterable[int]) -> list[object]:
        return [*(sum(weights[m] for m in chosen) for weights in criteria), [m not in chosen for m in members]]

    subsets = (set(chosen) for size in range(len(members) + 1) for chosen in combinations(members, size))
    meeting = [chosen for chosen in subsets if missed(frozenset(chosen)) is None]
    found = least_hitting(frozenset(members), criteria, missed, earliest=True)
    assert found == min(meeting, key=rank)
