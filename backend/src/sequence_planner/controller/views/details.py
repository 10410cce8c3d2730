"""View schemas of details: ability definitions, job contents, corrections, explanations, ROS network."""

from __future__ import annotations

from typing import Literal

from sequence_planner.controller.views.part import Value, View
from sequence_planner.controller.views.proposals import PlanPreviewView
from sequence_planner.controller.views.station import BeliefView, DiagnosisView, SpecificationView
from sequence_planner.texts.message import Message

# What a person is shown before a correction is made.


class CorrectedView(View):
    """An estimate and the value that it is to have. `related` is what is measured that bears on it, as it is now, and
    `related_messages` is that in words.
    """

    name: str
    now: Value
    then: Value
    belief: BeliefView
    related: list[str]
    related_messages: list[Message]


class CorrectionPreview(View):
    """What a correction made at `revision` would bring about; it is refused on any other.

    `safe` says whether the state is a safe one afterwards, `safe_now` whether it is so without it, and `violates` which
    specifications the corrected state violates. Abilities would become `startable`, or be so no longer; operations
    would be `activated` or `completed`. `plan` is what the station then does for the operations `goals`, in automatic
    mode; `reason` says why there is none. `obstacle` says why it cannot be made as things are, null where it can.
    """

    revision: int
    changes: list[CorrectedView]
    safe: bool
    safe_now: bool
    violates: list[SpecificationView]
    startable: list[str]
    no_longer_startable: list[str]
    activated: list[str]
    completed: list[str]
    contradictions_gone: list[str]
    contradictions_new: list[str]
    contradiction_messages: list[Message]  # of those that would be gone, and of those that would be new
    plan: PlanPreviewView | None
    goals: list[str]
    left_out: list[str]
    reason: str
    reason_message: Message | None
    obstacle: str | None
    obstacle_message: Message | None


# What people read in place of the names of the model.


class VariableNameView(View):
    """What a variable is called in a table below the title of its resource, by language.

    `values` is the place of the words for its values in `NamesView.values`; null where the model has none. `topic` is
    the one that tells what it is; null for what is not measured.
    """

    title: dict[str, str]
    values: int | None
    topic: str | None


class NamesView(View):
    """What all variables are called. `values` has each set of words once: by value, and then by language.

    The others are the titles of the station and of its parts by language, of those parts that have them by language;
    `tasks` what is asked of people, by ability. One of several without a title has words to be told apart;
    what stands for it elsewhere is under no language.
    """

    variables: dict[str, VariableNameView]
    values: list[dict[str, dict[str, str]]]
    station: dict[str, str]
    resources: dict[str, dict[str, str]]
    abilities: dict[str, dict[str, str]]
    tasks: dict[str, dict[str, str]]
    operations: dict[str, dict[str, str]]
    specifications: dict[str, dict[str, str]]
    work_masters: dict[str, dict[str, str]]


# How an ability is defined, and what of that holds in a state, most often that of the live station.


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
    sentence: Message
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
    obstacle_message: Message | None
    real_devices: list[str]
    trial: TrialView | None


class OperationDefinitionView(View):
    """An operation of the live station in the state of `revision`: `turns` are the sequences in which it waits for its
    turn, by name. All parts of `precondition`, which is as it is written, and of these must hold before it is active.
    """

    name: str
    title: str
    revision: int
    precondition: PredicateView
    turns: dict[str, PredicateView]
    goal: PredicateView


# What is on the ROS network, as one document: nodes, topics, services, actions, and how the station stands to them.


class QualityView(View):
    """What an endpoint offers or wants, in ROS 2's words; `deadline` and `liveliness` are seconds, or null for none."""

    reliability: Literal["reliable", "best_effort"]
    durability: Literal["volatile", "transient_local"]
    deadline: float | None
    liveliness: float | None


class EndpointView(View):
    """A publisher or subscriber. `node`, `type_hash` and `vendor` (of its middleware) are null where it does not tell.

    `own` is true of this station's controller.
    """

    node: str | None
    own: bool
    type: str
    type_hash: str | None
    quality: QualityView
    vendor: str | None


class MismatchView(View):
    """Why the station and an endpoint do not understand one another, or would fight.

    `type`: it uses another type under this name. `definition`: another definition of the type (`ours` and `theirs` are
    hashes). `quality`: `policy` is not agreed on, and nothing passes between the two. `rival`: it publishes what the
    station commands. `text` says it in words.
    """

    kind: Literal["type", "definition", "quality", "rival"]
    policy: Literal["reliability", "durability", "deadline", "liveliness"] | None
    node: str | None
    ours: str
    theirs: str
    text: str
    text_message: Message


class StationUseView(View):
    """A topic of the station's model, and how many endpoints there are with which it is understood."""

    resource: str
    direction: Literal["in", "out"]
    type: str
    type_hash: str
    quality: QualityView
    peers: int
    mismatches: list[MismatchView]


class GraphTopicView(View):
    """A topic; `station` is null where the model does not use it."""

    types: list[str]
    publishers: list[EndpointView]
    subscribers: list[EndpointView]
    station: StationUseView | None


class CallView(View):
    """A service or an action: who answers it and who asks, by node; null stands for one that does not tell its name."""

    types: list[str]
    servers: list[str | None]
    clients: list[str | None]


class NodeView(View):
    """A node, and the names of what it uses and serves."""

    own: bool
    vendor: str | None
    publishes: list[str]
    subscribes: list[str]
    services: list[str]
    actions: list[str]


