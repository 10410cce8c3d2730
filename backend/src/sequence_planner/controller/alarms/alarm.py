"""Life cycle of an alarm (ISA-18.2): its cause, urgency and consequences, and its persistent suppression."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace

from pydantic import BaseModel, ConfigDict, JsonValue, TypeAdapter, ValidationError

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.station import AlarmState, AlarmView, Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import variables
from sequence_planner.planning.heuristic.relaxation import reachable
from sequence_planner.planning.problem import Circumstances

# Why there is an alarm, and how urgent that is.

_URGENCY = (Priority.LOW, Priority.MEDIUM, Priority.HIGH)


@dataclass(frozen=True)
class Cause:
    """`key` stays the same as long as it is the same alarm; `parts` are what it consists of, where that is several.

    It is no alarm of its own but a part of another as long as one of those is there that it `follows` from. `past` is
    its `text` once it is over, `past_parts` are its parts then, `of` the resources whose devices fail with it, and
    `about` the variables of which it is doubted what is believed. A device that `waits` has nothing to do itself.
    """

    key: str
    priority: Priority
    text: str  # what is wrong
    consequence: str  # what comes of it
    action: str  # what to do
    follows: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()
    past: str = field(kw_only=True)
    past_parts: tuple[str, ...] = field(default=(), kw_only=True)
    of: frozenset[str] = field(default=frozenset(), kw_only=True)
    about: frozenset[str] = field(default=frozenset(), kw_only=True)
    waits: bool = field(default=False, kw_only=True)


def urgency(priority: Priority) -> int:
    """The more, the more urgent."""
    return _URGENCY.index(priority)


def most_urgent(*priorities: Priority) -> Priority:
    """The most urgent of them."""
    return max(priorities, key=urgency)


# What comes of an alarm's cause: which of the active operations wait because of it, as far as that can be told.

_NAMED = 3  # so many are named, and the others counted


class Consequences:
    """Sentences about `execution` as it is now."""

    def __init__(self, execution: Executor, who_can: WhoCan | None = None) -> None:
        self._execution = execution
        self._who_can = who_can
        self._about: tuple[object, ...] = ()
        self._held_up: dict[frozenset[str], frozenset[str]] = {}  # by idle resources, of one plan

    def standstill(self) -> str:
        """Of what keeps everything from starting."""
        return f"Nothing is started. {self.waiting(self._execution.active)}"

    def waiting(self, operations: Collection[str], until: str = "") -> str:
        """That those of the operations that are active wait, or why none does just now."""
        execution = self._execution
        if execution.production is not Production.STARTED:
            return "Production is not started, so nothing waits for it."
        if execution.errand is not None:
            return f"“{execution.errand.title}” waits{until}."
        if execution.mode is not Mode.AUTOMATIC:
            return f"Nothing waits for it as long as the mode is {execution.mode}."
        names = sorted(execution.active.intersection(operations))
        if not names:
            return "No active operation waits for it."
        return f"{listed(self._quoted(names))} {'waits' if len(names) == 1 else 'wait'}{until}."

    def without(self, resources: Collection[str]) -> str:
        """Of resources that cannot be used: what the plan without them leaves out."""
        execution = self._execution
        begun = execution.production is Production.STARTED
        if not begun or not execution.conduct.executes_operations:
            return self.waiting(())
        if not execution.active:
            return self._open(resources) or self.waiting(())
        plan, them = execution.plan, "it" if len(resources) == 1 else "them"
        if plan.status is PlanStatus.NONE:
            return f"There is no plan without {them}. {self._nobody(resources, them)}"
        if plan.status is not PlanStatus.FOLLOWED or plan.answer is None:
            return f"A plan without {them} is being looked for. {self._nobody(resources, them)}"
        waiting = self.held_up(resources) | execution.active.intersection(plan.answer.left_out)
        return self.waiting(waiting) if waiting else f"The work goes on without {them}."

    def _nobody(self, resources: Collection[str], them: str) -> str:
        """That nobody can do some operations without these, as far as that is known without a plan; others wait."""
        active, lacking = self._execution.active, {} if self._who_can is None else self._who_can.lacking
        beyond = [name for name in sorted(active) if lacking.get(name, frozenset()).intersection(resources)]
        if not beyond:
            return self.waiting(active)
        nobody = f"Nobody can do {listed(self._quoted(beyond))} without {them}."
        rest = active.difference(beyond)
        return f"{nobody} {self.waiting(rest)}" if rest else nobody

    def _quoted(self, names: Iterable[str]) -> list[str]:
        return [f"“{self._execution.automaton.operations[name].title}”" for name in names]

    def _open(self, resources: Collection[str]) -> str:
        """That it is not known whether operations can begin, since values of these resources are not."""
        execution, automaton = self._execution, self._execution.automaton
        unknown = {
            name
            for name, declared in automaton.variables.items()
            if declared.resource in resources and execution.state[name] is None
        }
        idle = execution.conduct.idle_operations(automaton)
        titles = [
            f"“{operation.title}”"
            for name, operation in automaton.operations.items()
            if name not in idle
            and evaluate(operation.precondition, execution.state) is None
            and unknown.intersection(_read(automaton, variables(operation.precondition)))
        ]
        return f"Whether {listed(titles)} can begin is not known." if titles else ""

    def held_up(self, resources: Collection[str]) -> frozenset[str]:
        """The active operations that cannot be completed while these resources do nothing.

        Of those in the plan what is left of it counts, of those it leaves out all that could be done; without a plan
        all wait. A relaxation says it, so of one that waits for something more subtle it is not said.
        """
        execution = self._execution
        order = execution.plan.order
        if execution.plan.status is not PlanStatus.FOLLOWED:
            return execution.active
        about = (order.names, len(order.running), execution.active)
        if about != self._about:
            self._about, self._held_up = about, {}
        idle = frozenset(resources)
        if idle not in self._held_up:
            planned, active = order.goals & execution.active, execution.active
            barred = frozenset(execution.automaton.abilities) - set(order.names)
            self._held_up[idle] = self._beyond(idle, planned, barred) | self._beyond(idle, active - planned)
        return self._held_up[idle]

    def _beyond(
        self, idle: frozenset[str], names: Collection[str], barred: frozenset[str] = frozenset()
    ) -> frozenset[str]:
        """Those of the operations whose goals cannot come true without these resources and abilities."""
        execution = self._execution
        if not names:
            return frozenset()
        circumstances = Circumstances(offline=idle, restart=True, barred=barred)
        relaxed = reachable(execution.automaton, execution.state, circumstances)
        return frozenset(name for name in names if not relaxed.may(execution.automaton.operations[name].goal))

    def of_values(self, names: Collection[str]) -> str:
        """Of values that are wrong or not known: which operations are decided by them."""
        execution = self._execution
        deciding = read_by(execution.automaton, names)
        if not execution.active & deciding:
            return "No active operation is decided by it, but plans may be wrong."
        titles = [execution.automaton.operations[name].title for name in sorted(execution.active & deciding)]
        return f"Plans may be wrong, and so may be whether {listed([f'“{title}”' for title in titles])} is reached."


def read_by(automaton: Automaton, names: Collection[str]) -> frozenset[str]:
    """The operations whose goals depend on one of the variables."""
    wanted = set(names)
    return frozenset(
        name
        for name, operation in automaton.operations.items()
        if wanted.intersection(_read(automaton, variables(operation.goal)))
    )


def _read(automaton: Automaton, names: Iterable[str]) -> set[str]:
    """The variables, and those that flags among them depend on."""
    found: set[str] = set()
    to_see = list(names)
    while to_see:
        name = to_see.pop()
        if name not in found:
            found.add(name)
            predicate = automaton.flag_predicates.get(name)
            to_see += [] if predicate is None else variables(predicate)
    return found


def listed(titles: Iterable[str]) -> str:
    """As in `a, b and c`, or with how many others there are."""
    every = list(titles)
    if len(every) > _NAMED + 1:
        every = [*every[:_NAMED], f"{len(every) - _NAMED} more"]
    return " and ".join([", ".join(every[:-1]), every[-1]] if len(every) > 1 else every)


# What follows from what: a device that fails keeps others from finishing, and leads to states nobody wants.
#
# Which alarm is a part of which is said by the alarms' own causes where they know; this adds what only the model tells:
# what an effect waits for, what a specification speaks of, and which operations need a resource.

UNSAFE = "unsafe-state"
LATE = "overdue:"
_PLANS = ("no-plan", "left-out", "undecided")


class ConsequenceGraph:
    """Of one automaton; `touched` are the variables for which the state is unsafe, if it is."""

    def __init__(self, automaton: Automaton, touched: Callable[[], Collection[str]]) -> None:
        self._automaton = automaton
        self._touched = touched
        self._awaits = _awaits(automaton)

    def trace(self, causes: Iterable[Cause]) -> list[Cause]:
        """The causes, each with all that it follows from."""
        every = list(causes)
        failures = [cause for cause in every if cause.of]
        unsafe = any(cause.key == UNSAFE for cause in every)
        return [self._traced(cause, failures, unsafe) for cause in every] if failures or unsafe else every

    def _traced(self, cause: Cause, failures: Iterable[Cause], unsafe: bool) -> Cause:
        others = [failure for failure in failures if failure.key != cause.key]
        if cause.key == UNSAFE:
            about = self._resources(self._touched())
            found = [each.key for each in others if each.of & about]
        elif cause.about:
            found = [UNSAFE] if unsafe and not cause.about.isdisjoint(self._touched()) else []
        elif cause.key in _PLANS:
            found = [each.key for each in others] + ([UNSAFE] if unsafe else [])
        elif cause.waits:
            awaited = frozenset[str]().union(*(self._awaits.get(name, frozenset()) for name in cause.of))
            found = [each.key for each in others if each.of & awaited]
        else:
            return cause
        return replace(cause, follows=(*cause.follows, *found)) if found else cause

    def _resources(self, names: Iterable[str]) -> frozenset[str]:
        """Those of the variables, and of what flags among them depend on."""
        found: set[str] = set()
        seen: set[str] = set()
        to_see = list(names)
        while to_see:
            name = to_see.pop()
            if name in seen:
                continue
            seen.add(name)
            if (predicate := self._automaton.flag_predicates.get(name)) is not None:
                to_see += variables(predicate)
            elif (resource := self._automaton.variables[name].resource) is not None:
                found.add(resource)
        return frozenset(found)


def _awaits(automaton: Automaton) -> dict[str, frozenset[str]]:
    """For each resource those of others whose measured values its own effects wait for."""
    found: dict[str, set[str]] = {}
    for effect in automaton.effects:
        if not effect.fault:
            declared = (automaton.variables.get(name) for name in variables(effect.guard))
            of = {each.resource for each in declared if each is not None and each.resource is not None}
            found.setdefault(effect.resource, set()).update(of - {effect.resource})
    return {name: frozenset(others) for name, others in found.items()}


# The life of an alarm (ISA-18.2): from when it comes until it has gone and a person knows of it.
#
# Where an alarm stands is never said twice: it follows from whether its cause is there, whether somebody has
# acknowledged it, and whether it has been put aside.


@dataclass(frozen=True)
class Suppression:
    """An alarm is not told: it is shelved `until` some time, or out of service where there is none."""

    by: str
    why: str
    until: Timestamp | None


@dataclass
class Alarm:
    """One alarm. `cause` is what was said of it last, and `since` when it came last, in seconds since the epoch.

    `away` says since when its cause has not been there, `ended` that this counts. Without `acknowledged` somebody still
    has to take note; of an alarm of low priority nobody has to.
    """

    cause: Cause
    since: float
    acknowledged: bool = False
    count: int = 1
    by: str | None = None  # who has acknowledged it
    away: Timestamp | None = None
    ended: float | None = None
    aside: Suppression | None = None
    part: bool = False  # it is told as a part of another
    worst: Priority = Priority.LOW  # how urgent it has been since somebody last had a reason to look

    @property
    def state(self) -> AlarmState:
        """The state in which it stands."""
        if self.aside is not None:
            return AlarmState.OUT_OF_SERVICE if self.aside.until is None else AlarmState.SHELVED
        if self.ended is not None:
            return AlarmState.RETURNED
        return AlarmState.ACKNOWLEDGED if self.acknowledged else AlarmState.UNACKNOWLEDGED

    @property
    def over(self) -> bool:
        """True if there is nothing more to tell of it."""
        return self.ended is not None and self.aside is None and self.acknowledged

    @property
    def shown(self) -> bool:
        """True if it has a place of its own; what is put aside is always in sight as such."""
        return self.aside is not None or not self.part

    def come(self, now: float, lasts: bool) -> None:
        """Its cause is there again. With `lasts` it had not been away long enough to count."""
        self.count += 1
        self.away = None
        if not lasts:
            self.since, self.ended = now, None
            self.must_be_seen()

    def must_be_seen(self) -> None:
        """Somebody has to take note of it, if anybody ever has to."""
        self.acknowledged = not needs_acknowledgement(self.cause)
        self.by, self.worst = None, self.cause.priority

    def acknowledge(self, by: str) -> None:
        """A person has taken note of it."""
        self.acknowledged, self.by, self.count = True, by, 0

    def view(self) -> AlarmView:
        """As it is shown. Of one that is over nothing comes any more, and nothing is to be done about it."""
        aside, cause, over = self.aside, self.cause, self.ended is not None
        return AlarmView(
            priority=cause.priority,
            state=self.state,
            text=cause.past if over else cause.text,
            consequence="" if over else cause.consequence,
            action="" if over else cause.action,
            since=self.since,
            ended=self.ended,
            by=self.by if aside is None else aside.by,
            until=None if aside is None or aside.until is None else aside.until.epoch,
            why=None if aside is None else aside.why,
            count=self.count,
            parts=list(cause.past_parts if over else cause.parts),
        )


def needs_acknowledgement(cause: Cause) -> bool:
    """Return whether a person has to take note of such an alarm: of a mere notice nobody has to."""
    return cause.priority is not Priority.LOW


# What is shelved or out of service, written down so that it is so again after the controller was started anew.

KIND = "alarms-aside"  # of the record


class PutAside(BaseModel):
    """One that is put aside, and what was said of it last. `until` is null where it is out of service."""

    model_config = ConfigDict(frozen=True)
    priority: Priority
    text: str
    past: str = ""  # of a program that did not write it
    consequence: str
    action: str
    by: str
    why: str
    until: float | None

    @classmethod
    def of(cls, life: Alarm, aside: Suppression) -> PutAside:
        """To be written down."""
        cause, until = life.cause, None if aside.until is None else aside.until.epoch
        return cls(
            priority=cause.priority,
            text=cause.text,
            past=cause.past,
            consequence=cause.consequence,
            action=cause.action,
            by=aside.by,
            why=aside.why,
            until=until,
        )

    def cause(self, key: str) -> Cause:
        """Return the cause, as what was said of it."""
        return Cause(key, self.priority, self.text, self.consequence, self.action, past=self.past or self.text)

    def aside(self, now: Timestamp) -> Suppression:
        """That it is put aside."""
        until = None
        if self.until is not None:
            until = Timestamp(self.until, now.monotonic + self.until - now.epoch)
        return Suppression(self.by, self.why, until)


_ALL: TypeAdapter[dict[str, PutAside]] = TypeAdapter(dict[str, PutAside])


def aside_to_keep(lives: Mapping[str, Alarm]) -> dict[str, JsonValue]:
    """The content of a record of all that is put aside."""
    return aside_again({key: PutAside.of(life, life.aside) for key, life in lives.items() if life.aside is not None})


def aside_again(kept: Mapping[str, PutAside]) -> dict[str, JsonValue]:
    """The content of a record of what such a record has said."""
    found: JsonValue = _ALL.dump_python(dict(kept), mode="json")
    assert isinstance(found, dict)
    return {"aside": found}


def aside_from(content: Mapping[str, JsonValue]) -> dict[str, PutAside]:
    """Return what such a record says; nothing where it is of a program that wrote it differently."""
    try:
        return _ALL.validate_python(content.get("aside", {}))
    except ValidationError:
        return {}
