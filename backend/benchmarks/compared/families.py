"""Families of planning problems: `stations` of any size, and those of `classical` and `unreachable`.

All are deterministic: the same parameters, and seed where there is one, give the same problem. Run it to see how large
they are. To import it, the folder above this one must be on the path: `from compared.families import stations`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from compared.classical import automaton_of, blocks, blocks_document, logistics, logistics_document
from compared.declaring import Declared, Does, Problem
from compared.unreachable import blocked, capacity, mutex

from sequence_planner.automaton.automaton import Kind
from sequence_planner.language.types import BOOLEAN

__all__ = [
    "Problem",
    "automaton_of",
    "blocked",
    "blocks",
    "blocks_document",
    "capacity",
    "logistics",
    "logistics_document",
    "mutex",
    "stations",
]

SIZES = ((3, 2, 2), (10, 4, 2), (20, 8, 2), (40, 16, 2))  # of `stations`: 44, 136, 271 and 540 variables
POSES = ("home", "left", "right", "work")


class Product(NamedTuple):
    """A product, which visits the stations `route` one after the other, and the vehicle that brings and fetches it."""

    name: str
    route: tuple[int, ...]
    vehicle: str

    def needs(self, number: int) -> str:
        """That it is at that station, for the step that is next."""
        return f"({self.name}.at == station_{number} and {self.name}.done == {self.route.index(number)})"


def stations(number: int, products: int, steps: int) -> Problem:
    """So many stations in a ring, and products each of which visits `steps` of them, one after the other.

    Each station has a robot, a clamp, and a drive that moves a product on to the next station; between two neighbours
    there are a tool, which one of their robots can hold, and a zone, in which the tool lies and one of them can be. One
    vehicle serves four products. In the initial state every product is in stock. The questions: `part`, whether
    product 0 can be done; `several`, whether the first three can be, or both if there are two; `out`, whether product 0
    can be delivered.
    """
    assert number >= 3
    assert steps <= number
    declared = Declared(f"stations-{number}-{products}-{steps}")
    spacing = max(number // products, 1)
    made = [
        Product(f"product_{p}", tuple((p * spacing + s) % number for s in range(steps)), f"vehicle_{p // 4}")
        for p in range(products)
    ]
    for product in made:
        places = ("stock", "vehicle", *(f"station_{each}" for each in product.route), "delivered")
        declared.variable(product.name, "at", Kind.ESTIMATED, places, "stock")
        declared.variable(product.name, "done", Kind.ESTIMATED, steps, 0)
    for each in range(number):
        before, after = (each - 1) % number, (each + 1) % number
        _robot(declared, each, before)
        _tool(declared, each, before, after, made)
        _clamp(declared, each, before)
        _drive(declared, each, after, made)
    for vehicle in dict.fromkeys(product.vehicle for product in made):
        _vehicle(declared, vehicle, [product for product in made if product.vehicle == vehicle])
    done = {product.name: f"{product.name}.done == {steps}" for product in made[:3]}
    delivered = {"product_0": "product_0.at == delivered"}
    return declared.problem({"part": {"product_0": done["product_0"]}, "several": done, "out": delivered})


def _robot(declared: Declared, number: int, before: int) -> None:
    """It goes from its home pose to others and back; to the left and the right it needs the zones there for itself."""
    robot = f"robot_{number}"
    pose = declared.variable(robot, "pose", Kind.MEASURED, (*POSES, "between"), "home")
    target = declared.variable(robot, "target", Kind.OUTPUT, POSES, "home")
    declared.variable(f"zone_{number}", "owner", Kind.ESTIMATED, ("free", "first", "second"), "free")
    zones = {"left": (f"zone_{before}.owner", "second"), "right": (f"zone_{number}.owner", "first")}
    for name in POSES:
        enabled = f"{pose} == {target} and {pose} {'!=' if name == 'home' else '=='} home"
        start: tuple[str, ...] = (f"{target} := {name}",)
        finally_: tuple[str, ...] = ()
        if name in zones:
            owner, mine = zones[name]
            enabled += f" and {owner} == free"
            start += (f"{owner} := {mine}",)
        elif name == "home":
            finally_ = tuple(f"{owner} := free if {owner} == {mine}" for owner, mine in zones.values())
        executing = f"{target} == {name} and {pose} != {name}"
        finish = f"executing and {pose} == {name}"
        declared.ability(robot, f"move({name})", Does(start, enabled, executing, finish, finally_))
        declared.effect(robot, f"arrives_{name}", f"{target} == {name} and {pose} == between", f"{pose} := {name}")
    declared.effect(robot, "leaves", f"{target} != {pose} and {pose} != between", f"{pose} := between")


def _tool(declared: Declared, number: int, before: int, after: int, products: Sequence[Product]) -> None:
    """The robots beside it pick it up and put it back; at work, it does what a product needs next there."""
    tool = f"tool_{number}"
    holder = declared.variable(tool, "holder", Kind.ESTIMATED, ("rack", "first", "second"), "rack")
    run = declared.variable(tool, "run", Kind.OUTPUT, BOOLEAN, False)
    running = declared.variable(tool, "running", Kind.MEASURED, BOOLEAN, False)
    torque = declared.variable(tool, "torque", Kind.MEASURED, BOOLEAN, False)
    idle = f"not {run} and not {running}"
    sides = {"first": (number, "right", f"tool_{before}.holder != second")}
    sides["second"] = (after, "left", f"tool_{after}.holder != first")
    for side, (station, pose, empty) in sides.items():
        held = f"{holder} == {side}"
        there = f"robot_{station}.pose == {pose} and robot_{station}.target == {pose}"
        declared.ability(
            tool, f"pick_{side}", Does((f"{holder} := {side}",), f"{there} and {holder} == rack and {empty}")
        )
        declared.ability(tool, f"put_{side}", Does((f"{holder} := rack",), f"{there} and {idle} and {held}"))
        here = [product for product in products if station in product.route]
        if here:
            works = f"robot_{station}.pose == work and robot_{station}.target == work and clamp_{station}.closed"
            needed = " or ".join(product.needs(station) for product in here)
            counted = tuple(
                f"{product.name}.done := {product.route.index(station) + 1} if {product.needs(station)} and {held}"
                for product in here
            )
            enabled = f"{idle} and not {torque} and {held} and {works} and ({needed})"
            finish = f"{run} and {torque} and {held}"
            name = f"tighten_{side}"
            executing = f"{run} and {running} and not {torque} and {held}"
            declared.ability(
                tool, name, Does((f"{run} := true",), enabled, executing, finish, (f"{run} := false", *counted))
            )
    declared.effect(tool, "starts", f"{run} and not {running} and not {torque}", f"{running} := true")
    declared.effect(tool, "reaches", f"{run} and {running} and not {torque}", f"{torque} := true")
    declared.effect(
        tool, "stops", f"not {run} and ({running} or {torque})", f"{running} := false", f"{torque} := false"
    )


def _clamp(declared: Declared, number: int, before: int) -> None:
    """It holds a product while a tool is at it."""
    clamp = f"clamp_{number}"
    close = declared.variable(clamp, "close", Kind.OUTPUT, BOOLEAN, False)
    closed = declared.variable(clamp, "closed", Kind.MEASURED, BOOLEAN, False)
    occupied = declared.variable(clamp, "occupied", Kind.ESTIMATED, BOOLEAN, False)
    closes = Does(
        (f"{close} := true",), f"{occupied} and not {close} and not {closed}", f"{close} and not {closed}", closed
    )
    quiet = f"not tool_{number}.run and not tool_{before}.run"
    opens = Does(
        (f"{close} := false",), f"{close} and {closed} and {quiet}", f"not {close} and {closed}", f"not {closed}"
    )
    declared.ability(clamp, "closes", closes)
    declared.ability(clamp, "opens", opens)
    declared.effect(clamp, "shuts", f"{close} and not {closed}", f"{closed} := true")
    declared.effect(clamp, "yields", f"not {close} and {closed}", f"{closed} := false")


def _drive(declared: Declared, number: int, after: int, products: Sequence[Product]) -> None:
    """It moves a product whose step here is done to the next station of its route."""
    drive = f"drive_{number}"
    run = declared.variable(drive, "run", Kind.OUTPUT, BOOLEAN, False)
    arrived = declared.variable(drive, "arrived", Kind.MEASURED, BOOLEAN, False)
    declared.effect(drive, "arrives", f"{run} and not {arrived}", f"{arrived} := true")
    declared.effect(drive, "rests", f"not {run} and {arrived}", f"{arrived} := false")
    through = [each for each in products if (number, after) in zip(each.route, each.route[1:], strict=False)]
    if not through:
        return
    here = f"at == station_{number}"
    done = (f"({p.name}.{here} and {p.name}.done == {p.route.index(number) + 1})" for p in through)
    enabled = (
        f"not {run} and not {arrived} and clamp_{number}.occupied and not clamp_{after}.occupied and "
        f"not clamp_{number}.close and not clamp_{number}.closed and robot_{number}.pose != work and "
        f"robot_{number}.target != work and ({' or '.join(done)})"
    )
    moved = tuple(f"{p.name}.at := station_{after} if {p.name}.{here}" for p in through)
    start = (f"{run} := true", f"clamp_{after}.occupied := true")
    finally_ = (f"{run} := false", f"clamp_{number}.occupied := false", *moved)
    declared.ability(drive, "moves", Does(start, enabled, f"{run} and not {arrived}", f"{run} and {arrived}", finally_))


def _vehicle(declared: Declared, vehicle: str, products: Sequence[Product]) -> None:
    """It brings products, one at a time, from the depot to their first stations and fetches them from their last."""
    stops = ("depot", *dict.fromkeys(f"station_{each}" for p in products for each in (p.route[0], p.route[-1])))
    position = declared.variable(vehicle, "position", Kind.MEASURED, (*stops, "between"), "depot")
    target = declared.variable(vehicle, "target", Kind.OUTPUT, stops, "depot")
    loaded = declared.variable(vehicle, "loaded", Kind.ESTIMATED, BOOLEAN, False)
    declared.effect(vehicle, "leaves", f"{target} != {position} and {position} != between", f"{position} := between")
    for stop in stops:
        declared.effect(
            vehicle, f"arrives_{stop}", f"{target} == {stop} and {position} == between", f"{position} := {stop}"
        )
        go = Does(
            (f"{target} := {stop}",),
            f"{position} == {target} and {position} != {stop}",
            f"{target} == {stop} and {position} != {stop}",
        )
        declared.ability(vehicle, f"go({stop})", go)
    for product in products:
        at, done = f"{product.name}.at", f"{product.name}.done"
        first, last = product.route[0], product.route[-1]

        def there(stop: str) -> str:
            return f"{position} == {stop} and {target} == {stop}"

        free = f"not clamp_{last}.close and not clamp_{last}.closed"
        finished = f"{done} == {len(product.route)}"
        handling = {
            "load": ("depot", f"not {loaded} and {at} == stock", ("vehicle", True), ()),
            "unload": (f"station_{first}", f"{at} == vehicle and {done} == 0 and not clamp_{first}.occupied",
                       (f"station_{first}", False), (f"clamp_{first}.occupied := true",)),
            "fetch": (f"station_{last}", f"not {loaded} and {at} == station_{last} and {finished} and {free}",
                      ("vehicle", True), (f"clamp_{last}.occupied := false",)),
            "deliver": ("depot", f"{at} == vehicle and {finished}", ("delivered", False), ()),
        }  # fmt: skip
        for name, (stop, condition, (place, full), more) in handling.items():
            start = (f"{at} := {place}", f"{loaded} := {str(full).lower()}", *more)
            declared.ability(vehicle, f"{name}({product.name})", Does(start, f"{there(stop)} and {condition}"))


def main() -> None:
    """Print how large the problems are."""
    problems = [stations(*size) for size in SIZES]
    problems += [logistics(40, 4), blocks(10), mutex(6), blocked(6), capacity(4)]
    for problem in problems:
        print(f"{problem.name:<24} {problem.size}; questions: {', '.join(problem.questions)}")


if __name__ == "__main__":
    main()
