"""Jobs: when they begin, what they make active, how they end, and what is said of it."""

from __future__ import annotations

import asyncio
import json

import pytest
from pydantic import TypeAdapter

from controller.bench_of_jobs import STATION, Bench
from controller.test_why_not import Inquirer, found
from sequence_planner.automaton.automaton import Automaton, Specification
from sequence_planner.controller import restore
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.jobs import (
    CommandJob,
    JobOperation,
    JobWait,
    SequenceJobs,
    SetByOrder,
    TakeJob,
)
from sequence_planner.controller.commands.registry import AnyCommand
from sequence_planner.controller.features.records import KeptJobs
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.planner_client import AdvisorClient
from sequence_planner.controller.views.jobs import job_views, why_idle
from sequence_planner.core.actor import SYSTEM, ActorKind
from sequence_planner.core.immutable import replace
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import predicate_of
from support.people import EVA, person

BOTTLE = ("fill_it", "check_it", "label_it")


@pytest.fixture
def on() -> Bench:
    """At work, by order."""
    bench = Bench()
    bench.by_order()
    bench.execution.start_production()
    bench.tick()
    return bench


def refused(slug: str) -> pytest.RaisesExc[CommandRefused]:
    return pytest.RaisesExc(CommandRefused, check=lambda error: error.slug == slug)


def test_a_station_that_works_freely_is_active_wherever_it_can() -> None:
    on = Bench()
    on.execution.start_production()
    on.tick()
    assert on.execution.active == {"fill_it", "check_it", "pack_it", "sweep"}
    with refused("not-in-job-mode"):
        on.take("a", "bottle")
    on.by_order()
    on.tick()
    assert on.execution.active == {"sweep"}, "what is in no work master goes on"
    on.by_order(False)
    on.tick()
    assert on.execution.active == {"fill_it", "check_it", "pack_it", "sweep"}


def test_operations_are_active_in_their_order_and_the_job_ends_with_the_last(on: Bench) -> None:
    on.take("a", "bottle")
    on.tick()
    assert on.jobs["a"].state == "running"
    assert on.steps("a") == {"fill_it": "active", "check_it": "waiting", "label_it": "waiting"}
    assert on.jobs["a"].steps["label_it"].waits_for == ["fill_it"]
    on.correct({"content": "full"})
    on.ticks(2)
    assert on.steps("a") == {"fill_it": "completed", "check_it": "active", "label_it": "active"}
    on.tick(checked=True)
    on.tick(checked=False)
    assert on.steps("a")["check_it"] == "completed", "and stays so"
    assert "check_it" not in on.execution.active
    on.tick(labelled=True)
    view = on.jobs["a"]
    assert view.state == "ended"
    assert view.ended == on.now.epoch
    assert [step.started is not None and step.ended is not None for step in view.steps.values()] == [True] * 3
    assert on.execution.active == {"sweep"}


def test_where_there_is_nothing_to_do_an_operation_is_completed_without_being_active(on: Bench) -> None:
    on.take("a", "crate")
    on.ticks(3, packed=True, labelled=True)
    view = on.jobs["a"]
    assert view.state == "ended"
    assert [(step.started, step.ended) for step in view.steps.values()] == [(None, 1001.0), (None, 1001.5)]


def test_what_cannot_be_active_yet_is_eligible(on: Bench) -> None:
    on.take("a", "crate")
    on.ticks(3, packed=True)
    assert on.steps("a") == {"pack_it": "completed", "label_it": "eligible"}
    on.correct({"content": "full"})
    on.tick()
    assert on.steps("a")["label_it"] == "active"


def test_what_a_product_brings_waits_for_production_the_mode_and_errands() -> None:
    on = Bench()
    on.by_order()
    on.correct({"content": "full"})
    on.take("a", "bottle")
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    on.tick()
    assert on.jobs["a"].state == "waiting"
    assert on.jobs["a"].waits_for == ["production to be started", "automatic mode"]
    on.execution.start_production()
    on.reset("pack_it")
    assert on.jobs["a"].waits_for == ["automatic mode", "the end of what is carried out: reset"]
    on.tick()
    on.execution.change_mode(Mode.AUTOMATIC, "Eva", on.now)
    assert on.jobs["a"].waits_for == []
    beliefs = Beliefs(on.execution)
    on.tick()
    assert on.jobs["a"].state == "running"
    assert on.execution.state["content"] == "empty"
    assert beliefs.of("content").writer == "job a"
    record = next(json.loads(each.content) for each in reversed(on.records) if '"begun"' in each.content)
    assert record["changes"] == {"content": "empty"}, "what it brought and that it began is one record"


