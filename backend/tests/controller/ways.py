"""Ways back that are taken, while devices and people do what they may in any order: each comes to its end."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from dataclasses import replace as replaced

from planning.advice.carrying_out import ANYTHING, Stopped, changed
from planning.advice.rules import station
from planning.advice.single_faults import asked, drawn
from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import (
    apply_effects,
    effect_writes,
    finish,
    supervised_start,
    synchronise,
)
from sequence_planner.controller.views.wording import offer_title
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import OperatorPlan, OperatorPlanKind
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Expression
from sequence_planner.planning.problem import Circumstances
from sequence_planner.planning.recovery.manual_plans import stalling, stalls
from sequence_planner.planning.recovery.proposals import RecoveryProposal

MOST_STATES = 3000  # that are looked at, to see that an end is out of reach
PATIENCE = 400  # ticks, in each of which any of what may happen happens or does not


@dataclass
class Taken:
    """An errand that was taken in a station that stands in `state`; `real` has what can happen there."""

    execution: Executor
    real: Automaton
    offline: frozenset[str]
    seconds: float = 0.0

    def tick(self, effects: Iterable[str] = ()) -> tuple[str, ...]:
        """The abilities that start in a tick in which these effects happen, as far as they can."""
        state: State = self.execution.state
        by_name = {effect.name: effect for effect in self.real.effects}
        for name in effects:
            state = apply_effects(state, [by_name[name]]) or state
        self.seconds += 0.1
        measured = {name: state[name] for name in self.real.names(Kind.MEASURED)}
        return self.execution.tick(measured, Timestamp(self.seconds, self.seconds), (), self.offline).started

    def possible(self) -> list[str]:
        """What devices and people may do now."""
        state = self.execution.state
        return [
            effect.name
            for effect in self.real.effects
            if not effect.fault
            and effect.resource not in self.offline
            and any(state[name] != value for name, value in (effect_writes(effect, state) or {}).items())
        ]


def execution_in(
    automaton: Automaton, supervisor: Supervisor, state: State, active: frozenset[str], circumstances: Circumstances
) -> Executor:
    """A station that has come to stand in a state, in restart mode."""
    execution = Executor(automaton, supervisor)
    execution.start_production()
    execution.state = state
    execution.published = state
    execution.active = active
    execution.change_mode(Mode.RESTART, "Eva", Timestamp(0.0, 0.0))
    for name in circumstances.barred:
        execution.set_service(ServiceKind.ABILITY, name, False, "Eva", "gone", Timestamp(0.0, 0.0))
    return execution


def operator_plan_of(automaton: Automaton, offer: RecoveryProposal, goal: Expression | None = None) -> OperatorPlan:
    """What is carried out of an offer; with a `goal`, for that instead."""
    assert offer.operator_plan is not None
    return OperatorPlan(
        kind=OperatorPlanKind.WAY_BACK,
        title=offer_title(automaton, offer),
        plan=offer.operator_plan,
        goal=offer.goal if goal is None else goal,
        restart=offer.restart or offer.unsupervised,
        unsupervised=offer.unsupervised,
        into_safe=offer.into_safe if goal is None else False,
        by="Eva",
        why="to see it",
    )


def after_a_fault(name: str, seed: str, deadline: float) -> Counter[str]:
    """All ways that are proposed after a fault, or after several at once, are taken.

    AssertionError where one does not come to its end.
    """
    chance = random.Random(seed)
    tried = station(name)
    automaton, supervisor, advisor = tried.automaton, tried.supervisor, tried.advisor
    moment, fault = drawn(automaton, tried.moments, chance)
    for _ in range(chance.randrange(3)):
        _, other = drawn(automaton, [moment], chance)
        fault = replaced(fault, kind=f"{fault.kind}, {other.kind}", values={**other.values, **fault.values})
    request = replace(asked(automaton, moment, fault), deadline=deadline)
    real = stalling(automaton, stalls(automaton, request.state, request.stalled))
    met: Counter[str] = Counter()
    for offer in advisor.advise(request).offers:
        if offer.operator_plan is None:
            continue
        stopped = Stopped(automaton, supervisor, request.state, request.goals, request.circumstances)
        state, circumstances = changed(stopped, offer)
        execution = execution_in(automaton, supervisor, state, moment.active, circumstances)
        taken = Taken(execution, real, circumstances.offline)
        taken.tick()
        execution.start_operator_plan(operator_plan_of(automaton, offer), Timestamp(taken.seconds, taken.seconds))
        hurry, started = chance.choice((0.05, 0.3, 1.0)), 0
        for _ in range(PATIENCE):
            possible = taken.possible()
            chance.shuffle(possible)
            started += len(taken.tick([each for each in possible if chance.random() < hurry]))
            if execution.operator_plan is None:
                break
        last = execution.conduct.last_operator_plan
        case = f"{name}, {fault.kind}: {offer_title(automaton, offer)}, in {state}"
        assert execution.operator_plan is None, f"{case}: it does not end"
        assert last is not None, case
        if last.done:
            assert execution.safe, f"{case}: it ends outside the safe states"
            met[f"{name}: {offer.kind} came to its end"] += 1
        else:
            # Two devices may have come in another order than they must: then nothing leads there any more.
            order = [] if offer.operator_plan is None else [ability for _, ability in offer.operator_plan.starts]
            left = order[started:]
            assert not can_come(taken, offer, left), f"{case}: {last.why}, with {left} ahead, in {execution.state}"
            met[f"{name}: {offer.kind} was departed from, and its end was out of reach"] += 1
    return met


def can_come(taken: Taken, offer: RecoveryProposal, order: Sequence[str]) -> bool:
    """Whether there is any order of effects, and of these starts among them, in which the end of the offer comes."""
    automaton, supervisor = taken.real, taken.execution.supervisor
    effects = [e for e in automaton.effects if not e.fault and e.resource not in taken.offline]
    free = offer.unsupervised and not taken.execution.safe
    pending = [(dict(taken.execution.state), tuple(order), free)]
    seen: set[object] = set()
    while pending and len(seen) < MOST_STATES:
        state, left, free = pending.pop()
        key = (tuple(state.values()), left)
        if key in seen:
            continue
        seen.add(key)
        safe = supervisor.safe.includes(state)
        if holds(offer.goal, state) and (safe or not offer.into_safe):
            return True
        if left:
            allowed = ANYTHING if free and not safe else supervisor
            after = supervised_start(automaton, allowed, state, state, automaton.abilities[left[0]])
            if after is not None:
                pending.append((dict(after), left[1:], free and not safe))
        for effect in effects:
            sensed = apply_effects(state, [effect])
            if sensed is not None and sensed != state:
                later = synchronise(automaton, finish(automaton, sensed).state)
                pending.append((dict(later), left, free and not safe))
    return False
