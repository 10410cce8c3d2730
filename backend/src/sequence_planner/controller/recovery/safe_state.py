"""A running station outside its safe states: what is wrong, how a safe state differs, and which way leads back.

Pure, as `executor` is. Nothing is started because of it: it only says what there is to know.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.state_set import StateSet
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import UNSAFE_STATE, Cause
from sequence_planner.controller.views.station import DifferenceView, SpecificationView, WayBackStepView, WayBackView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.language.syntax import variables
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Circumstances, RecoveryPath, WayBackAnswer, WayBackRequest
from sequence_planner.planning.recovery_path import deciding, violated
from sequence_planner.texts.message import Item, Message, message


@dataclass(frozen=True)
class SafeStateDifference:
    """A variable that has another value in the nearest safe state."""

    name: str
    now: Value
    safe: Value


@dataclass(frozen=True)
class SafetyStatus:
    """The faults of a state that does not count as safe.

    `violated` are specifications, `differences` lead to the nearest safe state in fewest variables, and `awaited` are
    the unknown variables that safety depends on. Without differences the state would be safe for some of their values.
    """

    violated: tuple[str, ...]
    differences: tuple[SafeStateDifference, ...]
    awaited: tuple[str, ...]

    @property
    def certain(self) -> bool:
        """True if the state is outside whatever the unknown values are."""
        return bool(self.violated or self.differences)


def surely_outside(safe: StateSet, state: State) -> bool:
    """Return whether a state is outside the safe states whatever its unknown values are."""
    return any(state[name] is not None for name in safe.nearest(state) or ())


def leaves(safe: StateSet, before: State, after: State) -> bool:
    """Return whether a change leads out of the safe states, whatever is not heard yet."""
    if surely_outside(safe, after) and not surely_outside(safe, before):
        return True
    return safe.includes(before) and not safe.includes(after)


class SafeStateMonitor:
    """Looks at the state of `execution`, asks for a way back where one is wanted, and remembers the last answer.

    `feeds` names the topic behind each measured variable.
    """

    def __init__(self, execution: Executor, feeds: Mapping[str, str] | None = None) -> None:
        self._execution = execution
        self._feeds = {} if feeds is None else feeds
        self._consequences = Consequences(execution)
        self._deciding = deciding(execution.automaton, execution.supervisor.safe)
        self._looked_at: tuple[State | None, object] = None, None
        self._seen: tuple[tuple[tuple[Value | None, ...], frozenset[str]] | None, SafetyStatus | None] = None, None
        self._asked: tuple[tuple[Value | None, ...], Circumstances] | None = None
        self._answer: tuple[tuple[Value | None, ...], WayBackAnswer | str] | None = None

    @property
    def situation(self) -> SafetyStatus | None:
        """The faults that there are now; None in a state that counts as safe."""
        state, answers = self._execution.state, self._execution.conduct.answers
        if self._looked_at[0] is not state or self._looked_at[1] is not answers:
            self._looked_at = state, answers
            key = (self._key(state), frozenset(answers))
            if key != self._seen[0]:
                self._seen = (key, None if self._execution.safe else self._look(state))
        return self._seen[1]

    @property
    def certain(self) -> bool:
        """True if the state is outside whatever the unknown values are."""
        situation = self.situation
        return situation is not None and situation.certain

    @property
    def answer(self) -> WayBackAnswer | str | None:
        """The answer on the way back from here, or why it cannot be computed; None while it is looked for."""
        if self._answer is None or self._answer[0] != self._key(self._execution.state):
            return None
        return self._answer[1]

    def request(self, deadline: float) -> WayBackRequest | None:
        """Return what to ask the planner now; None when there is nothing to ask or it would answer the same again."""
        if not self.certain:
            return None
        key = (self._key(self._execution.state), self._execution.circumstances)
        if key == self._asked:
            return None
        self._asked = key
        return WayBackRequest(dict(self._execution.state), deadline, circumstances=self._execution.circumstances)

    def take(self, request: WayBackRequest, answer: WayBackAnswer) -> None:
        """Remember an answer."""
        self._answer = (self._key(request.state), answer)

    def unanswered(self, request: WayBackRequest, why: str, again: bool) -> None:
        """The planner could not answer. With `again` the same question is asked once more."""
        if again:
            self._asked = None
        else:
            self._answer = (self._key(request.state), why)

    def describe(self, situation: SafetyStatus) -> Message:
        """Say what is wrong, for a person to read."""
        automaton, answer = self._execution.automaton, self.answer
        if situation.violated:
            wrong = message("unsafe.violates", specifications=_named(automaton, situation.violated))
        elif isinstance(answer, WayBackAnswer) and answer.threatened:
            wrong = message("unsafe.threatened", specifications=_named(automaton, answer.threatened))
        elif isinstance(answer, WayBackAnswer):
            wrong = message("unsafe.no-rest")
        else:
            wrong = message("unsafe.either")
        return message("unsafe.now", wrong=wrong)

    def past(self, situation: SafetyStatus) -> Message:
        """Say what was wrong, once it is over."""
        named = _named(self._execution.automaton, situation.violated)
        return message("unsafe.past-violated", specifications=named) if named else message("unsafe.past")

    def touched(self, situation: SafetyStatus) -> frozenset[str]:
        """The variables that make the state what it is: of what is violated, and those that would have to change."""
        automaton = self._execution.automaton
        told = [automaton.specifications[name].forbidden for name in situation.violated]
        answer = self.answer
        if isinstance(answer, WayBackAnswer):
            told += [automaton.specifications[name].forbidden for name in answer.threatened]
        names = frozenset(name for expression in told for name in variables(expression))
        return names | {each.name for each in situation.differences}

    def way(self) -> Message:
        """Say which way leads back, for a person to read.

        Which one is best is for advice alone to say, which weighs all that people and devices can do.
        """
        answer = self.answer
        if answer is None:
            return message("way.looking")
        if isinstance(answer, str):
            return message("way.failed", why=answer)
        if answer.way is None:
            return self._no_way(answer.searched)
        return message("way.choose") if answer.way.starts else self._by_itself(answer.way)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"way_back": self.way_back_view()}

    def way_back_view(self) -> WayBackView | None:
        """The way back as it is shown; None while the state is safe."""
        situation, automaton = self.situation, self._execution.automaton
        if situation is None:
            return None

        def named(specifications: tuple[str, ...]) -> list[SpecificationView]:
            return [SpecificationView(name=name, title=automaton.specifications[name].title) for name in specifications]

        awaits = sorted({self._feeds.get(name, name) for name in situation.awaited})
        answer = self.answer if situation.certain else None
        found = answer if isinstance(answer, WayBackAnswer) else None
        way = found.way if found is not None else None
        reason = self.way() if situation.certain else self._unsure(situation.awaited)
        return WayBackView(
            violated=named(situation.violated),
            threatened=named(found.threatened) if found is not None else [],
            differences=[DifferenceView(name=d.name, now=d.now, safe=d.safe) for d in situation.differences],
            awaits=awaits,
            ticks=len(way.ticks) if way is not None else None,
            steps=_steps(automaton, way) if way is not None else [],
            breaks=named(way.breaks) if way is not None else [],
            reason=reason,
            reason_message=reason,
        )

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        situation = self.situation
        # What is only possible with values that are unknown has an alarm of its own: the topic is silent.
        if situation is not None and situation.certain:
            yield UNSAFE_STATE.cause(
                "",
                {
                    "what": self.describe(situation),
                    "what_past": self.past(situation),
                    "waiting": self._consequences.standstill(),
                    "way": self.way(),
                },
            )

    def _unsure(self, awaited: tuple[str, ...]) -> Message:
        """Say whom the station does not hear, so that it cannot tell whether it is safe."""
        automaton = self._execution.automaton
        resources = [automaton.variables[name].resource for name in awaited if name in self._feeds]
        devices = sorted({automaton.resources[name] for name in resources if name is not None})
        if devices:
            return message("unsafe.unheard", devices=devices)
        return message(
            "unsafe.unknown", variables=[sentences_of(automaton).call_variable(name) for name in sorted(awaited)]
        )

    def _no_way(self, searched: int) -> Message:
        unknown = self.situation.awaited if self.situation is not None else ()
        far = message("way.within", ticks=searched) if searched else message("way.in-time")
        blind = message("way.blind", variables=", ".join(unknown)) if unknown else ""
        return message("way.none", far=far, blind=blind, choose=message("way.choose"))

    def _by_itself(self, way: RecoveryPath) -> Message:
        automaton, state = self._execution.automaton, self._execution.state
        awaited = [
            sentences_of(automaton).tell_value(name, value)
            for name in automaton.names(Kind.MEASURED)
            if name in self._deciding and (value := way.end[name]) is not None and value != state[name]
        ]
        return message("way.itself-when", conditions=awaited) if awaited else message("way.itself")

    def _look(self, state: State) -> SafetyStatus:
        automaton, safe = self._execution.automaton, self._execution.supervisor.safe
        nearest = safe.nearest(state, self._execution.conduct.answers) or {}
        differences = [
            SafeStateDifference(name, now, nearest[name])
            for name in automaton.variables
            if name in nearest and (now := state[name]) is not None
        ]
        awaited = tuple(name for name in safe.names if state[name] is None)
        return SafetyStatus(violated(automaton, state), tuple(differences), awaited)

    def _key(self, state: State) -> tuple[Value | None, ...]:
        return tuple(state[name] for name in self._deciding)


def _named(automaton: Automaton, specifications: Iterable[str]) -> list[Item]:
    return [message("unsafe.specification", title=automaton.specifications[name].title) for name in specifications]


def _steps(automaton: Automaton, way: RecoveryPath) -> list[WayBackStepView]:
    abilities = [(tick, automaton.abilities[name]) for tick, name in way.starts]
    return [WayBackStepView(tick=tick, ability=a.name, title=a.title, resource=a.resource) for tick, a in abilities]
