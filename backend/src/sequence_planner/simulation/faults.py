"""Fault injection in emulated devices: fault kinds, their text syntax and their behaviour."""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.syntax import ExpressionError, Span
from sequence_planner.language.types import BooleanType, IntegerRange, Type, Value, contains
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.simulation.devices import EmulatedDevices
from sequence_planner.simulation.messages import CannotSpeakError, Message, spoken

# Faults that emulated devices can have.


class FaultKind(StrEnum):
    """A kind of thing that can be wrong with a device."""

    SILENT = "silent"  # it says nothing
    STUCK = "stuck"  # it says what it said when the fault began
    WRONG = "wrong"  # it says another value than is true
    OFFLINE = "offline"  # it is not on the network
    RESTARTED = "restarted"  # offline, and then as at the beginning, without a command
    SLOW = "slow"  # it takes so many times as long for everything
    DROP = "drop"  # a share of its messages, and of those to it, is lost
    GARBAGE = "garbage"  # it sends bytes without sense


@dataclass(frozen=True)
class Fault:
    """A fault of a resource, of a topic of it or of a measured variable.

    `amount` is how many times as slow it is, or the share of messages that is lost; `value` is the wrong one. Without
    `seconds` it lasts until it is cleared.
    """

    kind: FaultKind
    target: str
    amount: float = 1.0
    value: Value | None = None
    seconds: float | None = None

    def __str__(self) -> str:
        behind = {
            FaultKind.WRONG: f" {str(self.value).lower() if isinstance(self.value, bool) else self.value}",
            FaultKind.SLOW: f" {self.amount:g}",
            FaultKind.DROP: f" {self.amount:g}",
        }.get(self.kind, "")
        lasting = "" if self.seconds is None else f" for {self.seconds:g} s"
        return f"{self.target} {self.kind}{behind}{lasting}"


@dataclass(frozen=True)
class Clear:
    """The end of all faults, or of those of one target."""

    target: str | None = None

    def __str__(self) -> str:
        return "clear" if self.target is None else f"clear {self.target}"


# Faults as a person writes them, in one line: `robot silent for 5 s`, `nutrunner.tool_is_idle stuck`, `clear`.

LONGEST = 1e6  # seconds

# What each kind can be at; `command` is a topic on which the station speaks.
_AT = {
    FaultKind.SILENT: ("resource", "topic"),
    FaultKind.STUCK: ("resource", "topic", "variable"),
    FaultKind.WRONG: ("variable",),
    FaultKind.OFFLINE: ("resource",),
    FaultKind.RESTARTED: ("resource",),
    FaultKind.SLOW: ("resource",),
    FaultKind.DROP: ("resource", "topic", "command"),
    FaultKind.GARBAGE: ("resource", "topic"),
}
# Kinds of what a device says.
_SPEAKING = (FaultKind.SILENT, FaultKind.STUCK, FaultKind.GARBAGE)
_WORD = re.compile(r"\S+")

Word = re.Match[str]


class FaultReader:
    """Reads faults of the devices of a station of which the resources are emulated for which `emulates` holds."""

    def __init__(self, automaton: Automaton, pipelines: StationPipelines, emulates: Callable[[str], bool]) -> None:
        self._automaton = automaton
        self._targets = dict(_targets(pipelines, emulates))
        self._speaking = {each.topic.resource for each in pipelines.sources.values()}

    def read(self, text: str) -> Fault | Clear:
        """Return what a line says. Raises `ExpressionError` with the word that does not fit."""
        words = list(_WORD.finditer(text))
        if not words:
            raise ExpressionError("write a fault such as `robot silent for 5 s`", Span(0, len(text)))
        if words[0][0] == "clear":
            _no_more(words[2:])
            for word in words[1:]:
                self._kind_of(word)
            return Clear(words[1][0] if len(words) > 1 else None)
        at = self._kind_of(words[0])
        kind = _kind(words)
        if at not in _AT[kind]:
            of = " or a ".join(_AT[kind]).replace("command", "topic")
            raise _wrong(words[1], f"`{kind}` is for a {of}, and {words[0][0]} is a {_shown(at)}")
        if kind in _SPEAKING and at == "resource" and words[0][0] not in self._speaking:
            raise _wrong(words[1], f"nothing is heard from {words[0][0]} in any case: nothing of it could be {kind}")
        behind, amount, value = words[2:], 1.0, None
        if kind is FaultKind.WRONG:
            value = self._value(words)
            behind = words[3:]
        elif kind in (FaultKind.SLOW, FaultKind.DROP):
            amount = _amount(kind, words)
            behind = words[3:]
        return Fault(kind, words[0][0], amount, value, _seconds(behind))

    def _kind_of(self, word: Word) -> str:
        kind = self._targets.get(word[0])
        if kind is None:
            near = suggestion(word[0], self._targets)
            raise _wrong(word, f"no emulated device has `{word[0][:80]}`: name a resource, a topic or a variable{near}")
        return kind

    def _value(self, words: Sequence[Word]) -> Value:
        type_ = self._automaton.variables[words[0][0]].type
        if len(words) < 3:
            raise _wrong(words[-1], f"`wrong` needs a value of {words[0][0]}, which ranges over {type_}")
        value = _read_value(words[2][0], type_)
        if value is None or not contains(type_, value):
            near = suggestion(words[2][0], map(str, type_.domain))
            raise _wrong(words[2], f"`{words[2][0]}` is no value of {words[0][0]}, which ranges over {type_}{near}")
        return value


