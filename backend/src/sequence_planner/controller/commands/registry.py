"""All commands by their kinds, and how one is read from a message."""

from __future__ import annotations

from typing import Annotated

from pydantic import PlainValidator, SerializeAsAny
from pydantic_core import PydanticCustomError

from sequence_planner.controller.commands import alarms, approvals, execution, jobs, recovery, tasks
from sequence_planner.controller.commands.command import Command

COMMANDS: dict[str, type[Command]] = {
    each.model_fields["kind"].default: each
    for module in (execution, recovery, approvals, alarms, tasks, jobs)
    for each in vars(module).values()
    if isinstance(each, type) and issubclass(each, Command) and not each.model_fields["kind"].is_required()
}


def _read(value: object) -> Command:
    if isinstance(value, Command):
        return value
    kind = value.get("kind") if isinstance(value, dict) else None
    if kind not in COMMANDS:
        raise PydanticCustomError("no_command", "There is no command of this kind")
    return COMMANDS[kind].model_validate(value)


AnyCommand = Annotated[SerializeAsAny[Command], PlainValidator(_read)]
