"""What is shown of a recording: what it has for the draft, its moments, and the state at one of them."""

from __future__ import annotations

from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.controller.views.part import View
from sequence_planner.editor.recordings.reading import Difference, Incomplete, Standing
from sequence_planner.texts.message import Message


class RecordedTopicView(View):
    """A topic of the draft with the `messages` that were read of it, and the variables that they tell: those that are
    measured, or commanded.
    """

    name: str
    type: str
    messages: int
    variables: list[str]


class MissingTopicView(View):
    """A topic of the draft that was not recorded, and the measured variables that it tells."""

    name: str
    type: str
    variables: list[str]


class OtherTopicView(View):
    """A topic of the draft of which the messages were not read: they are `recorded` as another type, the `type` has
    another definition there, or they are in another encoding.
    """

    name: str
    type: str
    recorded: str
    difference: Difference
    messages: int
    variables: list[str]


class RecordedTroubleView(View):
    """What made no sense, or could not be read, in `count` messages of a topic; for the `first` time so many seconds
    after the beginning.
    """

    topic: str
    text: str
    count: int
    first: float


class RecordedChangeView(View):
    """A variable that became another, or of which what was said counts no more or for the first time."""

    name: str
    before: ShownValue | None
    after: ShownValue | None
    standing: Standing


class RecordedMomentView(View):
    """A moment, so many seconds after the beginning, at which variables became others."""

    at: float
    changes: list[RecordedChangeView]


class RecordingView(View):
    """A recording as the draft after its change `number` reads it: `bytes` of a file `name`, begun at a time, which
    lasts so many `seconds`.

    It was read `until` a moment: to its end unless it is `incomplete`. Its `moments` are those after the one that was
    asked for; `earlier` and `later` count the others. `messages` were read, and those of `others` passed over, which
    the draft has no use for. With an `obstacle` the draft cannot be used.
    """

    id: str
    number: int
    name: str
    bytes: int
    obstacle: Message | None
    began: float
    seconds: float
    until: float
    incomplete: Incomplete | None
    messages: int
    passed_over: int
    topics: list[RecordedTopicView]
    missing: list[MissingTopicView]
    otherwise: list[OtherTopicView]
    others: list[str]
    troubles: list[RecordedTroubleView]
    moments: list[RecordedMomentView]
    earlier: int
    later: int


class RecordedVariableView(View):
    """A variable that is measured, or `commanded`, at a moment: its value, null where it is unknown, and whence it has
    it.

    `last` is what it was when it was known last, `since` when.
    """

    name: str
    commanded: bool
    value: ShownValue | None
    standing: Standing
    last: ShownValue | None
    since: float | None
    topics: list[str]


class RecordedStateView(View):
    """The state of the draft at a moment of a recording: `values` of all variables, as What-if begins with them, and
    whence those that are measured or commanded have theirs. All others are as the model begins.
    """

    id: str
    number: int
    at: float
    obstacle: Message | None
    values: dict[str, ShownValue | None]
    variables: list[RecordedVariableView]
