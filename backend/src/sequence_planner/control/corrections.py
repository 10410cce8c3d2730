"""Corrections of what is believed, and what a person decides about outputs that came back.

A correction writes estimates and nothing else. It is shown with all that follows before it is made, is refused when the
state has moved since, and can be taken back in one step.
"""

from __future__ import annotations

from collections.abc import Mapping

from sequence_planner.automaton.structure import Kind
from sequence_planner.control.belief import Beliefs
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.correction_preview import PlansOnRequest, Previewing
from sequence_planner.control.correction_view import CorrectionPreview
from sequence_planner.control.doubting import Doubting
from sequence_planner.control.execution import Execution
from sequence_planner.control.heard import Heard
from sequence_planner.control.moment import Moment
from sequence_planner.control.offer_refusals import correcting_refused
from sequence_planner.control.outside import leaves
from sequence_planner.control.restart_commands import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    GivenValue,
    UndoCorrection,
)
from sequence_planner.control.restart_view import LastCorrectionView
from sequence_planner.control.vocabulary import Production
from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import Value, contains

CorrectionCommand = CorrectEstimates | UndoCorrection | ConfirmEstimates | DecideOutputs


class Corrections:
    """Takes corrections of the estimates of `execution`."""

    def __init__(self, execution: Execution, adviser: PlansOnRequest, beliefs: Beliefs, doubting: Doubting) -> None:
        self._execution = execution
        self._doubting = doubting
        self._previewing = Previewing(execution, adviser, beliefs, doubting)
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

    async def preview(self, values: Mapping[str, GivenValue]) -> CorrectionPreview:
        """What the correction would bring about. Raises `CommandRefused`."""
        obstacle = correcting_refused(self._execution)
        return await self._previewing.preview(self._estimates(values), None if obstacle is None else obstacle.detail)

    def carry_out(self, command: CorrectionCommand, moment: Moment) -> None:
        """Do what is asked for. Raises `CommandRefused`; nothing has changed then."""
        match command:
            case CorrectEstimates():
                self._correct(command, moment)
            case UndoCorrection():
                self._undo(command, moment)
            case ConfirmEstimates():
                self._confirm(command, moment)
            case DecideOutputs():
                self._decide(command, moment)

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

    def _correct(self, command: CorrectEstimates, moment: Moment) -> None:
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

    def _undo(self, command: UndoCorrection, moment: Moment) -> None:
        last = self._last
        if last is None:
            raise CommandRefused(
                "nothing-to-undo",
                "There is nothing to undo",
                "There is no correction that could be taken back: correct what is not true once more.",
            )
        self._require_allowed()
        if command.revision != last.revision:
            detail = f"The last correction is another one by now, made by {last.by}. Look at it, then decide."
            raise CommandRefused("state-moved", "The state has moved", detail)
        if not self._stayed:
            detail = "Something that was corrected has got another value since. Look at the state and correct that."
            raise CommandRefused("state-moved", "The state has moved", detail)
        # Who takes it back has seen nothing: what counts is what was said before, unless work has gone on since.
        said = self._answered_before & self._execution.conduct.answers.keys()
        taken_back = frozenset(last.before) - said
        self._execution.correct(last.before, command.actor.name, command.reason, moment, taken_back)
        self._last = None

    def _confirm(self, command: ConfirmEstimates, moment: Moment) -> None:
        values = self._estimates(command.values)
        if not self._is_so(values):
            raise _moved()
        self._execution.confirm(frozenset(values), command.actor.name, moment)

    def _decide(self, command: DecideOutputs, moment: Moment) -> None:
        values = self._decidable(command)
        self._execution.correct(values, command.actor.name, command.reason, moment)

    def _decidable(self, command: DecideOutputs) -> dict[str, Value]:
        execution = self._execution
        values = self._checked(command.values, Kind.OUTPUT)
        if execution.production is Production.STARTED:
            detail = "Production has been started, so outputs are what abilities write. An engineer can force one."
            raise CommandRefused("production-started", "Production is started", detail)
        if decided := sorted(values.keys() - execution.conduct.returned):
            detail = f"Nobody has to decide on {' and '.join(decided)}."
            raise CommandRefused("nothing-to-decide", "There is nothing to decide", detail)
        if leaves(execution.supervisor.safe, execution.state, execution.corrected(values)):
            detail = (
                "With these values the station would be outside its safe states. Choose others, or several at once."
            )
            raise CommandRefused("output-unsafe", "That is not safe", detail)
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
                detail = f"The station has no variable `{name}`{suggestion(name, known) or '.'}"
                raise CommandRefused("unknown-variable", "There is no such variable", detail, 404)
            if variable.kind is not kind:
                raise _other_kind(name, variable.kind, kind)
            if not contains(variable.type, value):
                detail = f"`{name}` is one of {variable.type}, and {print_value(value)} is none of these."
                raise CommandRefused("not-in-domain", "No such value", detail, 422)
        return dict(values)


def _other_kind(name: str, is_: Kind, wanted: Kind) -> CommandRefused:
    if wanted is Kind.ESTIMATED:
        detail = f"`{name}` is {is_}; only what is estimated can be corrected, as nothing else says what it is."
        return CommandRefused("not-estimated", "It is not estimated", detail, 422)
    return CommandRefused("not-an-output", "It is no output", f"`{name}` is {is_}, and no output.", 422)


def _moved() -> CommandRefused:
    detail = "Something has changed at the station since this was looked at. Look at it again, then decide."
    return CommandRefused("state-moved", "The state has moved", detail)
