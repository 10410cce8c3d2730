"""What people have asked of a station beside its work, and what it asks of them, as it is shown."""

from __future__ import annotations

from sequence_planner.control.view_part import Value, View


class ForceView(View):
    """A forced variable: what it is taken to be, what it would be, until when, by whom and why."""

    value: Value
    real: Value | None
    until: float
    by: str
    why: str


class ServiceView(View):
    """What is out of service since when, by whom and why; `by` is null where the station gave an ability up itself."""

    of: str  # resource, ability or operation
    name: str
    title: str
    since: float
    by: str | None
    why: str


class ErrandView(View):
    """What a person has taken, and is being carried out: nothing but this plan is. `kind` is what it is for.

    It is done when it `ends`, and one `into_safe` when the station is inside its safe states besides. `ability` is the
    one that is tried.
    """

    kind: str  # way-back, reset, goal, trial
    title: str
    by: str
    why: str
    since: float
    ends: str | None  # in the model's language; null where it is a way into the safe states and nothing else
    into_safe: bool
    ability: str | None


class LastErrandView(View):
    """How the last errand has ended: `done`, or why not. `ability` is the one that was tried."""

    title: str
    done: bool
    why: str
    ended: float
    ability: str | None


class UndecidedOutputView(View):
    """An output that came back from the journal, and would make its device react as soon as it is published.

    `reacts` says how; with each of `quiet` its device would stay as it is. With each of `unsafe` the station would
    leave its safe states, unless other outputs change as well.
    """

    value: Value
    reacts: list[str]
    quiet: list[Value]
    unsafe: list[Value]


class QuestionView(View):
    """What to look at: the station's belief does not fit what is measured. The first question separates most.

    `variable` is what is asked about, `believed` its value, `possible` those that would fit; `because` says which
    belief does not go together with which measurement.
    """

    variable: str
    believed: Value
    possible: list[Value]
    because: list[str]


class LastCorrectionView(View):
    """The last correction, made on `revision`; it can be undone in one step while `undoable`."""

    revision: int
    values: dict[str, Value]
    before: dict[str, Value]
    by: str
    why: str
    at: float
    undoable: bool
