"""Where what the station believes does not fit what is measured, and what else could be true.

Pure. It says nothing of measurements that never come without a fault, nor of beliefs that never are together whatever
is measured: only of a belief that could be, a measurement that could be, and not both. An unknown variable may have any
value.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice, product
from math import inf, prod

from sequence_planner.analysis.never_together import NeverTogether
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet
from sequence_planner.automaton.structure import Automaton, Kind, State
from sequence_planner.control.restart_view import QuestionView
from sequence_planner.control.value_text import value_text
from sequence_planner.expressions.types import Value

MOST_HYPOTHESES = 64
_MOST_MEMBERS = 1000  # several can be one hypothesis, where values are unknown

Hypothesis = Mapping[str, Value]  # the estimates that have another value than is believed
Price = Callable[[str, Value], float]  # of a variable's value; infinite where it cannot have it


@dataclass(frozen=True)
class Contradictions:
    """`because` says which belief does not go together with which measurement; by one of `hypotheses` all fits."""

    because: tuple[str, ...] = ()
    hypotheses: tuple[Hypothesis, ...] = ()


def contradictions(automaton: Automaton, known: NeverTogether, state: State) -> Contradictions:
    """What is wrong in `state` with the estimates, if anything is."""
    if known.fits is not None and (found := _of_all(automaton, known.fits, state)) is not None:
        return found
    return _of_pairs(automaton, known, state)


def questions(automaton: Automaton, found: Contradictions, state: State) -> list[QuestionView]:
    """What to look at; first the variable whose value leaves the fewest hypotheses, whichever it turns out to be."""
    asked: list[tuple[int, QuestionView]] = []
    for name in automaton.names(Kind.ESTIMATED):
        believed = state[name]
        if believed is None or not any(name in hypothesis for hypothesis in found.hypotheses):
            continue
        said = [hypothesis.get(name, believed) for hypothesis in found.hypotheses]
        possible = [value for value in automaton.types[name].domain if value in said]
        question = QuestionView(variable=name, believed=believed, possible=possible, because=list(found.because))
        asked.append((sum(said.count(value) ** 2 for value in possible), question))
    return [question for _, question in sorted(asked, key=lambda each: each[0])]


def _of_all(automaton: Automaton, fits: StateSet, state: State) -> Contradictions | None:
    """By all variables at once. None where the measurements, or the estimates, alone are never so."""
    estimates = frozenset(automaton.names(Kind.ESTIMATED))

    def costs(held: frozenset[str], may_change: frozenset[str]) -> _Priced:
        """With the values of `held`, any of the others, and as few changes as possible of `may_change`."""

        def price(name: str, value: Value) -> float:
            now = state[name]
            if now is None or now == value:
                return 0
            return 1 if name in may_change else inf if name in held else 0

        return _Priced(fits, price)

    if _fits(fits, state):
        return Contradictions()
    names = frozenset(fits.names)
    believing = costs(names, estimates)
    if believing.least == inf or costs(estimates, frozenset()).least == inf:
        return None
    held = names
    for name in _last_first(automaton, fits.names):
        if costs(held - {name}, frozenset()).least == inf:
            held -= {name}
    members = islice(believing.members(), _MOST_MEMBERS)
    hypotheses = ({n: v for n, v in member.items() if n in estimates and v != state[n]} for member in members)
    return Contradictions((_because(automaton, state, held),), _different(hypotheses)[:MOST_HYPOTHESES])


def _fits(fits: StateSet, state: State) -> bool:
    """Whether the set holds the state for some values that its unknown variables could have."""
    pending, seen = [fits.root], set[int]()
    while pending:
        reference = pending.pop()
        if reference == EVERYTHING:
            return True
        if reference == NOTHING or reference in seen:
            continue
        seen.add(reference)
        axis, children = fits.nodes[reference - 2]
        value = state[fits.names[axis]]
        pending.extend(c for c, v in zip(children, fits.domains[axis], strict=True) if value is None or v == value)
    return False


def _of_pairs(automaton: Automaton, known: NeverTogether, state: State) -> Contradictions:
    """By pairs: each estimate by itself, and only where it could have some other value."""
    because: list[str] = []
    options: dict[str, list[Value]] = {}
    for name in automaton.names(Kind.ESTIMATED):
        excluded = {(value, other) for one, value, other, seen in known.pairs if one == name and state[other] == seen}
        against = sorted(other for value, other in excluded if value == state[name])
        possible = [v for v in automaton.types[name].domain if all(v != value for value, _ in excluded)]
        if against and possible:
            options[name] = possible
            because += [_because(automaton, state, (name, other)) for other in against]
    while prod(map(len, options.values())) > MOST_HYPOTHESES:
        options.popitem()  # one looks at this later, when the others are known
    combined = product(*options.values()) if options else ()
    return Contradictions(tuple(because), tuple(dict(zip(options, values, strict=True)) for values in combined))


def _last_first(automaton: Automaton, names: Iterable[str]) -> list[str]:
    """Outputs before what is measured before estimates: what is kept longest tells a person most."""
    order = (Kind.OUTPUT, Kind.MEASURED, Kind.ESTIMATED)
    return sorted(names, key=lambda name: order.index(automaton.variables[name].kind))


def _because(automaton: Automaton, state: State, names: Iterable[str]) -> str:
    """That the belief in some of `names` does not go with what the others are measured to be."""
    told = set(names)
    believed: list[str] = []
    measured: list[str] = []
    for name in (each for each in automaton.variables if each in told):
        value = state[name]
        if value is not None:
            kind = automaton.variables[name].kind
            (believed if kind is Kind.ESTIMATED else measured).append(value_text(automaton, name, value))
    return f"{' and '.join(believed)} is believed, which never goes together with {' and '.join(measured)}"


def _different(hypotheses: Iterable[Hypothesis]) -> tuple[Hypothesis, ...]:
    found: list[Hypothesis] = []
    for hypothesis in hypotheses:
        if hypothesis not in found:
            found.append(hypothesis)
    return tuple(found)


class _Priced:
    """The members of a set by what the values of their variables cost together."""

    def __init__(self, states: StateSet, price: Price) -> None:
        self._states = states
        self._prices = [
            [price(name, value) for value in domain] for name, domain in zip(states.names, states.domains, strict=True)
        ]
        # A variable that a way does not test has the value that costs nothing: there always is one that is free.
        self._costs: list[float] = [inf, 0]
        for axis, children in states.nodes:
            prices = self._prices[axis]
            self._costs.append(min(self._costs[c] + p for c, p in zip(children, prices, strict=True)))

    @property
    def least(self) -> float:
        """What the cheapest cost; infinite if there are none."""
        return self._costs[self._states.root]

    def members(self) -> Iterator[dict[str, Value]]:
        """The cheapest, by what is said of them on the way."""

        def cheapest(reference: int) -> Iterator[dict[str, Value]]:
            if reference == NOTHING:
                return
            if reference == EVERYTHING:
                yield {}
                return
            axis, children = self._states.nodes[reference - 2]
            name, domain = self._states.names[axis], self._states.domains[axis]
            for value, child, cost in zip(domain, children, self._prices[axis], strict=True):
                if cost + self._costs[child] == self._costs[reference] < inf:
                    for rest in cheapest(child):
                        yield {name: value, **rest}

        return cheapest(self._states.root)
