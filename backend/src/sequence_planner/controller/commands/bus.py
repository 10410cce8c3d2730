"""Who carries out which command: one table, made of the methods of features that say which command they handle."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Protocol, TypeVar

from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.clock import Timestamp

Given = TypeVar("Given", bound=Command)
Feature = TypeVar("Feature")
Handler = Callable[[Command, Timestamp], None]
_HANDLES = "_handles"  # of a function: the command that it handles


def handles(
    command: type[Given],
) -> Callable[[Callable[[Feature, Given, Timestamp], None]], Callable[[Feature, Given, Timestamp], None]]:
    """Declare that a method carries out a command, now. It raises `CommandRefused`, and nothing has changed then."""

    def declare(method: Callable[[Feature, Given, Timestamp], None]) -> Callable[[Feature, Given, Timestamp], None]:
        setattr(method, _HANDLES, command)
        return method

    return declare


def handlers(features: Iterable[object]) -> dict[type[Command], Handler]:
    """The methods of features by the commands that they handle. Raises `ValueError` where two handle the same one."""
    found: dict[type[Command], Handler] = {}
    for feature in features:
        for name, method in vars(type(feature)).items():
            if (command := getattr(method, _HANDLES, None)) is not None:
                if command in found:
                    raise ValueError(f"{command.__name__} is handled twice, by {type(feature).__name__} and another")
                found[command] = getattr(feature, name)
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
        self._handlers: Mapping[type[Command], Handler] = handlers(features)
        if lacking := [each.__name__ for each in commands if each not in self._handlers]:
            raise ValueError(f"no feature handles {', '.join(lacking)}")
        self._in_control = in_control
        self._require_one = require_one
        self._real_devices = real_devices

    def execute(self, command: Command, moment: Timestamp) -> None:
        """Do what is asked for, if its actor may. Raises `CommandRefused`; nothing has changed then."""
        actor = command.actor
        if actor.kind is ActorKind.DEMONSTRATION and not command.harmless and (there := list(self._real_devices())):
            detail = f"{'; '.join(there)}. A demonstration may command emulated devices only."
            raise CommandRefused("real-devices", "There are real devices", detail, 403)
        if command.needs_control and actor.kind is not ActorKind.SYSTEM:
            self._in_control.require(actor)
        self._require_one(command.for_two)
        self.perform(command, moment)

    def perform(self, command: Command, moment: Timestamp) -> None:
        """Do it, whoever wants it: what two people have agreed on. Raises `CommandRefused`."""
        self._handlers[type(command)](command, moment)
