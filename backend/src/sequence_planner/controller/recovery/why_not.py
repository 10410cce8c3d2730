"""Answers to the question why not: what is in the way of an ability, an operation or a goal, and who could change it.

Nothing is computed before somebody asks. All of it but plans is found on the controller's own loop, in a moment.
"""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.automaton import Operation
from sequence_planner.controller.commands.command import CommandRefused, answers
from sequence_planner.controller.commands.queries import AskAbilityBlockers, AskGoalBlockers, AskOperationBlockers
from sequence_planner.controller.planner_client import AIMED_WITHIN, AdvisorClient, aim
from sequence_planner.controller.recovery.explain import (
    BlockingCondition,
    ConditionContext,
    HindranceKind,
    Involving,
    goal_holds,
    in_words,
    lacking,
    of_ability,
    of_station,
    out_of_turn,
    right_moment,
)
from sequence_planner.controller.tracing.reasons import Reasons
from sequence_planner.controller.views.details import ReasonTreeView, WhyNotView
from sequence_planner.controller.views.jobs import why_idle
from sequence_planner.controller.views.wording import diagnosis_view, plan_preview, read_predicate, title_text
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.recovery.request import GoalPlanRequest
from sequence_planner.texts.message import Message, all_titles, message


class WhyNot:
    """Answers about `execution`. Used from one event loop."""

    def __init__(self, execution: Executor, surroundings: ConditionContext, advisor: AdvisorClient) -> None:
        self._execution = execution
        self._around = surroundings
        self._advisor = advisor
        self._involving = Involving(execution, surroundings)
        self._reasons = Reasons(execution, self._involving)

    @answers(AskAbilityBlockers)
    def ability(self, query: AskAbilityBlockers) -> WhyNotView:
        """Return what is in the way of an ability. Raises `CommandRefused` for one that the station does not have."""
        execution, name = self._execution, query.name
        ability = execution.automaton.abilities.get(name)
        if ability is None:
            raise _unknown("ability", name)
        if name in execution.running():
            trees = self._reasons.of_ability(ability, None)
            return self._view("ability", name, ability.title, message("blocked.runs"), [], trees)
        guard = self._around.guards().get(name)
        found = [*of_station(execution), *of_ability(execution, ability, self._around.feeds, guard)]
        if not found:
            found = list(self._unplanned(name))
        if not found:
            summary = message("blocked.nothing")
        elif found[0].kind is HindranceKind.PLAN:
            summary = message("blocked.not-planned")
        else:
            summary = _summary(found)
        return self._view("ability", name, ability.title, summary, found, self._reasons.of_ability(ability, guard))

    def _unplanned(self, name: str) -> Iterable[BlockingCondition]:
        """Return why an ability that may start does not."""
        order = self._execution.plan.order.names
        if name not in order:
            reason = self._execution.plan.reason
            why = message("waits.in-plan-why", reason=reason) if reason else message("waits.in-plan")
            yield BlockingCondition(HindranceKind.PLAN, why)
        elif order[0] != name:
            titles = [self._execution.automaton.abilities[each].title for each in order[: order.index(name)]]
            turn = message("waits.turn", abilities=all_titles(dict.fromkeys(titles)))
            yield BlockingCondition(HindranceKind.PLAN, turn)
        elif not self._execution.may_go_on(name):
            yield BlockingCondition(HindranceKind.PLAN, right_moment(self._execution))

    @answers(AskOperationBlockers)
    def operation(self, query: AskOperationBlockers) -> WhyNotView:
        """Return what is in the way of an operation. Raises `CommandRefused` for one that the station does not have."""
        execution, name = self._execution, query.name
        operation = execution.automaton.operations.get(name)
        if operation is None:
            raise _unknown("operation", name)
        trees = self._reasons.of_operation(operation)
        if name in execution.active:
            unreached = self._lacking(operation.goal)
            view = self._view("operation", name, operation.title, self._progress(operation), unreached, trees)
            diagnosis = execution.plan.diagnosis
            if diagnosis is None:
                return view
            reasons = diagnosis_view(execution.automaton, diagnosis, self._unused, execution.conduct.answers)
            return view.model_copy(update={"reasons": reasons})
        found = list(self._inactive(operation))
        undone = {each.expression for each in found}
        written = operation.precondition if operation.written is None else operation.written
        found += [each for each in self._lacking(written) if each.expression not in undone]
        found += out_of_turn(execution, operation)
        if evaluate(operation.goal, execution.state) is True:
            summary = message("blocked.done")
        elif found:
            summary = message("blocked.inactive", why=_summary(found))
        else:
            summary = message("blocked.next-tick")
        return self._view("operation", name, operation.title, summary, found, trees)

    def _inactive(self, operation: Operation) -> Iterable[BlockingCondition]:
        """Return why it is not active, beside its precondition."""
        execution = self._execution
        if operation.name in execution.conduct.out_of(ServiceKind.OPERATION):
            yield BlockingCondition(HindranceKind.SERVICE, message("waits.service", title=operation.title))
        if (idle := why_idle(execution, operation.name)) is not None:
            yield BlockingCondition(HindranceKind.ORDER, idle)  # a job lets it be active once more, if it was done
        elif operation.name in execution.conduct.done:
            yield BlockingCondition(HindranceKind.SERVICE, message("waits.reset"))
        if evaluate(operation.goal, execution.state) is True:
            yield goal_holds(execution, operation.goal)

    def _progress(self, operation: Operation) -> Message:
        """Say how far an active operation is."""
        execution, name = self._execution, operation.name
        if execution.operator_plan is not None:
            return message("blocked.operator-plan", title=title_text(execution.operator_plan.title))
        if execution.mode is Mode.RESTART:
            return message("blocked.restart")
        if name in execution.pursued.violated:
            return message("blocked.violated")
        answer = execution.plan.answer
        if answer is not None and name in answer.left_out:
            return message("blocked.left-out")
        if name in execution.plan.order.goals:
            return message("blocked.planned")
        return message("blocked.no-plan", reason=execution.plan.reason)

    @property
    def _unused(self) -> frozenset[str]:
        """The resources that are out of service."""
        return self._execution.conduct.out_of(ServiceKind.RESOURCE)

    @answers(AskGoalBlockers)
    async def goal(self, query: AskGoalBlockers) -> WhyNotView:
        """Return what is in the way of a predicate. Raises `CommandRefused` for one that cannot be read."""
        execution, text = self._execution, query.predicate
        goal = read_predicate(execution.automaton, text)
        blocking, title = list(self._lacking(goal)), in_words(execution, goal)
        if not blocking:
            return self._view("goal", text, title, message("blocked.holds"), [], self._reasons.of_predicate(goal))
        view = self._view("goal", text, title, _summary(blocking), blocking, self._reasons.of_predicate(goal))
        request = GoalPlanRequest(
            state=execution.state,
            goals=(),
            target=goal,
            circumstances=replace(execution.circumstances, restart=execution.mode is Mode.RESTART),
            deadline=AIMED_WITHIN,
        )
        try:
            aimed = await aim(self._advisor, request)
        except CommandRefused as refused:
            return _more(view, message("blocked.unknown", why=refused.detail))
        if aimed.offer is not None and aimed.offer.operator_plan is not None:
            plan = plan_preview(execution.automaton, aimed.offer.operator_plan, aimed.offer.start)
            return _more(view, message("blocked.reached", starts=len(plan.steps)), plan=plan)
        if aimed.proven:
            answers = execution.conduct.answers
            found = (
                None
                if aimed.why_not is None
                else diagnosis_view(execution.automaton, aimed.why_not, self._unused, answers)
            )
            return _more(view, message("blocked.proven"), reasons=found)
        return _more(view, message("blocked.not-found"))

    def _lacking(self, condition: Expression) -> Iterable[BlockingCondition]:
        """The parts of a condition that do not hold."""
        return lacking(self._execution, condition, self._around.feeds)

    def _view(
        self,
        of: str,
        name: str,
        title: str,
        summary: Message,
        found: Iterable[BlockingCondition],
        trees: Iterable[ReasonTreeView],
    ) -> WhyNotView:
        return WhyNotView(
            of=of,
            name=name,
            title=title,
            revision=self._execution.revision,
            summary=summary,
            summary_message=summary,
            conditions=[self._involving.condition(each) for each in found],
            trees=list(trees),
            plan=None,
            reasons=None,
        )


def _summary(found: list[BlockingCondition]) -> Message:
    if len(found) == 1:
        return message("blocked.one", what=found[0].text)
    return message("blocked.several", count=len(found))


def _more(view: WhyNotView, text: Message, **found: object) -> WhyNotView:
    summary = message("sentences", first=view.summary_message, second=text)
    return view.model_copy(update={"summary": str(summary), "summary_message": summary, **found})


def _unknown(kind: str, name: str) -> CommandRefused:
    return CommandRefused(f"unknown-{kind}", message(f"refused.unknown-{kind}.those", name=name), 404)
