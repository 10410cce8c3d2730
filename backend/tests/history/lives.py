"""Random lives of stations: all that can happen to an execution does, in any order, and is recorded."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

from controller.carrying_out import carry_out
from core.choices import Choices
from core.random_problems import RESOURCES, Problem, problem
from sequence_planner.automaton.automaton import Automaton, Kind, State, Timeouts, WorkMaster
from sequence_planner.automaton.tick import apply_effects
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.jobs import (
    CommandJob,
    ForgetJob,
    JobOperation,
    JobWait,
    SequenceJobs,
    SetByOrder,
    TakeJob,
)
from sequence_planner.controller.features.jobs import JobHandler
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace as changed
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.state import InitialState, OperatorPlan, OperatorPlanKind
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.syntax import TRUE, Assignment, Constant, Expression, Variable
from sequence_planner.language.types import Value
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.problem import Plan, PlanAnswer, PlanRequest, PlanTick, Verdict


@dataclass
class Life:
    """An execution and the records of what has happened to it."""

    execution: Executor
    planner: Planner
    records: list[RunRecord] = field(default_factory=list)
    now: float = 1000.0
    asked: PlanRequest | None = None

    @property
    def moment(self) -> Timestamp:
        """Epoch and the other clock never agree."""
        return Timestamp(1.7e9 + self.now, self.now)

    def write(self, kind: str, time: float, content: str) -> int:
        """As the journal does."""
        self.records.append(RunRecord(len(self.records) + 1, time, kind, content, ""))
        return len(self.records)


def life(choices: Choices, snapshot_every: int = 5) -> Life:
    """A station to which any number of things has happened."""
    given = problem(choices, demanding=True)
    station = _demanding(choices, given)
    beginning = _beginning(choices, station) if choices.chance(2) else None
    execution = Executor(station, given.supervisor, beginning)
    lived = Life(execution, Planner(station, given.supervisor))
    RunRecorder(execution, lived.write, model_digest(station), beginning, lambda: lived.moment.epoch, snapshot_every)
    if not choices.chance(5):
        execution.start_production()
    acts = _acts(choices, lived)
    for _ in range(choices.number(1, 30)):
        lived.now += choices.pick((0.0, 0.1, 1.0, 7.5))
        choices.pick(acts)()
    return lived


def _demanding(choices: Choices, given: Problem) -> Automaton:
    """The station with time-outs, operations that are done once, and work masters."""
    station = given.automaton
    abilities = {
        name: changed(each, timeouts=Timeouts(react=1.0, finish=3.0, retries=choices.number(0, 1), replan=True))
        if each.finish_guard is not None and choices.chance(2)
        else each
        for name, each in station.abilities.items()
    }
    operations = {name: changed(each, repeat=not choices.chance(3)) for name, each in station.operations.items()}
    masters = _work_masters(choices, station)
    return changed(station, abilities=abilities, operations=operations, work_masters=masters)


def _work_masters(choices: Choices, station: Automaton) -> dict[str, WorkMaster]:
    """Two of them, which may have operations and estimates in common; each operation may wait for earlier ones."""
    masters: dict[str, WorkMaster] = {}
    for name in ("one", "other"):
        steps: dict[str, frozenset[str]] = {}
        for operation in choices.different(tuple(station.operations), 1, 3):
            steps[operation] = frozenset(choices.different(tuple(steps), 0, 1))
        brought = [station.variables[each] for each in choices.different(station.names(Kind.ESTIMATED), 0, 2)]
        brings = [Assignment(Variable(v.name, v.type), Constant(choices.pick(v.type.domain))) for v in brought]
        if steps:
            masters[name] = WorkMaster(name, name, steps, tuple(brings))
    return masters


def _beginning(choices: Choices, station: Automaton) -> InitialState:
    kept = (*station.names(Kind.ESTIMATED), *station.names(Kind.OUTPUT))
    values = {name: choices.pick(station.variables[name].type.domain) for name in kept if not choices.chance(3)}
    return InitialState(values, 1.5e9, (), frozenset(), Timestamp(1.7e9, 1000.0))


def _acts(choices: Choices, lived: Life) -> list[Callable[[], object]]:
    """What may happen, ticks and plans most often."""
    execution = lived.execution
    station = execution.automaton

    def tick() -> None:
        obstacles = ("the network",) if choices.chance(10) else ()
        silent = frozenset(choices.different(RESOURCES, 1, 2)) if choices.chance(8) else frozenset[str]()
        execution.tick(_measured(choices, station, execution.state), lived.moment, obstacles, silent)

    def ask() -> None:
        request = execution.better(5) if choices.chance(3) else execution.request(5)
        lived.asked = request or lived.asked

    def answer() -> None:
        if lived.asked is None:
            return
        if choices.chance(6):
            execution.unanswered("the planner has ended", choices.chance(2))
        else:
            execution.adopt(lived.asked, _answer(choices, lived, lived.asked))

    def service() -> None:
        of = choices.pick(tuple(ServiceKind))
        parts = {ServiceKind.RESOURCE: RESOURCES, ServiceKind.ABILITY: tuple(station.abilities)}
        names = parts.get(of, tuple(station.operations))
        if names:
            execution.set_service(of, choices.pick(names), choices.chance(2), "Eva", "why not", lived.moment)

    def correct() -> None:
        names = station.names(Kind.ESTIMATED)
        if names:
            name = choices.pick(names)
            value = choices.pick(station.variables[name].type.domain)
            taken_back = frozenset({name}) if choices.chance(3) else frozenset[str]()
            execution.correct({name: value}, "Eva", "as seen", lived.moment, taken_back)

    def force() -> None:
        name = choices.pick((*station.names(Kind.MEASURED), *station.names(Kind.OUTPUT)))
        until = Timestamp(lived.moment.epoch + 3.0, lived.now + 3.0)
        execution.force(name, choices.pick(station.variables[name].type.domain), until, "Eva", "to see")

    def release() -> None:
        if execution.conduct.forces:
            execution.release(choices.pick(sorted(execution.conduct.forces)))

    def errand() -> None:
        goal = choices.pick([each.predicate for each in execution.pursued.goals.values()] or [_any_goal(station)])
        starts = tuple(choices.different(tuple(station.abilities), 0, 2))
        plan = Plan((PlanTick((), starts), PlanTick((), ())), False, False)
        kind = choices.pick(tuple(OperatorPlanKind))
        operation = choices.pick((None, *station.operations))
        taken = OperatorPlan(kind, "by hand", plan, goal, choices.chance(2), choices.chance(2), operation, "Eva", "so")
        taken = changed(taken, into_safe=choices.chance(3))
        if kind is OperatorPlanKind.TRIAL and station.abilities:
            tried = choices.pick(tuple(station.abilities))
            plan = Plan((PlanTick((), (tried,)), PlanTick((), ())), False, False)
            taken = OperatorPlan(kind, "by hand", plan, goal, by="Eva", ability=tried)
            execution.change_mode(Mode.PAUSED, "Eva", lived.moment)
        execution.start_operator_plan(taken, lived.moment)

    desk = JobHandler(execution)

    def order() -> None:
        with contextlib.suppress(CommandRefused):
            carry_out(desk, _order(choices, execution), lived.moment)

    return [
        *(tick, tick, tick, tick, ask, ask, answer, answer, order, order),
        lambda: execution.change_mode(choices.pick(tuple(Mode)), "Eva", lived.moment),
        lambda: execution.set_stepping(choices.chance(2)),
        lambda: execution.set_cycle_stop(not choices.chance(3), "Eva", "the shift ends", lived.moment),
        *(execution.take_step, service, correct, force, release, errand),
        lambda: execution.call_off("Eva", lived.moment),
        lambda: execution.confirm(frozenset(station.names(Kind.ESTIMATED)[:1]), "Eva", lived.moment),
        lambda: execution.stop_operator_plan("Eva", lived.moment),
        lambda: execution.explained(Diagnosis(None, ())),
    ]


def _order(choices: Choices, execution: Executor) -> Command:
    """What may be asked about jobs, where most of it is possible."""
    jobs, masters = execution.conduct.jobs, execution.automaton.work_masters
    if not jobs.by_order or choices.chance(8):
        return SetByOrder(actor=SYSTEM, on=not choices.chance(4), reason="so")
    if masters and (not jobs.taken or choices.chance(3)):
        name = choices.pick(tuple(masters))
        return TakeJob(actor=SYSTEM, job=f"job-{choices.number(1, 4)}", title="A job", work_master=name)
    job = choices.pick([each.id for each in jobs.taken] or ["job-1"])
    if choices.chance(3):
        return ForgetJob(actor=SYSTEM, job=job)
    if choices.chance(3):
        names = tuple(execution.automaton.operations)
        steps = [JobOperation(job=each.id, operation=name) for each in jobs.taken for name in names]
        chosen = choices.different(steps, 0, 3)
        waits = [JobWait(job=a.job, operation=a.operation, for_=[b]) for a, b in pairwise(chosen)]
        return SequenceJobs(actor=SYSTEM, waits=waits)
    return CommandJob(actor=SYSTEM, job=job, what=choices.pick(("resume", "pause", "stop", "abort")))


def _any_goal(station: Automaton) -> Expression:
    return next((each.goal for each in station.operations.values()), TRUE)


def _measured(choices: Choices, station: Automaton, state: State) -> dict[str, Value | None]:
    """Mostly what the devices would say, and now and then anything or nothing."""
    names = station.names(Kind.MEASURED)
    effects = [each for each in station.effects if not choices.chance(4) and apply_effects(state, [each])]
    sensed = apply_effects(state, effects) or state
    measured = {name: sensed[name] for name in names}
    for name in names:
        if measured[name] is None or choices.chance(12):
            measured[name] = None if choices.chance(4) else choices.pick(station.variables[name].type.domain)
    return measured


def _answer(choices: Choices, lived: Life, request: PlanRequest) -> PlanAnswer:
    """That of a planner, or one that says that there is none."""
    goals = tuple(goal.name for goal in request.goals)
    if not choices.chance(4):
        try:
            return lived.planner.answer(changed(request, deadline=1.0))
        except PlannerError:
            pass
    verdict = choices.pick((Verdict.NONE_AT_ALL, Verdict.NONE_UP_TO, Verdict.LATE))
    return PlanAnswer(verdict, None, (), goals, 3, 0.25)
