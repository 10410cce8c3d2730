"""Transfer of a running station's state to another model (what-if), and its simulated continuation."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from enum import StrEnum

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.controller.views.part import View
from sequence_planner.core.immutable import replace
from sequence_planner.editor.schemas.diff import Taken, TransferView
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.texts.message import Message

# Whether a station in its present state can take another model, and how it gets to where it can.

ADVISING = 5.0  # seconds


def transferred(automaton: Automaton, present: Mapping[str, Value | None]) -> State:
    """The state in which another model begins: what it has in common with the `present` one goes on, if its values are
    those of the model; what is unknown stays so.
    """
    kept = {
        name: present[name]
        for name, declared in automaton.variables.items()
        if name in present and (present[name] is None or contains(declared.type, present[name]))
    }
    return synchronise(automaton, {**initial_state(automaton), **kept})


def transfer(
    old: Automaton | None,
    automaton: Automaton,
    supervisor: Supervisor,
    present: Mapping[str, Value | None],
    running: Collection[str],
    *,
    reset: bool = False,
) -> TransferView:
    """Tell what would come of it, with abilities `running` as the `old` model has them; None for one that cannot be
    used.

    Where the station is `reset` it begins as the model says, and nothing of what runs goes on.
    """
    state = transferred(automaton, {} if reset else present)
    names = dict.fromkeys((*automaton.variables, *present))
    changes = [
        Taken(name=name, before=present.get(name), after=state[name] if name in automaton.variables else None)
        for name in names
        if name not in present or name not in automaton.variables or present[name] != state[name]
    ]
    before = {} if old is None else old.abilities
    going_on = () if reset else running
    under_way = [name for name in going_on if not _same(before.get(name), automaton.abilities.get(name))]
    safe = supervisor.safe.includes(state)
    violated = [
        specification.title
        for specification in automaton.specifications.values()
        if evaluate(specification.forbidden, state) is not False
    ]
    ways: list[list[str]] = []
    if not safe:
        advice = Advisor(automaton, supervisor).advise(AdviceRequest(state, (), deadline=ADVISING))
        ways = [
            [name for _, name in offer.operator_plan.starts]
            for offer in advice.offers
            if offer.operator_plan is not None
        ]
    return TransferView(
        legal=safe and not under_way,
        changes=changes,
        violated=violated,
        under_way=under_way,
        ways=ways,
        obstacle=None,
        obstacle_message=None,
    )


def untransferred(why: Message) -> TransferView:
    """Of a model that no station may run."""
    return TransferView(legal=False, changes=[], violated=[], under_way=[], ways=[], obstacle=why, obstacle_message=why)


def _same(one: Ability | None, other: Ability | None) -> bool:
    """Return whether they are the same but for what people call them."""
    return one is not None and other is not None and replace(one, title="") == replace(other, title="")


# What is shown of how a station would go on with another model.


class Run(View):
    """A run of an ability, in seconds from the beginning; `ended` is null where it was under way at the end."""

    ability: str
    title: str
    resource: str
    started: float
    ended: float | None


class Completed(View):
    """An operation reached its goal, so many seconds from the beginning."""

    operation: str
    title: str
    at: float


class WhatIfView(View):
    """`seconds` were simulated from the values `before` on, to those `after`; null is unknown.

    `safe` says whether it began in a safe state; from another one nothing is started. `active` are the operations under
    way at the end, and `unplanned` says why there was no plan then. `obstacle` says why nothing could be simulated.
    Both have their messages for readers of other languages.
    """

    seconds: float
    safe: bool
    runs: list[Run]
    completed: list[Completed]
    before: dict[str, ShownValue | None]
    after: dict[str, ShownValue | None]
    active: list[str]
    unplanned: str
    unplanned_message: Message | None
    obstacle: str | None
    obstacle_message: Message | None


# What is shown of a recording of ROS 2 traffic: what it has for the draft, its moments, and the state at one of them.


class RecordedStanding(StrEnum):
    """Whence a variable has its value at a moment of a recording."""

    RECORDED = "recorded"
    STALE = "stale"  # something was said, and counts no more: the deadline of a topic has passed
    NOT_RECORDED = "not-recorded"  # no message has said anything so far: it is as the model begins


class RecordedOtherwise(StrEnum):
    """Why the messages of a topic that was recorded are not read."""

    TYPE = "type"  # they are of another type
    DEFINITION = "definition"  # the type of this name was another one
    ENCODING = "encoding"  # they are not in CDR


class RecordingEnd(StrEnum):
    """Why a recording was not read to its end."""

    TIME = "time"
    MOMENTS = "moments"


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
    difference: RecordedOtherwise
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
    standing: RecordedStanding


class RecordedMomentView(View):
    """A moment, so many seconds after the beginning, at which variables became others."""

    at: float
    changes: list[RecordedChangeView]


class RecordedTrafficView(View):
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
    incomplete: RecordingEnd | None
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
    standing: RecordedStanding
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