def _targets(pipelines: StationPipelines, emulates: Callable[[str], bool]) -> Iterator[tuple[str, str]]:
    for kind, topics in (("topic", pipelines.incoming), ("command", pipelines.outgoing)):
        for name, each in topics.items():
            if emulates(each.topic.resource):
                yield from ((each.topic.resource, "resource"), (name, kind))
    for variable, source in pipelines.feeds.items():
        spoken = [pipelines.incoming[topic] for topic in pipelines.topics_of(source) if topic in pipelines.incoming]
        if any(emulates(each.topic.resource) for each in spoken):
            yield variable, "variable"


def _kind(words: Sequence[Word]) -> FaultKind:
    if len(words) < 2:
        raise _wrong(words[0], f"say what is wrong with {words[0][0]}: {', '.join(FaultKind)}")
    try:
        return FaultKind(words[1][0])
    except ValueError:
        near = suggestion(words[1][0], FaultKind)
        raise _wrong(words[1], f"`{words[1][0][:80]}` is no fault: write one of {', '.join(FaultKind)}{near}") from None


def _amount(kind: FaultKind, words: Sequence[Word]) -> float:
    least, most = (1.0, 1e4) if kind is FaultKind.SLOW else (0.0, 1.0)
    what = "how many times as long everything takes" if kind is FaultKind.SLOW else "the share that is lost"
    number = _number(words[2][0]) if len(words) > 2 else None
    if number is None or not least <= number <= most:
        raise _wrong(words[min(2, len(words) - 1)], f"behind `{kind}` stands {what}, from {least:g} to {most:g}")
    return number


def _seconds(words: Sequence[Word]) -> float | None:
    """The rest of the line: nothing, or `for 5 s`."""
    if not words:
        return None
    if words[0][0] != "for":
        raise _wrong(
            words[0], f"`{words[0][0][:80]}` does not belong here: at the end may stand how long, as `for 5 s`"
        )
    text = words[1][0] if len(words) > 1 else ""
    unit = words[2:3] or (words[1:2] if text.endswith("s") else [])
    number = _number(text.removesuffix("s") if not words[2:3] else text)
    if number is None or not 0 < number <= LONGEST or not unit or unit[0][0] not in ("s", text):
        raise _wrong(words[min(1, len(words) - 1)], "behind `for` stands a number of seconds, as in `for 5 s`")
    _no_more(words[3:])
    return number


def _no_more(words: Sequence[Word]) -> None:
    if words:
        raise _wrong(words[0], f"`{words[0][0][:80]}` does not belong here")


def _read_value(text: str, type_: Type) -> Value | None:
    if isinstance(type_, BooleanType):
        return {"true": True, "false": False}.get(text)
    if isinstance(type_, IntegerRange):
        return int(text) if re.fullmatch(r"-?[0-9]{1,18}", text) else None
    return text


