"""Tasks for people: whoever acknowledges one says that this very task is done, and no other, ever."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

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
from sequence_planner.controller.views.station import NextMovesView, TaskView
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.texts.message import message
from support.people import EVA
from support.simulated import PAIRS, Rig, never, truck_engine

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


def test_a_task_says_who_moves_next() -> None:
    rig, automaton = Rig(), truck_engine()[0].automaton
    abilities = automaton.abilities

    def moving() -> list[str]:
        return [name for name in rig.execution.plan.order.names if abilities[name].human is None]

    def shown(*, goes_on: bool, still: str = "") -> list[NextMovesView]:
        stilled = {still: replace(abilities[still], moves=False)} if still else {}
        execution = SimpleNamespace(
            automaton=replace(automaton, abilities={**abilities, **stilled}), plan=rig.execution.plan
        )
        tasks = OpenTasks(
            cast(Executor, execution), rig.desk, lambda: goes_on, lambda resource: message("still.nothing")
        )
        views = tasks.view_part(Timestamp(rig.now, rig.now))["tasks"]
        assert isinstance(views, dict)
        (view,) = views.values()
        assert isinstance(view, TaskView)
        return view.movers

    rig.start_production()
    assert rig.run(20, until=lambda: bool(rig.desk.open) and len(moving()) > 2)
    titles = [abilities[name].title for name in moving()[:3]]
    assert shown(goes_on=True) == [NextMovesView(name="robot", title="Robot UR10", moves=titles[:2])]
    assert shown(goes_on=False) == []
    # What moves nothing is not said to move, and what moves after it is.
    told = [title for view in shown(goes_on=True, still=moving()[0]) for title in view.moves]
    assert told == titles[1:]


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
