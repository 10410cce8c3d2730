"""The executor: a running station's state, plan and tick, and its response to all events."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import reverts
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.estimates import answered, still_to_rely_on
from sequence_planner.execution.events import (
    Answered,
    Asked,
    ByOrderChanged,
    CalledOff,
    Confirmed,
    Corrected,
    CycleStopChanged,
    Event,
    Explained,
    Forced,
    ForceReleased,
    Heard,
    JobCommanded,
    JobForgotten,
    JobsSequenced,
    JobTaken,
    ModeChanged,
    OperatorPlanStarted,
    OperatorPlanStopped,
    ProductionStarted,
    ServiceChanged,
    SteppingChanged,
    StepTaken,
    Ticked,
    TickOutcome,
    Unanswered,
)
from sequence_planner.execution.jobs import Job, JobAct, Waits
from sequence_planner.execution.plan_tracker import ExecutionSnapshot, PlanTracker
from sequence_planner.execution.products import final_operations, kept_back, lacking, still_written
from sequence_planner.execution.state import (
    NAME as OPERATOR_PLAN,
)
from sequence_planner.execution.state import (
    ActiveGoals,
    CycleStop,
    ExecutionState,
    Force,
    InitialState,
    LastOperatorPlan,
    OperatorPlan,
    OutOfService,
    writing,
)
from sequence_planner.execution.timeouts import Late, after_another_try, cancelled, overdue, to_call_off
from sequence_planner.execution.vocabulary import JobState, Mode, Production, ServiceKind
from sequence_planner.language.evaluator import holds
from sequence_planner.language.types import Value
from sequence_planner.planning.diagnosis import Diagnosis
from sequence_planner.planning.problem import Circumstances, Contract, PlanAnswer, PlanRequest
from sequence_planner.planning.validation.lookahead import Lookahead
from sequence_planner.texts.message import message

# A station's course from tick to tick: its state, how it is to execute, its plan, and the tick that leads on.
#
# Pure: it has no clock, does no I/O and starts nothing but in its own state. `executor` is what is made of it.

_UNSUPERVISED = Supervisor(StateSet((), ()), {})


class ExecutorBase:
    """The course of a running station. `beginning` is what is known of it from before."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, beginning: InitialState | None = None) -> None:
        self.automaton = automaton
        self.supervisor = supervisor
        self._compiled = CompiledTick(automaton)
        # What a look ahead says can depend on what was looked at before. So whoever is only curious has one of his own.
        self._supervised = Lookahead(self._compiled, supervisor)
        self._curious = Lookahead(self._compiled, supervisor)
        self._free: tuple[Lookahead, Lookahead] | None = None  # the same without the supervisor; made when needed
        self.conduct = ExecutionState()
        known: Mapping[str, Value] = {}
        if beginning is not None:
            known = beginning.values
            service = {(each.of, each.name): each for each in beginning.service}
            returned = automaton.outputs & known.keys()
            self.conduct = ExecutionState(
                mode=beginning.mode,
                stepping=beginning.stepping,
                service=service,
                done=beginning.done,
                returned=returned,
                jobs=beginning.jobs,
                answers=beginning.answers,
            )
        unmeasured = dict.fromkeys(automaton.names(Kind.MEASURED), None)
        self._run = CompiledRun(self._compiled, {**automaton.initial_valuation, **known, **unmeasured})
        self._run.synchronise()
        self.published: State = self.state
        self.active: frozenset[str] = frozenset()
        self._operations = ActiveGoals()  # what is pursued of them, also while there is something else to do
        self.plan = PlanTracker(automaton, self._supervised)
        self.asked: PlanRequest | None = None  # of the planner, last
        self.ticks = 0
        self.revision = 0 if beginning is None else beginning.revision
        self.obstacles: tuple[str, ...] = ()  # what keeps everything from starting, as one waits for it
        self.circumstances = Circumstances()
        self._face()

    # What it is like.

    @property
    def state(self) -> State:
        """The values of all variables and flags. It can be set to any other state, from which the ticks then go on."""
        return self._run.state

    @state.setter
    def state(self, state: State) -> None:
        self._run = CompiledRun(self._compiled, state)

    @property
    def mode(self) -> Mode:
        """The mode of execution."""
        return self.conduct.mode

    @property
    def production(self) -> Production:
        """The state of production: whether outputs are published."""
        return self.conduct.production

    @property
    def operator_plan(self) -> OperatorPlan | None:
        """The operator plan that is carried out beside the operations, which wait for it."""
        return self.conduct.operator_plan

    @property
    def pursued(self) -> ActiveGoals:
        """The goals that plans are made for: those of active operations, or that of an operator plan."""
        if self.operator_plan is not None:
            return (
                ActiveGoals()
                if self.operator_plan.ability
                else ActiveGoals({OPERATOR_PLAN: self.operator_plan.pursued})
            )
        return self._operations

    @property
    def safe(self) -> bool:
        """True if the state is in the safe set for every value its unknown variables could have."""
        return self.supervisor.safe.includes(self.state)

    @property
    def blind(self) -> bool:
        """True if some measured variable has no value."""
        return any(self.state[name] is None for name in self.automaton.names(Kind.MEASURED))

    def corrected(self, values: Mapping[str, Value]) -> State:
        """The state with other values of estimates or outputs."""
        run = self._run.fork()
        run.sense(values)
        run.synchronise()
        return run.state

    def running(self) -> frozenset[str]:
        """The abilities under way: started and not ended, or executing whoever has started them."""
        started = {step.ability for step in self.plan.order.running}
        state = self.state
        executing = {a.name for a in self.automaton.abilities.values() if state[a.flag("executing")] is True}
        return frozenset(started | executing)

    def is_due(self, now: Timestamp) -> bool:
        """Return whether time alone makes a difference in the next tick: a force ends, or what runs is to be called
        off.
        """
        if any(force.until.monotonic <= now.monotonic for force in self.conduct.forces.values()):
            return True
        return bool(self._overdue(now)) or self._trial_overdue(now) is not None

    def simulated(self) -> CompiledRun:
        """A run that goes on from the present, for those who want to see what would become of it."""
        return self._run.fork()

    def startable(self, name: str) -> CompiledRun | None:
        """The run after the start of the ability, if its guards and the supervisor allow it now."""
        if self.circumstances.bars(self.automaton.abilities[name]) or name not in self._run.startable():
            return None
        after = self._run.fork()
        if not after.start(name) or reverts(self.automaton, self.published, self._run.values, after.values):
            return None
        return after if self._allows(after.values) else None

    def keeps_from_beginning(self, job: Job) -> tuple[str, ...]:
        """Return what has to be otherwise before what the product of this job brings can be so, in words."""
        master = self.automaton.work_masters[job.work_master]
        found = list(still_written(self.automaton, master, self.running()))
        if self.conduct.cycle_stop is not None:
            found.append(message("waits.cycle-stop", by=self.conduct.cycle_stop.by))
        if brought := lacking(master, self.state):
            found = [*kept_back(self.conduct), *found]
            if not found and not self._is_safe_with(brought):
                found = [message("waits.product-safe")]
        return tuple(found)

    def may_go_on(self, name: str) -> bool:
        """Return whether the order still reaches the goals once its first ability, `name`, has been started now."""
        after = self.startable(name)
        if after is None:
            return False
        curious = self._curious if self._free is None or not self._is_free else self._free[1]
        return self.plan.may_go_on(self._present, after, curious)

    def _allows(self, after: State) -> bool:
        """Return whether a start may lead to `after`. From outside the safe states only one that a person confirmed
        may.
        """
        before = self._run.values
        if self.supervisor.allows(before, after):
            return True
        return (
            self.operator_plan is not None
            and self.operator_plan.unsupervised
            and not self.supervisor.safe.includes(before)
        )

    @property
    def _present(self) -> ExecutionSnapshot:
        confirmed = self.operator_plan is not None
        return ExecutionSnapshot(self._run, self.published, self.pursued, self.circumstances, confirmed)

    @property
    def _is_free(self) -> bool:
        """True if what is carried out has still to come into the safe states, outside which no supervisor speaks."""
        return self.operator_plan is not None and (self.operator_plan.unsupervised or self.operator_plan.into_safe)

    # How a tick is taken.

    def _tick(self, measured: Mapping[str, Value | None], now: Timestamp) -> TickOutcome:
        before, conduct = self.state, self.conduct
        self._release([name for name, force in conduct.forces.items() if force.until.monotonic <= now.monotonic])
        self._begin_jobs(now)
        sensed, self.conduct = self.conduct.sensing(measured)
        self._run.sense(sensed)
        finishing = self._run.finish()
        kept, self.conduct = self.conduct.keeping(self._run.values, self.automaton.outputs)
        self._run.sense(kept)
        self._run.synchronise()
        ended = tuple(name for name in finishing.finished if self.plan.order.finish(name, now))
        called_off, given_up = self._check_running(ended, now)
        activated, completed = self._update_operations(now)
        self._check_cycle_stop(completed)
        self._check_operator_plan(now)
        self._heed_supervisor()
        started = self._start(now)
        self._heed_supervisor()
        self._heed_answers(started)
        called_off += self._update_plan(now)
        # Before production is started nothing is published, and then all outputs are: no change of one is news.
        news = self.automaton.outputs if self.production is Production.STARTED else ()
        outputs = frozenset(name for name in news if self.state[name] != self.published[name])
        self.published = self.state
        moved = (self.state is not before and self.state != before) or self.conduct != conduct
        changed = bool(started or ended or activated or completed or outputs or called_off) or moved
        return TickOutcome(
            finishing.finished,
            ended,
            started,
            activated,
            completed,
            finishing.conflicts,
            outputs,
            changed,
            called_off,
            given_up,
        )

    def _begin_jobs(self, now: Timestamp) -> None:
        """Let what the products of new jobs bring be so from now on, where nothing is in the way: as after a
        correction.
        """
        for job in self.conduct.jobs.under_way:
            if job.may_begin and not self.keeps_from_beginning(job):
                master = self.automaton.work_masters[job.work_master]
                self._write(lacking(master, self.state))
                done = self.conduct.done - master.operations.keys()
                self._change(jobs=self.conduct.jobs.having_begun(job.id, now), done=done)

    def _check_running(self, ended: tuple[str, ...], now: Timestamp) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """The overdue abilities that are called off to be planned anew, and those of them that are given up."""
        if any(name in self.conduct.tried for name in ended):
            self._change(tried={name: n for name, n in self.conduct.tried.items() if name not in ended})
        for step in self.plan.order.running:
            flag = self.automaton.abilities[step.ability].flag("executing")
            step.reacted = step.reacted or self._run.values[flag] is True
        overdue = self._overdue(now)
        if not overdue:
            return (), ()
        self.conduct, given_up = after_another_try(self.conduct, self.automaton, overdue, now)
        self._face()
        self._cancel(overdue)
        for name in overdue:
            self.plan.order.finish(name, now)
        return tuple(overdue), given_up

    def _cancel(self, names: Iterable[str]) -> tuple[str, ...]:
        """Take the cancel actions of these abilities; those that were called off by it."""
        called_off, writes = cancelled(self.automaton, self._run.state, names)
        if self.safe and not self._is_safe_with(writes):
            called_off, writes = (), {}  # it goes on as it is: nothing that is done here leads out of the safe states
        self._run.sense(writes)
        kept, self.conduct = self.conduct.keeping(self._run.values, self.automaton.outputs)
        self._write(kept)
        return called_off

    def _overdue(self, now: Timestamp) -> Mapping[str, str]:
        """The abilities that are to be called off because they are overdue, each with what has not come in time."""
        return to_call_off(self.automaton, self.plan.order, now) if self.conduct.executes_operations else {}

    def _update_operations(self, now: Timestamp) -> tuple[frozenset[str], frozenset[str]]:
        """Step 4: the operations that are activated by it, and those that are completed."""
        active = self._run.update_operations(self.active)
        reached = frozenset(name for name in self.automaton.branching_operations if self._has_reached(name))
        idle = self.conduct.idle_operations(self.automaton, active, reached)
        left = self.active - active
        withdrawn = (self.active & active & idle) | (left & idle)
        active, completed = active - idle, left - idle
        activated = active - self.active
        done = completed | self._advance_jobs(active, now)
        if once := frozenset(name for name in done if not self.automaton.operations[name].repeat):
            self._change(done=self.conduct.done | once)
        if self.conduct.executes_operations:
            self._operations = self._operations.settled(completed, self._run.values, now)
        else:
            self._operations = self._operations.without(completed)  # what happens meanwhile is none of their run
        self._operations = self._operations.without(withdrawn)
        self._run.record_activity(active)
        if self.production is Production.STARTED:
            begun = active - self._operations.goals.keys()
            self._operations = self._operations.activated(self.automaton, begun, self._run.values, now)
        self.active = active
        if self.operator_plan is None:
            self.plan.settle(active, self._operations.hopeful)
        return activated, completed

    def _check_cycle_stop(self, completed: frozenset[str]) -> None:
        """Notice that the product which was in work is done: no job is running, or its last operation is completed."""
        stop = self.conduct.cycle_stop
        if stop is None or stop.reached:
            return
        if self.conduct.jobs.by_order:
            reached = all(job.state is not JobState.RUNNING for job in self.conduct.jobs.under_way)
        else:
            reached = not completed.isdisjoint(final_operations(self.automaton))
        if reached:
            self._change(cycle_stop=replace(stop, reached=True))

    def _advance_jobs(self, active: frozenset[str], now: Timestamp) -> frozenset[str]:
        """Let what was eligible for a job in step 4 begin, or be completed where its goal holds; return the latter."""
        before = self.conduct.jobs
        after = before.advanced(self.automaton, active, self._has_reached, now)
        if after is before:
            return frozenset()
        self._change(jobs=after)
        pairs = zip(before.taken, after.taken, strict=True)
        return frozenset(name for old, new in pairs for name in new.completed.keys() - old.completed.keys())

    def _has_reached(self, operation: str) -> bool:
        return holds(self.automaton.operations[operation].goal, self._run.values)

    def _check_operator_plan(self, now: Timestamp) -> None:
        """An operator plan whose goal holds is done; with it an operation that is reset begins anew."""
        operator_plan = self.operator_plan
        if (
            operator_plan is None
            or operator_plan.ability is not None
            or not holds(operator_plan.goal, self._run.values)
        ):
            return
        if operator_plan.into_safe and not self.safe:
            return
        if operator_plan.operation is not None:
            jobs = self.conduct.jobs.reopened(operator_plan.operation, self.automaton)
            self._change(done=self.conduct.done - {operator_plan.operation}, jobs=jobs)
            # What comes after it in a job has to wait for it again.
            withdrawn = {operator_plan.operation} | (self.active & self.conduct.idle_operations(self.automaton))
            self.active -= withdrawn
            self._operations = self._operations.without(withdrawn)
            self._run.record_activity(self.active)
        self._end_operator_plan("", now, done=True)

    def _heed_supervisor(self) -> None:
        """An operator plan goes by the supervisor from the first safe state on, also when something becomes unknown."""
        if self.operator_plan is not None and self._is_free and self.safe:
            self._change(operator_plan=replace(self.operator_plan, unsupervised=False, into_safe=False))

    def _heed_answers(self, started: Iterable[str]) -> None:
        """Let what a person has said count until it is another by now, or operations go on with what they rely on."""
        answers = self.conduct.answers
        if not answers:
            return
        if self.operator_plan is None:
            abilities = (self.automaton.abilities[name] for name in started)
            answers = still_to_rely_on(self.automaton, answers, abilities)
        answers = {name: value for name, value in answers.items() if self._run.values[name] == value}
        if answers != self.conduct.answers:
            self.conduct = replace(self.conduct, answers=answers)

    def _update_plan(self, now: Timestamp) -> tuple[str, ...]:
        """Notice that the plan is done with, or that the state has departed from it; what was called off by it."""
        if self.conduct.executes_operations:
            self.plan.update(self._present, self.active)
        elif self.operator_plan is not None and self.operator_plan.ability is not None:
            return self._check_trial(self.operator_plan.ability, now)
        elif self.operator_plan is not None and not self.blind and not self.plan.still_leads(self._present):
            self._end_operator_plan(message("ended.departed"), now)
        return ()

    def _check_trial(self, ability: str, now: Timestamp) -> tuple[str, ...]:
        """A trial starts in the first tick after it was taken, and is over when its run is, or when that is overdue: it
        is called off then.
        """
        title, order = self.automaton.abilities[ability].title, self.plan.order
        if order.ahead:
            self._end_operator_plan(message("ended.not-startable", ability=title), now)
        elif all(step.ability != ability for step in order.running):
            self._end_operator_plan("", now, done=True)
        elif (what := self._trial_overdue(now)) is not None:
            called_off = self._break_off(ability, now)
            self._end_operator_plan(message("ended.late", ability=title, late=what.words()), now)
            return called_off
        return ()

    def _trial_overdue(self, now: Timestamp) -> Late | None:
        """Say what has not come in time of the ability that is tried; None while it is in time, or nothing is tried."""
        tried = None if self.operator_plan is None else self.operator_plan.ability
        late = (
            overdue(step, self.automaton.abilities[step.ability], now.monotonic)
            for step in self.plan.order.running
            if step.ability == tried
        )
        return next((what for what in late if what is not None), None)

    def _break_off(self, ability: str, now: Timestamp) -> tuple[str, ...]:
        """Call off a run of an ability, where it says how that is done; otherwise the run goes on to its end. What was
        called off is returned.
        """
        if all(step.ability != ability for step in self.plan.order.running):
            return ()
        called_off = self._cancel((ability,))
        for name in called_off:
            self.plan.order.finish(name, now)
        return called_off

    def _start(self, now: Timestamp) -> tuple[str, ...]:
        """Step 5: the first abilities of the order start, as long as they may."""
        started: list[str] = []
        # An ability starts once in a tick, or its first command would never be published.
        while (
            self.conduct.may_start
            and not self.obstacles
            and self.plan.next_may_start(self._present, lambda name: None if name in started else self.startable(name))
        ):
            step = self.plan.start(now)
            self._run.start(step.ability)
            self.conduct = self.conduct.started_one()
            if self.operator_plan is None:
                self._operations = self._operations.moved(self._run.values, now)
            if self.automaton.abilities[step.ability].finish_guard is None:
                step.ended = now
            started.append(step.ability)
        return tuple(started)

    # What both have in common.

    def _change(self, **changes: object) -> None:
        """Another conduct, and what follows from it for plans."""
        self.conduct = replace(self.conduct, **changes)
        self._face()

    def _face(self) -> None:
        circumstances = self.conduct.circumstances(self.automaton)
        lookahead, curious = self._supervised, self._curious
        if self._is_free:
            lookahead, curious = self._free = self._free or (self._recovery_lookahead(), self._recovery_lookahead())
        if circumstances != self.circumstances or not self.plan.looks(lookahead):
            self.circumstances = circumstances
            lookahead.face(circumstances)
            curious.face(circumstances)
            self.plan.use_lookahead(lookahead)

    def _recovery_lookahead(self) -> Lookahead:
        """A look ahead from outside the safe states: whatever is to be reached is reached inside."""
        return Lookahead(self._compiled, _UNSUPERVISED, self.supervisor.safe)

    def drop_caches(self) -> None:
        """Drop what was remembered only to be quick, so that who goes on from a copy of this goes on the same way."""
        for each in (self._supervised, self._curious, *(self._free or ())):
            each.face(self.circumstances)

    def _write(self, values: Mapping[str, Value | None]) -> None:
        self._run.sense(values)
        self._run.synchronise()

    def _release(self, names: Sequence[str]) -> None:
        """Variables are forced no longer. An output stays as it is where what it would be is not safe any more."""
        ended = {name: force for name, force in self.conduct.forces.items() if name in names}
        if not ended:
            return
        self._change(forces={name: force for name, force in self.conduct.forces.items() if name not in ended})
        for name, force in ended.items():
            # What is measured is sensed with the next tick.
            if name in self.automaton.outputs and (not self.safe or self._is_safe_with({name: force.real})):
                self._write({name: force.real})

    def _is_safe_with(self, values: Mapping[str, Value | None]) -> bool:
        run = self._run.fork()
        run.sense(values)
        run.synchronise()
        return self.supervisor.safe.includes(run.values)

    def _call_off(self, now: Timestamp) -> tuple[str, ...]:
        """Take the cancel actions of all that runs, and return what was called off so.

        Forces end, and nothing is set in motion by that: a forced output is called off as an ability that writes it
        would be. Where none says how, it stays as it is.
        """
        forced = self.conduct.forces.keys() & self.automaton.outputs
        self._change(forces={})
        called_off, writes = cancelled(self.automaton, self.state, self.running())
        _, others = cancelled(self.automaton, self.state, writing(self.automaton, forced))
        self._write({name: value for name, value in others.items() if name in forced} | writes)
        for name in called_off:
            self.plan.order.finish(name, now)
        return called_off

    def _end_operator_plan(self, why: str, now: Timestamp, *, by: str | None = None, done: bool = False) -> None:
        operator_plan = self.operator_plan
        if operator_plan is not None:
            self._change(
                operator_plan=None,
                last_operator_plan=LastOperatorPlan(operator_plan.title, done, why, now, by, operator_plan.ability),
            )
            self.plan.drop(message("plan.taken-done") if done else message("plan.taken-ended", why=why))