def _number(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _shown(kind: str) -> str:
    return "topic on which the station speaks" if kind == "command" else kind


def _wrong(word: Word, message: str) -> ExpressionError:
    return ExpressionError(message, Span(*word.span()))


# Emulated devices with faults in them.
#
# Most faults are in what a device says: behind them it goes on as ever, and once they end it says the truth again. Only
# a device that is slow or starts again does something else than it would.

_OFFLINE = (FaultKind.OFFLINE, FaultKind.RESTARTED)
RESTART = 1.0  # seconds for which a device that starts again is offline, if nothing else is said
_SURPLUS = b"\xff" * 8  # more than a message may be padded with


@dataclass
class _Underway:
    """A fault that has begun, when it ends, and what was said when it began."""

    fault: Fault
    until: float | None
    messages: Mapping[str, Message] = field(default_factory=dict)
    values: Mapping[str, Value] = field(default_factory=dict)
    held: Mapping[str, Value | None] = field(default_factory=dict)  # the variables of those messages


class FaultyDevices:
    """The outcome of what `devices` say and hear while they have faults. Times are on the clock of the devices.

    `seed` draws which messages are lost.
    """

    def __init__(self, devices: EmulatedDevices, pipelines: StationPipelines, seed: int = 0) -> None:
        self.devices = devices
        self._pipelines = pipelines
        self._random = random.Random(f"faults {seed}")
        self._underway: list[_Underway] = []

    @property
    def faults(self) -> tuple[Fault, ...]:
        """Those that have begun and not ended, the oldest first."""
        return tuple(each.fault for each in self._underway)

    @property
    def offline_resources(self) -> frozenset[str]:
        """The resources whose devices are not on the network."""
        return frozenset(each.fault.target for each in self._underway if each.fault.kind in _OFFLINE)

    def start(self, fault: Fault, now: float) -> None:
        """Let a fault begin. It takes the place of one of the same kind at the same target."""
        self._end(
            [each for each in self._underway if (each.fault.kind, each.fault.target) == (fault.kind, fault.target)]
        )
        seconds = RESTART if fault.seconds is None and fault.kind is FaultKind.RESTARTED else fault.seconds
        begun = _Underway(fault, None if seconds is None else now + seconds)
        if fault.kind is FaultKind.WRONG and fault.value is not None:
            begun.values = {fault.target: fault.value}
        elif fault.kind is FaultKind.STUCK and fault.target in self.devices.topics:
            value = self.devices.state[fault.target]
            begun.values = {} if value is None else {fault.target: value}
        elif fault.kind is FaultKind.STUCK:
            begun.messages = {topic: self.devices.report(topic) for topic in self._topics(fault.target)}
            begun.held = {
                name: self.devices.state[name]
                for name, topics in self.devices.topics.items()
                if not begun.messages.keys().isdisjoint(topics)
            }
        self._underway.append(begun)
        self._slow()

    def clear(self, clear: Clear) -> list[Fault]:
        """End faults now; returns which."""
        ended = [each for each in self._underway if clear.target in (None, each.fault.target)]
        self._end(ended)
        return [each.fault for each in ended]

    def advance(self, now: float) -> None:
        """Let time pass: faults end whose time is over, and the devices do what is due."""
        self._end([each for each in self._underway if each.until is not None and each.until <= now])
        self.devices.advance(now)

    @property
    def due(self) -> float:
        """The time when the next thing happens by itself, after the last `advance`; inf if none will."""
        ends = min((each.until for each in self._underway if each.until is not None), default=math.inf)
        return min(ends, self.devices.due)

    def says(self, topic: str) -> Message | None:
        """The message with which a device would report now; None while it says nothing."""
        if self._has(topic, *_OFFLINE, FaultKind.SILENT):
            return None
        values: dict[str, Value] = {}
        for each in self._underway:
            if topic in each.messages:
                return each.messages[topic]
            values |= {name: value for name, value in each.values.items() if topic in self.devices.topics[name]}
        message = self.devices.report(topic)
        if not values:
            return message
        try:
            return spoken(self._pipelines, topic, {**self.devices.state, **values}, message)
        except CannotSpeakError:  # beside what else the device says now, the value cannot be said
            return message

    def heard(self, variable: str) -> Value | None:
        """What can be heard of a measured variable: what is so, or what a fault makes of it; None where nothing is said
        that has a sense. Of messages that are lost only sometimes, the next comes.
        """
        for topic in self.devices.topics[variable]:
            at = (topic, self._pipelines.sources[topic].topic.resource)
            if any(_is_mute(fault) and fault.target in at for fault in self.faults):
                return None
        for each in self._underway:
            if variable in each.held:
                return each.held[variable]
            if variable in each.values:
                return each.values[variable]
        return self.devices.state[variable]

    def sent(self, topic: str, data: bytes) -> bytes | None:
        """Return what a message is on the network: itself, bytes that are no message, or None for one that is lost."""
        if self._is_lost(topic):
            return None
        return garbage(data) if self._has(topic, FaultKind.GARBAGE) else data

    def hears(self, topic: str) -> bool:
        """Return whether a command that is sent on a topic of the station comes to the device."""
        return not self._has(topic, *_OFFLINE) and not self._is_lost(topic)

    def _end(self, ended: list[_Underway]) -> None:
        if not ended:
            return
        for each in ended:
            self._underway.remove(each)
            if each.fault.kind is FaultKind.RESTARTED:
                self.devices.restart(each.fault.target)
        self._slow()

    def _slow(self) -> None:
        self.devices.slow({f.target: f.amount for f in self.faults if f.kind is FaultKind.SLOW})

    def _topics(self, target: str) -> list[str]:
        """The topics on which the devices of a resource speak, or the topic itself."""
        return [name for name, each in self._pipelines.incoming.items() if target in (name, each.topic.resource)]

    def _has(self, topic: str, *kinds: FaultKind) -> bool:
        return any(f.kind in kinds and self._is_at(f, topic) for f in self.faults)

    def _is_at(self, fault: Fault, topic: str) -> bool:
        described = self._pipelines.incoming.get(topic) or self._pipelines.outgoing[topic]
        return fault.target in (topic, described.topic.resource)

    def _is_lost(self, topic: str) -> bool:
        kept = math.prod(1 - f.amount for f in self.faults if f.kind is FaultKind.DROP and self._is_at(f, topic))
        return kept < 1 and self._random.random() >= kept


def _is_mute(fault: Fault) -> bool:
    """Return whether nothing that a station understands is said for as long as it lasts."""
    lost = fault.kind is FaultKind.DROP and fault.amount >= 1
    return lost or fault.kind in (*_OFFLINE, FaultKind.SILENT, FaultKind.GARBAGE)


def garbage(data: bytes) -> bytes:
    """A message with more behind it than its type has, as a node sends it that was built with another definition.

    Other nonsense does not reach a station: the middleware sends no text without its length and no message that is too
    short, and of any byte that stands for a truth it makes `true`.
    """
    return data + _SURPLUS
