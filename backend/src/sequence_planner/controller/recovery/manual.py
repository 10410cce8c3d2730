"""Manual intervention: forced values, two-person approvals, and detection of devices moved by hand."""

from __future__ import annotations

import itertools
import secrets
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from dataclasses import replace as replace_fields
from enum import StrEnum
from typing import Final

from pydantic import JsonValue

from sequence_planner.automaton.automaton import Ability, Kind, State
from sequence_planner.automaton.reactions import Reactions
from sequence_planner.controller.commands.commands import (
    Act,
    ApprovedCommand,
    ApproveRequest,
    CommandRefused,
    DeclineRequest,
    ForceVariable,
    ReleaseForce,
    RequestApproval,
)
from sequence_planner.controller.commands.control_lock import ControlLock
from sequence_planner.controller.views.station import ApprovalState, ApprovalView
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.execution.events import Heard, Ticked, TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.printer import print_value
from sequence_planner.language.resolver import suggestion
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value, contains
from sequence_planner.pipelines.graph import GOAL_ON_ITS_WAY, StationPipelines
from sequence_planner.planning.recovery_path import violated

# Requests for what a variable with `approval: dual` asks two people for (four-eyes principle).
#
# A request holds for two minutes, in the state in which it was looked at, while who has asked for it is in control.
# None outlives the controller.

PATIENCE = 120.0  # seconds in which a second person has to answer
SHOWN = 60.0  # seconds for which a request is shown that is over
MOST_SHOWN = 20
LONGEST_NAME = 200  # characters of who has done something


class _Request(Immutable):
    """A request; `over` is when it came to its end, on the clock of `time.monotonic`."""

    actor: Actor
    act: Act
    revision: int
    why: str
    asked: Timestamp
    state: ApprovalState = ApprovalState.WAITING
    over: float | None = None
    answered_by: str | None = None
    answer: str | None = None


class Approvals:
    """The commands that wait for a second person at the station of `execution`."""

    def __init__(self, execution: Executor, in_control: ControlLock) -> None:
        self._execution = execution
        self._in_control = in_control
        self._requests: dict[str, _Request] = {}
        self._life = secrets.token_hex(3)  # no answer is taken for one to a request of an earlier controller
        self._numbers = itertools.count(1)

    def require_none(self, names: Iterable[str]) -> None:
        """Raises `CommandRefused` when a second person has to approve what is done to one of these variables."""
        if dual := self._dual(names):
            detail = f"A second person has to approve what is done to {' and '.join(dual)}: ask for that."
            raise CommandRefused("approval-needed", "A second person is needed", detail)

    def ask(self, command: RequestApproval, moment: Timestamp) -> None:
        """Let it wait for a second person; an earlier request of the same person ends. Raises `CommandRefused`."""
        _require_person(command.actor)
        if not self._dual(command.act.names):
            detail = "None of these variables asks for a second person: it can be done at once."
            raise CommandRefused("no-approval-needed", "Nobody has to approve it", detail)
        if command.revision != self._execution.revision:
            raise _moved()
        for id_, request in self._waiting(moment).items():
            if request.actor.id == command.actor.id:
                self._end(id_, ApprovalState.WITHDRAWN, moment, command.actor)
        request = _Request(command.actor, command.act, command.revision, command.reason, moment)
        self._requests[f"{self._life}-{next(self._numbers)}"] = request
        for id_ in list(self._requests)[:-MOST_SHOWN]:
            del self._requests[id_]

    def approved(self, command: ApproveRequest, moment: Timestamp) -> ApprovedCommand:
        """Return what is to be done, in the names of both. Raises `CommandRefused`."""
        _require_person(command.actor)
        request = self._answerable(command, moment)
        if request.actor.id == command.actor.id:
            detail = "You have asked for it yourself: somebody else has to approve it."
            raise CommandRefused("same-person", "A second person is needed", detail, 403)
        if command.revision != request.revision:
            raise _moved()
        both = f"{request.actor.name} + {command.actor.name}"[:LONGEST_NAME]
        return request.act.command(request.actor.model_copy(update={"name": both}), request.why, request.revision)

    def note_approved(self, command: ApproveRequest, moment: Timestamp) -> None:
        """It was done."""
        self._end(command.request, ApprovalState.APPROVED, moment, command.actor, command.reason)

    def decline(self, command: DeclineRequest, moment: Timestamp) -> None:
        """Let it be, in the name of who declines or withdraws it. Raises `CommandRefused`."""
        _require_person(command.actor)
        own = self._answerable(command, moment).actor.id == command.actor.id
        state = ApprovalState.WITHDRAWN if own else ApprovalState.DECLINED
        self._end(command.request, state, moment, command.actor, command.reason)

    def view(self, moment: Timestamp) -> dict[str, ApprovalView]:
        """Return what waits, and what was over lately."""
        self._look(moment)
        return {
            id_: ApprovalView(
                act=request.act,
                revision=request.revision,
                person=request.actor.id,
                by=request.actor.name,
                why=request.why,
                since=request.asked.epoch,
                until=request.asked.epoch + PATIENCE,
                state=request.state,
                answered_by=request.answered_by,
                answer=request.answer,
            )
            for id_, request in self._requests.items()
        }

    def _answerable(self, command: ApproveRequest | DeclineRequest, moment: Timestamp) -> _Request:
        request = self._waiting(moment).get(command.request)
        if request is None:
            detail = "Nobody waits for this any more: it was answered, took too long, or the state has moved. Ask anew."
            raise CommandRefused("request-gone", "The request is gone", detail)
        if command.act.model_dump_json() != request.act.model_dump_json():
            detail = "What was answered is not what the request asks for. Look at it again, then answer that."
            raise CommandRefused("not-confirmed", "Something else was confirmed", detail)
        return request

    def _waiting(self, moment: Timestamp) -> dict[str, _Request]:
        self._look(moment)
        return {id_: each for id_, each in self._requests.items() if each.state is ApprovalState.WAITING}

    def _look(self, moment: Timestamp) -> None:
        """End what has waited too long or was overtaken, and forget what has been over for a while."""
        for id_, request in list(self._requests.items()):
            if request.over is not None:
                if moment.monotonic >= request.over + SHOWN:
                    del self._requests[id_]
            elif moment.monotonic >= request.asked.monotonic + PATIENCE:
                self._end(id_, ApprovalState.EXPIRED, moment)
            elif request.revision != self._execution.revision or not self._controls(request.actor):
                self._end(id_, ApprovalState.OVERTAKEN, moment)

    def _controls(self, actor: Actor) -> bool:
        holder = self._in_control.view()
        return holder is not None and holder.session == actor.session

    def _end(
        self, id_: str, state: ApprovalState, moment: Timestamp, by: Actor | None = None, why: str | None = None
    ) -> None:
        name = None if by is None else by.name
        self._requests[id_] = replace(
            self._requests[id_], state=state, over=moment.monotonic, answered_by=name, answer=why
        )

    def _dual(self, names: Iterable[str]) -> list[str]:
        variables = self._execution.automaton.variables
        return sorted(name for name in names if name in variables and variables[name].dual_approval)


