"""Life cycle of an alarm (ISA-18.2): its cause, urgency and consequences, and its persistent suppression."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, replace

from pydantic import BaseModel, ConfigDict, JsonValue, TypeAdapter, ValidationError

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.controller.alarms.kinds import (
    KINDS,
    LEFT_OUT,
    NO_PLAN,
    UNDECIDED,
    UNSAFE_STATE,
    AlarmKind,
    Cause,
)
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.station import AlarmGroup, AlarmMessages, AlarmState, AlarmView, Priority
from sequence_planner.controller.views.wording import title_text
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, PlanStatus, Production
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import variables
from sequence_planner.planning.heuristic.relaxation import reachable
from sequence_planner.planning.problem import Circumstances
from sequence_planner.texts.message import Argument, Item, Message, as_it_was, message, quoted

# How urgent an alarm is.

_URGENCY = (Priority.LOW, Priority.MEDIUM, Priority.HIGH)


def urgency(priority: Priority) -> int:
    """The more, the more urgent."""
    return _URGENCY.index(priority)


def most_urgent(*priorities: Priority) -> Priority:
    """The most urgent of them."""
    return max(priorities, key=urgency)


# What comes of an alarm's cause: which of the active operations wait because of it, as far as that can be told.


class Consequences:
    """Sentences about `execution` as it is now."""

    def __init__(self, execution: Executor, who_can: WhoCan | None = None) -> None:
        self._execution = execution
        self._who_can = who_can
        self._about: tuple[object, ...] = ()
        self._held_up: dict[frozenset[str], frozenset[str]] = {}  # by idle resources, of one plan

    def standstill(self) -> Message:
        """Of what keeps everything from starting."""
        return message("wait.standstill", waiting=self.waiting(self._execution.active))

    def waiting(self, operations: Collection[str], until_it_does: bool = False) -> Message:
        """That those of the operations that are active wait, or why none does just now."""
        execution = self._execution
        until: Argument = message("wait.until-it-does") if until_it_does else ""
        if execution.production is not Production.STARTED:
            return message("wait.not-started")
        if execution.operator_plan is not None:
            title = title_text(execution.operator_plan.title)
            return message("wait.errand", title=message("quoted", title=title), until=until)
        if execution.mode is not Mode.AUTOMATIC:
            return message("wait.mode", mode=message(f"mode.{execution.mode}"))
        names = sorted(execution.active.intersection(operations))
        if not names:
            return message("wait.none")
        return message("wait.operations", operations=self._quoted(names), until=until)

    def without(self, resources: Collection[str]) -> Message:
        """Of resources that cannot be used: what the plan without them leaves out."""
        execution = self._execution
        begun = execution.production is Production.STARTED
        if not begun or not execution.conduct.executes_operations:
            return self.waiting(())
        if not execution.active:
            return self._open(resources) or self.waiting(())
        plan, count = execution.plan, len(resources)
        if plan.status is PlanStatus.NONE:
            return message("wait.no-plan", count=count, rest=self._nobody(resources))
        if plan.status is not PlanStatus.FOLLOWED or plan.answer is None:
            return message("wait.looking", count=count, rest=self._nobody(resources))
        waiting = self.held_up(resources) | execution.active.intersection(plan.answer.left_out)
        return self.waiting(waiting) if waiting else message("wait.goes-on", count=count)

    def _nobody(self, resources: Collection[str]) -> Message:
        """That nobody can do some operations without these, as far as that is known without a plan; others wait."""
        active, lacking = self._execution.active, {} if self._who_can is None else self._who_can.lacking
        beyond = [name for name in sorted(active) if lacking.get(name, frozenset()).intersection(resources)]
        if not beyond:
            return self.waiting(active)
        nobody = message("wait.nobody", operations=self._quoted(beyond), count=len(resources))
        rest = active.difference(beyond)
        return message("sentences", first=nobody, second=self.waiting(rest)) if rest else nobody

    def _quoted(self, names: Iterable[str]) -> list[Item]:
        return quoted([self._execution.automaton.operations[name].title for name in names])

    def _open(self, resources: Collection[str]) -> Message | None:
        """That it is not known whether operations can begin, since values of these resources are not."""
        execution, automaton = self._execution, self._execution.automaton
        unknown = {
            name
            for name, declared in automaton.variables.items()
            if declared.resource in resources and execution.state[name] is None
        }
        idle = execution.conduct.idle_operations(automaton)
        titles = [
            operation.title
            for name, operation in automaton.operations.items()
            if name not in idle
            and evaluate(operation.precondition, execution.state) is None
            and unknown.intersection(_read(automaton, variables(operation.precondition)))
        ]
        return message("wait.open", operations=quoted(titles)) if titles else None

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

    def of_values(self, names: Collection[str]) -> Message:
        """Of values that are wrong or not known: which operations are decided by them."""
        execution = self._execution
        deciding = read_by(execution.automaton, names)
        if not execution.active & deciding:
            return message("wait.undecided")
        return message("wait.decided", operations=self._quoted(sorted(execution.active & deciding)))


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


# What follows from what: a device that fails keeps others from finishing, and leads to states nobody wants.
#
# Which alarm is a part of which is said by the alarms' own causes where they know; this adds what only the model tells:
# what an effect waits for, what a specification speaks of, and which operations need a resource.

_PLANS = (NO_PLAN, LEFT_OUT, UNDECIDED)


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
        unsafe = any(cause.kind is UNSAFE_STATE for cause in every)
        return [self._traced(cause, failures, unsafe) for cause in every] if failures or unsafe else every

    def _traced(self, cause: Cause, failures: Iterable[Cause], unsafe: bool) -> Cause:
        others = [failure for failure in failures if failure.key != cause.key]
        if cause.kind is UNSAFE_STATE:
            about = self._resources(self._touched())
            found = [each.key for each in others if each.of & about]
        elif cause.about:
            found = [UNSAFE_STATE.key()] if unsafe and not cause.about.isdisjoint(self._touched()) else []
        elif cause.kind in _PLANS:
            found = [each.key for each in others] + ([UNSAFE_STATE.key()] if unsafe else [])
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
        text, parts = (cause.past, cause.past_parts) if over else (cause.text, cause.parts)
        consequence, action = (None, None) if over else (cause.consequence, cause.action)
        return AlarmView(
            kind=cause.kind.name,
            subject=cause.subject,
            group=cause.kind.group,
            priority=cause.priority,
            state=self.state,
            text=str(text),
            consequence="" if consequence is None else str(consequence),
            action="" if action is None else str(action),
            parts=[str(part) for part in parts],
            messages=AlarmMessages(text, consequence, action, parts),
            resources=list(cause.resources),
            topics=list(cause.topics),
            since=self.since,
            ended=self.ended,
            by=self.by if aside is None else aside.by,
            until=None if aside is None or aside.until is None else aside.until.epoch,
            why=None if aside is None else aside.why,
            count=self.count,
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
    text: Message | str  # a string where it is of a program that wrote no other
    past: Message | str = ""
    consequence: Message | str
    action: Message | str
    kind: str = ""
    subject: str = ""
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
            kind=cause.kind.name,
            subject=cause.subject,
            by=aside.by,
            why=aside.why,
            until=until,
        )

    def cause(self, key: str) -> Cause:
        """Return the cause, as what was said of it."""
        kind, subject = (self.kind, self.subject) if self.kind else key.partition(":")[::2]
        said = (self.text, self.consequence, self.action, self.past or self.text)
        text, consequence, action, past = (as_it_was(each) for each in said)
        known = KINDS.get(kind, AlarmKind(kind, self.priority, AlarmGroup.SYSTEM))
        return Cause(key, known, subject, self.priority, text, consequence, action, past)

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
