"""Faults as a person writes them, in one line: `robot silent for 5 s`, `nutrunner.tool_is_idle stuck`, `clear`."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence

from sequence_planner.automaton.structure import Automaton
from sequence_planner.emulation.faults import Clear, Fault, FaultKind
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.syntax import ExpressionError, Span
from sequence_planner.expressions.types import BooleanType, IntegerRange, Type, Value, contains
from sequence_planner.pipelines.graph import StationPipelines

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
_WORD = re.compile(r"\S+")

Word = re.Match[str]


class FaultReader:
    """Reads faults of the devices of a station of which the resources are emulated for which `emulates` holds."""

    def __init__(self, automaton: Automaton, pipelines: StationPipelines, emulates: Callable[[str], bool]) -> None:
        self._automaton = automaton
        self._targets = dict(_targets(pipelines, emulates))

    def read(self, text: str) -> Fault | Clear:
        """What a line says. Raises `ExpressionError` with the word that does not fit."""
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
