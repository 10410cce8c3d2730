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
    lacking_text,
    of_ability,
    of_station,
    right_moment,
)
from sequence_planner.controller.views.details import WhyNotView
from sequence_planner.controller.views.jobs import why_idle
from sequence_planner.controller.views.wording import diagnosis_view, plan_preview, read_predicate
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import Expression, Not, conjuncts
from sequence_planner.planning.recovery.request import ErrandRequest


class WhyNot:
    """Answers about `execution`. Used from one event loop."""

    def __init__(self, execution: Executor, surroundings: ConditionContext, adviser: AdvisorClient) -> None:
        self._execution = execution
        self._around = surroundings
        self._adviser = adviser
        self._involving = Involving(execution, surroundings)

    @answers(AskAbilityBlockers)
    def ability(self, query: AskAbilityBlockers) -> WhyNotView:
        """Return what is in the way of an ability. Raises `CommandRefused` for one that the station does not have."""
        execution, name = self._execution, query.name
        ability = execution.automaton.abilities.get(name)
        if ability is None:
            raise _unknown("ability", name)
        if name in execution.running():
            return self._view("ability", name, ability.title, "It runs.", [])
        guard = self._around.guards().get(name)
        found = [*of_station(execution), *of_ability(execution, ability, self._around.feeds, guard)]
        if not found:
            found = list(self._unplanned(name))
        if not found:
            summary = "Nothing is in the way: it starts in the next tick."
        elif found[0].kind is HindranceKind.PLAN:
            summary = "It may start, and the plan does not have it now."
        else:
            summary = _summary(found)
        return self._view("ability", name, ability.title, summary, found)

    def _unplanned(self, name: str) -> Iterable[BlockingCondition]:
        """Return why an ability that may start does not."""
        order = self._execution.plan.order.names
        if name not in order:
            reason = self._execution.plan.reason
            yield BlockingCondition(HindranceKind.PLAN, f"a plan that has it{f' ({reason})' if reason else ''}")
        elif order[0] != name:
            titles = [self._execution.automaton.abilities[each].title for each in order[: order.index(name)]]
            yield BlockingCondition(
                HindranceKind.PLAN, f"its turn in the plan, after {', '.join(dict.fromkeys(titles))}"
            )
        elif not self._execution.may_go_on(name):
            yield BlockingCondition(HindranceKind.PLAN, right_moment(self._execution))

    @answers(AskOperationBlockers)
    def operation(self, query: AskOperationBlockers) -> WhyNotView:
        """Return what is in the way of an operation. Raises `CommandRefused` for one that the station does not have."""
        execution, name = self._execution, query.name
        operation = execution.automaton.operations.get(name)
        if operation is None:
            raise _unknown("operation", name)
        if name in execution.active:
            lacking = list(self._lacking(operation.goal))
            view = self._view("operation", name, operation.title, self._progress(operation), lacking)
            diagnosis = execution.plan.diagnosis
            if diagnosis is None:
                return view
            reasons = diagnosis_view(diagnosis, self._unused, execution.conduct.answers)
            return view.model_copy(update={"reasons": reasons})
        lacking = list(self._inactive(operation))
        undone = {each.expression for each in lacking}
        lacking += [each for each in self._lacking(operation.precondition) if each.expression not in undone]
        summary = f"It is not active. {_summary(lacking)}" if lacking else "It becomes active in the next tick."
        return self._view("operation", name, operation.title, summary, lacking)

    def _inactive(self, operation: Operation) -> Iterable[BlockingCondition]:
        """Return why it is not active, beside its precondition."""
        execution = self._execution
        if operation.name in execution.conduct.out_of(ServiceKind.OPERATION):
            yield BlockingCondition(HindranceKind.SERVICE, f"{operation.title} to be put back in service")
        if (idle := why_idle(execution, operation.name)) is not None:
            yield BlockingCondition(HindranceKind.ORDER, idle)  # a job lets it be active once more, if it was done
        elif operation.name in execution.conduct.done:
            text = "a reset: it is completed, and does not become active again by itself"
            yield BlockingCondition(HindranceKind.SERVICE, text)
        if evaluate(operation.goal, execution.state) is True:
            undone = Not(operation.goal)
            yield BlockingCondition(HindranceKind.WRITTEN, f"{print_expression(undone)}: its goal holds", undone)

    def _progress(self, operation: Operation) -> str:
        """Say how far an active operation is."""
        execution, name = self._execution, operation.name
        if execution.operator_plan is not None:
            return f"It waits: {execution.operator_plan.title} is being carried out."
        if execution.mode is Mode.RESTART:
            return "It waits: the station is in restart mode."
        if name in execution.pursued.violated:
            return "It cannot be completed any more as its local specification asks: it has to be reset."
        answer = execution.plan.answer
        if answer is not None and name in answer.left_out:
            return "It is left out of the plan, for it could not be planned together with the others."
        if name in execution.plan.order.goals:
            return "It is active, and the plan leads to its goal."
        return f"It is active and has no plan. {execution.plan.reason}".strip()

    @property
    def _unused(self) -> frozenset[str]:
        """The resources that are out of service."""
        return self._execution.conduct.out_of(ServiceKind.RESOURCE)

    @answers(AskGoalBlockers)
    async def goal(self, query: AskGoalBlockers) -> WhyNotView:
        """Return what is in the way of a predicate. Raises `CommandRefused` for one that cannot be read."""
        execution, text = self._execution, query.predicate
        goal = read_predicate(execution.automaton, text)
        lacking = list(self._lacking(goal))
        if not lacking:
            return self._view("goal", text, print_expression(goal), "It holds.", [])
        view = self._view("goal", text, print_expression(goal), _summary(lacking), lacking)
        request = ErrandRequest(
            state=execution.state,
            goals=(),
            target=goal,
            circumstances=replace(execution.circumstances, restart=execution.mode is Mode.RESTART),
            deadline=AIMED_WITHIN,
        )
        try:
            aimed = await aim(self._adviser, request)
        except CommandRefused as refused:
            return _more(view, f"Whether it can be reached is not known: {refused.detail}")
        if aimed.offer is not None and aimed.offer.errand is not None:
            plan = plan_preview(execution.automaton, aimed.offer.errand)
            return _more(view, f"The station could reach it with {_count(len(plan.steps), 'start')}.", plan=plan)
        if aimed.proven:
            answers = execution.conduct.answers
            found = None if aimed.why_not is None else diagnosis_view(aimed.why_not, self._unused, answers)
            return _more(view, "The station cannot reach it from here: that is proven.", reasons=found)
        return _more(view, "No plan to it was found; that there is none is not proven.")

    def _lacking(self, condition: Expression) -> Iterable[BlockingCondition]:
        """The parts of a condition that do not hold."""
        for part in conjuncts(condition):
            truth = evaluate(part, self._execution.state)
            if truth is not True:
                text = lacking_text(self._execution, part, truth is None, self._around.feeds)
                yield BlockingCondition(HindranceKind.WRITTEN, text, part)

    def _view(
        self,
        of: str,
        name: str,
        title: str,
        summary: str,
        found: Iterable[BlockingCondition],
    ) -> WhyNotView:
        return WhyNotView(
            of=of,
            name=name,
            title=title,
            revision=self._execution.revision,
            summary=summary,
            conditions=[self._involving.condition(each) for each in found],
            plan=None,
            reasons=None,
        )


def _summary(found: list[BlockingCondition]) -> str:
    return f"It waits for {found[0].text}." if len(found) == 1 else f"It waits for {len(found)} things."


def _more(view: WhyNotView, text: str, **found: object) -> WhyNotView:
    return view.model_copy(update={"summary": f"{view.summary} {text}", **found})


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def _unknown(kind: str, name: str) -> CommandRefused:
    detail = f"The station has no {kind} `{name}`. Look at what it has."
    return CommandRefused(f"unknown-{kind}", f"There is no such {kind}", detail, 404)
