"""Corrections of estimates: preview of their consequences, execution, and decisions on restored outputs."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Iterator, Mapping

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.dependencies import looked_at, read_variables
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.tick import record_activity, supervised_start, update_operations
from sequence_planner.controller.commands.command import CommandRefused, GivenValue, answers, handles
from sequence_planner.controller.commands.queries import AskCorrection
from sequence_planner.controller.commands.recovery import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    UndoCorrection,
)
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.explain import TellsBelief
from sequence_planner.controller.recovery.safe_state import leaves
from sequence_planner.controller.views.details import CorrectedView, CorrectionPreview
from sequence_planner.controller.views.station import LastCorrectionView, SpecificationView
from sequence_planner.controller.views.wording import correcting_refused, hint_of, plan_preview
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.events import Heard
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.problem import Contract, Goal, PlanAnswer, PlanRequest, Verdict, goal_of
from sequence_planner.planning.recovery_path import violated
from sequence_planner.texts.message import Message, message

# What follows from a correction, found out without making it.

PLANNED_WITHIN = 1.5  # seconds
WAITING = 2.0  # seconds beyond that: the advisor may be at something else
MOST_RELATED = 12

_WHY_NONE = {
    Verdict.NONE_UP_TO: message("preview.none-up-to"),
    Verdict.NONE_AT_ALL: message("preview.none-at-all"),
    Verdict.LATE: message("preview.late"),
}


def _specification(automaton: Automaton, name: str) -> SpecificationView:
    return SpecificationView(name=name, title=automaton.specifications[name].title)


# Corrections of what is believed, and what a person decides about outputs that came back.
#
# A correction writes estimates and nothing else. It is shown with all that follows before it is made, is refused when
# the state has moved since, and can be taken back in one step.


class Corrections:
    """Takes corrections of the estimates of `execution`; `require_one` refuses what a second person has to approve."""

    def __init__(
        self,
        execution: Executor,
        plan: Callable[[PlanRequest, float], Awaitable[PlanAnswer]],
        beliefs: TellsBelief,
        doubting: ConsistencyMonitor,
        require_one: Callable[[Iterable[str]], None],
    ) -> None:
        self._execution = execution
        self._require_one = require_one
        self._doubting = doubting
        self._plan, self._beliefs = plan, beliefs
        self._last: LastCorrectionView | None = None
        self._stayed = False  # what was corrected is so ever since
        self._answered_before = frozenset[str]()  # what somebody had said of these before the last correction
        execution.listeners.append(self._hear)

    @property
    def last(self) -> LastCorrectionView | None:
        """The last correction; None if there was none, or it was taken back."""
        if self._last is None:
            return None
        return self._last.model_copy(update={"undoable": self._stayed and correcting_refused(self._execution) is None})

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"last_correction": self.last}

    @answers(AskCorrection)
    async def preview(self, query: AskCorrection) -> CorrectionPreview:
        """Return what the correction would bring about. Raises `CommandRefused`.

        Without a planner it says why there is no plan, and the rest all the same.
        """
        refusal, values = correcting_refused(self._execution), self._estimates(query.values)
        execution, automaton, revision = self._execution, self._execution.automaton, self._execution.revision
        now, then = execution.state, execution.corrected(values)
        active = update_operations(automaton, then, execution.active)
        active -= execution.conduct.idle_operations(automaton, active)
        before, after = self._startable(now), self._startable(then)
        wrong_now, wrong_then = (self._doubting.contradictions(state).because for state in (now, then))
        changes = [self._changed(name, value) for name, value in values.items()]
        gone = [text for text in wrong_now if text not in wrong_then]
        new = [text for text in wrong_then if text not in wrong_now]
        preview = CorrectionPreview(
            revision=revision,
            changes=changes,
            safe=execution.supervisor.safe.includes(then),
            safe_now=execution.safe,
            violates=[_specification(automaton, name) for name in violated(automaton, then)],
            startable=[name for name in after if name not in before],
            no_longer_startable=[name for name in before if name not in after],
            activated=sorted(active - execution.active),
            completed=sorted(execution.active - active),
            contradictions_gone=[*gone],
            contradictions_new=[*new],
            contradiction_messages=[*gone, *new],
            plan=None,
            goals=[],
            left_out=[],
            reason="",
            reason_message=None,
            obstacle=None if refusal is None else refusal.detail,
            obstacle_message=None if refusal is None else refusal.detail,
        )
        goals = self._goals(active)
        if not goals:
            return preview.model_copy(update=_why(message("preview.nothing")))
        state = record_activity(automaton, then, active)
        return preview.model_copy(update=await self._planned(state, goals))

    async def _planned(self, state: State, goals: tuple[Goal, ...]) -> dict[str, object]:
        circumstances = replace(self._execution.circumstances, restart=False)
        request = PlanRequest(
            state, goals, deadline=PLANNED_WITHIN, contract=Contract.FAST, circumstances=circumstances
        )
        try:
            answer = await self._plan(request, PLANNED_WITHIN + WAITING)
        except CommandRefused as refused:
            return _why(message("preview.refused", title=refused.title, detail=refused.detail))
        if answer.plan is None:
            return {**_why(_WHY_NONE[answer.verdict]), "left_out": list(answer.left_out)}
        preview = plan_preview(self._execution.automaton, answer.plan, state)
        return {"plan": preview, "goals": list(answer.goals), "left_out": list(answer.left_out)}

    def _goals(self, active: frozenset[str]) -> tuple[Goal, ...]:
        """Return what would be pursued: what is, as far as it has come, and what becomes active."""
        pursued, operations = self._execution.pursued.goals, self._execution.automaton.operations
        return tuple(pursued.get(name) or goal_of(operations[name]) for name in sorted(active))

    def _startable(self, state: State) -> list[str]:
        """The abilities whose guards and the supervisor would allow their start there, whatever the mode."""
        execution, automaton = self._execution, self._execution.automaton
        return [
            ability.name
            for ability in automaton.abilities.values()
            if not execution.circumstances.bars(ability)
            and supervised_start(automaton, execution.supervisor, execution.published, state, ability) is not None
        ]

    def _changed(self, name: str, value: Value) -> CorrectedView:
        now = self._execution.state[name]
        assert now is not None
        related = list(self._related(name))
        return CorrectedView(
            name=name,
            now=now,
            then=value,
            belief=self._beliefs.of(name),
            related=[written for written, _ in related],
            related_messages=[said for _, said in related],
        )

    def _related(self, name: str) -> Iterator[tuple[str, Message]]:
        """Yield what is measured that abilities look at before they write the estimate: as written, and in words."""
        automaton, state = self._execution.automaton, self._execution.state
        guards = [guard for ability in automaton.abilities.values() for guard in looked_at(ability, name)]
        read = read_variables(automaton, guards)
        for measured in [each for each in automaton.names(Kind.MEASURED) if each in read][:MOST_RELATED]:
            value, sentences = state[measured], sentences_of(automaton)
            if value is None:
                said = message("value.unknown", name=sentences.call_variable(measured))
                yield message("value.unknown", name=measured), said
            else:
                told = message("offer.so", condition=sentences.tell_value(measured, value))
                yield sentences.write_value(measured, value), told

    def check(self, command: CorrectEstimates | DecideOutputs) -> None:
        """Raises `CommandRefused` when it could not be carried out now."""
        if isinstance(command, CorrectEstimates):
            self._correctable(command)
        else:
            self._decidable(command)

    def _correctable(self, command: CorrectEstimates) -> dict[str, Value]:
        values = self._estimates(command.values)
        self._require_allowed()
        if command.revision != self._execution.revision:
            raise _moved()
        return values

    @handles(CorrectEstimates)
    def correct(self, command: CorrectEstimates, moment: Timestamp) -> None:
        """Give the estimates these values."""
        execution = self._execution
        values = self._correctable(command)
        before = {name: now for name in values if (now := execution.state[name]) is not None}
        self._answered_before = frozenset(execution.conduct.answers)
        execution.correct(values, command.actor.name, command.reason, moment)
        self._stayed = True
        self._last = LastCorrectionView(
            revision=command.revision,
            values=dict(values),
            before=before,
            by=command.actor.name,
            why=command.reason,
            at=moment.epoch,
            undoable=True,
        )

    @handles(UndoCorrection)
    def undo(self, command: UndoCorrection, moment: Timestamp) -> None:
        """Take the last correction back."""
        last = self._last
        self._require_one(() if last is None else last.values)
        if last is None:
            raise CommandRefused("nothing-to-undo", message("refused.nothing-to-undo.none"))
        self._require_allowed()
        if command.revision != last.revision:
            raise CommandRefused("stale-revision", message("refused.stale-revision.other", by=last.by))
        if not self._stayed:
            raise CommandRefused("stale-revision", message("refused.stale-revision.value"))
        # Who takes it back has seen nothing: what counts is what was said before, unless work has gone on since.
        said = self._answered_before & self._execution.conduct.answers.keys()
        taken_back = frozenset(last.before) - said
        self._execution.correct(last.before, command.actor.name, command.reason, moment, taken_back)
        self._last = None

    @handles(ConfirmEstimates)
    def confirm(self, command: ConfirmEstimates, moment: Timestamp) -> None:
        """Note that somebody has seen that the estimates are so."""
        values = self._estimates(command.values)
        if not self._is_so(values):
            raise _moved()
        self._execution.confirm(frozenset(values), command.actor.name, moment)

    @handles(DecideOutputs)
    def decide(self, command: DecideOutputs, moment: Timestamp) -> None:
        """Give the outputs these values."""
        values = self._decidable(command)
        self._execution.correct(values, command.actor.name, command.reason, moment)

    def _decidable(self, command: DecideOutputs) -> dict[str, Value]:
        execution = self._execution
        values = self._checked(command.values, Kind.OUTPUT)
        if execution.production is Production.STARTED:
            raise CommandRefused("production-started", message("refused.production-started.outputs"))
        if decided := sorted(values.keys() - execution.conduct.returned):
            raise CommandRefused("nothing-to-confirm", message("refused.nothing-to-confirm.names", names=decided))
        if leaves(execution.supervisor.safe, execution.state, execution.corrected(values)):
            raise CommandRefused("output-unsafe", message("refused.output-unsafe.outside"))
        return values

    def _hear(self, heard: Heard) -> None:
        """A value that was another one in between is not the one that was corrected, though it may be the same."""
        if self._stayed and self._last is not None:
            self._stayed = all(heard.after[name] == value for name, value in self._last.values.items())

    def _is_so(self, values: Mapping[str, Value]) -> bool:
        return all(self._execution.state[name] == value for name, value in values.items())

    def _require_allowed(self) -> None:
        if (refusal := correcting_refused(self._execution)) is not None:
            raise refusal

    def _estimates(self, values: Mapping[str, GivenValue]) -> dict[str, Value]:
        return self._checked(values, Kind.ESTIMATED)

    def _checked(self, values: Mapping[str, GivenValue], kind: Kind) -> dict[str, Value]:
        """The values, each one that its variable can have. Raises `CommandRefused`."""
        known = self._execution.automaton.variables
        for name, value in values.items():
            variable = known.get(name)
            if variable is None:
                raise CommandRefused(
                    "unknown-variable",
                    message("refused.unknown-variable.name", name=name, hint=hint_of(name, known)),
                    404,
                )
            if variable.kind is not kind:
                raise _other_kind(name, variable.kind, kind)
            if not contains(variable.type, value):
                raise CommandRefused(
                    "not-in-domain",
                    message(
                        "refused.not-in-domain.none", name=name, domain=str(variable.type), value=print_value(value)
                    ),
                    422,
                )
        return dict(values)


def _other_kind(name: str, is_: Kind, wanted: Kind) -> CommandRefused:
    if wanted is Kind.ESTIMATED:
        return CommandRefused(
            "not-estimated", message("refused.not-estimated.kind", name=name, kind=message(f"kind.{is_}")), 422
        )
    return CommandRefused(
        "not-an-output", message("refused.not-an-output.kind", name=name, kind=message(f"kind.{is_}")), 422
    )


def _moved() -> CommandRefused:
    return CommandRefused("stale-revision", message("refused.stale-revision.looked"))


def _why(reason: Message) -> dict[str, object]:
    return {"reason": str(reason), "reason_message": reason}
