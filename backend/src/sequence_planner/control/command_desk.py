"""Commands, carried out: first whether their actor may give them now, then what they ask for.

What a role allows is decided before, where requests come in; here it is decided what only the station can know.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from sequence_planner.actor import ActorKind
from sequence_planner.control.commands import (
    AcknowledgeTask,
    ClearOverride,
    Command,
    CommandRefused,
    ReleaseControl,
    SetMode,
    SetOverride,
    StartProduction,
    TakeControl,
    WithdrawControl,
)
from sequence_planner.control.execution import Execution
from sequence_planner.control.in_control import InControl
from sequence_planner.control.moment import Moment
from sequence_planner.control.overrides import Overrides
from sequence_planner.control.tasks import TaskDesk


class CommandDesk:
    """Takes commands; `start_production` may refuse, `real_devices` names what speaks against a demonstration."""

    def __init__(
        self,
        execution: Execution,
        tasks: TaskDesk,
        overrides: Overrides,
        start_production: Callable[[], None],
        real_devices: Callable[[], Sequence[str]],
    ) -> None:
        self.in_control = InControl()
        self._execution = execution
        self._tasks = tasks
        self._overrides = overrides
        self._start_production = start_production
        self._real_devices = real_devices

    def carry_out(self, command: Command, moment: Moment) -> None:
        """Do what is asked for. Raises `CommandRefused`; nothing has changed then."""
        self._check(command)
        match command:
            case SetMode(mode=mode):
                self._execution.mode = mode
            case StartProduction():
                self._start_production()
            case AcknowledgeTask(task=task, revision=revision):
                self._tasks.acknowledge(task, revision)
            case SetOverride(name=name, fields=fields, actor=actor):
                self._overrides.set(name, fields, actor.name, moment.monotonic)
            case ClearOverride(name=name):
                self._overrides.clear(name, moment.monotonic)
            case TakeControl(actor=actor, over=over):
                self.in_control.take(actor, over, moment.epoch)
            case ReleaseControl(actor=actor):
                self.in_control.release(actor)
            case WithdrawControl(session=session):
                self.in_control.withdraw(session)

    def _check(self, command: Command) -> None:
        actor = command.actor
        if actor.kind is ActorKind.DEMONSTRATION and not command.harmless and (there := self._real_devices()):
            detail = f"{'; '.join(there)}. A demonstration may command emulated devices only."
            raise CommandRefused("real-devices", "There are real devices", detail, 403)
        if command.needs_control and actor.kind is not ActorKind.SYSTEM:
            self.in_control.require(actor)
