"""Answers what a draft does step by step, in a process that keeps the model it has prepared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.editor.processes import encoded
from sequence_planner.editor.schemas.draft import RefusedStepView, StepsView, StepView
from sequence_planner.editor.schemas.what_if import transferred
from sequence_planner.editor.stepping.stepper import StepError, StepMoment, Stepper, StopReason, TickStep
from sequence_planner.editor.stepping.telling import StepTelling
from sequence_planner.editor.usable import KeptDraft, UnusableModelError, prepared, read_condition
from sequence_planner.process.budget import Budget

FOLLOWED_WITHIN = 20.0  # seconds

# Files that are others since the last question, none for those that are gone; its name, and what is asked.
Asked = tuple[int, Path | None, Mapping[str, ShownValue | None], Sequence[StepView], bool, str | None]
StepsQuestion = tuple[Mapping[str, str | None], str, Asked]


class StepService:
    """Answers about a draft that it keeps in `folder`."""

    def __init__(self, folder: Path) -> None:
        self._draft = KeptDraft(folder, prepared)
        self._telling: StepTelling | None = None

    def steps_view(self, question: StepsQuestion) -> StepsView:
        """Return the moments of the steps that are asked for. Raises `EditError` for a condition that is none."""
        changed, _, (number, stages, present, steps, follow, until) = question
        meant = self._draft.meant(changed, stages)
        if isinstance(meant, UnusableModelError):
            return StepsView(
                number=number,
                obstacle=meant.why,
                before={},
                moments=[],
                choices=[],
                kept_back=[],
                settable={},
                plan=None,
                refused=None,
                stopped=None,
            )
        if self._telling is None or self._telling.stepper.automaton is not meant.automaton:
            self._telling = StepTelling(Stepper(meant.automaton, meant.supervisor))
        return _told(self._telling, number, present, steps, follow=follow, until=until)


def _told(
    telling: StepTelling,
    number: int,
    present: Mapping[str, ShownValue | None],
    steps: Sequence[StepView],
    *,
    follow: bool,
    until: str | None,
) -> StepsView:
    stepper = telling.stepper
    condition = None if until is None else read_condition(stepper.automaton, until)
    state = transferred(stepper.automaton, present)
    moments, refused = [stepper.first_moment(state)], None
    for index, step in enumerate(steps):
        try:
            moments.append(_after(stepper, moments[-1], step))
        except StepError as error:
            refused = RefusedStepView(index=index, why=error.why)
            break
    stopped: StopReason | None = None
    if follow and refused is None:
        followed, stopped = stepper.follow(moments[-1], condition, Budget.seconds(FOLLOWED_WITHIN))
        moments += followed
    answer = stepper.ask_plan(moments[-1])
    return StepsView(
        number=number,
        obstacle=None,
        before={name: state[name] for name in stepper.automaton.variables},
        moments=list(telling.moments(state, moments)),
        choices=list(telling.choices(moments[-1].state, answer)),
        kept_back=list(telling.kept_back(moments[-1].state)),
        settable=telling.settable(),
        plan=telling.plan_view(answer),
        refused=refused,
        stopped=stopped,
    )


def _after(stepper: Stepper, moment: StepMoment, step: StepView) -> StepMoment:
    """Return the moment after a step of somebody, and after what then happens by itself. Raises `StepError`."""
    return stepper.come_to_rest(stepper.step_on(moment, TickStep(tuple(step.effects), tuple(step.starts), step.sets)))


def answering(folder: Path) -> Callable[[StepsQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    service = StepService(folder)
    return lambda question, _: encoded(service.steps_view(question))
