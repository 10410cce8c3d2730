"""Operator plans: what a person has taken and the station carries out beside its operations, and its alarms."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from sequence_planner.controller.alarms.kinds import ERRAND, ERRAND_WAITS, Cause
from sequence_planner.controller.commands.command import handles
from sequence_planner.controller.commands.recovery import StopOperatorPlan
from sequence_planner.controller.recovery.explain import idle_since, waits_for
from sequence_planner.controller.views.execution import last_operator_plan_view, operator_plan_view
from sequence_planner.controller.views.wording import end_message, ended_text, title_text
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.texts.message import awaiting, message

START_WITHIN = 5.0  # seconds in which the next start of what was taken begins, or it is said why not
END_WITHIN = 30.0  # seconds in which it comes to its end once nothing of it is left to be started


class OperatorPlans:
    """What is carried out of `execution`'s operator plans; `feeds` names the topic behind each measured variable."""

    def __init__(self, execution: Executor, feeds: Mapping[str, str]) -> None:
        self._execution = execution
        self._feeds = feeds

    @handles(StopOperatorPlan)
    def stop_operator_plan(self, command: StopOperatorPlan, moment: Timestamp) -> None:
        """End what is carried out, if anything is."""
        if self._execution.operator_plan is not None:
            self._execution.stop_operator_plan(command.actor.name, moment)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        execution = self._execution
        last = last_operator_plan_view(execution.conduct)
        return {"errand": operator_plan_view(execution), "last_errand": last}

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        yield from self._waiting(moment.monotonic)
        yield from self._ended()

    def _waiting(self, monotonic: float) -> Iterator[Cause]:
        """Yield what a person has taken, and does not go on."""
        execution, operator_plan = self._execution, self._execution.operator_plan
        if (
            operator_plan is None
            or operator_plan.ability is not None
            or (since := idle_since(execution, operator_plan)) is None
        ):
            return
        ahead, waited = execution.plan.order.ahead, monotonic - since
        if waited <= (START_WITHIN if ahead else END_WITHIN):
            return
        if ahead:
            title = execution.automaton.abilities[ahead[0].ability].title
            known = waits_for(execution, ahead[0].ability, self._feeds)
            waits = awaiting(known or [message("errand-waits.nothing-known")])
            what = message("errand-waits.start", ability=title, seconds=START_WITHIN, waits=waits)
        else:
            inside = [message("waits.safe")] if operator_plan.into_safe else []
            goal = end_message(execution.automaton, operator_plan.goal, operator_plan.into_safe)
            what = message(
                "errand-waits.end", seconds=END_WITHIN, waits=awaiting(inside if goal is None else [*inside, goal])
            )
        yield ERRAND_WAITS.cause(
            "",
            {"what": what, "title": message("quoted", title=title_text(operator_plan.title)), "by": operator_plan.by},
        )

    def _ended(self) -> Iterator[Cause]:
        last = self._execution.conduct.last_operator_plan
        # Who has ended it knows of it; and once operations are executed again it is past.
        if last is None or last.done or last.by is not None or self._execution.operator_plan is not None:
            return
        if self._execution.mode is not Mode.AUTOMATIC:
            yield ERRAND.cause(
                str(last.ended.epoch),
                {"title": message("quoted", title=title_text(last.title)), "why": ended_text(last.why)},
            )
