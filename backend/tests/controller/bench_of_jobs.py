"""A small station for jobs: a product that is filled and checked, and one that is packed, told what is measured."""

from __future__ import annotations

from collections.abc import Mapping

from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import Automaton, WorkMaster
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.controller.commands.command import Command
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
from sequence_planner.controller.views.jobs import job_views
from sequence_planner.controller.views.station import JobView
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.state import OperatorPlan, OperatorPlanKind
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.syntax import TRUE
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Plan, PlanTick
from support.automata import Does, automaton, predicate_of

CONTENT = EnumerationType(("empty", "full"))
_WRITTEN = automaton(
    {
        "fill": Does(
            start=("pour := true",),
            enabled="not pour and not flows and content == empty",
            executing="pour and flows",
            finish="pour and flows and level",
            finally_=("pour := false", "content := full"),
        )
    },
    measured=dict.fromkeys(("flows", "level", "checked", "labelled", "packed", "swept"), (BOOLEAN, False)),
    output={"pour": (BOOLEAN, False)},
    estimated={"content": (CONTENT, "empty"), "boxed": (BOOLEAN, False)},
    effects={
        "runs": ("pour and not flows", ("flows := true",)),
        "is_full": ("flows and not level", ("level := true",)),
        "stops": ("not pour and flows", ("flows := false", "level := false")),
    },
    goals={
        "fill_it": "content == full",
        "check_it": "checked",
        "label_it": "labelled",
        "pack_it": "packed",
        "sweep": "swept",
    },
)
EMPTY = _WRITTEN.read_action("content := empty")
NOT_BOXED = _WRITTEN.read_action("boxed := false")
MASTERS = {
    "bottle": WorkMaster(
        "bottle",
        "A bottle",
        {
            "fill_it": frozenset(),
            "check_it": frozenset({"fill_it"}),
            "label_it": frozenset({"fill_it"}),
        },
        (EMPTY,),
    ),
    "box": WorkMaster("box", "A box", {"pack_it": frozenset()}, (NOT_BOXED,)),
    "crate": WorkMaster("crate", "A crate", {"pack_it": frozenset(), "label_it": frozenset({"pack_it"})}),
}
STATION = replace(
    _WRITTEN,
    operations={
        **_WRITTEN.operations,
        "check_it": replace(_WRITTEN.operations["check_it"], repeat=False),
        "label_it": replace(_WRITTEN.operations["label_it"], precondition=predicate_of(_WRITTEN, "content == full")),
    },
    work_masters=MASTERS,
)
SAFE = Supervisor(StateSet((), ()), {})
FOR_JOBS = frozenset(STATION.operations) - {"sweep"}


class Bench:
    """The station with its recorder; half a second passes with each tick."""

    def __init__(self, station: Automaton = STATION, supervisor: Supervisor = SAFE) -> None:
        self.execution = Executor(station, supervisor)
        self.desk = JobHandler(self.execution)
        self.records: list[RunRecord] = []
        self.seconds = 0.0
        self.measured: dict[str, Value | None] = dict.fromkeys(("flows", "level", "checked"), False)
        self.measured |= dict.fromkeys(("labelled", "packed", "swept"), False)
        RunRecorder(self.execution, self._write, model_digest(station), None, lambda: self.now.epoch, 20)

    def _write(self, kind: str, time: float, content: str) -> int:
        self.records.append(RunRecord(len(self.records) + 1, time, kind, content, ""))
        return len(self.records)

    @property
    def now(self) -> Timestamp:
        return Timestamp(1000.0 + self.seconds, self.seconds)

    @property
    def jobs(self) -> dict[str, JobView]:
        return job_views(self.execution)

    def steps(self, job: str) -> dict[str, str]:
        """The state of each operation of a job."""
        return {name: str(step.state) for name, step in self.jobs[job].steps.items()}

    def ask(self, command: Command) -> None:
        carry_out(self.desk, command, self.now)

    def by_order(self, on: bool = True) -> None:
        self.ask(SetByOrder(actor=SYSTEM, on=on, reason="so"))

    def take(self, job: str, work_master: str) -> None:
        self.ask(TakeJob(actor=SYSTEM, job=job, title=f"Job {job}", work_master=work_master))

    def tell(self, job: str, what: str) -> None:
        self.ask(CommandJob.model_validate({"actor": SYSTEM, "job": job, "what": what}))

    def forget(self, job: str) -> None:
        self.ask(ForgetJob(actor=SYSTEM, job=job))

    def sequence(self, *pairs: tuple[str, str]) -> None:
        """Pairs such as `b/pack_it` and `a/check_it`: the one is to wait for the other."""
        waits = []
        for pair in pairs:
            (job, operation), (other, before) = (each.split("/") for each in pair)
            waits.append(JobWait(job=job, operation=operation, for_=[JobOperation(job=other, operation=before)]))
        self.ask(SequenceJobs(actor=SYSTEM, waits=waits))

    def correct(self, values: Mapping[str, Value]) -> None:
        self.execution.correct(values, "Eva", "as seen", self.now)

    def reset(self, operation: str) -> None:
        """A reset that has nothing to do: it is done in the next tick."""
        plan = Plan((PlanTick((), ()), PlanTick((), ())), False, False)
        operator_plan = OperatorPlan(
            OperatorPlanKind.RESET, "reset", plan, TRUE, operation=operation, by="Eva", taken=self.now
        )
        self.execution.start_operator_plan(operator_plan, self.now)

    def tick(self, **measured: Value | None) -> None:
        self.measured |= measured
        self.seconds += 0.5
        self.execution.tick(self.measured, self.now)

    def ticks(self, number: int = 3, **measured: Value | None) -> None:
        for _ in range(number):
            self.tick(**measured)

    def plan(self) -> None:
        request = self.execution.request(20)
        assert request is not None
        self.execution.adopt(request, Planner(STATION, SAFE).answer(request))
