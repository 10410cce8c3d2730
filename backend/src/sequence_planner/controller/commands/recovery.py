"""Commands for a station that is not as it should be: corrections, decisions on outputs, plans, tests of abilities."""

from __future__ import annotations

from collections.abc import Collection
from typing import Annotated, Literal

from pydantic import Field, StrictBool

from sequence_planner.controller.commands.command import Command, GivenValue, GivenValues, Revision, Route, Why

MOST_STARTS = 150  # of a plan that a person confirms start by start; a body holds no more
_REFUSALS = (404, 409, 422, 504)


class ValuesCommand(Command):
    """Base of what says of variables which values they have or are to have, all at once."""

    values: GivenValues
    reason: Why

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class CorrectEstimates(ValuesCommand):
    """Give estimates other values, all at once: in restart mode, or before production is started. It takes control.

    409 `stale-revision` when the state is not at this revision any more; nothing has changed then.
    """

    routes = (
        Route(
            "POST",
            "/corrections",
            "correct",
            tag="corrections",
            body="CorrectionBody",
            body_text="The values, the revision of the state that the person saw, and why.",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["correct-estimates"] = "correct-estimates"
    for_control = True
    revision: Revision

    @property
    def for_two(self) -> Collection[str]:
        """The variables."""
        return self.values


class UndoCorrection(Command):
    """Take the last correction back, as long as its variables have the values that it gave them. It takes control.

    409 `stale-revision` when they have others, or when the last correction was made on another revision.
    """

    routes = (
        Route(
            "POST",
            "/corrections/undo",
            "undo_correction",
            tag="corrections",
            body="UndoBody",
            body_text="The revision on which the correction was made that is to be taken back, and why.",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["undo-correction"] = "undo-correction"
    for_control = True
    reason: Why
    revision: Revision


class ConfirmEstimates(ValuesCommand):
    """Say that these estimates are as the station believes; 409 `stale-revision` when one is another by now."""

    routes = (
        Route(
            "POST",
            "/corrections/confirm",
            "confirm_correction",
            tag="corrections",
            body="DecisionBody",
            body_text="Variables with their values, and why.",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["confirm-estimates"] = "confirm-estimates"


class DecideOutputs(ValuesCommand):
    """Decide on outputs that came back from the journal and would move devices; before production. It takes control."""

    routes = (
        Route(
            "PUT",
            "/restored-outputs",
            "confirm_restored_outputs",
            tag="corrections",
            body="DecisionBody",
            body_text="Variables with their values, and why.",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["decide-outputs"] = "decide-outputs"
    for_control = True

    @property
    def for_two(self) -> Collection[str]:
        """The variables."""
        return self.values


class ExecuteOperatorPlan(Command):
    """Make the corrections of an offer and have its plan carried out, and nothing else. It takes control.

    409 `proposal-gone` and `stale-revision` ask to look again; `not-confirmed`: starts and corrections are not those
    of the offer.
    """

    routes = (
        Route(
            "POST",
            "/operator-plans",
            "execute_operator_plan",
            tag="recovery",
            body="OperatorPlanBody",
            body_text="The offer, and all that it contains as the person has seen it: the starts in order, and the "
            "corrections.",
            refusals=(409, 422, 504),
        ),
    )
    kind: Literal["take-errand"] = "take-errand"
    for_control = True
    about = "offer {offer}"
    reason: Why
    offer: Annotated[str, Field(min_length=1, max_length=100)]
    starts: Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=MOST_STARTS)]
    corrections: dict[str, GivenValue] = Field(default_factory=dict, max_length=200)

    @property
    def for_two(self) -> Collection[str]:
        """The variables that it corrects."""
        return self.corrections


class TryAbility(Command):
    """Start the ability alone, at once; `POST /operator-plans/stop` ends that. It takes control, and the paused mode.

    409 `not-startable` says what its guards or the supervisor lack; `real-devices`: they have not been confirmed.
    """

    routes = (
        Route(
            "POST",
            "/test-runs",
            "start_test_run",
            tag="abilities",
            body="TrialBody",
            body_text="`real_devices` confirms that devices may move which are not emulated ones.",
            role="engineer",
            refusals=_REFUSALS,
        ),
    )
    kind: Literal["try-ability"] = "try-ability"
    for_control = True
    about = "{ability}"
    ability: Annotated[str, Field(min_length=1, max_length=400)]
    real_devices: StrictBool = False


class StopOperatorPlan(Command):
    """Start no more of what is carried out; what runs goes on to its end. Anybody who may act can do it.

    200 says that it was done and the journal does not have it yet.
    """

    routes = (
        Route(
            "POST",
            "/operator-plans/stop",
            "stop_operator_plan",
            tag="recovery",
            body="StopBody",
            body_text="To stop is all that there is to say, but perhaps why.",
        ),
    )
    kind: Literal["stop-errand"] = "stop-errand"

    @property
    def harmless(self) -> bool:
        """It only ends starts."""
        return True
