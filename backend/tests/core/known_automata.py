"""Documents of plain automata of any size whose numbers of states are known."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

Document = dict[str, Any]


def philosophers(number: int) -> Document:
    """Dining philosophers, each of whom takes the two forks in either order and releases both; all is controllable.

    Without a supervisor 3^n states can be reached: the owners of the forks, as a philosopher who has one of them can
    have either. Two of these, in which everybody has a left or everybody a right fork, are without a way on.
    """
    variables: dict[str, Any] = {}
    transitions: list[Document] = []
    for each in range(number):
        who, left, right = f"p{each}", f"f{each}", f"f{(each + 1) % number}"
        variables |= {who: ["thinks", "has_left", "has_right", "eats"], left: "bool"}
        transitions += [
            _start(f"take_left_{each}", f"{who} == thinks and {left}", {who: "has_left", left: False}),
            _start(f"take_right_{each}", f"{who} == thinks and {right}", {who: "has_right", right: False}),
            _start(f"add_left_{each}", f"{who} == has_right and {left}", {who: "eats", left: False}),
            _start(f"add_right_{each}", f"{who} == has_left and {right}", {who: "eats", right: False}),
            _start(f"release_{each}", f"{who} == eats", {who: "thinks", left: True, right: True}),
        ]
    free = [f"f{each}" for each in range(number)]
    thinking = [f"p{each} == thinks" for each in range(number)]
    return {
        "name": f"philosophers-{number}",
        "variables": variables,
        "initial": " and ".join([*thinking, *free]),
        "transitions": transitions,
        "marked": " and ".join(free),
    }


def transfer_lines(number: int) -> Document:
    """Transfer lines one behind another (after Wonham, "Supervisory Control of Discrete-Event Systems").

    A line is machine 1, a buffer of 3, machine 2, a buffer of 1 and a test unit, which sends rejected parts back to the
    first buffer. Machine 1 of the first line has parts without end, and what the last test unit accepts is gone. Two
    lines have a buffer of 1 between them, for what the test unit before it accepts and machine 1 behind it takes. Only
    starts are controllable. The last value of a buffer is its overflow, which is forbidden; a part more changes nothing
    then. A line has 8 bits, a buffer between two has 2. Marked: all machines idle and all buffers empty.

    All 120 states of each line and 3 of each buffer between can be reached; 28 for one line under its supervisor, and
    45 times as many with each line and buffer more.
    """
    variables: dict[str, Any] = {}
    transitions: list[Document] = []
    forbidden: list[str] = []
    sizes: dict[str, int] = {}
    for line in range(number):
        first, second, test = f"machine_1_{line}", f"machine_2_{line}", f"test_{line}"
        before, after = f"between_{line - 1}", f"between_{line}"
        rework, finished = f"buffer_1_{line}", f"buffer_2_{line}"
        sizes |= {rework: 3, finished: 1} | ({after: 1} if line < number - 1 else {})
        variables |= dict.fromkeys((first, second, test), "bool")
        for machine, source in ((first, before), (second, rework), (test, finished)):
            transitions.append(_taking(f"start_{machine}", machine, source if source in sizes else None))
        for event, machine, target in (
            (f"end_{first}", first, rework),
            (f"end_{second}", second, finished),
            (f"accept_{line}", test, after),
            (f"reject_{line}", test, rework),
        ):
            transitions += _giving(event, machine, target, sizes.get(target))
    for buffer, size in sizes.items():
        variables[buffer] = {"min": 0, "max": size + 1}
        forbidden.append(f"{buffer} == {size + 1}")
    empty = [f"{name} == 0" if name in sizes else f"not {name}" for name in variables]
    return {
        "name": f"transfer-lines-{number}",
        "variables": variables,
        "initial": " and ".join(empty),
        "transitions": transitions,
        "forbidden": forbidden,
        "marked": " and ".join(empty),
    }


def _start(event: str, guard: str, updates: Mapping[str, Any]) -> Document:
    return {"event": event, "controllable": True, "guard": guard, "set": dict(updates)}


def _taking(event: str, machine: str, source: str | None) -> Document:
    """A machine begins to work on a part from `source`."""
    if source is None:
        return _start(event, f"not {machine}", {machine: True})
    return _start(event, f"not {machine} and {source} > 0", {machine: True, source: f"{source} - 1"})


def _giving(event: str, machine: str, target: str, size: int | None) -> list[Document]:
    """A machine ends, and its part goes to `target`; one without a size is outside, and takes everything."""
    if size is None:
        return [_end(event, machine, {machine: False})]
    return [
        _end(event, f"{machine} and {target} <= {size}", {machine: False, target: f"{target} + 1"}),
        _end(event, f"{machine} and {target} > {size}", {machine: False}),
    ]


def _end(event: str, guard: str, updates: Mapping[str, Any]) -> Document:
    return {"event": event, "controllable": False, "guard": guard, "set": dict(updates)}