def test_where_what_it_brings_is_so_it_begins_in_any_mode() -> None:
    on = Bench()
    on.by_order()
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    on.take("a", "bottle")
    on.tick()
    assert on.jobs["a"].state == "running"
    assert "production to be started" in on.jobs["a"].waits_for
    assert "automatic mode: the station is paused" in on.jobs["a"].waits_for


def test_a_run_that_decides_on_what_is_brought_belongs_to_the_product_before(on: Bench) -> None:
    on.take("a", "bottle")
    on.tick()
    on.plan()
    on.ticks(2)
    on.tick(flows=True)
    assert on.execution.running() == {"fill"}
    on.tell("a", "abort")
    on.take("b", "bottle")
    on.ticks()
    assert on.jobs["b"].waits_for == ["the end of “fill”"]
    on.tick(level=True)
    on.tick(flows=False, level=False)
    assert on.jobs["b"].state == "running"
    assert on.steps("b")["fill_it"] == "active", "the bottle that was filled last is not this one"


def test_a_product_is_brought_only_where_that_is_safe() -> None:
    forbidden = predicate_of(STATION, "boxed and content == empty")
    strict = replace(STATION, specifications={"no": Specification("no", "No empty boxes", forbidden)})
    on = Bench(strict, synthesise(strict))
    on.by_order()
    on.correct({"content": "full", "boxed": True})
    on.execution.start_production()
    on.take("a", "bottle")
    on.ticks()
    assert on.jobs["a"].waits_for == ["a state that stays safe with what the product brings"]
    on.correct({"boxed": False})
    on.tick()
    assert on.jobs["a"].state == "running"


def test_what_is_done_once_is_done_for_each_job(on: Bench) -> None:
    for job in ("a", "b"):
        on.take(job, "bottle")
        on.tick(checked=False, labelled=False)
        assert on.jobs[job].state == "running"
        on.correct({"content": "full"})
        on.ticks(2)
        assert "check_it" in on.execution.active
        on.ticks(2, checked=True, labelled=True)
        assert on.jobs[job].state == "ended"
        assert "check_it" in on.execution.conduct.done


def test_jobs_that_have_something_in_common_are_worked_one_after_the_other(on: Bench) -> None:
    on.take("a", "bottle")
    on.take("a", "bottle")
    on.take("b", "box")
    for slug, job, master in [
        ("job-conflict", "c", "bottle"),  # its operations
        ("job-conflict", "c", "crate"),  # one of them
        ("job-conflict", "a", "box"),  # the id
        ("unknown-work-master", "c", "barrel"),
    ]:
        with refused(slug):
            on.take(job, master)
    on.ticks()
    assert list(on.jobs) == ["a", "b"]
    assert on.execution.active == {"fill_it", "pack_it", "sweep"}
    on.tell("a", "abort")
    on.take("a", "bottle")
    assert on.jobs["a"].state == "aborted", "it is not taken again"
    on.take("c", "bottle")
    on.tick()
    assert on.jobs["c"].state == "running"


def test_a_job_is_paused_and_goes_on(on: Bench) -> None:
    on.take("a", "bottle")
    on.tick()
    on.tell("a", "pause")
    records = len(on.records)
    on.tell("a", "pause")
    assert len(on.records) == records, "to repeat it changes nothing"
    on.tick()
    assert on.execution.active == {"sweep"}
    assert (on.jobs["a"].state, on.jobs["a"].waits_for) == ("paused", ["somebody to resume it"])
    on.correct({"content": "full"})
    on.ticks()
    assert on.steps("a")["fill_it"] == "waiting"
    on.tell("a", "resume")
    on.tick()
    assert on.steps("a")["fill_it"] == "completed"


