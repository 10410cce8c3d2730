"""Who carries out which command, and who answers which query: tables made of the methods of features that say so."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol

from sequence_planner.controller.commands.command import HANDLES, Command, CommandRefused, Query
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.data_models import DataModel
from sequence_planner.texts.message import joined, message

Handler = Callable[..., Any]
Made = DataModel | None  # by a command


def handlers(features: Iterable[object]) -> dict[type, Handler]:
    """The methods of features by what they handle or answer. Raises `ValueError` where two handle the same."""
    found: dict[type, Handler] = {}
    for feature in features:
        for name, method in vars(type(feature)).items():
            if (command := getattr(method, HANDLES, None)) is not None:
                if command in found:
                    raise ValueError(f"{command.__name__} is handled twice, by {type(feature).__name__} and another")
                found[command] = getattr(feature, name)
    return found


def complete(features: Iterable[object], declared: Iterable[type]) -> Mapping[type, Handler]:
    """The handlers of all that is declared. Raises `ValueError` where something has none."""
    found = handlers(features)
    if lacking := [each.__name__ for each in declared if each not in found]:
        raise ValueError(f"no feature handles {', '.join(lacking)}")
    return found


class Authority(Protocol):
    """Decides what only the station can know; what a role allows is decided before, where requests come in."""

    def require(self, actor: Actor) -> None:
        """Raises `CommandRefused` unless the session of `actor` is in control."""


class CommandBus:
    """Carries out commands: first whether their actor may give them now, then what they ask for.

    `real_devices` names what speaks against a demonstration, `require_one` refuses what takes two people. Raises
    `ValueError` when one of `commands` has no handler.
    """

    def __init__(
        self,
        features: Iterable[object],
        commands: Iterable[type[Command]],
        *,
        in_control: Authority,
        require_one: Callable[[Iterable[str]], None],
        real_devices: Callable[[], Iterable[str]],
    ) -> None:
        self._handlers = complete(features, commands)
        self._in_control = in_control
        self._require_one = require_one
        self._real_devices = real_devices

    def execute(self, command: Command, moment: Timestamp) -> Made:
        """Do what is asked for, if its actor may; return what that makes. Raises `CommandRefused`; nothing has changed
        then.
        """
        actor = command.actor
        if actor.kind is ActorKind.DEMONSTRATION and not command.harmless and (there := list(self._real_devices())):
            raise CommandRefused(
                "real-devices", message("refused.real-devices.demonstration", devices=joined(there)), 403
            )
        if command.needs_control and actor.kind is not ActorKind.SYSTEM:
            self._in_control.require(actor)
        self._require_one(command.for_two)
        return self.perform(command, moment)

    def perform(self, command: Command, moment: Timestamp) -> Made:
        """Do it, whoever wants it: what two people have agreed on. Raises `CommandRefused`."""
        made: Made = self._handlers[type(command)](command, moment)
        return made


class QueryBus:
    """Has queries answered. Raises `ValueError` when nobody answers one of `queries`."""

    def __init__(self, features: Iterable[object], queries: Iterable[type[Query[Any]]]) -> None:
        self._handlers = complete(features, queries)

    async def answer(self, query: Query[Any]) -> DataModel:
        """The document that answers it. Raises `CommandRefused`."""
        answer = self._handlers[type(query)](query)
        found: DataModel = await answer if inspect.isawaitable(answer) else answer
        return found