class NetworkView(View):
    """The whole graph. Where `services_known` is false, the transport cannot tell services, and they are left out."""

    nodes: dict[str, NodeView]
    topics: dict[str, GraphTopicView]
    services: dict[str, CallView]
    actions: dict[str, CallView]
    services_known: bool


# Why an ability does not start, an operation is not active or not done, or a goal does not hold.


class ChangerView(View):
    """Who could change a variable: an ability, which may be running, or a person.

    `how` is `start`, `finish` or `effect` of an ability; `correction` of an estimate, `device` where something has to
    be done at the resource `name`, `message` where its topic `name` has to speak, `force` of an output, `task` where
    somebody acknowledges a task, of the ability `name` or else of any of the resource `name`, and `clock` where its
    pipeline goes by time.
    """

    how: str
    name: str
    title: str
    title_message: Message | None  # null where the title is the model's
    running: bool


class InvolvedView(View):
    """A variable that decides a condition. With one of the values `wanted`, and nothing else different, it would hold.

    `since` is when the value was seen first, `topic` where a measured one is heard. An estimate may be unconfirmed.
    """

    name: str
    kind: str  # measured, output, estimated, activity
    resource: str | None
    value: Value | None
    wanted: list[Value]
    since: float | None
    topic: str | None
    unconfirmed_since: float | None
    changers: list[ChangerView]


class ConditionView(View):
    """Something that has to be otherwise. `involved` alone keep its parts from being true, and none of them could be
    spared. Where `text` has names of the model for it, `expanded` is what does not hold of it, written out.

    `kind` is station (how the station executes), service (what does not take part), written (in the model),
    unpublished (a command has to leave first), supervisor (what synthesis has added), plan (nothing wants it yet) or
    order (no job asks for it yet).
    """

    kind: str
    text: str
    text_message: Message
    expanded: str | None
    involved: list[InvolvedView]
    sentence: Message | None  # what it waits for, as a sentence


class ReasonView(View):
    """A part of a condition, as it is now; `holds` is null as long as unknown values leave it open.

    `kind` says how that follows from its `parts`: all of them hold (`all`), one does (`any`), the only one does not
    (`not`), the second does if the first does (`implies`), or the only one is what it is a name for (`same`): a flag of
    an ability, or a `predicate` of the model. A `leaf` has none, and `reads` variables.

    It `decides` if the whole is as it is because of it: that stays so whatever all other leaves were. `wanted` is what
    it would have to be for the whole to be as it has to; `involved` are the variables that alone keep a leaf that
    decides from that.
    """

    kind: Literal["all", "any", "not", "implies", "same", "leaf"]
    text: str
    sentence: Message
    predicate: str | None
    holds: bool | None
    decides: bool
    wanted: bool
    reads: list[ReadValueView]
    involved: list[InvolvedView]
    parts: list[ReasonView]


class ReasonTreeView(View):
    """A condition in whole, with what of it holds and what does not.

    `about` says of what: `enabled` and `start` of an ability, `supervisor` for what synthesis has added for the sake of
    the `specifications`, or with `rest` because of states of rest; `finish` of one that runs; `precondition` of an
    operation, `turn` in a `sequence`, `goal`; `undone` for a goal that must not hold first; `predicate`.
    """

    about: Literal["enabled", "start", "supervisor", "finish", "precondition", "turn", "goal", "undone", "predicate"]
    specifications: list[SpecificationView]
    rest: bool
    sequence: str | None
    tree: ReasonView


class WhyNotView(View):
    """All `conditions` have to be otherwise; without any, nothing is in the way. `trees` have those of the model in
    whole, and those that end what runs.

    For a goal, `plan` is how the station could reach it from here, or `reasons` say why it cannot at all; both are null
    where nothing was found in time. For an operation that has no plan, `reasons` are those of the plan.
    """

    of: str  # ability, operation, goal
    name: str
    title: str
    revision: int
    summary: str
    summary_message: Message
    conditions: list[ConditionView]
    trees: list[ReasonTreeView]
    plan: PlanPreviewView | None
    reasons: DiagnosisView | None


# What jobs of a station consist of: its work masters, and what their operations and the abilities depend on.


class WorkOperationView(View):
    """An operation of a work master: which others come before it, and the variables that its goal depends on."""

    title: str
    after: list[str]
    goal_reads: list[str]


class WorkMasterView(View):
    """A work master: its operations, the estimates that a new product `brings`, and the variables of these.

    Of the branches of each of the `alternatives` one is taken, of those in `arbitrary` order one at a time.
    """

    title: str
    brings: list[str]
    brought: list[str]
    operations: dict[str, WorkOperationView]
    alternatives: list[list[list[str]]]
    arbitrary: list[list[list[str]]]


class WorkAbilityView(View):
    """An ability: the variables that it writes, or that are expected to react to it.

    An `instant` one is done as soon as it was started.
    """

    title: str
    writes: list[str]
    instant: bool


class WorkMastersView(View):
    """All work masters, and all abilities."""

    work_masters: dict[str, WorkMasterView]
    abilities: dict[str, WorkAbilityView]


# When the station is to work.


class ShiftTimesView(View):
    """A shift: its title by language, under "" that of none in particular, and the `days` on which it begins, Monday
    being 0. From when to when it lasts, and its breaks, are in minutes since midnight of that day, by the clock.
    """

    title: dict[str, str]
    minutes: tuple[int, int]
    days: list[int]
    breaks: list[tuple[int, int]]


class ShiftsView(View):
    """The shifts of a station, by their names; no two are on at the same time."""

    shifts: dict[str, ShiftTimesView]
