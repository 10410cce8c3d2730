"""The restart advisor after single faults, at moments of the main job drawn by seed.

Run with `make bench`. The times are CPU time, for all that is offered: an advisor that has 1.8 s for itself. A fault is
one of a device, of what is believed, or of an ability; the model's own `pose` and `tool` are faults of a kind of their
own. *goes on* counts those with an offer that leaves no goal out, *complete* those with nothing left undecided.
"""

from __future__ import annotations

import math
import random
import statistics
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, Kind, State
from sequence_planner.automaton.tick import initial_state, record_activity, synchronise, update_operations
from sequence_planner.expressions.types import Value
from sequence_planner.planning.advice.advisor import Advisor
from sequence_planner.planning.advice.offer import Advice
from sequence_planner.planning.advice.request import AdviceRequest
from sequence_planner.planning.advice.stalling import stalled_effects
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.plan import ORDINARY, Circumstances, Contract, PlanRequest, goals_of
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.replaying.acceptance import Acceptance
from sequence_planner.planning.replaying.replay import missing
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervision import synthesise

MODELS = Path(__file__).parents[2] / "models"
SEED = 8
EACH = 10  # faults of a kind
SECONDS = 1.8


class OwnTime(Budget):
    """So many seconds of this process, whatever others do on the machine meanwhile."""

    def __init__(self, seconds: float) -> None:
        super().__init__(math.inf, time.process_time() + seconds)

    def part(self, share: float) -> Budget:
        """Nobody calls it off."""
        return OwnTime(share * self.remaining)


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


def main() -> None:
    """Measure and print a table for each station."""
    for name in ("bolt_tightening", "truck_engine_station"):
        automaton = prepare_station(MODELS / name).automaton
        supervisor = synthesise(automaton)
        moments = main_job(automaton, supervisor)
        advisor = Advisor(automaton, supervisor)
        advisor.prepare()
        print(f"\n{name}: {len(moments)} moments\n")
        print("| fault | number | goes on | complete | first offers | median | most |")
        print("|---|---|---|---|---|---|---|")
        measure(automaton, advisor, moments)


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
        course = acceptance.course(Task(state, goals, contract=Contract.FAST), plan)
        assert course is not None
        moments += [Moment(dict(point.run.values), active) for point in course.way[:-1]]
        state = course.way[-1].run.values


def measure(automaton: Automaton, advisor: Advisor, moments: list[Moment]) -> None:
    """One line for each kind of fault."""
    chance = random.Random(SEED)
    drawn: dict[str, list[tuple[Moment, Fault]]] = defaultdict(list)
    for moment in chance.sample(moments, len(moments)) * EACH:
        by_kind: dict[str, list[Fault]] = defaultdict(list)
        for fault in faults(automaton, moment.state):
            by_kind[fault.kind].append(fault)
        for kind, some in by_kind.items():
            if len(drawn[kind]) < EACH:
                drawn[kind].append((moment, chance.choice(some)))
        if all(len(some) == EACH for some in drawn.values()):
            break
    for kind, some in drawn.items():
        seconds, answers = zip(*(advised(automaton, advisor, *each) for each in some), strict=True)
        first = Counter(answer.offers[0].kind.value if answer.offers else "none" for answer in answers)
        goes_on = sum(any(not offer.left_out for offer in answer.offers) for answer in answers)
        complete = sum(answer.complete for answer in answers)
        kinds = ", ".join(f"{name} {number}" for name, number in first.most_common())
        times = f"{statistics.median(seconds):.2f} s | {max(seconds):.2f} s"
        print(f"| {kind} | {len(some)} | {goes_on} | {complete} | {kinds} | {times} |", flush=True)


def advised(automaton: Automaton, advisor: Advisor, moment: Moment, fault: Fault) -> tuple[float, Advice]:
    """The CPU seconds it took, and the advice."""
    request = AdviceRequest(
        synchronise(automaton, {**moment.state, **fault.values}),
        goals_of(automaton, sorted(moment.active)),
        fault.circumstances,
        fault.stalled,
        last={name: value for name in fault.values if (value := moment.state[name]) is not None},
    )
    began = time.process_time()
    advice = advisor.advise(request, OwnTime(SECONDS))
    return time.process_time() - began, advice


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


if __name__ == "__main__":
    main()
