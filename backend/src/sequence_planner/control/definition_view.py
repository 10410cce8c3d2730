"""How an ability is defined, and what of that holds in a state, most often that of the live station."""

from __future__ import annotations

from sequence_planner.control.view_part import Value, View
from sequence_planner.control.way_back_view import SpecificationView


class WrittenPlaceView(View):
    """Where something is written, in a file of the model; lines count from 1."""

    file: str
    line: int


class ReadValueView(View):
    """A variable, or a flag of an ability, that an expression reads; `value` is null where it is unknown."""

    name: str
    kind: str  # measured, output, estimated, activity, flag
    value: Value | None


class ConjunctView(View):
    """A part of a conjunction. Whether it `holds` is null as long as unknown values leave it open."""

    text: str
    holds: bool | None
    reads: list[ReadValueView]


class PredicateView(View):
    """A predicate: it holds if all its parts do; a constant has none. `place` is null for what nobody has written."""

    text: str
    holds: bool | None
    parts: list[ConjunctView]
    place: WrittenPlaceView | None


class AbilityActionView(View):
    """An action; `done` says whether its variable has by now the value that it would write."""

    text: str
    variable: str
    done: bool | None


class SupervisedView(View):
    """What the supervisor adds to the start: `guard` is null where no short one was found.

    Then `blocked` are some conditions wherever one of which holds it must wait. `specifications` are those it comes
    from; with `rest`, some starts must wait because no state of rest could be reached any more.
    """

    guard: PredicateView | None
    specifications: list[SpecificationView]
    rest: bool
    blocked: list[PredicateView]


class ReactionView(View):
    """An expected reaction of the device, in so many seconds at least and at most; nobody counts on a `fault`."""

    name: str
    kind: str  # starting, executing, finishing
    guard: PredicateView
    actions: list[AbilityActionView]
    shortest: float
    longest: float
    fault: bool


class TimeoutsView(View):
    """Seconds after the start in which it must have reacted, and have finished; null where there is no limit.

    With `replan` it is then called off and planned anew, `retries` times with it, later without; otherwise there is an
    alarm and no more.
    """

    react: float | None
    finish: float | None
    retries: int
    replan: bool


class TriedReactionView(View):
    """Since when a reaction could be expected in a trial, and when it came; null where it was not."""

    name: str
    due: float | None
    came: float | None


class TrialView(View):
    """The last trial of the ability: accepted, started, seen executing, and ended at these times.

    It is `done` when the ability has finished; otherwise `why` says how it ended.
    """

    by: str
    reason: str
    accepted: float
    started: float | None
    executing: float | None
    ended: float | None
    done: bool
    why: str
    reactions: list[TriedReactionView]


class AutomatonView(View):
    """A ground ability as it is written, and what of that holds in a state; `arguments` are those of its parameters.

    `allowed` says whether the supervisor would allow a start in that state, null where that cannot be told. `finish` is
    null for an ability that is done at its start. `supervised` is null where nothing is added, or not known yet.
    """

    name: str
    title: str
    resource: str
    arguments: list[str]
    place: WrittenPlaceView | None
    restart: bool
    task: str | None  # what the person is asked to do who carries it out
    acknowledgement: str | None  # the variable by which that person says it is done
    duration: tuple[float, float] | None
    enabled: PredicateView
    start: PredicateView
    start_actions: list[AbilityActionView]
    supervised: SupervisedView | None
    allowed: bool | None
    executing: PredicateView
    finished: PredicateView
    finish: PredicateView | None
    finish_actions: list[AbilityActionView]
    cancel_actions: list[AbilityActionView]
    timeouts: TimeoutsView
    reactions: list[ReactionView]


class AbilityDefinitionView(AutomatonView):
    """An ability of the live station in the state of `revision`.

    `obstacle` says why it cannot be tried now; `real_devices` what speaks against its devices being emulated, which has
    to be confirmed.
    """

    revision: int
    obstacle: str | None
    real_devices: list[str]
    trial: TrialView | None
