"""Plain automata that nobody has seen before: their shapes and parameters are drawn anew from a seed.

Each shape makes an automaton from a source of chance and a scale. What is asked of it is where a run of random
transitions has led to: some of the values there, so there is a plan, and nobody knows how long the shortest is. What
cannot be reached is asked, too, in the shapes that have an invariant which the delete relaxation does not see.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from compared.classical import automaton_of
from compared.declaring import UNSUPERVISED
from compared.families import stations

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.automaton.plain.steps import plain_transitions, step
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.export.efa import plain_of_station
from sequence_planner.language.syntax import Comparison, Constant, Expression, Variable, conjunction
from sequence_planner.planning.problem import Goal

Names = Sequence[str]


@dataclass(frozen=True)
class Unseen:
    """A plain automaton with goals: one that can be reached together from its initial state, and one that cannot."""

    name: str
    automaton: Automaton
    goals: tuple[Goal, ...]
    impossible: tuple[Goal, ...] = ()
    supervisor: Supervisor = UNSUPERVISED

    @property
    def size(self) -> str:
        """How many variables and transitions there are."""
        transitions = len(plain_transitions(self.automaton))
        return f"{len(self.automaton.variables)} variables, {transitions} transitions"


class _Shape:
    """Collects what a document of a plain automaton has."""

    def __init__(self) -> None:
        self.variables: dict[str, Any] = {}
        self.initial: dict[str, Any] = {}
        self.transitions: list[dict[str, Any]] = []
        self.impossible = ""

    def variable(self, name: str, domain: object, initial: object) -> str:
        """A variable; a number means a range from 0 on."""
        self.variables[name] = {"min": 0, "max": domain} if isinstance(domain, int) else domain
        self.initial[name] = initial
        return name

    def event(self, name: str, guard: Sequence[str], **update: object) -> None:
        """A transition."""
        written = " and ".join(guard) or "true"
        self.transitions.append({"event": name, "controllable": True, "guard": written, "set": update})

    def automaton(self, name: str) -> Automaton:
        """What has been collected."""
        initial = [
            (variable if value else f"not {variable}") if isinstance(value, bool) else f"{variable} == {value}"
            for variable, value in self.initial.items()
        ]
        document = {
            "name": name,
            "variables": self.variables,
            "initial": " and ".join(initial),
            "transitions": self.transitions,
        }
        return automaton_of(document)


def net(chance: random.Random, scale: int) -> _Shape:
    """Tokens move between places of some capacity, one or two at a time; no transition makes or loses one."""
    shape, size, most = _Shape(), 10 * scale, chance.randint(1, 3)
    places = [shape.variable(f"p{n}", most, chance.randint(0, most)) for n in range(size)]
    for number in range(size * chance.choice((2, 3))):
        pairs = chance.choice((1, 1, 2))
        near = chance.randrange(size)
        nearby = [places[(near + offset) % size] for offset in range(-3, 4)]
        moved = chance.sample(nearby, 2 * pairs)
        update = {place: f"{place} - 1" for place in moved[:pairs]} | {place: f"{place} + 1" for place in moved[pairs:]}
        shape.event(f"t{number}", [*(f"{p} > 0" for p in moved[:pairs]), *(f"{p} < {most}" for p in moved[pairs:])],
                    **update)  # fmt: skip
    left = sum(shape.initial.values())
    demanded: list[str] = []
    for place in chance.sample(places, size):  # one token more than there are
        value = min(most, left + 1)
        demanded.append(f"{place} >= {value}" if value else "true")
        left -= value
        if left < 0:
            break
    shape.impossible = " and ".join(demanded) if left < 0 else ""
    return shape


def rooms(chance: random.Random, scale: int) -> _Shape:
    """Robots in rooms with doors that keys open; a key and other things lie in rooms or are carried, one at a time."""
    shape = _Shape()
    width, height = 2 + chance.randint(1, 2), 1 + scale
    cells = [f"r{x}_{y}" for x in range(width) for y in range(height)]
    robots = [f"robot{n}" for n in range(1 + scale // 3)]
    for robot in robots:
        shape.variable(robot, cells, chance.choice(cells))
        shape.variable(f"{robot}_full", "bool", False)
    doors = [(f"r{x}_{y}", other) for x in range(width) for y in range(height)
             for other in (f"r{x + 1}_{y}", f"r{x}_{y + 1}") if other in cells]  # fmt: skip
    locked = [door for door in doors if chance.random() < 0.25]
    things = [f"thing{n}" for n in range(4 * scale)]
    for thing in things:
        shape.variable(thing, [*cells, *(f"on_{robot}" for robot in robots)], chance.choice(cells))
    for one, other in doors:
        door = f"open_{one}_{other}"
        if (one, other) in locked:
            shape.variable(door, "bool", False)
            key = chance.choice(things)
            for robot in robots:
                for side in (one, other):
                    needed = [f"not {door}", f"{robot} == {side}", f"{key} == on_{robot}"]
                    shape.event(f"{robot}_opens_{door}_{side}", needed, **{door: True})
        for robot in robots:
            for here, there in ((one, other), (other, one)):
                guard = [f"{robot} == {here}", *([door] if (one, other) in locked else [])]
                shape.event(f"{robot}_{here}_{there}", guard, **{robot: there})
    for thing in things:
        for robot in robots:
            full = f"{robot}_full"
            for cell in cells:
                shape.event(f"{robot}_takes_{thing}_{cell}",
                            [f"not {full}", f"{robot} == {cell}", f"{thing} == {cell}"],
                            **{thing: f"on_{robot}", full: True})  # fmt: skip
                shape.event(f"{robot}_leaves_{thing}_{cell}", [f"{thing} == on_{robot}", f"{robot} == {cell}"],
                            **{thing: cell, full: False})  # fmt: skip
    shape.impossible = " and ".join(f"{thing} == on_{robots[0]}" for thing in chance.sample(things, 2))
    return shape


def line(chance: random.Random, scale: int) -> _Shape:
    """Parts go through cells in a line, each with room for one, and are worked on by robots that neighbours share."""
    shape, cells = _Shape(), 3 + 2 * scale
    parts = [f"part{n}" for n in range(1 + scale)]
    places = ["store", *(f"c{n}" for n in range(cells)), "out"]
    for n in range(cells):
        shape.variable(f"free{n}", "bool", True)
    shared = chance.randint(2, 3)
    for n in range(0, cells, shared):
        shape.variable(f"robot{n}", ["home", *(f"c{m}" for m in range(n, min(n + shared, cells)))], "home")
        shape.variable(f"tool{n}", ["none", "drill", "glue"], "none")
    working = [n for n in range(cells) if chance.random() < 0.6] or [0]
    for part in parts:
        shape.variable(part, places, "store")
        steps = chance.sample(working, min(len(working), chance.randint(1, 3)))
        shape.variable(f"{part}_done", len(steps), 0)
        for step_, cell in enumerate(sorted(steps)):
            robot = f"robot{cell // shared * shared}"
            tool = chance.choice(("drill", "glue"))
            shape.event(f"{part}_worked_{cell}",
                        [f"{part} == c{cell}", f"{robot} == c{cell}", f"tool{cell // shared * shared} == {tool}",
                         f"{part}_done == {step_}"], **{f"{part}_done": step_ + 1})  # fmt: skip
        shape.event(f"{part}_in", [f"{part} == store", "free0"], **{part: "c0", "free0": False})
        shape.event(f"{part}_out", [f"{part} == c{cells - 1}"], **{part: "out", f"free{cells - 1}": True})
        for n in range(cells - 1):
            arm = n // shared * shared
            shape.event(f"{part}_moves_{n}", [f"{part} == c{n}", f"free{n + 1}", f"robot{arm} != c{n}"],
                        **{part: f"c{n + 1}", f"free{n}": True, f"free{n + 1}": False})  # fmt: skip
    for n in range(0, cells, shared):
        for pose in shape.variables[f"robot{n}"][1:]:
            shape.event(f"robot{n}_to_{pose}", [f"robot{n} == home"], **{f"robot{n}": pose})
            shape.event(f"robot{n}_from_{pose}", [f"robot{n} == {pose}"], **{f"robot{n}": "home"})
        for tool in ("drill", "glue"):
            shape.event(f"tool{n}_{tool}", [f"robot{n} == home", f"tool{n} != {tool}"], **{f"tool{n}": tool})
    if len(parts) > 1:
        where = f"c{chance.randrange(cells)}"
        shape.impossible = " and ".join(f"{part} == {where}" for part in chance.sample(parts, 2))
    return shape


def counters(chance: random.Random, scale: int) -> _Shape:
    """Counters that gears turn in pairs, up or down; switches, which some gears need, move at certain counts."""
    shape, number = _Shape(), 4 * scale
    most = chance.randint(4, 7)
    names = [shape.variable(f"n{n}", most, chance.randint(0, most)) for n in range(number)]
    switches = [shape.variable(f"s{n}", "bool", chance.random() < 0.5) for n in range(max(number // 2, 1))]
    for gear in range(2 * number):
        one, other = (names[(gear + offset) % number] for offset in (0, chance.randint(1, min(3, number - 1))))
        way, back = chance.choice((("+", "-"), ("+", "+")))
        needs = [chance.choice(("", "not ")) + chance.choice(switches)] if chance.random() < 0.5 else []
        shape.event(f"g{gear}", needs, **{one: f"{one} {way} 1", other: f"{other} {back} 1"})
        undo = {"+": "-", "-": "+"}
        shape.event(f"b{gear}", needs, **{one: f"{one} {undo[way]} 1", other: f"{other} {undo[back]} 1"})
    for switch in switches:
        count = chance.choice(names)
        shape.event(f"on_{switch}", [f"not {switch}", f"{count} >= {chance.randint(1, most)}"], **{switch: True})
        shape.event(f"off_{switch}", [switch, f"{count} <= {chance.randint(0, most - 1)}"], **{switch: False})
    values = [shape.initial[name] for name in names]
    changed = chance.randrange(number)  # the sum of all counters stays even, or stays odd
    values[changed] += 1 if values[changed] < most else -1
    shape.impossible = " and ".join(f"{name} == {value}" for name, value in zip(names, values, strict=True))
    return shape


def web(chance: random.Random, scale: int) -> _Shape:
    """Enumerations whose steps from value to value need values of a few others, in no order of any kind."""
    shape, number = _Shape(), 8 * scale
    sizes = [chance.randint(2, 5) for _ in range(number)]
    for n, size in enumerate(sizes):
        shape.variable(f"v{n}", [f"x{value}" for value in range(size)], "x0")
    for n, size in enumerate(sizes):
        for value in range(size):
            for other in {(value + 1) % size, chance.randrange(size)} - {value}:
                needs = [m for m in chance.sample(range(number), chance.randint(0, 2)) if m != n]
                guard = [f"v{n} == x{value}", *(f"v{m} == x{chance.randrange(sizes[m])}" for m in needs)]
                shape.event(f"v{n}_{value}_{other}", guard, **{f"v{n}": f"x{other}"})
    return shape


def station(chance: random.Random, scale: int) -> Automaton:
    """A ring of stations, of a size drawn, as a plain automaton."""
    number = chance.randint(3, 3 + 2 * scale)
    problem = stations(number, chance.randint(1, number), chance.randint(1, 2))
    return plain_of_station(problem.automaton)


SHAPES: Mapping[str, Callable[[random.Random, int], _Shape]] = {
    shape.__name__: shape for shape in (net, rooms, line, counters, web)
}
SCALES = {
    "net": (2, 6, 13),
    "rooms": (1, 2, 4),
    "line": (1, 3, 6),
    "counters": (1, 2, 4),
    "web": (2, 5, 10),
    "station": (0, 1),
}


def unseen(name: str, scale: int, seed: int) -> Unseen:
    """The automaton of that shape, or of a `station`, with goals; the same for the same seed."""
    chance = random.Random(f"{name} {scale} {seed}")
    if name == "station":
        automaton, impossible = station(chance, scale), ""
    else:
        shape = SHAPES[name](chance, scale)
        automaton, impossible = shape.automaton(f"{name}-{scale}"), shape.impossible
    asked = (Goal("impossible", _predicate(automaton, impossible)),) if impossible else ()
    return Unseen(f"{name}-{scale}", automaton, (_goal(automaton, chance, 40 * (scale + 1)),), asked)


def strayed(automaton: Automaton, state: State, chance: random.Random, steps: int = 1) -> State:
    """Where so many random transitions lead from `state`."""
    transitions = list(plain_transitions(automaton).values())
    for _ in range(steps):
        ways = [after for each in transitions if (after := step(state, each)) is not None and after != state]
        state = chance.choice(ways) if ways else state
    return state


def _goal(automaton: Automaton, chance: random.Random, steps: int) -> Goal:
    begin = automaton.initial_valuation
    end = strayed(automaton, begin, chance, steps)
    changed = [name for name, value in begin.items() if end[name] != value]
    some = chance.sample(changed, min(len(changed), chance.randint(2, 6)))
    parts: list[Expression] = []
    for name in some:
        value = end[name]
        assert value is not None
        parts.append(Comparison("==", Variable(name, automaton.variables[name].type), Constant(value)))
    return Goal("reached", conjunction(*parts))


def _predicate(automaton: Automaton, text: str) -> Expression:
    return automaton.read_condition(text)
