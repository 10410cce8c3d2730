"""Jobs with alternatives and with what is done one at a time: one branch is taken, and the others are skipped."""

from __future__ import annotations

import pytest

from controller.bench_of_jobs import STATION, Bench
from sequence_planner.automaton.automaton import WorkMaster
from sequence_planner.controller.views.jobs import why_idle
from sequence_planner.core.immutable import replace
from sequence_planner.execution.vocabulary import ServiceKind

NONE: frozenset[str] = frozenset()


def active(on: Bench) -> frozenset[str]:
    """The active operations of the job."""
    return on.execution.active & on.execution.automaton.job_operations


def at_work(master: WorkMaster) -> Bench:
    """A station that works by order, with a job of this work master."""
    bench = Bench(replace(STATION, work_masters={master.name: master}))
    bench.by_order()
    bench.execution.start_production()
    bench.take("a", master.name)
    bench.tick()
    return bench


# Checked, or labelled and packed; then swept. What is filled allows the label.
ONE_OF = WorkMaster(
    "one_of",
    "One of",
    {
        "label_it": NONE,
        "pack_it": frozenset({"label_it"}),
        "check_it": NONE,
        "sweep": frozenset({"pack_it", "check_it"}),
    },
    alternatives=((frozenset({"label_it", "pack_it"}), frozenset({"check_it"})),),
)


def test_the_first_branch_that_can_begin_is_taken() -> None:
    on = at_work(ONE_OF)  # nothing is filled, so nothing is to be labelled
    assert active(on) == {"check_it"}
    assert on.steps("a") == {"label_it": "skipped", "pack_it": "skipped", "check_it": "active", "sweep": "waiting"}
    on.tick(checked=True)
    on.tick()
    assert active(on) == {"sweep"}
    on.tick(swept=True)
    assert on.jobs["a"].state == "ended"
    assert on.steps("a")["pack_it"] == "skipped"


def test_of_two_that_can_begin_in_one_tick_the_first_does() -> None:
    on = Bench(replace(STATION, work_masters={"one_of": ONE_OF}))
    on.by_order()
    on.correct({"content": "full"})
    on.execution.start_production()
    on.take("a", "one_of")
    on.tick()
    assert active(on) == {"label_it"}
    on.tick()
    assert on.steps("a") == {"label_it": "active", "pack_it": "waiting", "check_it": "skipped", "sweep": "waiting"}
    assert on.jobs["a"].steps["sweep"].waits_for == ["pack_it"]
    assert why_idle(on.execution, "check_it") == "another job that asks for it: for Job a another alternative is taken"


def test_what_is_out_of_service_leaves_its_turn_to_the_next() -> None:
    on = Bench(replace(STATION, work_masters={"one_of": ONE_OF}))
    on.by_order()
    on.correct({"content": "full"})
    on.execution.set_service(ServiceKind.OPERATION, "label_it", False, "Eva", "broken", on.now)
    on.execution.start_production()
    on.take("a", "one_of")
    on.tick()
    assert active(on) == {"check_it"}


def test_of_goals_that_hold_already_one_branch_counts() -> None:
    on = Bench(replace(STATION, work_masters={"one_of": ONE_OF}))
    on.by_order()
    on.execution.start_production()
    on.take("a", "one_of")
    on.tick(labelled=True, checked=True)
    on.tick()
    assert on.steps("a") == {"label_it": "completed", "pack_it": "active", "check_it": "skipped", "sweep": "waiting"}


def test_a_reset_lets_the_job_choose_again() -> None:
    on = at_work(ONE_OF)
    on.correct({"content": "full"})
    on.reset("check_it")
    on.tick()
    on.tick()
    assert on.steps("a")["label_it"] == "active"
    assert on.steps("a")["check_it"] == "skipped"


ONE_AT_A_TIME = WorkMaster(
    "turns",
    "Turns",
    {"check_it": NONE, "pack_it": NONE, "label_it": frozenset({"pack_it"}), "sweep": NONE},
    arbitrary=((frozenset({"check_it"}), frozenset({"pack_it", "label_it"})),),
)


def test_one_branch_waits_until_the_other_is_over() -> None:
    on = at_work(ONE_AT_A_TIME)
    assert active(on) == {"check_it", "sweep"}
    on.tick()
    assert on.jobs["a"].steps["pack_it"].waits_for == ["check_it"]
    assert (
        why_idle(on.execution, "pack_it") == f"what comes before it for Job a: {STATION.operations['check_it'].title}"
    )
    on.tick(checked=True, content="full")
    on.tick()
    assert active(on) == {"pack_it", "sweep"}
    on.correct({"content": "full"})
    on.tick(packed=True)
    on.tick()
    assert active(on) == {"label_it", "sweep"}


@pytest.mark.parametrize("act", ["stop", "abort"])
def test_it_ends_as_any_job(act: str) -> None:
    on = at_work(ONE_OF)
    on.tell("a", act)
    on.tick(checked=True)
    on.tick()
    assert on.jobs["a"].state == ("stopped" if act == "stop" else "aborted")
