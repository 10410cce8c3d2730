"""Why an offer cannot be made, or not be taken."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from sequence_planner.control.aims import GOAL, Aimed
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.errand import Errand
from sequence_planner.control.execution import Execution
from sequence_planner.control.offer_showing import diagnosis_view, needs_restart
from sequence_planner.control.restart_commands import TakeErrand
from sequence_planner.control.vocabulary import Mode, Production
from sequence_planner.expressions.types import Value
from sequence_planner.planning.advice.offer import Offer


def refusal_of(offer: Offer, execution: Execution) -> CommandRefused | None:
    """Why an offer for the present state cannot be taken now; None when it can."""
    if execution.errand is not None:
        return errand_under_way(execution.errand)
    if offer.physical or offer.online or offer.in_service:
        detail = "Something has to be done at the station first. Do that, then ask again."
        return CommandRefused("physical-first", "Something has to be done first", detail)
    if offer.errand is None:
        if offer.corrections:
            return correcting_refused(execution)
        detail = "Nothing has to be carried out. Leave restart mode if the station is in it, and go on."
        return CommandRefused("nothing-to-take", "There is nothing to take", detail)
    if execution.production is not Production.STARTED:
        detail = "Production has not been started, so nothing can be. Start production, then ask again."
        return CommandRefused("production-waiting", "Production waits", detail)
    return _wrong_mode(offer, execution.mode)


def correcting_refused(execution: Execution) -> CommandRefused | None:
    """Why no correction can be made now; None when one can."""
    if execution.errand is not None:
        return errand_under_way(execution.errand)
    if execution.mode is not Mode.RESTART and execution.production is Production.STARTED:
        detail = "Corrections are made in restart mode, or before production is started. Enter restart mode first."
        return CommandRefused("not-in-restart", "The mode is another one", detail)
    return None


def _wrong_mode(offer: Offer, mode: Mode) -> CommandRefused | None:
    if mode is Mode.RESTART or (mode is Mode.PAUSED and not needs_restart(offer)):
        return None
    if needs_restart(offer):
        detail = f"The mode is {mode}, and this takes restart mode. Enter it, then ask again."
    else:
        detail = f"The mode is {mode}, and this takes the paused mode, or restart. Pause, then ask again."
    return CommandRefused("wrong-mode", "The mode is another one", detail)


def require_confirmation(offer: Offer, command: TakeErrand) -> None:
    """Raises `CommandRefused` unless the command repeats what the offer contains."""
    starts = [] if offer.errand is None else [name for _, name in offer.errand.starts]
    corrections = {change.name: change.new for change in offer.corrections}
    if command.starts != starts or not _same(command.corrections, corrections):
        detail = "What was confirmed is not what the offer contains. Look at the offer again, then confirm that."
        raise CommandRefused("not-confirmed", "Something else was confirmed", detail)


def _same(one: Mapping[str, Value], other: Mapping[str, Value]) -> bool:
    """Whether they are equal, where true is not 1."""
    return one == other and all(type(one[name]) is type(other[name]) for name in one)


def errand_under_way(errand: Errand) -> CommandRefused:
    """Nothing is offered beside an errand: the state moves with it."""
    detail = f"{errand.title} is being carried out. Wait for its end, or stop it."
    return CommandRefused("errand-under-way", "Something else is being carried out", detail)


def no_plan(aimed: Aimed, out_of_service: Collection[str]) -> CommandRefused:
    """Nothing can be offered; the reasons as far as they are known. Resources can be `out_of_service`."""
    members = [] if aimed.why_not is None else diagnosis_view(aimed.why_not, out_of_service).members
    because = "; ".join(member for member in members if member != f"the goal {GOAL}")
    if because:
        detail = f"There is no plan as long as all of this is so: {because}."
    elif aimed.proven:
        detail = "There is no plan at all from the present state: that is proven."
    else:
        detail = "No plan was found in the time there is; that there is none is not proven. Try again."
    return CommandRefused("no-plan", "There is no plan", detail)
