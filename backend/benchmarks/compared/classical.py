"""Logistics and blocks world: plain automata, and the same as stations whose abilities are done at their start."""

from __future__ import annotations

import json
import random
from collections.abc import Mapping
from itertools import permutations
from typing import Any

from compared.declaring import UNSUPERVISED, Problem

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.automaton.tick import synchronise
from sequence_planner.model.efa_document import read_plain
from sequence_planner.planning.problem import goals_of
from sequence_planner.planning.single.derived import for_planning

Document = dict[str, Any]


def logistics_document(packages: int, cities: int, seed: int = 1) -> Document:
    """Each package from one place to another. A city has an office, an airport and a truck between them; one aeroplane
    flies between the airports.
    """
    chosen = random.Random(seed)
    places = [f"{kind}_{city}" for city in range(cities) for kind in ("office", "airport")]
    airports = places[1::2]
    vehicles = {f"truck_{city}": places[2 * city : 2 * city + 2] for city in range(cities)} | {"plane": airports}
    variables: dict[str, list[str]] = {name: list(stops) for name, stops in vehicles.items()}
    initial = {name: chosen.choice(stops) for name, stops in vehicles.items()}
    wanted: dict[str, str] = {}
    transitions = [
        _event(f"go_{name}_{one}_{other}", f"{name} == {one}", {name: other})
        for name, stops in vehicles.items()
        for one, other in permutations(stops, 2)
    ]
    for package in (f"package_{number}" for number in range(packages)):
        variables[package] = [*places, *(f"in_{vehicle}" for vehicle in vehicles)]
        initial[package], wanted[package] = chosen.sample(places, 2)
        for name, stops in vehicles.items():
            for stop in stops:
                there, inside = f"{name} == {stop}", f"in_{name}"
                where = f"{package}_{name}_{stop}"
                transitions.append(_event(f"load_{where}", f"{there} and {package} == {stop}", {package: inside}))
                transitions.append(_event(f"unload_{where}", f"{there} and {package} == {inside}", {package: stop}))
    return _document(f"logistics-{packages}-{cities}", variables, initial, transitions, wanted)


def blocks_document(blocks: int, seed: int = 1) -> Document:
    """Towers of blocks built into others by a hand that holds one block."""
    chosen = random.Random(seed)
    names = [f"b{number}" for number in range(blocks)]
    variables: dict[str, Any] = {f"on_{name}": ["table", "hand", *names] for name in names}
    variables |= {f"clear_{name}": "bool" for name in names} | {"holding": "bool"}
    initial = _towers(names, chosen)
    wanted = {name: below for name, below in _towers(names, chosen).items() if name.startswith("on_")}
    transitions: list[Document] = []
    for name in names:
        free = f"clear_{name} and on_{name}"
        taken: dict[str, str | bool] = {f"on_{name}": "hand", "holding": True}
        transitions.append(_event(f"pick_{name}", f"not holding and {free} == table", taken))
        transitions.append(_event(f"put_{name}", f"on_{name} == hand", {f"on_{name}": "table", "holding": False}))
    for name, other in permutations(names, 2):
        below = f"clear_{other}"
        off: dict[str, str | bool] = {f"on_{name}": "hand", "holding": True, below: True}
        on: dict[str, str | bool] = {f"on_{name}": other, "holding": False, below: False}
        guard = f"not holding and clear_{name} and on_{name} == {other}"
        transitions.append(_event(f"take_{name}_{other}", guard, off))
        transitions.append(_event(f"stack_{name}_{other}", f"on_{name} == hand and {below} and on_{other} != hand", on))
    return _document(f"blocks-{blocks}", variables, initial | {"holding": False}, transitions, wanted)


def logistics(packages: int, cities: int, seed: int = 1) -> Problem:
    """`logistics_document` as a station."""
    return as_station(logistics_document(packages, cities, seed))


def blocks(number: int, seed: int = 1) -> Problem:
    """`blocks_document` as a station."""
    return as_station(blocks_document(number, seed))


def automaton_of(document: Document) -> Automaton:
    """The plain automaton that a document means."""
    return plain_automaton(read_plain(json.dumps(document), str(document["name"])))


def as_station(document: Document) -> Problem:
    """The transitions as abilities that are done at their start, several of which fit into a tick."""
    plain = automaton_of(document)
    station = for_planning(plain)
    state = synchronise(station, {**dict.fromkeys(station.types), **plain.initial_valuation})
    return Problem(plain.name, station, UNSUPERVISED, state, {"all": goals_of(plain, plain.operations)})


def _towers(names: list[str], chosen: random.Random) -> dict[str, str | bool]:
    """Where each block stands, and whether nothing stands on it."""
    below: dict[str, str | bool] = {}
    tops: list[str] = []
    for name in chosen.sample(names, len(names)):
        base = chosen.choice(["table", *tops]) if tops else "table"
        below[f"on_{name}"], below[f"clear_{name}"] = base, True
        if base != "table":
            tops.remove(base)
            below[f"clear_{base}"] = False
        tops.append(name)
    return below


def _event(event: str, guard: str, update: Mapping[str, str | bool]) -> Document:
    return {"event": event, "controllable": True, "guard": guard, "set": dict(update)}


def _document(
    name: str,
    variables: Mapping[str, Any],
    initial: Mapping[str, str | bool],
    transitions: list[Document],
    wanted: Mapping[str, str | bool],
) -> Document:
    goal = " and ".join(f"{variable} == {value}" for variable, value in wanted.items())
    return {
        "name": name,
        "variables": dict(variables),
        "initial": " and ".join(
            (variable if value else f"not {variable}") if isinstance(value, bool) else f"{variable} == {value}"
            for variable, value in initial.items()
        ),
        "transitions": transitions,
        "goal": [f"F ({goal})"],
    }
