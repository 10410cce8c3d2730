"""Tasks for people: whoever acknowledges one says that this very task is done, and no other, ever."""

from __future__ import annotations

import pytest

from sequence_planner.automaton.automaton import State
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.tasks import (
    AcknowledgeTask,
    ReportProblem,
    SolveProblem,
    TaskProblem,
    WaitingTask,
)
from sequence_planner.controller.features.tasks import OpenTasks, TaskHandler
from sequence_planner.controller.views.station import TaskView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.texts.message import message
from support.people import EVA
from support.simulated import PAIRS, Rig, at_once, never, truck_engine

PLACE_1, PLACE_2 = (f"operator.place_bolt_pair({pair})" for pair in PAIRS[:2])
ACKNOWLEDGED = "operator.acknowledged"
NOW = Timestamp(6.0, 6.0)


def desk() -> TaskHandler:
    return TaskHandler(truck_engine()[0].automaton)


def executing(*names: str) -> State:
    abilities = truck_engine()[0].automaton.abilities
    return {a.flag("executing"): a.name in names for a in abilities.values()}


def only(tasks: TaskHandler) -> WaitingTask:
    (task,) = tasks.open.values()
    return task


def acknowledge(tasks: TaskHandler, id_: str, revision: int) -> None:
    tasks.acknowledge(AcknowledgeTask(actor=EVA, task=id_, revision=revision), NOW)


def waiting() -> tuple[Rig, WaitingTask]:
    """A station with a task that nobody acknowledges."""
    rig = Rig(acknowledges=never)
    rig.start_production()
    assert rig.run(10, until=lambda: bool(rig.desk.open))
    return rig, only(rig.desk)


def test_an_acknowledgement_lasts_until_its_ability_has_finished() -> None:
    tasks = desk()
    tasks.update(executing(PLACE_1), (), (), 5.0)
    assert tasks.measured() == {ACKNOWLEDGED: False}
    assert only(tasks).ability == PLACE_1
    acknowledge(tasks, only(tasks).id, 1)
    tasks.update(executing(), (), (), 6.0)
    assert tasks.measured() == {ACKNOWLEDGED: True}
    tasks.update(executing(), (PLACE_2,), (), 7.0)
    assert tasks.measured() == {ACKNOWLEDGED: True}
    tasks.update(executing(), (PLACE_1,), (PLACE_1,), 8.0)
    assert tasks.measured() == {ACKNOWLEDGED: False}


def test_an_acknowledgement_is_let_go_also_when_nobody_remembers_the_start() -> None:
    """As after a controller was started again amid a task: the ability takes its finish actions all the same."""
    tasks = desk()
    tasks.update(executing(PLACE_1), (), (), 5.0)
    acknowledge(tasks, only(tasks).id, 1)
    tasks.update(executing(), (PLACE_1,), (), 6.0)
    assert tasks.measured() == {ACKNOWLEDGED: False}


def test_an_acknowledgement_of_an_earlier_controller_is_for_a_task_that_is_gone() -> None:
    before, after = desk(), desk()
    before.update(executing(PLACE_1), (), (), 5.0)
    after.update(executing(PLACE_2), (), (), 6.0)
    with pytest.raises(CommandRefused) as refused:
        acknowledge(after, only(before).id, only(before).revision)
    assert refused.value.slug == "task-gone"


def test_the_same_ability_started_again_in_the_tick_of_its_end_is_another_task() -> None:
    tasks = desk()
    tasks.update(executing(PLACE_1), (), (), 5.0)
    first = only(tasks)
    acknowledge(tasks, first.id, first.revision)
    tasks.update(executing(PLACE_1), (PLACE_1,), (PLACE_1,), 6.0)
    assert only(tasks).created == 6.0
    with pytest.raises(CommandRefused):
        acknowledge(tasks, first.id, first.revision)
    assert tasks.measured() == {ACKNOWLEDGED: False}


def test_another_revision_is_refused() -> None:
    tasks = desk()
    tasks.update(executing(PLACE_1), (), (), 5.0)
    with pytest.raises(CommandRefused) as refused:
        acknowledge(tasks, only(tasks).id, 2)
    assert refused.value.slug == "task-changed"
    assert tasks.measured() == {ACKNOWLEDGED: False}


def test_a_watch_that_speaks_on_a_topic_is_heard_beside_the_page() -> None:
    tasks = TaskHandler(truck_engine()[0].automaton, {ACKNOWLEDGED})
    tasks.update(executing(PLACE_1), (), (), 5.0)
    assert tasks.measured() == {}
    acknowledge(tasks, only(tasks).id, 1)
    assert tasks.measured() == {ACKNOWLEDGED: True}


def shown(rig: Rig, *, goes_on: bool = True) -> TaskView:
    """The only open task, as people see it."""
    tasks = OpenTasks(rig.execution, rig.desk, lambda: goes_on, lambda resource: message("still.nothing"))
    views = tasks.view_part(Timestamp(rig.now, rig.now))["tasks"]
    assert isinstance(views, dict)
    (view,) = views.values()
    assert isinstance(view, TaskView)
    return view