# A running station: its course, and all that can happen to it.
#
# All that changes it is a happening, of which those who listen are told: the same happenings lead to the same state
# again, bit for bit. Whoever runs it brings measurements, plans and what people ask for, and carries out what a tick's
# outcome says.


class Executor(ExecutorBase):
    """A running station. `listeners` hear of each happening right after it."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, beginning: InitialState | None = None) -> None:
        super().__init__(automaton, supervisor, beginning)
        self.listeners: list[Callable[[Heard], None]] = []

    def tick(
        self,
        measured: Mapping[str, Value | None],
        now: Timestamp,
        obstacles: tuple[str, ...] = (),
        silent: frozenset[str] = frozenset(),
    ) -> TickOutcome:
        """One tick with the given measured values. One that raises has not happened: all is as it was before."""
        before = self.state
        kept = (self._run.state, self.published, self.active, self._operations, self.plan.copy(), self.conduct)
        kept_obstacles = self.obstacles
        try:
            self.obstacles = obstacles
            if silent != self.conduct.silent:
                self._change(silent=silent)
            outcome = self._tick(measured, now)
        except BaseException:
            self.state, self.published, self.active, self._operations, self.plan, self.conduct = kept
            self.obstacles = kept_obstacles
            self._face()
            self.drop_caches()
            raise
        self.ticks += 1
        if outcome.changed:
            self.revision += 1
        self._emit(Ticked(measured, obstacles, silent, now), before, outcome)
        return outcome

    def start_production(self) -> None:
        """From now on outputs are published; all of them at once, by whoever runs this."""
        before = self.state
        self._change(production=Production.STARTED, returned=frozenset())
        self.published = self.state
        self._emit(ProductionStarted(), before)

    def change_mode(self, mode: Mode, by: str, now: Timestamp) -> None:
        """Another mode. An operator plan ends with it, and holding calls off what runs."""
        before = self.state
        self._end_operator_plan(message("ended.mode", by=by, mode=message(f"mode.{mode}")), now, by=by)
        called_off = self._call_off(now) if mode is Mode.HOLD else ()
        restarts = Mode.RESTART in (mode, self.mode)
        # A step is for what can be seen now, and a wish to stop after the product for this mode; one that is reached
        # says why it is paused.
        stop = self.conduct.cycle_stop
        stays = stop is not None and stop.reached and (self.mode, mode) == (Mode.AUTOMATIC, Mode.PAUSED)
        self._change(mode=mode, steps=0, cycle_stop=stop if stays else None)
        if restarts:
            self.plan.drop(message("plan.in-restart" if mode is Mode.RESTART else "plan.restart-left"))
        self._emit(ModeChanged(mode, by, now), before, called_off=called_off)

    def call_off(self, by: str, now: Timestamp) -> None:
        """Call off what runs, and the operator plan; the mode stays."""
        before = self.state
        self._end_operator_plan(message("ended.hold", by=by), now, by=by)
        self._change(steps=0)
        called_off = self._call_off(now)
        self._emit(CalledOff(by, now), before, called_off=called_off)

    def set_cycle_stop(self, on: bool, by: str, why: str, now: Timestamp) -> None:
        """From now on nothing starts once the product that is in work is done, or things start as ever."""
        self._change(cycle_stop=CycleStop(by, why, now) if on else None)
        self._emit(CycleStopChanged(on, by, why, now), self.state)

    def set_stepping(self, on: bool) -> None:
        """From now on every start waits for a step, or none does."""
        self._change(stepping=on, steps=0)
        self._emit(SteppingChanged(on), self.state)

    def take_step(self) -> None:
        """One start may be taken."""
        self._change(steps=1)
        self._emit(StepTaken(), self.state)

    def set_service(self, of: ServiceKind, name: str, in_service: bool, by: str, why: str, now: Timestamp) -> None:
        """Take something out of service, or put it back."""
        service = {key: each for key, each in self.conduct.service.items() if key != (of, name)}
        if not in_service:
            service[of, name] = OutOfService(of, name, now, by, why)
        done = self.conduct.done - {name} if of is ServiceKind.OPERATION else self.conduct.done
        tried = {each: times for each, times in self.conduct.tried.items() if each != name}
        self._change(service=service, done=done, tried=tried)
        self._emit(ServiceChanged(of, name, in_service, by, why, now), self.state)

    def correct(
        self,
        values: Mapping[str, Value],
        by: str,
        why: str,
        now: Timestamp,
        taken_back: frozenset[str] = frozenset(),
    ) -> None:
        """Estimated variables have these values from now on; outputs too, before production is started.

        What was said of those in `taken_back` was taken back.
        """
        before = self.state
        forces = self.conduct.forces
        real = {name: replace(force, real=values[name]) for name, force in forces.items() if name in values}
        self._write({name: value for name, value in values.items() if name not in real})
        self._change(
            returned=self.conduct.returned - values.keys(),
            forces={**forces, **real} if real else forces,
            answers=answered(self.automaton, self.conduct.answers, values, self.state, taken_back),
        )
        self._emit(Corrected(values, by, why, now, taken_back), before)

    def confirm(self, names: frozenset[str], by: str, now: Timestamp) -> None:
        """A person has seen that these estimates are as believed."""
        self._change(answers=answered(self.automaton, self.conduct.answers, names, self.state))
        self._emit(Confirmed(names, by, now), self.state)

    def force(self, name: str, value: Value, until: Timestamp, by: str, why: str) -> None:
        """Let a measured variable or an output have a value until then; a measured one is sensed by the next tick."""
        before = self.state
        held = self.conduct.forces.get(name)
        real = before[name] if held is None else held.real
        self._change(forces={**self.conduct.forces, name: Force(value, until, by, why, real)})
        if name in self.automaton.outputs:
            self._write({name: value})
        self._emit(Forced(name, value, until, by, why), before)

    def release(self, name: str) -> None:
        """Let a forced variable be as it comes."""
        before = self.state
        self._release((name,))
        self._emit(ForceReleased(name), before)

    def start_operator_plan(self, operator_plan: OperatorPlan, now: Timestamp) -> None:
        """Carry out a plan that a person has taken."""
        self._end_operator_plan(message("ended.another"), now, by=operator_plan.by)
        self._change(operator_plan=operator_plan)
        self.plan.follow(
            operator_plan.plan,
            frozenset() if operator_plan.ability else frozenset({OPERATOR_PLAN}),
            operator_plan.title,
        )
        self._emit(OperatorPlanStarted(operator_plan, now), self.state)

    def stop_operator_plan(self, by: str, now: Timestamp) -> None:
        """Start no more of it. What is only tried is called off with it."""
        before, operator_plan = self.state, self.operator_plan
        tried = None if operator_plan is None else operator_plan.ability
        called_off = () if tried is None else self._break_off(tried, now)
        self._end_operator_plan(message("ended.stopped", by=by), now, by=by)
        self._emit(OperatorPlanStopped(by, now), before, called_off=called_off)

    # Its jobs. They advance with the next tick.

    def set_by_order(self, on: bool, by: str, why: str, now: Timestamp) -> None:
        """From now on the operations of work masters are active for jobs only, or whenever they can be."""
        self._change(jobs=replace(self.conduct.jobs, by_order=on))
        self._emit(ByOrderChanged(on, by, why, now), self.state)

    def accept_job(self, job: str, title: str, work_master: str, by: str, now: Timestamp) -> None:
        """Work a job of which there is none yet, and whose operations no other job under way has."""
        self._change(jobs=self.conduct.jobs.taking(Job(job, title, work_master, now)))
        self._emit(JobTaken(job, title, work_master, by, now), self.state)

    def sequence_jobs(self, waits: Waits, by: str, now: Timestamp) -> None:
        """Operations of jobs wait for these of others, which leads into no circle."""
        self._change(jobs=replace(self.conduct.jobs, waits=waits))
        self._emit(JobsSequenced(waits, by, now), self.state)

    def command_job(self, job: str, act: JobAct, by: str, why: str, now: Timestamp) -> None:
        """Pause, resume, stop or abort a job under way."""
        self._change(jobs=self.conduct.jobs.after_act(job, act, self.active, self.automaton, now))
        self._emit(JobCommanded(job, act, by, why, now), self.state)

    def forget_job(self, job: str, by: str, now: Timestamp) -> None:
        """Do not keep a job that has ended any longer."""
        self._change(jobs=self.conduct.jobs.forgetting(job))
        self._emit(JobForgotten(job, by, now), self.state)

    # Its plan.

    def request(self, deadline: float) -> PlanRequest | None:
        """Return what to ask the planner now, or None when there is nothing to ask or it would answer the same
        again.
        """
        request = self.plan.request(self._present, deadline) if self.conduct.executes_operations else None
        return self._record_request(request, Contract.FAST)

    def better(self, deadline: float) -> PlanRequest | None:
        """Return what to ask a planner that has nothing else to do; None when there is nothing that could become
        better.
        """
        request = self.plan.better(self._present, deadline) if self.conduct.executes_operations else None
        return self._record_request(request, Contract.MINIMAL)

    def adopt(self, request: PlanRequest, answer: PlanAnswer) -> bool:
        """Follow an answered plan, if it still fits the state. False when a new one must be asked for."""
        if not self.conduct.executes_operations:
            return True
        adopted = self.plan.adopt(self._present, request, answer)
        self._emit(Answered(answer), self.state)
        return adopted

    def unanswered(self, why: str, again: bool) -> None:
        """The planner could not answer. With `again` the same question is asked once more, else only another one."""
        self.plan.unanswered(why, again)
        self._emit(Unanswered(why, again), self.state)

    def explained(self, diagnosis: Diagnosis) -> None:
        """Take note of why there is no plan, as far as that was found."""
        self.plan.explained(diagnosis)
        self._emit(Explained(diagnosis), self.state)

    def _record_request(self, request: PlanRequest | None, contract: Contract) -> PlanRequest | None:
        if request is not None:
            self.asked = request
            self._emit(Asked(contract), self.state)
        return request

    def _emit(
        self,
        happening: Event,
        before: State,
        outcome: TickOutcome | None = None,
        called_off: tuple[str, ...] = (),
    ) -> None:
        if outcome is None and not isinstance(happening, Asked | Answered | Unanswered | Explained):
            self.revision += 1
        heard = Heard(happening, before, self.state, outcome, called_off)
        for listener in self.listeners:
            listener(heard)
