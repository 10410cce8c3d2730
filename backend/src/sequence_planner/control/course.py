"""A station's course from tick to tick: its state, how it is to execute, its plan, and the tick that leads on.

Pure: it has no clock, does no I/O and starts nothing but in its own state. `execution` is what is made of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from sequence_planner.automaton.compiled import CompiledRun, CompiledTick
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.structure import Automaton, Kind, State
from sequence_planner.automaton.tick import reverts
from sequence_planner.control.answers import still_to_rely_on
from sequence_planner.control.bringing import kept_back, lacking, still_written
from sequence_planner.control.cancelling import cancelled
from sequence_planner.control.conduct import Beginning, Conduct, LastErrand, writing
from sequence_planner.control.errand import NAME as ERRAND
from sequence_planner.control.errand import Errand
from sequence_planner.control.heard import TickOutcome
from sequence_planner.control.jobs import Job
from sequence_planner.control.live_plan import LivePlan, Present
from sequence_planner.control.moment import Moment
from sequence_planner.control.pursued import Pursued
from sequence_planner.control.timeouts import after_another_try, overdue, to_call_off
from sequence_planner.control.vocabulary import Mode, Production
from sequence_planner.expressions.evaluation import holds
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.plan import Circumstances, PlanRequest
from sequence_planner.planning.replaying.lookahead import Lookahead

_UNSUPERVISED = Supervisor(StateSet((), ()), {})


class Course:
    """The course of a running station. `beginning` is what is known of it from before."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, beginning: Beginning | None = None) -> None:
        self.automaton = automaton
        self.supervisor = supervisor
        self._compiled = CompiledTick(automaton)
        # What a look ahead says can depend on what was looked at before. So whoever is only curious has one of his own.
        self._supervised = Lookahead(self._compiled, supervisor)
        self._curious = Lookahead(self._compiled, supervisor)
        self._free: tuple[Lookahead, Lookahead] | None = None  # the same without the supervisor; made when needed
        self.conduct = Conduct()
        known: Mapping[str, Value] = {}
        if beginning is not None:
            known = beginning.values
            service = {(each.of, each.name): each for each in beginning.service}
            returned = automaton.outputs & known.keys()
            self.conduct = Conduct(
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
        self._operations = Pursued()  # what is pursued of them, also while there is something else to do
        self.plan = LivePlan(automaton, self._supervised)
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
        """Whether outputs are published."""
        return self.conduct.production

    @property
    def errand(self) -> Errand | None:
        """What is carried out beside the operations, which wait for it."""
        return self.conduct.errand

    @property
    def pursued(self) -> Pursued:
        """What plans are made for: the goals of active operations, or that of an errand."""
        if self.errand is not None:
            return Pursued() if self.errand.ability else Pursued({ERRAND: self.errand.pursued})
        return self._operations

    @property
    def safe(self) -> bool:
        """Whether the state is in the safe set for every value its unknown variables could have."""
        return self.supervisor.safe.includes(self.state)

    @property
    def blind(self) -> bool:
        """Whether some measured variable has no value."""
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

    def is_due(self, now: Moment) -> bool:
        """Whether time alone makes a difference in the next tick: a force ends, or what runs is to be called off."""
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
        """What has to be otherwise before what the product of this job brings can be so, in words."""
        master = self.automaton.work_masters[job.work_master]
        found = list(still_written(self.automaton, master, self.running()))
        if brought := lacking(master, self.state):
            found = [*kept_back(self.conduct), *found]
            if not found and not self._is_safe_with(brought):
                found = ["a state that stays safe with what the product brings"]
        return tuple(found)

    def may_go_on(self, name: str) -> bool:
        """Whether the order still reaches the goals once its first ability, `name`, has been started now."""
        after = self.startable(name)
        if after is None:
            return False
        curious = self._curious if self._free is None or not self._is_free else self._free[1]
        return self.plan.may_go_on(self._present, after, curious)

    def _allows(self, after: State) -> bool:
        """Whether a start may lead to `after`. From outside the safe states only one that a person confirmed may."""
        before = self._run.values
        if self.supervisor.allows(before, after):
            return True
        return self.errand is not None and self.errand.unsupervised and not self.supervisor.safe.includes(before)

    @property
    def _present(self) -> Present:
        confirmed = self.errand is not None
        return Present(self._run, self.published, self.pursued, self.circumstances, confirmed)

    @property
    def _is_free(self) -> bool:
        """Whether what is carried out has still to come into the safe states, outside which no supervisor speaks."""
        return self.errand is not None and (self.errand.unsupervised or self.errand.into_safe)

    # How a tick is taken.

    def _tick(self, measured: Mapping[str, Value | None], now: Moment) -> TickOutcome:
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
        called_off, given_up = self._look_after_running(ended, now)
        activated, completed = self._update_operations(now)
        self._look_after_errand(now)
        self._heed_supervisor()
        started = self._start(now)
        self._heed_supervisor()
        self._heed_answers(started)
        self._look_at_plan(now)
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

    def _begin_jobs(self, now: Moment) -> None:
        """What the products of new jobs bring is so from now on, where nothing is in the way: as after a correction."""
        for job in self.conduct.jobs.under_way:
            if job.may_begin and not self.keeps_from_beginning(job):
                master = self.automaton.work_masters[job.work_master]
                self._write(lacking(master, self.state))
                done = self.conduct.done - master.operations.keys()
                self._change(jobs=self.conduct.jobs.having_begun(job.id, now), done=done)

    def _look_after_running(self, ended: tuple[str, ...], now: Moment) -> tuple[tuple[str, ...], tuple[str, ...]]:
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

    def _overdue(self, now: Moment) -> Mapping[str, str]:
        """The abilities that are to be called off because they are overdue, each with what has not come in time."""
        return to_call_off(self.automaton, self.plan.order, now) if self.conduct.executes_operations else {}

    def _update_operations(self, now: Moment) -> tuple[frozenset[str], frozenset[str]]:
        """Step 4: the operations that are activated by it, and those that are completed."""
        idle = self.conduct.idle_operations(self.automaton)
        active = self._run.update_operations(self.active)
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
        if self.errand is None:
            self.plan.settle(active, self._operations.hopeful)
        return activated, completed

    def _advance_jobs(self, active: frozenset[str], now: Moment) -> frozenset[str]:
        """What was eligible for a job in step 4 has begun, or is completed where its goal holds: the latter."""
        before, operations, values = self.conduct.jobs, self.automaton.operations, self._run.values
        after = before.advanced(self.automaton, active, lambda name: holds(operations[name].goal, values), now)
        if after is before:
            return frozenset()
        self._change(jobs=after)
        pairs = zip(before.taken, after.taken, strict=True)
        return frozenset(name for old, new in pairs for name in new.completed.keys() - old.completed.keys())

    def _look_after_errand(self, now: Moment) -> None:
        """An errand whose goal holds is done; with it an operation that is reset begins anew."""
        errand = self.errand
        if errand is None or errand.ability is not None or not holds(errand.goal, self._run.values):
            return
        if errand.into_safe and not self.safe:
            return
        if errand.operation is not None:
            jobs = self.conduct.jobs.reopened(errand.operation, self.automaton)
            self._change(done=self.conduct.done - {errand.operation}, jobs=jobs)
            # What comes after it in a job has to wait for it again.
            withdrawn = {errand.operation} | (self.active & self.conduct.idle_operations(self.automaton))
            self.active -= withdrawn
            self._operations = self._operations.without(withdrawn)
            self._run.record_activity(self.active)
        self._end_errand("", now, done=True)

    def _heed_supervisor(self) -> None:
        """From the first safe state on an errand goes by the supervisor, also when something becomes unknown later."""
        if self.errand is not None and self._is_free and self.safe:
            self._change(errand=replace(self.errand, unsupervised=False, into_safe=False))

    def _heed_answers(self, started: Iterable[str]) -> None:
        """What a person has said counts until it is another by now, or operations go on with what they rely on."""
        answers = self.conduct.answers
        if not answers:
            return
        if self.errand is None:
            abilities = (self.automaton.abilities[name] for name in started)
            answers = still_to_rely_on(self.automaton, answers, abilities)
        answers = {name: value for name, value in answers.items() if self._run.values[name] == value}
        if answers != self.conduct.answers:
            self.conduct = replace(self.conduct, answers=answers)

    def _look_at_plan(self, now: Moment) -> None:
        """Notice that the plan is done with, or that the state has departed from it."""
        if self.conduct.executes_operations:
            self.plan.look(self._present, self.active)
        elif self.errand is not None and self.errand.ability is not None:
            self._look_after_trial(self.errand.ability, now)
        elif self.errand is not None and not self.blind and not self.plan.still_leads(self._present):
            self._end_errand("the station departed from it, so that it no longer led to its goal", now)

    def _look_after_trial(self, ability: str, now: Moment) -> None:
        """A trial starts in the first tick after it was taken, and is over when its run is, or when that is overdue."""
        title, order = self.automaton.abilities[ability].title, self.plan.order
        if order.ahead:
            self._end_errand(f"{title} could not start any more", now)
        elif all(step.ability != ability for step in order.running):
            self._end_errand("", now, done=True)
        elif (what := self._trial_overdue(now)) is not None:
            self._break_off(ability, now)
            self._end_errand(f"{title} {what}", now)

    def _trial_overdue(self, now: Moment) -> str | None:
        """What has not come in time of the ability that is tried; None while it is in time, or nothing is tried."""
        tried = None if self.errand is None else self.errand.ability
        late = (
            overdue(step, self.automaton.abilities[step.ability], now.monotonic)
            for step in self.plan.order.running
            if step.ability == tried
        )
        return next((what for what in late if what is not None), None)

    def _break_off(self, ability: str, now: Moment) -> None:
        """Call off a run of an ability, where it says how that is done; otherwise the run goes on to its end."""
        if any(step.ability == ability for step in self.plan.order.running):
            for name in self._cancel((ability,)):
                self.plan.order.finish(name, now)

    def _start(self, now: Moment) -> tuple[str, ...]:
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
            if self.errand is None:
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
            lookahead, curious = self._free = self._free or (self._look_out(), self._look_out())
        if circumstances != self.circumstances or not self.plan.looks(lookahead):
            self.circumstances = circumstances
            lookahead.face(circumstances)
            curious.face(circumstances)
            self.plan.look_with(lookahead)

    def _look_out(self) -> Lookahead:
        """A look ahead from outside the safe states: whatever is to be reached is reached inside."""
        return Lookahead(self._compiled, _UNSUPERVISED, self.supervisor.safe)

    def forget(self) -> None:
        """Drop what was remembered only to be quick, so that who goes on from a copy of this goes on the same way."""
        self._supervised.face(self.circumstances)
        if self._free is not None:
            self._free[0].face(self.circumstances)

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

    def _call_off(self, now: Moment) -> None:
        """Take the cancel actions of all that runs.

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

    def _end_errand(self, why: str, now: Moment, *, by: str | None = None, done: bool = False) -> None:
        errand = self.errand
        if errand is not None:
            self._change(errand=None, last_errand=LastErrand(errand.title, done, why, now, by, errand.ability))
            self.plan.drop("what was taken is done" if done else f"what was taken has ended: {why}")
