"""Questions to the planner as circuits in AIGER, the format of hardware model checkers (Biere 2007).

One step of the circuit is a tick. Its inputs choose effects and starts, its latches hold the state and which goals have
been reached, and one more says that no choice so far was against the rules. Its output is true when all goals have
been reached by allowed choices, so that a trace of n steps is a plan of n ticks.
"""

from __future__ import annotations

from dataclasses import dataclass

from compared.declaring import UNSUPERVISED, Problem

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.core.immutable import replace
from sequence_planner.planning.goals.pursuit import Goals
from sequence_planner.planning.goals.tracking import Progress, Tracker
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.sat.encoding import Encoding
from sequence_planner.planning.sat.solver import Circuit
from sequence_planner.planning.sat.start_order import Sweep
from sequence_planner.planning.sat.symbolic import Symbol, SymbolicState
from sequence_planner.planning.single.derived import for_planning
from sequence_planner.process.budget import Budget


class _Gates(Circuit):
    """A circuit that is not turned into clauses; what it demands is kept."""

    def __init__(self) -> None:
        self.demanded: list[tuple[int, ...]] = []
        super().__init__(self)

    def add_clause(self, clause: list[int], /) -> None:
        """Gates are kept by the circuit itself."""

    def require(self, *literals: int) -> None:
        """Demand that at least one of `literals` is true."""
        self.demanded.append(literals)


@dataclass(frozen=True)
class _Latch:
    literal: int
    following: int
    initial: bool


def aiger(problem: Problem, question: str) -> bytes:
    """The question in the binary format. Its goals must be without local formulas."""
    circuit = _Gates()
    encoding = Encoding(problem.automaton, problem.supervisor, circuit, frozenset())
    flags = frozenset(flag.name for flag in problem.automaton.flags)
    state = encoding.initial(frozenset(), determined=flags)
    circuit.demanded.clear()  # that a variable has one value is so in the state to begin with, and stays so
    sweep = Sweep(problem.automaton, problem.supervisor, known=True)
    tick = encoding.tick(state, sweep.complete(Budget.seconds(600), restart=Circumstances().restart))
    tracker = Tracker(circuit)
    latches: dict[int, _Latch] = {}
    for name, symbol in state.items():
        for value, literal in symbol.literals.items():
            if literal > 0 and literal not in latches:
                latches[literal] = _Latch(literal, tick.end[name].literal(value), problem.state[name] == value)
    reached: list[int] = []
    for goal in problem.questions[question]:
        literal = circuit.fresh()
        after = tracker.after(goal, Progress(literal, {}), tick).reached
        latches[literal] = _Latch(literal, after, initial=False)
        reached.append(after)
    for literal in encoding.assumptions(Circumstances()):
        circuit.require(literal)
    return _allowed(circuit, latches, reached)


def aiger_of_plain(automaton: Automaton, state: State, goals: Goals) -> bytes:
    """The question whether a plain automaton, unsupervised, reaches `goals`: a step of the circuit is a transition."""
    circuit = _Gates()
    bare = replace(for_planning(automaton), flags=())
    encoding = Encoding(bare, UNSUPERVISED, circuit, frozenset(), inside=True, lazily=True)
    before = encoding.initial(frozenset())
    circuit.demanded.clear()
    true = Symbol({False: Circuit.FALSE, True: Circuit.TRUE})
    readable: SymbolicState = {**before, **{each.flag("enabled"): true for each in bare.abilities.values()}}
    after, choices = dict(before), []
    for ability in bare.abilities.values():
        choice = circuit.fresh()
        choices.append(choice)
        allowed, alone = encoding.start(ability, readable, readable, choice)
        circuit.require(-choice, allowed)
        for name in before:
            if alone[name] is not readable[name]:
                after[name] = encoding.reading.chosen(choice, alone[name], after[name])
    circuit.at_most_one(choices)
    latches: dict[int, _Latch] = {}
    for name, symbol in before.items():
        for value, literal in symbol.literals.items():
            if literal > 0 and literal not in latches:
                latches[literal] = _Latch(literal, after[name].literal(value), state[name] == value)
    reached: list[int] = []
    for goal in goals:
        literal = circuit.fresh()
        now = circuit.disjunction((literal, encoding.reading.truth(goal.predicate, after).yes))
        latches[literal] = _Latch(literal, now, initial=False)
        reached.append(now)
    return _allowed(circuit, latches, reached)


def _allowed(circuit: _Gates, latches: dict[int, _Latch], reached: list[int]) -> bytes:
    """With a latch that says no choice so far was against the rules."""
    before = circuit.fresh()
    allowed = circuit.conjunction((before, *map(circuit.disjunction, circuit.demanded)))
    latches[before] = _Latch(before, allowed, initial=True)
    return _written(circuit, tuple(latches.values()), circuit.conjunction((allowed, *reached)))


def _written(circuit: _Gates, latches: tuple[_Latch, ...], output: int) -> bytes:
    """Inputs, latches and gates are numbered in this order; a gate of many parts becomes a chain."""
    gates = tuple((gate, parts) for parts, gate in circuit.gates.items())
    inner = {gate for gate, _ in gates} | {latch.literal for latch in latches}
    inputs = [variable for variable in range(2, circuit.top + 1) if variable not in inner]
    numbers = {Circuit.TRUE: 1}
    for number, variable in enumerate((*inputs, *(latch.literal for latch in latches)), start=1):
        numbers[variable] = 2 * number
    # Latches begin at 0, so one that is true to begin with holds the opposite.
    numbers |= {latch.literal: numbers[latch.literal] ^ 1 for latch in latches if latch.initial}

    def literal(signed: int) -> int:
        return numbers[abs(signed)] ^ (signed < 0)

    highest = len(inputs) + len(latches)
    chain: list[tuple[int, int, int]] = []
    for gate, parts in gates:
        current = literal(parts[0])
        for part in parts[1:]:
            highest += 1
            larger, smaller = sorted((current, literal(part)), reverse=True)
            chain.append((2 * highest, larger, smaller))
            current = 2 * highest
        numbers[gate] = current
    lines = [f"aig {highest} {len(inputs)} {len(latches)} 1 {len(chain)}"]
    lines += [str(literal(latch.following) ^ latch.initial) for latch in latches]
    lines.append(str(literal(output)))
    coded = b"".join(_coded(gate - larger) + _coded(larger - smaller) for gate, larger, smaller in chain)
    return "\n".join(lines).encode() + b"\n" + coded


def _coded(number: int) -> bytes:
    """Seven bits to the byte, the lowest first."""
    coded = bytearray()
    while number >= 128:
        coded.append(number % 128 + 128)
        number //= 128
    coded.append(number)
    return bytes(coded)