def test_what_is_stopped_completes_what_is_active(on: Bench) -> None:
    on.take("a", "bottle")
    on.correct({"content": "full"})
    on.ticks(2)
    on.correct({"content": "full"})
    on.tick()
    on.tick(labelled=True)
    on.tell("a", "stop")
    assert on.jobs["a"].stopping
    on.ticks(2)
    assert on.jobs["a"].state == "running"
    assert on.execution.active == {"check_it", "sweep"}
    on.tick(checked=True)
    assert on.jobs["a"].state == "ended", "nothing was left"


def test_what_is_stopped_begins_nothing_more(on: Bench) -> None:
    on.take("a", "bottle")
    on.tick()
    on.tell("a", "stop")
    on.correct({"content": "full"})
    on.ticks()
    view = on.jobs["a"]
    assert (view.state, view.stopping, view.begun is not None) == ("stopped", False, True)
    assert on.steps("a") == {"fill_it": "completed", "check_it": "waiting", "label_it": "waiting"}
    assert on.execution.active == {"sweep"}
    for what in ("pause", "resume", "stop", "abort"):
        with refused("job-ended"):
            on.tell("a", what)


@pytest.mark.parametrize("before", ["nothing", "pause"])
def test_what_has_nothing_active_is_stopped_at_once(on: Bench, before: str) -> None:
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    on.correct({"content": "full"})
    on.take("a", "bottle")
    on.tick()
    if before == "pause":
        on.tell("a", "pause")
    on.tell("a", "stop")
    on.tick()
    assert on.jobs["a"].state == "stopped"
    assert on.execution.state["content"] == "full", "its product never came"


def test_what_is_aborted_is_withdrawn_and_forgotten_when_it_may_be(on: Bench) -> None:
    on.take("a", "bottle")
    on.tick()
    with refused("job-under-way"):
        on.forget("a")
    with refused("jobs-under-way"):
        on.by_order(False)
    on.tell("a", "abort")
    on.tick()
    assert on.jobs["a"].state == "aborted"
    assert on.execution.active == {"sweep"}
    on.forget("a")
    on.forget("a")
    assert on.jobs == {}
    with refused("unknown-job"):
        on.tell("a", "abort")


def test_an_operation_that_is_reset_is_open_again_and_it_alone(on: Bench) -> None:
    on.take("a", "bottle")
    on.tick()
    on.correct({"content": "full"})
    on.ticks(2, labelled=True)
    on.tick(labelled=False)
    on.correct({"content": "empty"})
    on.reset("fill_it")
    on.ticks(2)
    assert on.steps("a") == {"fill_it": "active", "check_it": "waiting", "label_it": "completed"}
    assert on.execution.active == {"fill_it", "sweep"}


def test_the_order_between_jobs_is_kept_as_long_as_both_are_there(on: Bench) -> None:
    on.take("a", "bottle")
    on.take("b", "box")
    on.sequence(("b/pack_it", "a/check_it"), ("b/pack_it", "nobody/check_it"), ("a/fill_it", "b/fill_it"))
    on.ticks()
    assert on.jobs["b"].steps["pack_it"].waits_for == ["a/check_it"]
    assert on.execution.active == {"fill_it", "sweep"}
    on.sequence(("b/pack_it", "a/check_it"), ("a/label_it", "a/check_it"), ("a/label_it", "a/fill_it"))
    assert on.jobs["a"].steps["label_it"].waits_for == ["check_it", "fill_it"]
    with refused("cyclic-order") as circle:
        on.sequence(("b/pack_it", "a/check_it"), ("a/fill_it", "b/pack_it"))
    assert circle.value.status == 422
    assert "a/fill_it" in circle.value.detail
    assert on.execution.active == {"fill_it", "sweep"}, "what was said before holds"
    on.tell("a", "abort")
    on.ticks(2)
    assert on.steps("b") == {"pack_it": "active"}
    on.sequence()
    assert on.execution.conduct.jobs.waits == {}