def _require_person(actor: Actor) -> None:
    if actor.kind is not ActorKind.PERSON:
        detail = "It takes two people who have signed in, each by their own name; a demonstration is nobody."
        raise CommandRefused("not-a-person", "Two people are needed", detail, 403)


def _moved() -> CommandRefused:
    detail = "Something has changed at the station since this was looked at. Look at it again, then decide."
    return CommandRefused("stale-revision", "The state has moved", detail)


# What devices do that nothing commanded: somebody moved them by hand, or the model does not know them well enough.
#
# A measured variable changed, and no effect of the model explains that from what the devices were told lately. It is
# noted, with the ability by which the station went on; nothing else comes of it.

KIND: Final = "by-hand"  # of the records
LATENCY: Final = 2.0  # seconds for which a device may act on what it was told before, and that be on its way
STAYS: Final = 120.0  # seconds for which a notice stays after the station has gone on
LONGEST: Final = 900.0  # seconds for which it stays at most
_MOST_STATES: Final = 32  # of the last seconds

Tell = Callable[[str, Mapping[str, JsonValue]], None]


class WentOn(StrEnum):
    """The way in which the station went on."""

    EXECUTES = "executes"  # the ability is under way again, as it was commanded before
    FINISHED = "finished"  # it counts as finished by it
    STARTED = "started"  # it was started after it


@dataclass(frozen=True)
class Moved:
    """The measured variables of a resource that changed in a tick, each with its value before and after it.

    `by` is the ability by which the station went on, once it has, `how` it did, and `on` when.
    """

    resource: str
    values: Mapping[str, tuple[Value, Value]]
    at: Timestamp
    by: str | None = None
    how: WentOn | None = None
    on: Timestamp | None = None

    def lasts(self, monotonic: float) -> bool:
        """Return whether people are still told of it."""
        past = self.on is not None and monotonic - self.on.monotonic > STAYS
        return not past and monotonic - self.at.monotonic <= LONGEST


