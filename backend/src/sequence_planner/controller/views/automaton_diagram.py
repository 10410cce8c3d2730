"""Draws automata of abilities, and operations: how they are written, and what of that holds in a state."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Operation, State, WorkMaster, target
from sequence_planner.automaton.dependencies import reactions, read_variables
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import start, writes
from sequence_planner.controller.views.details import (
    AbilityActionView,
    AutomatonView,
    ConjunctView,
    OperationDefinitionView,
    PredicateView,
    ReactionView,
    ReadValueView,
    SupervisedView,
    TimeoutsView,
    WorkAbilityView,
    WorkMastersView,
    WorkMasterView,
    WorkOperationView,
    WrittenPlaceView,
)
from sequence_planner.controller.views.station import SpecificationView
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import Assignment, Constant, Expression, conjuncts, variables
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.texts.message import message


class Drawing:
    """Of the abilities of `automaton` in `state`, with the `guards` of a `supervisor`; None where there is none."""

    def __init__(
        self, automaton: Automaton, state: State, guards: Mapping[str, SupervisorGuard], supervisor: Supervisor | None
    ) -> None:
        self._automaton = automaton
        self._state = state
        self._guards = guards
        self._supervisor = supervisor

    def of(self, ability: Ability) -> AutomatonView:
        """The automaton of a ground ability."""
        name = ability.name
        return AutomatonView(
            name=name,
            title=ability.title,
            resource=ability.resource,
            arguments=_arguments(name),
            place=self._place(name),
            restart=ability.restart,
            task=None if ability.human is None else ability.human.text,
            acknowledgement=None if ability.human is None else ability.human.acknowledgement,
            duration=ability.duration,
            enabled=self._written(ability, "enabled", ability.enabled),
            start=self._written(ability, "start", ability.start_guard),
            start_actions=self._actions(ability.start_actions),
            supervised=self._supervised(name),
            allowed=self._allowed(ability),
            executing=self._written(ability, "executing", ability.executing),
            finished=self._written(ability, "finished", ability.finished),
            finish=None if ability.finish_guard is None else self._written(ability, "finish", ability.finish_guard),
            finish_actions=self._actions(ability.finish_actions),
            cancel_actions=self._actions(ability.cancel_actions),
            timeouts=TimeoutsView(
                react=ability.timeouts.react,
                finish=ability.timeouts.finish,
                retries=ability.timeouts.retries,
                replan=ability.timeouts.replan,
            ),
            reactions=[self._reaction(effect) for effect in reactions(self._automaton, name)],
        )

    def of_operation(self, operation: Operation, revision: int) -> OperationDefinitionView:
        """A ground operation, in a state that has this number."""
        written = operation.precondition if operation.written is None else operation.written
        place = self._place(f"operation.{operation.name}")
        return OperationDefinitionView(
            name=operation.name,
            title=operation.title,
            revision=revision,
            precondition=self._predicate(written, place),
            turns={
                name: self._predicate(turn.condition, self._place(f"operation.{name}"))
                for name, turn in operation.turns.items()
            },
            goal=self._predicate(operation.goal, place),
        )

    def _written(self, ability: Ability, part: str, predicate: Expression) -> PredicateView:
        return self._predicate(predicate, self._place(f"{ability.name}.{part}"))

    def _predicate(self, predicate: Expression, place: WrittenPlaceView | None) -> PredicateView:
        state = self._state
        return PredicateView(
            text=print_expression(predicate),
            holds=_truth(evaluate(predicate, state)),
            parts=[
                ConjunctView(
                    text=(written := print_expression(part)),
                    sentence=message("sentence.so", condition=sentences_of(self._automaton).tell_so((part,), written)),
                    holds=_truth(evaluate(part, state)),
                    reads=[self._read(name) for name in dict.fromkeys(variables(part))],
                )
                for part in (() if isinstance(predicate, Constant) else conjuncts(predicate))
            ],
            place=place,
        )

    def _read(self, name: str) -> ReadValueView:
        declared = self._automaton.variables.get(name)
        kind = "flag" if declared is None else str(declared.kind)
        return ReadValueView(name=name, kind=kind, value=self._state[name])

    def _actions(self, actions: Iterable[Assignment]) -> list[AbilityActionView]:
        return [self._action(action) for action in actions]

    def _action(self, action: Assignment) -> AbilityActionView:
        state, variable = self._state, target(action)
        written = writes((action,), state)
        done = None if written is None or state[variable] is None else written.get(variable) == state[variable]
        return AbilityActionView(text=print_assignment(action), variable=variable, done=done)

    def _reaction(self, effect: Effect) -> ReactionView:
        return ReactionView(
            name=effect.name,
            kind=effect.kind,
            guard=self._predicate(effect.guard, self._place(effect.name)),
            actions=self._actions(effect.actions),
            shortest=effect.shortest,
            longest=effect.longest,
            fault=effect.fault,
        )

    def _supervised(self, name: str) -> SupervisedView | None:
        guard, specifications = self._guards.get(name), self._automaton.specifications
        if guard is None:
            return None
        return SupervisedView(
            guard=None if guard.expression is None else self._predicate(guard.expression, None),
            specifications=[
                SpecificationView(name=each, title=specifications[each].title) for each in guard.specifications
            ],
            rest=guard.rest,
            blocked=[self._predicate(each, None) for each in guard.blocked],
        )

    def _allowed(self, ability: Ability) -> bool | None:
        """Return whether the supervisor allows a start, whatever the written guards say."""
        if self._supervisor is None:
            return None
        after = start(self._automaton, self._state, ability)
        return None if after is None else self._supervisor.allows(self._state, after)

    def _place(self, part: str) -> WrittenPlaceView | None:
        place = self._automaton.places.get(part)
        return None if place is None else WrittenPlaceView(file=place.file, line=place.line)


def _arguments(name: str) -> list[str]:
    """The values of its parameters, as they stand in its name."""
    _, _, inside = name.partition("(")
    return [each.strip() for each in inside.removesuffix(")").split(",")] if inside else []


def _truth(value: object) -> bool | None:
    return value if isinstance(value, bool) else None


# What jobs consist of.


def work_masters_view(automaton: Automaton) -> WorkMastersView:
    """All work masters of a station, and what its abilities write."""
    return WorkMastersView(
        work_masters={name: _master(automaton, master) for name, master in automaton.work_masters.items()},
        abilities={name: _ability(automaton, ability) for name, ability in automaton.abilities.items()},
    )


def _master(automaton: Automaton, master: WorkMaster) -> WorkMasterView:
    return WorkMasterView(
        title=master.title,
        brings=[print_assignment(action) for action in master.brings],
        brought=sorted({target(action) for action in master.brings}),
        operations={name: _operation(automaton, name, after) for name, after in master.operations.items()},
        alternatives=[[sorted(branch) for branch in branches] for branches in master.alternatives],
        arbitrary=[[sorted(branch) for branch in branches] for branches in master.arbitrary],
    )


def _operation(automaton: Automaton, name: str, after: frozenset[str]) -> WorkOperationView:
    operation = automaton.operations[name]
    read = read_variables(automaton, (operation.goal,))
    return WorkOperationView(title=operation.title, after=sorted(after), goal_reads=sorted(read))


def _ability(automaton: Automaton, ability: Ability) -> WorkAbilityView:
    actions = [*ability.start_actions, *ability.finish_actions, *ability.cancel_actions]
    for effect in reactions(automaton, ability.name):
        actions += effect.actions
    written = sorted({target(action) for action in actions})
    return WorkAbilityView(title=ability.title, writes=written, instant=ability.finish_guard is None)
