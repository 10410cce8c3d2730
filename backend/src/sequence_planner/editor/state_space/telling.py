"""Tells people the state space of a draft in the words of its model: nodes, arrows, and a plan as a path."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from sequence_planner.automaton.automaton import State
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.editor.schemas.state_space import (
    ChosenVariableView,
    FoldedStateView,
    FoldingVariableView,
    SaidValueView,
    StateArrowView,
    StateCauseView,
    StatePathView,
)
from sequence_planner.editor.state_space.quotient import MOST_ARROWS, CauseKind, FoldedStates, Leading, Node, Quotient
from sequence_planner.editor.stepping.stepper import StepError, StepMoment, TickStep
from sequence_planner.editor.stepping.telling import StepTelling
from sequence_planner.language.syntax import Expression
from sequence_planner.language.types import Value
from sequence_planner.planning.problem import Plan
from sequence_planner.texts.message import Message, message


class StateSpaceTelling:
    """Tells of the states of a station in the words of `steps`."""

    def __init__(self, steps: StepTelling) -> None:
        self.steps = steps
        self._automaton = steps.stepper.automaton
        self._said = sentences_of(self._automaton)

    def folding_variables(self, names: Iterable[str]) -> list[FoldingVariableView]:
        """Return the variables of these names."""
        return [
            FoldingVariableView(
                name=name, title=self._call(name), values=len(self._automaton.variables[name].type.domain)
            )
            for name in names
        ]

    def tell_chosen(self, quotient: Quotient, nodes: Sequence[FoldedStates]) -> list[ChosenVariableView]:
        """Return the chosen variables with the values of the nodes."""
        found: list[ChosenVariableView] = []
        for place, name in enumerate(quotient.chosen):
            reached = {node.values[place] for node in nodes}
            domain = self._automaton.variables[name].type.domain
            found.append(
                ChosenVariableView(
                    name=name,
                    title=self._call(name),
                    values=[self._value(name, value) for value in domain if value in reached],
                    nodes_without=quotient.number_of_nodes([other for other in quotient.chosen if other != name]),
                )
            )
        return found

    def tell_nodes(self, nodes: Iterable[FoldedStates]) -> list[FoldedStateView]:
        """Return the nodes."""
        return [
            FoldedStateView(
                values=list(node.values),
                states=node.states,
                initial=node.initial,
                present=node.present,
                violated=list(node.violated),
                forbidden=node.forbidden,
                unsafe=node.unsafe,
                stuck=node.stuck,
                cut=node.cut,
            )
            for node in nodes
        ]

    def tell_arrows(self, quotient: Quotient, nodes: Sequence[FoldedStates]) -> tuple[list[StateArrowView], int]:
        """Return the arrows between nodes, and how many are left out: those of several things at once before others."""
        place = {node.values: number for number, node in enumerate(nodes)}
        led: dict[tuple[Node, Node], list[StateCauseView]] = {}
        for each in quotient.leading:
            if each.source in place and each.sink in place:
                led.setdefault((each.source, each.sink), []).append(self._cause(each))
        together = StateCauseView(
            kind=CauseKind.TOGETHER.value, name="", title=message("space.together"), allowed=True, kept=False
        )
        for source, sink in sorted(quotient.pairs_together, key=str):
            if source in place and sink in place:
                led[source, sink] = [together]
        arrows = [
            StateArrowView(source=place[source], sink=place[sink], causes=causes)
            for (source, sink), causes in led.items()
        ]
        return arrows[:MOST_ARROWS], max(len(arrows) - MOST_ARROWS, 0)

    def planned(
        self, state: State, until: Expression | None, quotient: Quotient, nodes: Sequence[FoldedStates]
    ) -> tuple[list[StatePathView] | None, str | None]:
        """Return a plan from a state to the goals of what is active, or to a condition, as a path, and what is known of
        it: after what happens in each tick, and after each start.
        """
        moment = self.steps.stepper.first_moment(state)
        answer = self.steps.stepper.ask_plan(moment, until)
        if answer is None or answer.plan is None:
            return None, None if answer is None else answer.verdict.value
        place = {node.values: number for number, node in enumerate(nodes)}

        def _step(title: Message, after: State) -> StatePathView:
            values = quotient.node_of(after)
            return StatePathView(node=None if values is None else place.get(values), title=title)

        steps = [_step(message("step.beginning"), state)]
        if moment.state != state:
            steps.append(_step(message("space.by-itself"), moment.state))
        steps += [
            _step(self.steps.tell_step(each, before), after) for each, before, after in self._taken(answer.plan, moment)
        ]
        return steps, answer.verdict.value

    def _taken(self, plan: Plan, moment: StepMoment) -> Iterator[tuple[TickStep, State, State]]:
        """Yield what happens one after the other, with the state before and after it: the states that count."""
        stepper = self.steps.stepper
        for tick in plan.ticks:
            before = moment
            for number in range(len(tick.starts) + 1):
                step = TickStep(tick.effects, tick.starts[:number])
                try:
                    after = stepper.step_on(before, step)
                except StepError:  # what happened by itself has changed what was planned for
                    return
                told = TickStep((), tick.starts[number - 1 : number]) if number else TickStep(tick.effects)
                if number or after.state != moment.state:
                    yield told, moment.state, after.state
                moment = after

    def _cause(self, each: Leading) -> StateCauseView:
        kind, title = self._told(each)
        return StateCauseView(kind=kind, name=each.cause.name, title=title, allowed=each.allowed, kept=each.kept)

    def _told(self, each: Leading) -> tuple[str, Message]:
        name, automaton = each.cause.name, self._automaton
        match each.cause.kind:
            case CauseKind.START:
                return each.cause.kind.value, self.steps.tell_step(TickStep(starts=(name,)), each.example)
            case CauseKind.EFFECT:
                effect = next(effect for effect in automaton.effects if effect.name == name)
                return self.steps.kind_of(effect).value, self.steps.tell_step(TickStep((name,)), each.example)
            case CauseKind.FINISH:
                return each.cause.kind.value, message("space.finish", ability=automaton.abilities[name].title)
            case _:
                return each.cause.kind.value, message("space.activity", operation=automaton.operations[name].title)

    def _call(self, name: str) -> Message:
        return message("step.so", so=self._said.call_variable(name))

    def _value(self, name: str, value: Value) -> SaidValueView:
        return SaidValueView(value=value, title=message("step.so", so=self._said.call_value(name, value)))
