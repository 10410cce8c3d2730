"""The laws of jobs, whatever is asked for and measured in whatever order."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from typing import TypeVar

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from controller.bench_of_jobs import FOR_JOBS, MASTERS, STATION, Bench
from sequence_planner.controller import restore
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.jobs import Job, Jobs
from sequence_planner.execution.record.codec import BEGUN, SNAPSHOT
from sequence_planner.execution.record.replay import Player
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.types import Value
from support.examples import examples

MEASURED = ("flows", "level", "checked", "labelled", "packed", "swept")
NUMBERS = st.integers(0, 11)  # picks one of what there is
MODES = (Mode.AUTOMATIC, Mode.PAUSED, Mode.RESTART)

T = TypeVar("T")


def picked(options: Sequence[T], number: int) -> T:
    """One of them."""
    return options[number % len(options)]


class Orders(RuleBasedStateMachine):
    """Somebody orders jobs and corrects what is believed, while devices say anything."""

    def __init__(self) -> None:
        super().__init__()
        self.on = Bench()
        self.on.by_order()
        self.over: dict[str, Job] = {}  # as they ended
        self.completed: dict[tuple[str, str], Timestamp] = {}
        self.reset: set[str] = set()  # jobs in which something was
        self.resetting: str | None = None
        self.ordered = 0

    @property
    def jobs(self) -> Jobs:
        return self.on.execution.conduct.jobs

    @initialize(started=st.sampled_from([True, True, True, False]))
    def begin(self, started: bool) -> None:
        if started:
            self.on.execution.start_production()

    @property
    def possible(self) -> list[str]:
        """The work masters of which a job could be taken now."""
        busy = {name for job in self.jobs.under_way for name in MASTERS[job.work_master].operations}
        return [name for name, master in MASTERS.items() if busy.isdisjoint(master.operations)]

    @precondition(lambda self: self.possible)
    @rule(number=NUMBERS)
    def take(self, number: int) -> None:
        self.on.by_order()
        self.ordered += 1
        self.on.take(f"job-{self.ordered}", picked(self.possible, number))

    @precondition(lambda self: self.jobs.under_way)
    @rule(master=st.sampled_from(sorted(MASTERS)))
    def take_what_may_be_in_the_way(self, master: str) -> None:
        with contextlib.suppress(CommandRefused):
            self.on.take(f"job-{self.ordered + 1}", master)
            self.ordered += 1

    @precondition(lambda self: self.jobs.under_way)
    @rule(number=NUMBERS, what=st.sampled_from(["resume", "resume", "pause", "stop", "abort"]))
    def tell(self, number: int, what: str) -> None:
        self.on.tell(picked(self.jobs.under_way, number).id, what)

    @precondition(lambda self: self.jobs.under_way)
    @rule(pairs=st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=2))
    def sequence(self, pairs: list[tuple[int, int]]) -> None:
        """What is not active yet waits for what is not completed yet, of another job or the same."""
        if "box" in self.possible:
            self.ordered += 1
            self.on.take(f"job-{self.ordered}", "box")
        steps = [(job, name) for job in self.jobs.under_way for name in MASTERS[job.work_master].operations]
        later = [f"{job.id}/{name}" for job, name in steps if name not in {*job.started, *job.completed}]
        sooner = [f"{job.id}/{name}" for job, name in steps if name not in job.completed]
        if later:
            with contextlib.suppress(CommandRefused):
                self.on.sequence(*((picked(later, one), picked(sooner, other)) for one, other in pairs))
            self._tick({})

    @precondition(lambda self: self.over)
    @rule(number=NUMBERS)
    def forget(self, number: int) -> None:
        job = picked(sorted(self.over), number)
        self.on.forget(job)
        self.over.pop(job)
        self.reset.discard(job)
        self.completed = {step: at for step, at in self.completed.items() if step[0] != job}

    @precondition(lambda self: not self.jobs.under_way)
    @rule()
    def work_freely(self) -> None:
        self.on.by_order(False)

    @rule(mode=st.sampled_from(MODES))
    def change_mode(self, mode: Mode) -> None:
        self.on.execution.change_mode(mode, "Eva", self.on.now)

    @precondition(lambda self: self.on.execution.operator_plan is None and self.completed)
    @rule(number=NUMBERS)
    def reset_operation(self, number: int) -> None:
        self.resetting = picked(sorted(self.completed), number)[1]
        self.on.reset(self.resetting)

    @rule(values=st.fixed_dictionaries({name: st.sampled_from([True, False, None]) for name in MEASURED}))
    def tick(self, values: dict[str, Value | None]) -> None:
        self._tick(values)

    @rule(full=st.booleans(), goals=st.sets(st.sampled_from(["checked", "labelled", "packed"])))
    def work(self, full: bool, goals: set[str]) -> None:
        """Something is done by hand, and undone; then there is time to see it."""
        self.on.correct({"content": "full" if full else "empty"})
        self._tick({name: name in goals for name in ("checked", "labelled", "packed")})
        self._tick({})

    def _tick(self, values: dict[str, Value | None]) -> None:
        self._before = self.jobs
        self.on.tick(**values)
        self._follow()

    def _follow(self) -> None:
        jobs, operator_plan = self.jobs, self.on.execution.operator_plan
        reset, self.resetting = (self.resetting, None) if operator_plan is None else (None, self.resetting)
        for job in jobs.taken:
            before = self._before.get(job.id)
            assert before is not None, "a tick takes no job"
            gone = before.completed.keys() - job.completed.keys()
            assert gone <= {reset}, "only what is reset is open again"
            if gone:
                self.reset.add(job.id)
                self.completed.pop((job.id, str(reset)))
            for name, at in job.completed.items():
                assert self.completed.setdefault((job.id, name), at) == at, "it is completed once"
            if job.id not in self.reset:
                self._require_order(job)
                was = before.started.keys() | before.completed.keys()
                for name in (job.started.keys() | job.completed.keys()) - was:
                    self._require_turn((job.id, name))

    def _require_turn(self, step: tuple[str, str]) -> None:
        for id_, name in self._before.waits.get(step, ()):
            other = self._before.get(id_)
            assert other is None or not other.under_way or name in other.completed, "it was not its turn"

    @staticmethod
    def _require_order(job: Job) -> None:
        for name, before in MASTERS[job.work_master].operations.items():
            if name in job.completed:
                assert before <= job.completed.keys(), "what comes first is completed"
                at = job.completed[name].monotonic
                assert all(job.completed[each].monotonic < at for each in before), "and was so before"
            if name in job.started:
                assert before <= job.completed.keys()

    @invariant()
    def nothing_changes_what_is_over(self) -> None:
        for job in self.jobs.taken:
            if not job.under_way:
                assert self.over.setdefault(job.id, job) == job

    @invariant()
    def only_what_a_job_asks_for_is_active(self) -> None:
        execution, jobs = self.on.execution, self.jobs
        if jobs.by_order:
            eligible = {name for job in jobs.under_way for name in jobs.eligible(job, STATION)}
            last = self.on.records[-1].kind
            if last == "ticked":  # what somebody asks for is done with the next tick
                assert execution.active & FOR_JOBS <= eligible
        else:
            assert not jobs.under_way

    @invariant()
    def no_two_jobs_have_an_operation_in_common(self) -> None:
        names = [name for job in self.jobs.under_way for name in MASTERS[job.work_master].operations]
        assert len(names) == len(set(names))

    def teardown(self) -> None:
        """It is replayed bit for bit, and what a start of the controller knows of it are the same jobs."""
        player = Player(STATION, self.on.execution.supervisor)
        for record in self.on.records:
            assert player.play(record) is None
        whole = max(n for n, each in enumerate(self.on.records) if each.kind in (BEGUN, SNAPSHOT))
        for first in (0, whole):
            known = restore._Known(self.on.records[first])
            for record in self.on.records[first + 1 :]:
                if record.kind not in (BEGUN, SNAPSHOT):
                    known.take(record)
            found = known.restored(STATION, self.on.now)
            assert found.left_out == ()
            assert found.beginning.jobs == self.jobs


TestOrders = Orders.TestCase
TestOrders.settings = examples(100)
