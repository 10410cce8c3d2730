"""The conditions of an ability, an operation or a goal as trees, down to the variables that decide them."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.automaton import Ability, Operation
from sequence_planner.automaton.lifting.condition_tree import ConditionTree, condition_tree
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.recovery.explain import Involving
from sequence_planner.controller.views.details import ReadValueView, ReasonTreeView, ReasonView
from sequence_planner.controller.views.station import SpecificationView
from sequence_planner.execution.executor import Executor
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import TRUE, Expression, Not, variables
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.texts.message import message


class Reasons:
    """Shows conditions on `execution`; `involving` knows who could change a variable."""

    def __init__(self, execution: Executor, involving: Involving) -> None:
        self._execution = execution
        self._involving = involving

    def of_ability(self, ability: Ability, guard: SupervisorGuard | None) -> Iterator[ReasonTreeView]:
        """Yield the conditions of its start, with what the supervisor adds; of one that runs, that of its end."""
        if ability.name in self._execution.running():
            if ability.finish_guard is not None:
                yield self._tree("finish", ability.finish_guard)
            return
        if ability.enabled != TRUE:
            yield self._tree("enabled", ability.enabled)
        if ability.start_guard != TRUE:
            yield self._tree("start", ability.start_guard)
        plan = self._execution.operator_plan
        if guard is not None and guard.expression is not None and not (plan is not None and plan.unsupervised):
            yield self._tree("supervisor", guard.expression, guard=guard)

    def of_operation(self, operation: Operation) -> Iterator[ReasonTreeView]:
        """Yield the goal of an active operation; of another one what it begins with."""
        if operation.name in self._execution.active:
            yield self._tree("goal", operation.goal)
            return
        if evaluate(operation.goal, self._execution.state) is True:
            yield self._tree("undone", operation.goal, wanted=False)
        written = operation.precondition if operation.written is None else operation.written
        if written != TRUE:
            yield self._tree("precondition", written)
        for name, turn in operation.turns.items():
            yield self._tree("turn", turn.condition, sequence=name)

    def of_predicate(self, condition: Expression) -> Iterator[ReasonTreeView]:
        """Yield the condition itself."""
        yield self._tree("predicate", condition)

    def _tree(
        self,
        about: str,
        condition: Expression,
        *,
        wanted: bool = True,
        guard: SupervisorGuard | None = None,
        sequence: str | None = None,
    ) -> ReasonTreeView:
        automaton = self._execution.automaton
        tree = condition_tree(automaton, condition, self._execution.state, wanted=wanted)
        specifications = [] if guard is None else [automaton.specifications[name] for name in guard.specifications]
        return ReasonTreeView.model_validate(
            {
                "about": about,
                "specifications": [SpecificationView(name=each.name, title=each.title) for each in specifications],
                "rest": guard is not None and guard.rest,
                "sequence": sequence,
                "tree": self._shown(tree, is_open=tree.holds is not wanted),
            }
        )

    def _shown(self, tree: ConditionTree, *, is_open: bool) -> ReasonView:
        """A part. Who could change it is told of leaves that decide, as long as the whole `is_open`."""
        condition, state, words = tree.condition, self._execution.state, sentences_of(self._execution.automaton)
        is_leaf = not tree.parts
        missing = condition if tree.wanted else Not(condition)
        return ReasonView(
            kind=tree.kind.value,
            text=tree.text,
            sentence=message("sentence.so", condition=words.tell_so([condition], tree.text)),
            predicate=tree.predicate,
            holds=tree.holds,
            decides=tree.decides,
            wanted=tree.wanted,
            reads=[self._read(name) for name in dict.fromkeys(variables(condition))] if is_leaf else [],
            involved=self._involving.among(missing)
            if is_leaf and is_open and tree.decides and evaluate(missing, state) is not True
            else [],
            parts=[self._shown(part, is_open=is_open) for part in tree.parts],
        )

    def _read(self, name: str) -> ReadValueView:
        declared = self._execution.automaton.variables.get(name)
        kind = "flag" if declared is None else str(declared.kind)
        return ReadValueView(name=name, kind=kind, value=self._execution.state[name])
