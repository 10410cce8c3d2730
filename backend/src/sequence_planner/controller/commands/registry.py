"""All commands and queries by their kinds, and how one is read from a message."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, PlainValidator, SerializeAsAny
from pydantic_core import PydanticCustomError

from sequence_planner.controller.commands import alarms, approvals, execution, jobs, queries, recovery, tasks
from sequence_planner.controller.commands.command import Command, Query

Declared = TypeVar("Declared", bound=BaseModel)


def _by_kind(base: type[Declared]) -> dict[str, type[Declared]]:
    return {
        each.model_fields["kind"].default: each
        for module in (execution, recovery, approvals, alarms, tasks, jobs, queries)
        for each in vars(module).values()
        if isinstance(each, type) and issubclass(each, base) and not each.model_fields["kind"].is_required()
    }


COMMANDS: dict[str, type[Command]] = _by_kind(Command)
QUERIES: dict[str, type[Query[Any]]] = _by_kind(Query)


def _read(known: Mapping[str, type[BaseModel]], base: type[BaseModel], value: object) -> BaseModel:
    if isinstance(value, base):
        return value
    kind = value.get("kind") if isinstance(value, dict) else None
    if not isinstance(kind, str) or kind not in known:
        raise PydanticCustomError("unknown_kind", "There is nothing of this kind")
    return known[kind].model_validate(value)


AnyCommand = Annotated[SerializeAsAny[Command], PlainValidator(partial(_read, COMMANDS, Command))]
AnyQuery = Annotated[SerializeAsAny[Query[Any]], PlainValidator(partial(_read, QUERIES, Query))]