class ByHand:
    """Listens to `execution`; `tell` hears of each change that nothing explains, and of how the station went on."""

    def __init__(self, execution: Executor, pipelines: StationPipelines, tell: Tell) -> None:
        self._execution = execution
        self._tell = tell
        self._reactions = Reactions(execution.automaton, on_its_way(pipelines))
        self._begins_anew = frozenset(name for use in pipelines.answers.values() for name in use.variables)
        measured = frozenset(execution.automaton.names(Kind.MEASURED))
        self._watched = self._reactions.variables & measured & pipelines.feeds.keys()
        self._reading = {name: _read(ability) for name, ability in execution.automaton.abilities.items()}
        self._states: deque[tuple[float, State]] = deque(maxlen=_MOST_STATES)
        self._forced: frozenset[str] = frozenset()
        self._moved: dict[str, Moved] = {}
        execution.listeners.append(self._hear)

    def notices(self, monotonic: float) -> list[Moved]:
        """Return what people are told of now, the last of each resource."""
        self._moved = {name: moved for name, moved in self._moved.items() if moved.lasts(monotonic)}
        return list(self._moved.values())

    def _hear(self, heard: Heard) -> None:
        happening, outcome = heard.happening, heard.outcome
        if not isinstance(happening, Ticked) or outcome is None:
            return
        now, forced = happening.now, frozenset(self._execution.conduct.forces)
        if self._execution.production is Production.STARTED:
            self._go_on(heard, outcome, now)
            self._look(heard, outcome, now, forced | self._forced)
        self._forced = forced
        self._remember(heard.after, now.monotonic)

    def _remember(self, state: State, monotonic: float) -> None:
        while len(self._states) > 1 and self._states[1][0] < monotonic - LATENCY:
            self._states.popleft()
        if not self._states or self._states[-1][1] is not state:
            self._states.append((monotonic, state))

    def _look(self, heard: Heard, outcome: TickOutcome, now: Timestamp, forced: frozenset[str]) -> None:
        found: dict[str, dict[str, tuple[Value, Value]]] = {}
        for name, before, after in self._changed(heard):
            if forced.isdisjoint(self._reactions.about(name)) and not self._is_explained(heard, name, after):
                resource = self._execution.automaton.variables[name].resource or ""
                found.setdefault(resource, {})[name] = (before, after)
        for resource, values in found.items():
            moved = Moved(resource, values, now)
            by, how = self._by(moved, heard, outcome, at_once=True)
            moved = self._moved[resource] = replace_fields(moved, by=by, how=how, on=now if how else None)
            changed: JsonValue = {name: [before, after] for name, (before, after) in values.items()}
            self._tell(KIND, {"resource": resource, "changed": changed, **_went_on(moved)})

    def _changed(self, heard: Heard) -> Iterator[tuple[str, Value, Value]]:
        for name in self._watched:
            before, after = heard.before[name], heard.after[name]
            if before is None or after is None or before == after:
                continue  # what a device has done that was not heard nobody knows
            if name in self._begins_anew and after == self._execution.automaton.variables[name].initial:
                continue  # as nothing is asked any more
            yield name, before, after

    def _is_explained(self, heard: Heard, name: str, after: Value) -> bool:
        explain = self._reactions.explain
        return explain((heard.before,), name, after) or explain(self._earlier(heard.before, name), name, after)

    def _earlier(self, before: State, name: str) -> Iterator[State]:
        """From where the device may have acted: told what it was lately, and being where it was seen last.

        What it does at once it may say one after the other, so of the others what they were lately counts too.
        """
        variables_ = self._execution.automaton.variables
        measured = {each: before[each] for each, v in variables_.items() if v.kind is Kind.MEASURED}
        for _, state in reversed(self._states):
            yield {**state, **measured}
            yield {**state, name: before[name]}

    def _go_on(self, heard: Heard, outcome: TickOutcome, now: Timestamp) -> None:
        for resource, moved in self._moved.items():
            if moved.how is not None:
                continue
            by, how = self._by(moved, heard, outcome)
            if how is not None:
                self._moved[resource] = gone = replace_fields(moved, by=by, how=how, on=now)
                self._tell(KIND, {"resource": resource, **_went_on(gone)})

    def _by(
        self, moved: Moved, heard: Heard, outcome: TickOutcome, at_once: bool = False
    ) -> tuple[str | None, WentOn | None]:
        """By which ability the station goes on, and how, if it does in this tick.

        In the tick of the change, `at_once`, what was under way and still is goes on too.
        """
        abilities = self._execution.automaton.abilities
        executing = [
            name
            for name, ability in abilities.items()
            if ability.resource == moved.resource
            and name not in outcome.started
            and heard.after[ability.flag("executing")] is True
            and (at_once or heard.before[ability.flag("executing")] is not True)
            and not self._reading[name].isdisjoint(moved.values)
        ]
        choices: tuple[tuple[WentOn, Collection[str]], ...] = (
            (WentOn.EXECUTES, executing),
            (WentOn.FINISHED, outcome.ended),
            (WentOn.STARTED, outcome.started),
        )
        for how, names in choices:
            for name in names:
                if abilities[name].resource == moved.resource or not self._reading[name].isdisjoint(moved.values):
                    return name, how
        return None, None