def test_why_an_operation_is_not_active(on: Bench) -> None:
    def why(operation: str) -> str | None:
        return why_idle(on.execution, operation)

    on.ticks()
    assert why("sweep") is None
    assert why("fill_it") == "a job that asks for it: the station works by order, and no job asks for it"
    on.correct({"content": "full"})
    on.execution.change_mode(Mode.PAUSED, "Eva", on.now)
    on.take("a", "bottle")
    assert why("fill_it") == "Job a to begin, which waits for automatic mode"
    on.execution.change_mode(Mode.AUTOMATIC, "Eva", on.now)
    on.take("b", "box")
    on.sequence(("b/pack_it", "a/check_it"))
    on.ticks(2)
    assert why("fill_it") is None
    assert why("check_it") == "what comes before it for Job a: fill_it"
    assert why("pack_it") == "what comes before it for Job b: “check_it” of job a"
    on.correct({"content": "full"})
    on.tick()
    assert why("fill_it") == "another job that asks for it: for Job a it is completed"
    on.tell("a", "pause")
    assert why("check_it") == "somebody to resume Job a"
    on.tell("a", "stop")
    assert why("check_it") == "another job that asks for it: Job a is being stopped"


def test_who_asks_why_not_is_told_of_the_job() -> None:
    async def scenario() -> None:
        on = Bench()
        advisor = AdvisorClient(STATION, on.execution.supervisor)
        try:
            asked = Inquirer(advisor, on.execution)
            on.by_order()
            on.execution.start_production()
            on.ticks(2)
            view = await asked.operation("check_it")
            assert found(view)[0] == (
                "order",
                "a job that asks for it: the station works by order, and no job asks for it",
            )
            on.take("a", "bottle")
            on.ticks(2)
            assert found(await asked.operation("check_it"))[0] == ("order", "what comes before it for Job a: fill_it")
            assert "order" not in dict(found(await asked.operation("fill_it")))
        finally:
            advisor.close()

    asyncio.run(scenario())


def test_how_a_job_stands_is_told_once_it_is_durable(on: Bench) -> None:
    kept = KeptJobs(on.execution, lambda: len(on.records))
    on.take("a", "box")
    taken = len(on.records)
    on.tick()
    begun = len(on.records)
    on.tick(packed=True)
    assert on.jobs["a"].state == "ended"
    for durable, state in ((taken, "waiting"), (begun, "running"), (len(on.records), "ended")):
        assert job_views(on.execution, kept.up_to(durable))["a"].state == state


def restored(on: Bench, model: Automaton) -> restore.Restored:
    known = restore._Known(on.records[0])
    for record in on.records[1:]:
        known.take(record)
    return known.restored(model, on.now)


def test_a_job_that_does_not_fit_another_model_is_aborted_and_said(on: Bench) -> None:
    on.take("a", "bottle")
    on.take("b", "box")
    on.correct({"content": "full"})
    on.ticks(2)
    known = restored(on, replace(STATION, work_masters={"bottle": STATION.work_masters["bottle"]}))
    assert known.left_out == ("job b was under way and is aborted: its work master box is not there any more",)
    a, b = known.beginning.jobs.taken
    assert (a.state, b.state) == ("running", "aborted")
    bottle = replace(STATION.work_masters["bottle"], operations={"check_it": frozenset(), "pack_it": frozenset()})
    known = restored(on, replace(STATION, work_masters={"bottle": bottle, "box": STATION.work_masters["box"]}))
    assert [each.split(",")[0] for each in known.left_out] == [
        "job a had fill_it",
        "job b was under way and is aborted: another job has pack_it too by now",
    ]


def test_commands_are_read_as_they_are_written() -> None:
    pairs = [JobWait(job="a", operation="x", for_=[JobOperation(job="b", operation="y")])]
    command = SequenceJobs(actor=SYSTEM, waits=pairs)
    written = command.model_dump_json()
    assert json.loads(written)["waits"] == [{"job": "a", "operation": "x", "for": [{"job": "b", "operation": "y"}]}]
    assert TypeAdapter[Command](AnyCommand).validate_json(written) == command
    with pytest.raises(ValueError, match="pattern"):
        TakeJob(actor=SYSTEM, job="a b", title="A", work_master="m")


def test_only_a_person_has_to_be_in_control_for_jobs_and_never_to_end_one() -> None:
    key = person("MES", kind=ActorKind.KEY)
    for actor, needs in ((EVA, True), (key, False), (SYSTEM, False)):
        assert TakeJob(actor=actor, job="a", title="A", work_master="m").needs_control is needs
        assert CommandJob(actor=actor, job="a", what="resume").needs_control is needs
        assert not CommandJob(actor=actor, job="a", what="abort").needs_control
        assert SetByOrder(actor=actor, on=True, reason="so").needs_control
