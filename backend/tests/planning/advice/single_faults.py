"""Single faults at the moments of the main job of a station, and what the advisor is asked then."""

from __future__ import annotations

import random
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, record_activity, synchronise, update_operations
from sequence_planner.language.types import Value
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.portfolio.engine import PlanningTask
from sequence_planner.planning.problem import ORDINARY, Circumstances, Contract, PlanRequest, goals_of
from sequence_planner.planning.recovery.manual_plans import stalled_effects
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.planning.validation.acceptance import Acceptance
from sequence_planner.planning.validation.replay import missing


@dataclass(frozen=True)
class Moment:
    """A state of the main job, and the operations that are active then."""

    state: State
    active: frozenset[str]


@dataclass(frozen=True)
class Fault:
    """What has become of some values, and of what is there."""

    kind: str
    values: dict[str, Value | None]
    circumstances: Circumstances = ORDINARY
    stalled: frozenset[str] = frozenset()


def main_job(automaton: Automaton, supervisor: Supervisor) -> list[Moment]:
    """All that one product takes the station through: operations as they are activated, one plan after the other."""
    planner, acceptance = Planner(automaton, supervisor), Acceptance.of(automaton, supervisor)
    state, active = initial_state(automaton), frozenset[str]()
    moments: list[Moment] = []
    done: set[frozenset[str]] = set()
    while True:
        active = update_operations(automaton, state, active)
        state = record_activity(automaton, state, active)
        if not active or active in done:
            return moments
        done.add(active)
        goals = missing(goals_of(automaton, sorted(active)), state)
        plan = planner.answer(PlanRequest(state, goals, 30.0, contract=Contract.FAST)).plan
        assert plan is not None
        course = acceptance.course(PlanningTask(state, goals, contract=Contract.FAST), plan)
        assert course is not None
        moments += [Moment(dict(point.run.values), active) for point in course.way[:-1]]
        state = course.way[-1].run.values


def faults(automaton: Automaton, state: State) -> Iterator[Fault]:
    """Every single fault in a state."""
    measured = automaton.names(Kind.MEASURED)
    for name in measured:
        for value in (value for value in automaton.variables[name].type.domain if value != state[name]):
            kind = "a sensor says another value"
            if name == "robot.pose" and str(value).lower() == "unknown":
                kind = "robot between its poses"
            elif name == "end_effector.tool" and value == "none":
                kind = "tool away"
            yield Fault(kind, {name: value})
    for name in automaton.names(Kind.ESTIMATED):
        for value in (value for value in automaton.variables[name].type.domain if value != state[name]):
            yield Fault("an estimate is wrong", {name: value})
    for resource in automaton.resources:
        own = [name for name in measured if automaton.variables[name].resource == resource]
        if own:
            yield Fault("a device is offline", dict.fromkeys(own), Circumstances(frozenset({resource})))
            initial: dict[str, Value | None] = {name: automaton.variables[name].initial for name in own}
            if any(state[name] != value for name, value in initial.items()):
                yield Fault("a device was restarted", initial)
        stalled = stalled_effects(automaton, state, [resource])
        if stalled:
            yield Fault("a device does nothing more", {}, stalled=stalled)
    for ability in automaton.abilities:
        yield Fault("an ability was given up", {}, Circumstances(barred=frozenset({ability})))


def drawn(automaton: Automaton, moments: list[Moment], chance: random.Random) -> tuple[Moment, Fault]:
    """A moment, and a fault of any kind at it."""
    moment = chance.choice(moments)
    by_kind: dict[str, list[Fault]] = defaultdict(list)
    for fault in faults(automaton, moment.state):
        by_kind[fault.kind].append(fault)
    return moment, chance.choice(by_kind[chance.choice(sorted(by_kind))])


def asked(automaton: Automaton, moment: Moment, fault: Fault) -> AdviceRequest:
    """What the advisor is asked once the fault is there."""
    return AdviceRequest(
        synchronise(automaton, {**moment.state, **fault.values}),
        goals_of(automaton, sorted(moment.active)),
        fault.circumstances,
        fault.stalled,
        last={name: value for name in fault.values if (value := moment.state[name]) is not None},
    )
