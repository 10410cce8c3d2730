"""Kinds of alarms, each declared once; their texts are in `texts`, and `docs/alarms.md` says when each is raised."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Final

from sequence_planner.controller.views.station import AlarmGroup, Priority
from sequence_planner.texts.message import Argument, Message, places


@dataclass(frozen=True)
class AlarmKind:
    """A kind of alarm. `subjects` is of how many names its subject consists, which are joined by colons."""

    name: str
    priority: Priority
    group: AlarmGroup
    subjects: int = 0

    def key(self, subject: str = "") -> str:
        """The key of such an alarm."""
        return f"{self.name}:{subject}" if subject else self.name

    def cause(
        self,
        subject: str,
        arguments: Mapping[str, Argument],
        *,
        follows: tuple[str, ...] = (),
        parts: Iterable[Message] = (),
        past_parts: Iterable[Message] = (),
        resources: Iterable[str] = (),
        topics: Iterable[str] = (),
        of: frozenset[str] = frozenset(),
        about: frozenset[str] = frozenset(),
        waits: bool = False,
        phase: str = "",
    ) -> Cause:
        """A cause of such an alarm. `parts` are told one by one; a single one that the text tells is not."""
        text, past = self._said("text", arguments), self._said("past", arguments)
        return Cause(
            self.key(subject),
            self,
            subject,
            self.priority,
            text,
            self._said("consequence", arguments),
            self._said("action", arguments),
            past,
            follows=follows,
            parts=_untold(text, parts),
            past_parts=_untold(past, past_parts),
            resources=tuple(resources),
            topics=tuple(topics),
            of=of,
            about=about,
            waits=waits,
            phase=phase,
        )

    def _said(self, what: str, arguments: Mapping[str, Argument]) -> Message:
        name = f"{self.name}.{what}"
        return Message(name, {place: arguments[place] for place in places(name)})


@dataclass(frozen=True)
class Cause:
    """Why there is an alarm. `key` stays the same as long as it is the same alarm.

    `parts` are what it consists of, where that is several. It is no alarm of its own but a part of another as long as
    one of those is there that it `follows` from. `past` is its `text` once it is over, `past_parts` are its parts then,
    `resources` and `topics` where to look, `of` the resources whose devices fail with it, and `about` the variables of
    which it is doubted what is believed. A device that `waits` has nothing to do itself. Where the text becomes another
    as it lasts, `phase` says which it is, and `since` is counted from there.
    """

    key: str
    kind: AlarmKind
    subject: str
    priority: Priority
    text: Message  # what is wrong
    consequence: Message  # what comes of it
    action: Message  # what to do
    past: Message
    follows: tuple[str, ...] = field(default=(), kw_only=True)
    parts: tuple[Message, ...] = field(default=(), kw_only=True)
    past_parts: tuple[Message, ...] = field(default=(), kw_only=True)
    resources: tuple[str, ...] = field(default=(), kw_only=True)
    topics: tuple[str, ...] = field(default=(), kw_only=True)
    of: frozenset[str] = field(default=frozenset(), kw_only=True)
    about: frozenset[str] = field(default=frozenset(), kw_only=True)
    waits: bool = field(default=False, kw_only=True)
    phase: str = field(default="", kw_only=True)


KINDS: Final[dict[str, AlarmKind]] = {}


def _untold(text: Message, parts: Iterable[Message]) -> tuple[Message, ...]:
    """The parts of what a text says, but for a single one that it tells already."""
    every = tuple(parts)
    return () if len(every) == 1 and str(every[0]) in str(text) else every


def _kind(name: str, priority: Priority, group: AlarmGroup, subjects: int = 0) -> AlarmKind:
    KINDS[name] = AlarmKind(name, priority, group, subjects)
    return KINDS[name]


SILENT = _kind("silent", Priority.MEDIUM, AlarmGroup.DEVICE, 1)
MANY_SILENT = _kind("many-silent", Priority.HIGH, AlarmGroup.DEVICE)
NEVER_HEARD = _kind("never-heard", Priority.MEDIUM, AlarmGroup.DEVICE)
OVERDUE = _kind("overdue", Priority.MEDIUM, AlarmGroup.DEVICE, 1)
STILL = _kind("still", Priority.MEDIUM, AlarmGroup.DEVICE, 1)
GIVEN_UP = _kind("given-up", Priority.MEDIUM, AlarmGroup.DEVICE, 1)
TRIED = _kind("tried", Priority.LOW, AlarmGroup.PLAN, 1)

NETWORK = _kind("network", Priority.MEDIUM, AlarmGroup.COMMUNICATION, 1)
RIVAL = _kind("rival", Priority.HIGH, AlarmGroup.COMMUNICATION)
COMMAND = _kind("command", Priority.HIGH, AlarmGroup.COMMUNICATION)
MESSAGE = _kind("message", Priority.MEDIUM, AlarmGroup.COMMUNICATION, 2)

PLANNER = _kind("planner", Priority.MEDIUM, AlarmGroup.PLAN)
NO_PLAN = _kind("no-plan", Priority.MEDIUM, AlarmGroup.RECOVERY)
LEFT_OUT = _kind("left-out", Priority.LOW, AlarmGroup.PLAN)
UNDECIDED = _kind("undecided", Priority.LOW, AlarmGroup.PLAN)
ERRAND_WAITS = _kind("errand-waits", Priority.MEDIUM, AlarmGroup.PLAN)
ERRAND = _kind("errand", Priority.MEDIUM, AlarmGroup.PLAN, 1)
LOCAL = _kind("local", Priority.MEDIUM, AlarmGroup.PLAN, 2)

UNSAFE_STATE = _kind("unsafe-state", Priority.HIGH, AlarmGroup.RECOVERY)
CONFLICT = _kind("conflict", Priority.HIGH, AlarmGroup.MODEL, 3)
CONTRADICTION = _kind("contradiction", Priority.MEDIUM, AlarmGroup.RECOVERY)
NOT_RESTORED = _kind("not-restored", Priority.MEDIUM, AlarmGroup.RECOVERY)
UNDECIDED_OUTPUTS = _kind("undecided-outputs", Priority.MEDIUM, AlarmGroup.RECOVERY)
RESTLESS = _kind("restless", Priority.MEDIUM, AlarmGroup.MODEL)

BEGINS_AT_REST = _kind("begins-at-rest", Priority.MEDIUM, AlarmGroup.PEOPLE)
FORCED = _kind("forced", Priority.LOW, AlarmGroup.PEOPLE, 1)
PROBLEM = _kind("problem", Priority.MEDIUM, AlarmGroup.PEOPLE, 1)
BY_HAND = _kind("by-hand", Priority.LOW, AlarmGroup.PEOPLE, 1)

CONTROLLER = _kind("controller", Priority.HIGH, AlarmGroup.SYSTEM, 1)
UNJOURNALLED = _kind("unjournalled", Priority.HIGH, AlarmGroup.SYSTEM)
UNRECORDED = _kind("unrecorded", Priority.HIGH, AlarmGroup.SYSTEM)
KEPT_BESIDE = _kind("kept-beside", Priority.MEDIUM, AlarmGroup.SYSTEM)
DEPLOYMENT_UNDONE = _kind("deployment-undone", Priority.HIGH, AlarmGroup.SYSTEM)
NOT_EMULATED = _kind("not-emulated", Priority.HIGH, AlarmGroup.SYSTEM)
NO_SUPERVISOR = _kind("no-supervisor", Priority.HIGH, AlarmGroup.SYSTEM)
MODEL_UNUSABLE = _kind("model-unusable", Priority.HIGH, AlarmGroup.SYSTEM)

MODEL = _kind("model", Priority.MEDIUM, AlarmGroup.PROCESS, 1)


def silences(resources: Collection[str]) -> tuple[str, ...]:
    """The keys of the alarms by which it is told that these are silent."""
    return (MANY_SILENT.key(), NEVER_HEARD.key(), *map(SILENT.key, sorted(resources))) if resources else ()
