"""The bolt tightening station as a planning problem of the size that people run."""

from __future__ import annotations

from pathlib import Path

from compared.declaring import Problem

from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.planning.problem import goals_of
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise

MODEL = Path(__file__).parents[3] / "models" / "bolt_tightening"
PAIRS = ("bolt_pair_1", "bolt_pair_2", "bolt_pair_3")


def bolt_tightening() -> Problem:
    """All bolts are placed and the station is at home: tighten one pair (`part`), or all three (`several`)."""
    automaton = prepare_station(MODEL).automaton
    placed = {f"bolts[{pair}]": "placed" for pair in PAIRS}
    state = synchronise(automaton, {**initial_state(automaton), **placed})
    goals = goals_of(automaton, (f"tighten_bolt_pair({pair})" for pair in PAIRS))
    questions = {"part": goals[:1], "several": goals}
    return Problem("bolt-tightening", automaton, synthesise(automaton), state, questions)
