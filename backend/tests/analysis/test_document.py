"""What was found, as JSON."""

from __future__ import annotations

from sequence_planner.analysis.report import trace_document
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis.reachability import Tracer
from sequence_planner.synthesis.supervisor import relevant
from sequence_planner.synthesis.traces import Trace
from sequence_planner.synthesis.transition_relation import Plant
from support.automata import Does, automaton

OFF = (BOOLEAN, False)


def test_a_trace_as_a_document() -> None:
    station = automaton(
        {"open": Does(start=("valve := true",))},
        measured={"flows": OFF},
        output={"valve": OFF},
        effects={"flow": ("valve", ("flows := true",))},
        forbidden={"no_flow": "flows"},
    )
    plant = Plant(station, relevant(station))
    trace = Tracer(plant).shortest(plant.where(station.specifications["no_flow"].forbidden))
    assert isinstance(trace, Trace)
    assert trace_document(station, trace).model_dump() == {
        "initial": {"flows": False, "valve": False},
        "forbidden_by": [],
        "steps": [
            {
                "kind": "start",
                "names": ["open"],
                "finished": [],
                "changes": {"valve": True},
                "forbidden_by": [],
                "text": "start 1: open: valve := true",
            },
            {
                "kind": "tick",
                "names": ["flow"],
                "finished": [],
                "changes": {"flows": True},
                "forbidden_by": ["no_flow"],
                "text": "tick 2: flows := true (flow), which no_flow forbids",
            },
        ],
    }
