"""View schemas of the trace of a variable: from a message to it, and from it to what follows."""

from __future__ import annotations

from typing import Literal

from pydantic import JsonValue

from sequence_planner.controller.views.details import ChangerView, WrittenPlaceView
from sequence_planner.controller.views.part import Value, View
from sequence_planner.controller.views.station import BeliefView, VariableKind
from sequence_planner.texts.message import Message


class TracedStepView(View):
    """What a message was as it came, or what a stage made of it: those `fields` of the last record that bear on the
    variable, of a stage those that it gives, with long lists and texts cut short; null where nothing has come so far.
    The first step has no `kind`.

    A stage that does not bear on the variable's fields `passes` them through, unless it holds the record: `held` are
    those it has dropped, held back, or made one of several.
    """

    kind: str | None
    summary: str
    place: WrittenPlaceView | None
    passes: bool
    fields: dict[str, JsonValue] | None
    at: float | None
    held: int
    troubles: list[str]


class TracedPipelineView(View):
    """The part of a pipeline that a variable comes by, or goes out by; a flow comes behind its sources.

    `last` is when a message was heard or sent last, also one that says the same as before, and null where there was
    none or that is not known; `fresh` whether what was heard still counts, null of what is sent and of flows.
    `between` is what leaves the last stage: the field, and the variable or the field of the message that it becomes.
    """

    name: str
    role: Literal["incoming", "flow", "outgoing"]
    resource: str
    message: str | None
    sources: list[str]
    last: float | None
    fresh: bool | None
    deadline: float | None
    trouble: str | None
    steps: list[TracedStepView]
    becomes: dict[str, str]


class TracedReaderView(View):
    """A condition that reads the variable. `part` is `enabled`, `start`, `executing`, `finish` or `supervisor` of an
    ability, `precondition` or `goal` of an operation, `forbidden` of a specification, `when` of an alarm.

    It `decides` if the condition is as it is because of the variable.
    """

    of: Literal["ability", "operation", "specification", "alarm"]
    name: str
    title: str
    part: str
    sentence: Message
    holds: bool | None
    decides: bool


class TracedChangeView(View):
    """Another variable whose value is from the same tick as the one that is traced, or from a later one: `by` whom it
    was written, an ability, where that is known. `sent` are the pipelines that carry it, with when each sent last.
    """

    name: str
    value: Value | None
    since: float
    same_tick: bool
    by: str | None
    sent: dict[str, float | None]


class TraceView(View):
    """A variable as it is at `time`: by what `incoming` it comes, by what `outgoing` it leaves, who can write it, who
    reads it, and what has changed with it or since; nothing of that is recorded for it, so what has changed twice
    since is told once, and `more_readers` and `more_changes` are not told. `from_beginning` holds as long as its value
    is that which the controller has found as it began: what was written with it is not known then.

    `written_by` is the ability that has written an output or an estimate; `belief` says it of an estimate.
    `acknowledges` are the abilities whose task somebody says to be done by it.
    """

    name: str
    kind: VariableKind
    resource: str | None
    value: Value | None
    since: float | None
    time: float
    revision: int
    incoming: list[TracedPipelineView]
    outgoing: list[TracedPipelineView]
    written_by: str | None
    belief: BeliefView | None
    acknowledges: list[str]
    writers: list[ChangerView]
    readers: list[TracedReaderView]
    more_readers: int
    from_beginning: bool
    changes: list[TracedChangeView]
    more_changes: int
