"""Orders of starts beside all orders there are, at stations that have more to start in a tick than other random ones.

Whether an order has all others in it depends on circles of abilities that read what the others write, which take five
abilities and more on few variables.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import product
from random import Random

from sequence_planner.automaton.automaton import Ability, Automaton, Flag, Kind, Specification, State, target
from sequence_planner.automaton.automaton import VariableDeclaration as Declared
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import supervised_start, synchronise
from sequence_planner.language.syntax import (
    FALSE,
    TRUE,
    And,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Not,
    Variable,
)
from sequence_planner.language.types import BOOLEAN, IntegerRange
from sequence_planner.planning.sat.start_order import StartPairs, Sweep
from sequence_planner.process.budget import Budget, SpentError

from .choices import Choices
from .random_expressions import Scope, equality, rare
from .random_problems import with_supervisor
from .random_stations import FLAGS, state_of

STATES = 6  # of one station
PAIRS = 6  # of one station
_SECONDS = 60.0
_IN_BETWEEN = 0.0005  # seconds: enough to ask about some pairs, and not about all


def crowded(choices: Choices, most: int = 7) -> Automaton:
    """A station of five to eight abilities on three to `most` variables, all of which the controller writes."""
    declared = {
        name: Declared(name, type_, choices.pick((Kind.OUTPUT, Kind.ESTIMATED, Kind.ESTIMATED)), type_.domain[0], None)
        for name in (f"v{number}" for number in range(choices.number(3, most)))
        for type_ in (IntegerRange(0, 2) if choices.chance(3) else BOOLEAN,)
    }
    plain = [Variable(name, each.type) for name, each in declared.items()]
    abilities = {name: _ability(choices, name, plain) for name in (f"a{n}" for n in range(choices.number(5, 8)))}
    return Automaton(
        name="crowded",
        title="crowded",
        description="",
        resources={"station": "station"},
        variables=declared,
        abilities=abilities,
        flags=tuple(Flag(a.flag(which), getattr(a, which)) for a in abilities.values() for which in FLAGS),
        effects=(),
        specifications={
            f"s{n}": Specification(f"s{n}", f"s{n}", rare(choices, plain)) for n in range(choices.number(0, 3))
        },
        rest=None,
        operations={},
    )


def _ability(choices: Choices, name: str, plain: Scope) -> Ability:
    """One that may need values of up to three variables, and writes one of these or two."""
    needed = choices.different(plain, 1, 3)
    written = choices.pick(needed)
    guard = [
        Comparison(choices.pick(("==", "==", "!=")), each, Constant(choices.pick(each.type.domain)))
        for each in needed
        if choices.chance(2)
    ]
    also = choices.different([each for each in plain if each is not written], 0, 1) if choices.chance(5) else []
    actions = tuple(
        Assignment(each, _value(choices, each), equality(choices, plain) if choices.chance(8) else None)
        for each in (written, *also)
    )
    return Ability(
        name=name,
        resource="station",
        title=name,
        enabled=TRUE,
        start_guard=And((TRUE, TRUE, *guard)),
        start_actions=actions,
        executing=FALSE,
        finished=FALSE,
        finish_guard=None,
        finish_actions=(),
        restart=choices.chance(3),
    )


def _value(choices: Choices, written: Variable) -> Expression:
    return (
        Not(written) if written.type == BOOLEAN and choices.chance(4) else Constant(choices.pick(written.type.domain))
    )


def compare_orders(seed: str) -> Counter[str]:
    """Orders of a station that `seed` makes, beside all orders; what has been met. Raises `AssertionError`."""
    choices = Choices(Random(seed).randrange)
    station, supervisor = with_supervisor(crowded(choices))
    known = choices.chance(2)
    sweep = Sweep(station, supervisor, known)
    met = Counter({"orders": 2})
    for restart in (False, True):
        if choices.chance(3):
            try:  # what is asked for is cut short: what was found by then is kept
                sweep.complete(Budget.seconds(_IN_BETWEEN), restart=restart)
            except SpentError:
                met["orders cut short once"] += 1
        order = [ability.name for ability in sweep.complete(Budget.seconds(_SECONDS), restart=restart)]
        assert set(order) == {name for name, each in station.abilities.items() if restart or not each.restart}
        met["orders with repetitions"] += len(order) > len(set(order))
        for _ in range(STATES):
            state = state_of(choices, station)
            if supervisor.safe.includes(state):
                published = state_of(choices, station) if choices.chance(3) else state
                anyhow = ends(station, supervisor, published, state, None, restart)
                assert ends(station, supervisor, published, state, order, restart) == anyhow
                met["ends of ticks"] += len(anyhow)
    return met


def compare_pairs(seed: str) -> Counter[str]:
    """Whether the order of two starts matters, beside all states; what has been met. Raises `AssertionError`."""
    choices = Choices(Random(seed).randrange)
    station, supervisor = with_supervisor(crowded(choices, 5))
    known = choices.chance(2)
    pairs = StartPairs(station, supervisor, known)
    met = Counter[str]()
    for _ in range(PAIRS):
        one, other = choices.different(list(station.abilities), 2, 2)
        told = pairs.order_matters(one, other)
        assert told == any(_told_apart(station, supervisor, one, other, known)), f"{one} and {other}, {known=}"
        met["pairs whose order matters" if told else "pairs whose order does not"] += 1
    return met


def _told_apart(station: Automaton, supervisor: Supervisor, one: str, other: str, known: bool) -> Iterator[bool]:
    """For all safe states, and all that devices may know of what is written: whether the order makes a difference."""
    first, second = station.abilities[one], station.abilities[other]
    written = sorted({target(action) for each in (first, second) for action in each.start_actions})
    for state in _states(station, list(station.variables), {}):
        if supervisor.safe.includes(state):
            for published in _states(station, written, state):
                after = _both(station, supervisor, published, state, first, second)
                back = _both(station, supervisor, published, state, second, first)
                yield after is not None and after != back and not (known and after == state)


def _both(
    station: Automaton, supervisor: Supervisor, published: State, state: State, first: Ability, second: Ability
) -> State | None:
    between = supervised_start(station, supervisor, published, state, first)
    return None if between is None else supervised_start(station, supervisor, published, between, second)


def _states(station: Automaton, names: Sequence[str], others: State) -> Iterator[State]:
    for values in product(*(station.types[name].domain for name in names)):
        yield synchronise(station, {**station.initial_valuation, **others, **dict(zip(names, values, strict=True))})


def ends(
    station: Automaton,
    supervisor: Supervisor,
    published: State,
    settled: State,
    order: Sequence[str] | None,
    restart: bool,
) -> dict[tuple[object, ...], int]:
    """All states at the end of a tick, each with the fewest starts: in any order, or as parts of `order`.

    `restart` allows more; `published` is what devices know, and `settled` the state before the starts.
    """
    fewest: dict[tuple[object, ...], int] = {}
    found = {(tuple(settled.values()), frozenset[str](), 0)}
    pending = [(settled, frozenset[str](), 0)]
    while pending:
        state, taken, place = pending.pop()
        values = tuple(state.values())
        fewest[values] = min(fewest.get(values, len(taken)), len(taken))
        following = (
            enumerate(order[place:], start=place + 1) if order is not None else ((0, n) for n in station.abilities)
        )
        for then, name in following:
            ability = station.abilities[name]
            if name in taken or (ability.restart and not restart):
                continue
            after = supervised_start(station, supervisor, published, state, ability)
            if after is None:
                continue
            key = (tuple(after.values()), taken | {name}, then)
            if key not in found:
                found.add(key)
                pending.append((after, taken | {name}, then))
    return fewest
