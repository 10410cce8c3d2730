"""Tells how an ability is defined, what of it holds now, and how its last trial went."""

from __future__ import annotations

from collections.abc import Iterable

from sequence_planner.automaton.structure import Ability, Effect, target
from sequence_planner.automaton.tick import start, writes
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.definition_view import (
    AbilityActionView,
    AbilityDefinitionView,
    ConjunctView,
    PredicateView,
    ReactionView,
    ReadValueView,
    SupervisedView,
    TimeoutsView,
    TrialView,
    TriedReactionView,
    WrittenPlaceView,
)
from sequence_planner.control.execution import Execution
from sequence_planner.control.involving import Surroundings
from sequence_planner.control.moment import Moment
from sequence_planner.control.trial_watch import Trial, TrialWatch, reactions
from sequence_planner.control.trials import Trials
from sequence_planner.control.way_back_view import SpecificationView
from sequence_planner.expressions.evaluation import evaluate
from sequence_planner.expressions.printing import print_assignment, print_expression
from sequence_planner.expressions.syntax import Assignment, Constant, Expression, conjuncts, variables


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
        return AbilityDefinitionView(
            name=name,
            title=ability.title,
            resource=ability.resource,
            arguments=_arguments(name),
            place=self._place(name),
            restart=ability.restart,
            task=None if ability.human is None else ability.human.text,
            acknowledgement=None if ability.human is None else ability.human.acknowledgement,
            duration=ability.duration,
            revision=execution.revision,
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
            reactions=[self._reaction(effect) for effect in reactions(execution.automaton, name)],
            obstacle=None if refusal is None else refusal.detail,
            real_devices=list(self._trials.real_devices()),
            trial=None if trial is None or trial.ability.name != name else _trial(trial),
        )

    def _written(self, ability: Ability, part: str, predicate: Expression) -> PredicateView:
        return self._predicate(predicate, self._place(f"{ability.name}.{part}"))

    def _predicate(self, predicate: Expression, place: WrittenPlaceView | None) -> PredicateView:
        state = self._execution.state
        return PredicateView(
            text=print_expression(predicate),
            holds=_truth(evaluate(predicate, state)),
            parts=[
                ConjunctView(
                    text=print_expression(part),
                    holds=_truth(evaluate(part, state)),
                    reads=[self._read(name) for name in dict.fromkeys(variables(part))],
                )
                for part in (() if isinstance(predicate, Constant) else conjuncts(predicate))
            ],
            place=place,
        )

    def _read(self, name: str) -> ReadValueView:
        declared = self._execution.automaton.variables.get(name)
        kind = "flag" if declared is None else str(declared.kind)
        return ReadValueView(name=name, kind=kind, value=self._execution.state[name])

    def _actions(self, actions: Iterable[Assignment]) -> list[AbilityActionView]:
        return [self._action(action) for action in actions]

    def _action(self, action: Assignment) -> AbilityActionView:
        state, variable = self._execution.state, target(action)
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
        guard, specifications = self._around.guards().get(name), self._execution.automaton.specifications
        if guard is None:
            return None
        return SupervisedView(
            guard=None if guard.expression is None else self._predicate(guard.expression, None),
            specifications=[
                SpecificationView(name=each, title=specifications[each].title) for each in guard.specifications
            ],
            rest=guard.rest,
        )

    def _allowed(self, ability: Ability) -> bool | None:
        """Whether the supervisor allows a start now, whatever the written guards say."""
        execution = self._execution
        after = start(execution.automaton, execution.state, ability)
        return None if after is None else execution.supervisor.allows(execution.state, after)

    def _place(self, part: str) -> WrittenPlaceView | None:
        place = self._execution.automaton.places.get(part)
        return None if place is None else WrittenPlaceView(file=place.file, line=place.line)


def _arguments(name: str) -> list[str]:
    """The values of its parameters, as they stand in its name."""
    _, _, inside = name.partition("(")
    return [each.strip() for each in inside.removesuffix(")").split(",")] if inside else []


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


def _truth(value: object) -> bool | None:
    return value if isinstance(value, bool) else None
