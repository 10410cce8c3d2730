"""One synthesis in a process of its own, for its time and its memory: `one_synthesis.py MODEL ENGINE ALGORITHM`.

MODEL is a station's folder, the file of a plain automaton, or `philosophers-N` or `transfer-lines-N`; ENGINE is `oxidd`
or `cudd`, ALGORITHM `saturation`, `chaining` or `breadth-first`. Prints figures as JSON, of states of all variables.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from importlib import import_module
from pathlib import Path

from core.known_automata import philosophers, transfer_lines
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.model.efa_document import load_plain, read_plain
from sequence_planner.station import prepare_station
from sequence_planner.synthesis import bdd, supervisor
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import Plant

KNOWN = {"philosophers": philosophers, "transfer-lines": transfer_lines}


def automaton_of(model: str) -> Automaton:
    """The automaton that is meant."""
    family, _, number = model.rpartition("-")
    if family in KNOWN:
        return plain_automaton(read_plain(json.dumps(KNOWN[family](int(number))), model))
    path = Path(model)
    return plain_automaton(load_plain(path)) if path.is_file() else prepare_station(path).automaton


def choose(engine: str, algorithm: str) -> None:
    """Put the engine and the algorithm in the place of our own."""
    if engine == "cudd":
        cudd = import_module("cudd")
        bdd.BCDDManager = cudd.Manager  # type: ignore[attr-defined]
        bdd.BCDDSubstitution = cudd.Substitution  # type: ignore[attr-defined]
    if algorithm != "saturation":
        reachable, reaching = import_module("fixpoints").closures(algorithm)
        supervisor.reachable = reachable  # type: ignore[attr-defined]
        supervisor.reaching = reaching  # type: ignore[attr-defined]


def main() -> None:
    """Measure and print."""
    model, engine, algorithm = sys.argv[1:]
    choose(engine, algorithm)
    automaton = automaton_of(model)
    began = time.process_time()
    found = Supervision(Plant(automaton, tuple(automaton.variables)))
    safe_at = time.process_time()
    counts = [found.plant.diagrams.count(found.reachable(supervised)) for supervised in (False, True)]
    ended = time.process_time()
    figures = {
        "bits": sum(map(len, found.plant.diagrams.bits.values())),
        "safe": safe_at - began,
        "all": ended - began,
        "mebibytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "reachable": counts[0],
        "supervised": counts[1],
    }
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
