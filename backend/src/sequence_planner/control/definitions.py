"""Tells how an ability is defined, what of it holds now, and how its last trial went."""

from __future__ import annotations

from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.definition_view import AbilityDefinitionView, TrialView, TriedReactionView
from sequence_planner.control.drawing import Drawing
from sequence_planner.control.execution import Execution
from sequence_planner.control.involving import Surroundings
from sequence_planner.control.moment import Moment
from sequence_planner.control.trial_watch import Trial, TrialWatch
from sequence_planner.control.trials import Trials


class Definitions:
    """Answers about the abilities of `execution`. Used from one event loop."""

    def __init__(self, execution: Execution, surroundings: Surroundings, trials: Trials) -> None:
        self._execution = execution
        self._around = surroundings
        self._trials = trials
        self._watch = TrialWatch(execution)

    def of(self, name: str) -> AbilityDefinitionView:
        """The definition of a ground ability. Raises `CommandRefused` for one that the station does not have."""
        execution = self._execution
        ability = execution.automaton.abilities.get(name)
        if ability is None:
            detail = f"The station has no ability `{name}`. Look at those it has."
            raise CommandRefused("unknown-ability", "There is no such ability", detail, 404)
        refusal, trial = self._trials.refusal(ability), self._watch.last
        drawing = Drawing(execution.automaton, execution.state, self._around.guards(), execution.supervisor)
        return AbilityDefinitionView(
            **dict(drawing.of(ability)),
            revision=execution.revision,
            obstacle=None if refusal is None else refusal.detail,
            real_devices=list(self._trials.real_devices()),
            trial=None if trial is None or trial.ability.name != name else _trial(trial),
        )


def _trial(trial: Trial) -> TrialView:
    errand, end = trial.errand, trial.end
    return TrialView(
        by=errand.by,
        reason=errand.why,
        accepted=errand.taken.epoch,
        started=_epoch(trial.started),
        executing=_epoch(trial.executing),
        ended=None if end is None else end.ended.epoch,
        done=end is not None and end.done,
        why="" if end is None else end.why,
        reactions=[
            TriedReactionView(name=each.effect.name, due=_epoch(each.due), came=_epoch(each.came))
            for each in trial.reactions
        ],
    )


def _epoch(moment: Moment | None) -> float | None:
    return None if moment is None else moment.epoch
