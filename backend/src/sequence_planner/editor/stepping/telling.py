"""Tells people the steps of a station: what happened, what can happen next, and the plan from there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sequence_planner.automaton.automaton import Effect, State
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.editor.schemas.draft import (
    ChoiceKind,
    ChoiceView,
    KeptBackView,
    SettableView,
    StepChangeView,
    StepMomentView,
    StepPlanView,
    StepStartView,
    StepView,
)
from sequence_planner.editor.stepping.stepper import StepMoment, Stepper, TickStep, steps_of
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import conjunction
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import PlanAnswer
from sequence_planner.planning.recovery.timing import expected_seconds
from sequence_planner.texts.message import Item, Message, message

MOST_KEPT_BACK = 300


class StepTelling:
    """Tells the steps of `stepper` in the words of its model."""

    def __init__(self, stepper: Stepper) -> None:
        self.stepper = stepper
        automaton = stepper.automaton
        self._said = sentences_of(automaton)
        self._effects = {effect.name: effect for effect in automaton.effects}
        self._people = frozenset(each.resource for each in automaton.abilities.values() if each.human is not None)

    def moments(self, before: State, moments: Sequence[StepMoment]) -> Iterator[StepMomentView]:
        """Yield the moments, of which the first is what comes of the state `before` by itself."""
        for index, moment in enumerate(moments):
            yield StepMomentView(
                step=_step(moment.step),
                title=self.tell_step(moment.step, before) if index else message("step.beginning"),
                resource=self._resource(moment.step),
                seconds=moment.seconds,
                changes=list(self._changes(before, moment.state)),
                ended=list(moment.ended),
                completed=list(moment.completed),
                activated=list(moment.activated),
                running=list(self.stepper.running(moment.state)),
                active=sorted(moment.active),
                safe=self.stepper.supervisor.safe.includes(moment.state),
                restless=moment.restless,
                violated=list(self.stepper.violated(moment.state)),
            )
            before = moment.state

    def choices(self, state: State, answer: PlanAnswer | None) -> Iterator[ChoiceView]:
        """Yield what can happen next, what the plan begins with before all else of its kind."""
        first = (
            next(steps_of(answer.plan), TickStep()) if answer is not None and answer.plan is not None else TickStep()
        )
        kinds = (ChoiceKind.DEVICE, ChoiceKind.PERSON, ChoiceKind.START, ChoiceKind.FAULT)
        found = [
            ChoiceView(
                kind=self.kind_of(effect),
                step=StepView(effects=[effect.name]),
                title=message("step.so", so=self._said.tell_values(written.items(), effect.name)),
                resource=effect.resource,
                seconds=(effect.shortest, effect.longest),
                planned=effect.name in first.effects,
            )
            for effect, written in self.stepper.possible_effects(state)
        ]
        found += [
            ChoiceView(
                kind=ChoiceKind.START,
                step=StepView(starts=[ability.name]),
                title=message("step.start", ability=ability.title),
                resource=ability.resource,
                seconds=ability.duration,
                planned=ability.name in first.starts,
            )
            for ability in self.stepper.possible_starts(state)
        ]
        yield from sorted(found, key=lambda choice: (kinds.index(choice.kind), not choice.planned))

    def settable(self) -> dict[str, SettableView]:
        """Return what somebody can disturb."""
        return {
            name: SettableView(domain=list(domain), unknown=unknown)
            for name, domain, unknown in self.stepper.settable()
        }

    def kept_back(self, state: State) -> Iterator[KeptBackView]:
        """Yield what may not start, and what is missing."""
        for number, (ability, supervised) in enumerate(self.stepper.kept_back(state)):
            if number >= MOST_KEPT_BACK:
                return
            condition = conjunction(ability.enabled, ability.start_guard)
            missing = self._said.tell_missing(condition, state, print_expression(condition))
            yield KeptBackView(
                ability=ability.name,
                title=ability.title,
                resource=ability.resource,
                supervisor=supervised,
                why=message("step.supervised") if supervised else message("sentence.until", conditions=[missing]),
            )

    def plan_view(self, answer: PlanAnswer | None) -> StepPlanView | None:
        """Return the plan of an answer, or what is known without one."""
        if answer is None:
            return None
        automaton, comes = self.stepper.automaton, 0.0
        starts: list[StepStartView] = []
        ticks = () if answer.plan is None else answer.plan.ticks
        for number, tick in enumerate(ticks):
            comes += expected_seconds(automaton, [tick])
            for name in tick.starts:
                ability = automaton.abilities[name]
                starts.append(
                    StepStartView(
                        ability=name, title=ability.title, resource=ability.resource, tick=number, seconds=comes
                    )
                )
        steps = [] if answer.plan is None else [_step(each) for each in steps_of(answer.plan)]
        return StepPlanView(verdict=answer.verdict, starts=starts, ticks=steps, seconds=comes)

    def kind_of(self, effect: Effect) -> ChoiceKind:
        """Return who or what makes an effect happen."""
        if effect.fault:
            return ChoiceKind.FAULT
        return ChoiceKind.PERSON if effect.resource in self._people else ChoiceKind.DEVICE

    def tell_step(self, step: TickStep, before: State) -> Message:
        """Return what happens in a step from a state."""
        said: list[Item] = []
        if step.sets:
            said += [self._so(name, value) for name, value in step.sets.items()]
        for name in step.effects:
            written = dict(self.stepper.written_by(name, before))
            said.append(message("step.so", so=self._said.tell_values(written.items(), name)) if written else name)
        said += [message("step.start", ability=self.stepper.automaton.abilities[name].title) for name in step.starts]
        return message("list", items=said) if said else message("step.nothing")

    def _so(self, name: str, value: Value | None) -> Message:
        if value is None:
            return message("member.unknown", name=self._said.call_variable(name))
        return message("step.so", so=self._said.tell_value(name, value))

    def _resource(self, step: TickStep) -> str | None:
        for name in step.starts:
            return self.stepper.automaton.abilities[name].resource
        for name in step.effects:
            return self._effects[name].resource
        variables = self.stepper.automaton.variables
        return next((variables[name].resource for name in step.sets), None)

    def _changes(self, before: State, after: State) -> Iterator[StepChangeView]:
        for name in self.stepper.automaton.variables:
            old, new = before[name], after[name]
            if old != new:
                so = None if new is None else message("step.so", so=self._said.tell_value(name, new))
                yield StepChangeView(name=name, before=old, after=new, so=so)


def _step(step: TickStep) -> StepView:
    return StepView(effects=list(step.effects), starts=list(step.starts), sets=dict(step.sets))
