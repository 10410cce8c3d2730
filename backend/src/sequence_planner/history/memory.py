"""All that an execution remembers, as one document: what comes next depends on nothing else.

The tables say of each attribute what it is. A test compares them with the attributes that there are, so that a new one
cannot be forgotten: it belongs into a table, or to what is made of the rest.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from typing import Any, Final

from pydantic import JsonValue

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.control.conduct import Conduct
from sequence_planner.control.execution import Execution
from sequence_planner.control.live_plan import Question, Replacement
from sequence_planner.control.pursued import Pursued
from sequence_planner.control.start_order import Step
from sequence_planner.control.vocabulary import PlanStatus
from sequence_planner.history.codec import Codec, Document
from sequence_planner.history.shapes import UnreadableError
from sequence_planner.planning.plan import Plan, PlanAnswer, PlanRequest
from sequence_planner.planning.reasons.diagnosis import Diagnosis

Table = Mapping[str, Any]  # attribute: its type

EXECUTION: Final[Table] = {
    "state": State,
    "published": State,
    "active": frozenset[str],
    "_operations": Pursued,
    "conduct": Conduct,
    "ticks": int,
    "revision": int,
    "obstacles": tuple[str, ...],
    "asked": PlanRequest | None,
}
PLAN: Final[Table] = {
    "status": PlanStatus,
    "reason": str,
    "answer": PlanAnswer | None,
    "replanned": int,
    "replacement": Replacement | None,
    "diagnosis": Diagnosis | None,
    "_asked": Question | None,
    "_asked_better": Question | None,
    "_started_since_asked": bool,
    "_none_while_blind": bool,
    "_undecided": bool,
    "_none": PlanRequest | None,
}
ORDER: Final[Table] = {
    "plan": Plan | None,
    "goals": frozenset[str],
    "requested": frozenset[str],
    "past": list[Step],
    "ahead": list[Step],
    "_numbers": int,
}
# What belongs to the station, is made of the rest (`state` is that of `_run`, `circumstances` those of `conduct`), or
# has an own table.
DERIVED: Final = frozenset(
    {
        *("automaton", "supervisor", "listeners", "plan", "order", "circumstances"),
        *("_automaton", "_compiled", "_run", "_supervised", "_curious", "_free", "_lookahead"),
    }
)


class Memory:
    """Writes and reads what executions of one station remember."""

    def __init__(self, automaton: Automaton, codec: Codec) -> None:
        self._automaton = automaton
        self._codec = codec
        self._texts: dict[str, tuple[object, bytes]] = {}  # of each part, as it was last

    def document(self, execution: Execution) -> Document:
        """All that an execution remembers."""
        return {part: self._codec.encode(form, value) for part, form, value in _parts(execution)}

    def digest(self, execution: Execution) -> str:
        """16 hexadecimal digits over all that it remembers."""
        total = hashlib.sha256()
        for part, form, value in _parts(execution):
            known = self._texts.get(part)
            # Steps are all that is changed in place; everything else is replaced when it changes.
            now = [tuple(vars(step).values()) for step in value] if isinstance(value, list) else value
            if known is None or (known[0] != now if isinstance(now, list) else known[0] is not now):
                known = self._texts[part] = now, json.dumps(self._codec.encode(form, value)).encode() + b"\n"
            total.update(known[1])
        return total.hexdigest()[:16]

    def execution(self, supervisor: Supervisor, document: Mapping[str, JsonValue]) -> Execution:
        """An execution that goes on as the one did that remembered this. Raises `UnreadableError`."""
        execution = Execution(self._automaton, supervisor)
        for part, owner, name, form in _places(execution):
            if part not in document:
                raise UnreadableError(f"nothing is said of {part}")
            setattr(owner, name, self._codec.decode(form, document[part]))
        execution._face()  # in the circumstances that are remembered
        return execution


def _parts(execution: Execution) -> Iterator[tuple[str, Any, object]]:
    """Each part by its name, with its type and value."""
    for part, owner, name, form in _places(execution):
        yield part, form, getattr(owner, name)


def _places(execution: Execution) -> Iterator[tuple[str, object, str, Any]]:
    """Each part by its name: whose attribute it is, the attribute's name and its type."""
    owners = (("", execution, EXECUTION), ("plan.", execution.plan, PLAN), ("order.", execution.plan.order, ORDER))
    for prefix, owner, table in owners:
        for name, form in table.items():
            yield f"{prefix}{name.lstrip('_')}", owner, name, form