def test_before_a_task_is_done_it_says_what_starts_by_it_and_who_may_move() -> None:
    """Hands are in the holes: whatever moves at once after it was named before, also after the last pair."""
    rig, abilities = Rig(acknowledges=never), truck_engine()[0].automaton.abilities
    rig.start_production()
    for _ in PAIRS:
        assert rig.run(60, until=lambda: bool(rig.desk.open) and not rig.execution.plan.order.running[1:])
        task, before = only(rig.desk), shown(rig)
        pair = before.title.removeprefix("Place ")
        assert before.begins == [f"Tighten {pair}"]
        assert {mover.title for mover in before.movers} >= {"Robot UR10"}
        rig.started.clear()
        acknowledge(rig.desk, task.id, task.revision)
        rig.run(3)
        moved = {abilities[name].resource for name in rig.started if abilities[name].human is None}
        assert moved
        assert moved <= {mover.name for mover in before.movers}


def test_what_moves_anyhow_is_not_said_of_the_next_task() -> None:
    """The robot is on its way for the pair before: that waits for nobody."""
    abilities = truck_engine()[0].automaton.abilities
    rig = Rig(acknowledges=lambda task, now: len(rig.completed) < 2 and at_once(task, now))
    rig.start_production()

    def robot_is_ahead() -> bool:
        return bool(rig.desk.open) and any(abilities[n].resource == "robot" for n in rig.execution.plan.order.names)

    assert rig.run(20, until=robot_is_ahead)
    assert [title for mover in shown(rig).movers for title in mover.moves] == []


def test_nothing_moves_by_a_task_while_the_station_stands() -> None:
    rig, _ = waiting()
    still = shown(rig, goes_on=False)
    assert (still.movers, still.begins, still.next_moves) == ([], [], [])


def test_what_tells_the_planner_what_the_robot_holds_moves_nothing() -> None:
    still = {name for name, ability in truck_engine()[0].automaton.abilities.items() if not ability.moves}
    assert still == {"robot.attach_in_planning_scene", "robot.detach_in_planning_scene"}


def told(
    tasks: TaskHandler, task: WaitingTask, why: str = "", revision: int = 1, by: str = "Eva", at: float = 6.0
) -> None:
    actor = EVA.model_copy(update={"name": by})
    problem = ReportProblem(actor=actor, task=task.id, revision=revision, reason=why)
    tasks.report(problem, Timestamp(at, at))


def test_a_problem_lasts_until_it_is_solved_or_its_task_is_over_and_says_nothing_is_done() -> None:
    tasks = desk()
    tasks.update(executing(PLACE_1), (), (), 5.0)
    task = only(tasks)
    told(tasks, task)
    told(tasks, task, "no bolts", by="Adam", at=7.0)  # by another, or once more
    assert tasks.problems == {task.id: TaskProblem("Adam", 6.0, "no bolts")}
    assert tasks.measured() == {ACKNOWLEDGED: False}
    for _ in range(2):
        tasks.solve(SolveProblem(actor=EVA, task=task.id, revision=1), NOW)
        assert tasks.problems == {}
    told(tasks, task)
    tasks.update(executing(), (PLACE_1,), (PLACE_1,), 8.0)
    assert tasks.problems == {}


def test_a_late_problem_is_not_one_of_another_task() -> None:
    tasks = desk()
    tasks.update(executing(PLACE_1), (), (), 5.0)
    first = only(tasks)
    tasks.update(executing(PLACE_1), (PLACE_1,), (PLACE_1,), 6.0)
    with pytest.raises(CommandRefused) as refused:
        told(tasks, first)
    assert refused.value.slug == "task-gone"
    with pytest.raises(CommandRefused) as refused:
        tasks.solve(SolveProblem(actor=EVA, task=first.id, revision=1), NOW)
    assert refused.value.slug == "task-gone"
    with pytest.raises(CommandRefused) as refused:
        told(tasks, only(tasks), revision=2)
    assert refused.value.slug == "task-changed"
    assert tasks.problems == {}


def test_a_task_acknowledged_twice_completes_one() -> None:
    rig, task = waiting()
    acknowledge(rig.desk, task.id, task.revision)
    acknowledge(rig.desk, task.id, task.revision)
    rig.run(2)
    assert [name for name in rig.completed if name.startswith("place")] == [f"place_bolt_pair({task.ability[-12:-1]})"]
    with pytest.raises(CommandRefused):
        acknowledge(rig.desk, task.id, task.revision)


def test_a_task_is_finished_while_the_station_is_paused() -> None:
    rig, task = waiting()
    rig.execution.change_mode(Mode.PAUSED, "Eva", Timestamp(rig.now, rig.now))
    before = len(rig.started)
    acknowledge(rig.desk, task.id, task.revision)
    rig.run(1)
    assert len([name for name in rig.completed if name.startswith("place")]) == 1
    assert rig.value(ACKNOWLEDGED) is False
    assert len(rig.started) == before


def test_an_acknowledgement_waits_for_what_its_finish_must_know() -> None:
    """It is neither lost nor given twice while the station is blind on every topic."""
    rig, task = waiting()
    rig.silent = set(rig.station.pipelines.incoming)
    acknowledge(rig.desk, task.id, task.revision)
    rig.run(2)
    rig.silent = set()
    rig.run(2)
    assert len([name for name in rig.completed if name.startswith("place")]) == 1
    assert rig.value(ACKNOWLEDGED) is False
