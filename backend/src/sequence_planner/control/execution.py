"""A running station: its course, and all that can happen to it.

All that changes it is a happening, of which those who listen are told: the same happenings lead to the same state
again, bit for bit. Whoever runs it brings measurements, plans and what people ask for, and carries out what a tick's
outcome says.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton, State
from sequence_planner.control.answers import answered
from sequence_planner.control.conduct import Beginning, Force, OutOfService
from sequence_planner.control.course import Course
from sequence_planner.control.errand import NAME as ERRAND
from sequence_planner.control.errand import Errand
from sequence_planner.control.happenings import (
    Answered,
    Asked,
    ByOrderChanged,
    CalledOff,
    Confirmed,
    Corrected,
    ErrandStopped,
    ErrandTaken,
    Explained,
    Forced,
    ForceReleased,
    Happening,
    JobCommanded,
    JobForgotten,
    JobsSequenced,
    JobTaken,
    ModeChanged,
    ProductionStarted,
    ServiceChanged,
    SteppingChanged,
    StepTaken,
    Ticked,
    Unanswered,
)
from sequence_planner.control.heard import Heard, TickOutcome
from sequence_planner.control.jobs import Job, JobAct, Waits
from sequence_planner.control.moment import Moment
from sequence_planner.control.vocabulary import Mode, Production, ServiceKind
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import replace
from sequence_planner.planning.plan import Contract, PlanAnswer, PlanRequest
from sequence_planner.planning.reasons.diagnosis import Diagnosis


class Execution(Course):
    """A running station. `listeners` hear of each happening right after it."""

    def __init__(self, automaton: Automaton, supervisor: Supervisor, beginning: Beginning | None = None) -> None:
        super().__init__(automaton, supervisor, beginning)
        self.listeners: list[Callable[[Heard], None]] = []

    def tick(
        self,
        measured: Mapping[str, Value | None],
        now: Moment,
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
            self.forget()
            raise
        self.ticks += 1
        if outcome.changed:
            self.revision += 1
        self._tell(Ticked(measured, obstacles, silent, now), before, outcome)
        return outcome

    def start_production(self) -> None:
        """From now on outputs are published; all of them at once, by whoever runs this."""
        before = self.state
        self._change(production=Production.STARTED, returned=frozenset())
        self.published = self.state
        self._tell(ProductionStarted(), before)

    def change_mode(self, mode: Mode, by: str, now: Moment) -> None:
        """Another mode. An errand ends with it, and holding calls off what runs."""
        before = self.state
        self._end_errand(f"{by} chose {mode}", now, by=by)
        if mode is Mode.HOLD:
            self._call_off(now)
        restarts = Mode.RESTART in (mode, self.mode)
        self._change(mode=mode, steps=0)  # a step is for what can be seen now
        if restarts:
            self.plan.drop("operations wait in restart mode" if mode is Mode.RESTART else "restart mode was left")
        self._tell(ModeChanged(mode, by, now), before)

    def call_off(self, by: str, now: Moment) -> None:
        """Call off what runs, and the errand; the mode stays."""
        before = self.state
        self._end_errand(f"{by} chose to hold", now, by=by)
        self._change(steps=0)
        self._call_off(now)
        self._tell(CalledOff(by, now), before)

    def set_stepping(self, on: bool) -> None:
        """From now on every start waits for a step, or none does."""
        self._change(stepping=on, steps=0)
        self._tell(SteppingChanged(on), self.state)

    def take_step(self) -> None:
        """One start may be taken."""
        self._change(steps=1)
        self._tell(StepTaken(), self.state)

    def set_service(self, of: ServiceKind, name: str, in_service: bool, by: str, why: str, now: Moment) -> None:
        """Take something out of service, or put it back."""
        service = {key: each for key, each in self.conduct.service.items() if key != (of, name)}
        if not in_service:
            service[of, name] = OutOfService(of, name, now, by, why)
        done = self.conduct.done - {name} if of is ServiceKind.OPERATION else self.conduct.done
        tried = {each: times for each, times in self.conduct.tried.items() if each != name}
        self._change(service=service, done=done, tried=tried)
        self._tell(ServiceChanged(of, name, in_service, by, why, now), self.state)

    def correct(
        self,
        values: Mapping[str, Value],
        by: str,
        why: str,
        now: Moment,
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
        self._tell(Corrected(values, by, why, now, taken_back), before)

    def confirm(self, names: frozenset[str], by: str, now: Moment) -> None:
        """A person has seen that these estimates are as believed."""
        self._change(answers=answered(self.automaton, self.conduct.answers, names, self.state))
        self._tell(Confirmed(names, by, now), self.state)

    def force(self, name: str, value: Value, until: Moment, by: str, why: str) -> None:
        """Let a measured variable or an output have a value until then; a measured one is sensed by the next tick."""
        before = self.state
        held = self.conduct.forces.get(name)
        real = before[name] if held is None else held.real
        self._change(forces={**self.conduct.forces, name: Force(value, until, by, why, real)})
        if name in self.automaton.outputs:
            self._write({name: value})
        self._tell(Forced(name, value, until, by, why), before)

    def release(self, name: str) -> None:
        """Let a forced variable be as it comes."""
        before = self.state
        self._release((name,))
        self._tell(ForceReleased(name), before)

    def take_errand(self, errand: Errand, now: Moment) -> None:
        """Carry out a plan that a person has taken."""
        self._end_errand("another was taken", now, by=errand.by)
        self._change(errand=errand)
        self.plan.carry_out(errand.plan, frozenset() if errand.ability else frozenset({ERRAND}), errand.title)
        self._tell(ErrandTaken(errand, now), self.state)

    def stop_errand(self, by: str, now: Moment) -> None:
        """Start no more of it. What is only tried is called off with it."""
        before, errand = self.state, self.errand
        if errand is not None and errand.ability is not None:
            self._break_off(errand.ability, now)
        self._end_errand(f"{by} stopped it", now, by=by)
        self._tell(ErrandStopped(by, now), before)

    # Its jobs. They advance with the next tick.

    def set_by_order(self, on: bool, by: str, why: str, now: Moment) -> None:
        """From now on the operations of work masters are active for jobs only, or whenever they can be."""
        self._change(jobs=replace(self.conduct.jobs, by_order=on))
        self._tell(ByOrderChanged(on, by, why, now), self.state)

    def take_job(self, job: str, title: str, work_master: str, by: str, now: Moment) -> None:
        """Work a job of which there is none yet, and whose operations no other job under way has."""
        self._change(jobs=self.conduct.jobs.taking(Job(job, title, work_master, now)))
        self._tell(JobTaken(job, title, work_master, by, now), self.state)

    def sequence_jobs(self, waits: Waits, by: str, now: Moment) -> None:
        """Operations of jobs wait for these of others, which leads into no circle."""
        self._change(jobs=replace(self.conduct.jobs, waits=waits))
        self._tell(JobsSequenced(waits, by, now), self.state)

    def command_job(self, job: str, act: JobAct, by: str, why: str, now: Moment) -> None:
        """Pause, resume, stop or abort a job under way."""
        self._change(jobs=self.conduct.jobs.told(job, act, self.active, self.automaton, now))
        self._tell(JobCommanded(job, act, by, why, now), self.state)

    def forget_job(self, job: str, by: str, now: Moment) -> None:
        """Do not keep a job that has ended any longer."""
        self._change(jobs=self.conduct.jobs.forgetting(job))
        self._tell(JobForgotten(job, by, now), self.state)

    # Its plan.

    def request(self, deadline: float) -> PlanRequest | None:
        """What to ask the planner now, or None when there is nothing to ask or it would answer the same again."""
        request = self.plan.request(self._present, deadline) if self.conduct.executes_operations else None
        return self._note_asked(request, Contract.FAST)

    def better(self, deadline: float) -> PlanRequest | None:
        """What to ask a planner that has nothing else to do; None when there is nothing that could become better."""
        request = self.plan.better(self._present, deadline) if self.conduct.executes_operations else None
        return self._note_asked(request, Contract.MINIMAL)

    def adopt(self, request: PlanRequest, answer: PlanAnswer) -> bool:
        """Follow an answered plan, if it still fits the state. False when a new one must be asked for."""
        if not self.conduct.executes_operations:
            return True
        adopted = self.plan.adopt(self._present, request, answer)
        self._tell(Answered(answer), self.state)
        return adopted

    def unanswered(self, why: str, again: bool) -> None:
        """The planner could not answer. With `again` the same question is asked once more, else only another one."""
        self.plan.unanswered(why, again)
        self._tell(Unanswered(why, again), self.state)

    def explained(self, diagnosis: Diagnosis) -> None:
        """Take note of why there is no plan, as far as that was found."""
        self.plan.explained(diagnosis)
        self._tell(Explained(diagnosis), self.state)

    def _note_asked(self, request: PlanRequest | None, contract: Contract) -> PlanRequest | None:
        if request is not None:
            self.asked = request
            self._tell(Asked(contract), self.state)
        return request

    def _tell(self, happening: Happening, before: State, outcome: TickOutcome | None = None) -> None:
        if outcome is None and not isinstance(happening, Asked | Answered | Unanswered | Explained):
            self.revision += 1
        heard = Heard(happening, before, self.state, outcome)
        for listener in self.listeners:
            listener(heard)