def on_its_way(pipelines: StationPipelines) -> dict[str, Collection[Value]]:
    """Return what a variable is on its way: between two named values, or a goal before it has come to its end."""
    named = {w.variable: (w.between,) for node in pipelines.nodes for w in node.writings if w.between is not None}
    goals = {name: GOAL_ON_ITS_WAY for use in pipelines.actions.values() for name in use.status.variables}
    return {**named, **goals}


def _went_on(moved: Moved) -> dict[str, JsonValue]:
    return {} if moved.by is None else {"by_ability": moved.by, "how": moved.how}


def _read(ability: Ability) -> frozenset[str]:
    """Return what decides whether the ability may start, executes, or has finished."""
    finish = () if ability.finish_guard is None else tuple(variables(ability.finish_guard))
    guards = (ability.enabled, ability.start_guard, ability.executing)
    return frozenset((*finish, *(name for guard in guards for name in variables(guard))))


# Forces: a measured variable or an output has a value that a person gives it, for a stated time.
#
# For commissioning, where a device is not there yet, or must be made to do something. What is forced ends by itself.

ForceCommand = ForceVariable | ReleaseForce

_FORCED = (Kind.MEASURED, Kind.OUTPUT)


class Forcing:
    """Takes commands about the forces of `execution`."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution

    def carry_out(self, command: ForceCommand, moment: Timestamp) -> None:
        """Do what is asked for. Raises `CommandRefused`; nothing has changed then."""
        match command:
            case ForceVariable():
                self._force(command, moment)
            case ReleaseForce(name=name):
                self._require_known(name)
                if name in self._execution.conduct.forces:
                    self._execution.release(name)

    def check(self, command: ForceVariable) -> None:
        """Raises `CommandRefused` when it could not be carried out now."""
        self._require_known(command.name)
        variable = self._execution.automaton.variables[command.name]
        if variable.kind not in _FORCED:
            detail = f"`{variable.name}` is {variable.kind}, and only measured variables and outputs can be forced."
            if variable.kind is Kind.ESTIMATED:
                detail = f"{detail} If it is not true, correct it instead."
            raise CommandRefused("not-forceable", "It cannot be forced", detail, 422)
        if not contains(variable.type, command.value):
            detail = f"`{variable.name}` is one of {variable.type}, and {print_value(command.value)} is none of these."
            raise CommandRefused("not-in-domain", "No such value", detail, 422)
        self._require_safety(command)

    def _force(self, command: ForceVariable, moment: Timestamp) -> None:
        self.check(command)
        until = Timestamp(moment.epoch + command.seconds, moment.monotonic + command.seconds)
        self._execution.force(command.name, command.value, until, command.actor.name, command.reason)

    def _require_known(self, name: str) -> None:
        known = self._execution.automaton.variables
        if name not in known:
            detail = f"The station has no variable `{name}`{suggestion(name, known) or '.'}"
            raise CommandRefused("unknown-variable", "There is no such variable", detail, 404)

    def _require_safety(self, command: ForceVariable) -> None:
        """Raises `CommandRefused` when the force would lead out of the safe states, or farther where it is outside.

        From outside an output, which moves devices, is forced only back into them.
        """
        execution = self._execution
        before, after = execution.state, execution.corrected({command.name: command.value})
        broken = [name for name in self._violated(after) if name not in self._violated(before)]
        if not broken and not self._leaves(before, after, moving=command.name in execution.automaton.outputs):
            return
        specifications = execution.automaton.specifications
        named = " and ".join(f"“{specifications[name].title}” ({name})" for name in broken)
        if broken:
            why = f"It would violate {named}."
        elif self._certainly_outside(before):
            why = "The station is outside its safe states, and would be so with it too."
        else:
            why = "From there a device could bring about what is forbidden, or rest could no longer be reached."
        raise CommandRefused("force-unsafe", "That is not safe", f"{why} Nothing was forced.")

    def _leaves(self, before: State, after: State, *, moving: bool) -> bool:
        safe = self._execution.supervisor.safe
        if safe.includes(after):
            return False
        if safe.includes(before):
            return True
        # While values are unknown neither may be certain; then it is refused where it makes the worse certain.
        return self._certainly_outside(after) and (moving or not self._certainly_outside(before))

    def _certainly_outside(self, state: State) -> bool:
        """Return whether no values of what is unknown make the state a safe one."""
        return bool(self._execution.supervisor.safe.nearest(state)) or bool(self._violated(state))

    def _violated(self, state: State) -> tuple[str, ...]:
        return violated(self._execution.automaton, state)
