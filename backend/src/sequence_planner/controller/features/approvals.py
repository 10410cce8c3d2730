"""Requests for what a variable with `approval: dual` asks two people for (four-eyes principle).

A request holds for two minutes, in the state in which it was looked at, while who has asked for it is in control. None
outlives the controller.
"""

from __future__ import annotations

import itertools
import secrets
from collections.abc import Callable, Iterable

from sequence_planner.controller.commands.approvals import (
    Act,
    ApprovedCommand,
    ApproveRequest,
    DeclineRequest,
    RequestApproval,
)
from sequence_planner.controller.commands.command import Command, CommandRefused, handles
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.views.station import ApprovalState, ApprovalView
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.execution.executor import Executor
from sequence_planner.texts.message import message

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
    """The commands that wait for a second person at the station of `execution`.

    `check` raises `CommandRefused` where one could not be done now, whoever wants it; `perform` does it.
    """

    def __init__(
        self,
        execution: Executor,
        in_control: ControlLock,
        check: Callable[[ApprovedCommand], None],
        perform: Callable[[Command, Timestamp], None],
    ) -> None:
        self._execution = execution
        self._in_control = in_control
        self._check = check
        self._perform = perform
        self._requests: dict[str, _Request] = {}
        self._life = secrets.token_hex(3)  # no answer is taken for one to a request of an earlier controller
        self._numbers = itertools.count(1)

    def require_one(self, names: Iterable[str]) -> None:
        """Raises `CommandRefused` when a second person has to approve what is done to one of these variables."""
        if dual := self._dual(names):
            raise CommandRefused("approval-needed", message("refused.approval-needed.ask", variables=dual))

    @handles(RequestApproval)
    def ask(self, command: RequestApproval, moment: Timestamp) -> None:
        """Let it wait for a second person; an earlier request of the same person ends."""
        self._check(command.act.command(command.actor, command.reason, command.revision))
        _require_person(command.actor)
        if not self._dual(command.act.names):
            raise CommandRefused("no-approval-needed", message("refused.no-approval-needed.free"))
        if command.revision != self._execution.revision:
            raise _moved()
        for id_, request in self._waiting(moment).items():
            if request.actor.id == command.actor.id:
                self._end(id_, ApprovalState.WITHDRAWN, moment, command.actor)
        request = _Request(command.actor, command.act, command.revision, command.reason, moment)
        self._requests[f"{self._life}-{next(self._numbers)}"] = request
        for id_ in list(self._requests)[:-MOST_SHOWN]:
            del self._requests[id_]

    @handles(ApproveRequest)
    def approve(self, command: ApproveRequest, moment: Timestamp) -> None:
        """Do it, in the names of both."""
        _require_person(command.actor)
        request = self._answerable(command, moment)
        if request.actor.id == command.actor.id:
            raise CommandRefused("same-person", message("refused.same-person.yourself"), 403)
        if command.revision != request.revision:
            raise _moved()
        both = f"{request.actor.name} + {command.actor.name}"[:LONGEST_NAME]
        actor = request.actor.model_copy(update={"name": both})
        self._perform(request.act.command(actor, request.why, request.revision), moment)
        self._end(command.request, ApprovalState.APPROVED, moment, command.actor, command.reason)

    @handles(DeclineRequest)
    def decline(self, command: DeclineRequest, moment: Timestamp) -> None:
        """Let it be, in the name of who declines or withdraws it."""
        _require_person(command.actor)
        own = self._answerable(command, moment).actor.id == command.actor.id
        state = ApprovalState.WITHDRAWN if own else ApprovalState.DECLINED
        self._end(command.request, state, moment, command.actor, command.reason)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view: what waits, and what was over lately."""
        self._look(moment)
        views = {
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
        return {"approvals": views}

    def _answerable(self, command: ApproveRequest | DeclineRequest, moment: Timestamp) -> _Request:
        request = self._waiting(moment).get(command.request)
        if request is None:
            raise CommandRefused("request-gone", message("refused.request-gone.gone"))
        if command.act.model_dump_json() != request.act.model_dump_json():
            raise CommandRefused("not-confirmed", message("refused.not-confirmed.request"))
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
        holder = self._in_control.holder
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
        raise CommandRefused("not-a-person", message("refused.not-a-person.demonstration"), 403)


def _moved() -> CommandRefused:
    return CommandRefused("stale-revision", message("refused.stale-revision.looked"))
