"""Every reading that proves something impossible, against what the station is seen to do."""

from __future__ import annotations

from sequence_planner.analysis.checks.reachability import cannot_be
from sequence_planner.analysis.checks.relaxed_reachability import Growth
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.tick import synchronise
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Expression
from sequence_planner.model.loader import load_station
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import Plant
from support.places import WORKED_EXAMPLE


def predicate(automaton: Automaton, text: str) -> Expression:
    return automaton.read_condition(text)


def test_what_is_reached_is_never_said_to_be_impossible() -> None:
    """For every pair of values of every two variables of the worked example."""
    automaton = ground(load_station(WORKED_EXAMPLE))
    supervision = Supervision(Plant(automaton, tuple(automaton.variables)))
    members = supervision.plant.diagrams.exported(supervision.reachable(supervised=False)).members()
    full = [synchronise(automaton, {**automaton.initial_valuation, **member}) for member in members]
    growth = Growth(automaton, any_measurement=False)
    texts = [f"bolts == {bolts}" for bolts in ("empty", "placed", "tightened")]
    texts += [f"robot.target_pose == {pose}" for pose in ("home", "above", "bolt_pair")]
    texts += ["operator.task", "not operator.task", "nutrunner.set_tool_idle", "nutrunner.run_nut.executing"]
    impossible = 0
    for one in texts:
        for other in texts:
            both = predicate(automaton, f"({one}) and ({other})")
            if any(holds(both, state) for state in full):
                assert growth.may(both)
                assert not cannot_be(automaton, [both])
            else:
                impossible += cannot_be(automaton, [both])
    assert impossible > 0
