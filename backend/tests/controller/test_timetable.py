"""When the steps of a plan are expected: by the model, by the runs there were, and by what happened last."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from controller.test_local_formulas import beginning
from controller.test_receding_horizon import asked, ticks
from sequence_planner.automaton.automaton import Automaton, HumanTask, Timeouts
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.tick import synchronise
from sequence_planner.controller.views.wording import plan_preview
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution import forecast
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.forecast import Forecast, waiting_for_people
from sequence_planner.execution.outlook import Outlook, simulate_plan
from sequence_planner.execution.plan_tracker import PlanCursor
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.problem import Plan, PlanAnswer, PlanTick, Verdict
from support.automata import Does, automaton

PLACES = EnumerationType(("here", "detour", "there", "back"))
AT_REST: dict[str, Value] = {"at": "here"}


def going(place: str, since: str) -> Does:
    """Goes there from `since`, which is over on arrival."""
    return Does(
        start=(f"target := {place}",),
        enabled=f"at == {since} and target == {since}",
        executing=f"target == {place} and at != {place}",
        finish=f"target == {place} and at == {place}",
    )


WAY = automaton(
    {
        "aside": going("detour", "here"),
        "return": going("here", "detour"),
        "onwards": going("there", "detour"),
        "away": going("back", "there"),
    },
    measured={"at": (PLACES, "here")},
    output={"target": (PLACES, "here")},
    effects={str(place): (f"target == {place} and at != {place}", (f"at := {place}",)) for place in PLACES.domain},
    goals={"come": "at == back"},
)
SLOW = replace(WAY, effects=tuple(replace(effect, shortest=2.0, longest=4.0) for effect in WAY.effects))
TICKS = ticks(("", "aside"), ("detour", "onwards"), ("there", "away"), ("back", ""))


class Watched:
    """An execution that follows a plan, and its timetable."""

    def __init__(self, automaton: Automaton, plan: tuple[PlanTick, ...] = TICKS) -> None:
        self.execution, _ = beginning(automaton, **AT_REST)
        self.timetable = Forecast(self.execution)
        answer = PlanAnswer(Verdict.FOUND, Plan(plan, False, False), ("come",), (), 0, 0.01)
        assert self.execution.adopt(asked(self.execution), answer)

    def tick(self, seconds: float, at: str = "here") -> None:
        self.execution.tick({"at": at}, Timestamp(1000 + seconds, seconds))
        self.timetable.update(1000 + seconds)

    @property
    def expected(self) -> dict[str, tuple[float, float]]:
        """By ability, in seconds after the first tick."""
        order = self.execution.plan.order
        names = {step.number: step.ability for step in (*order.past, *order.ahead)}
        table = self.timetable.expected().items()
        return {names[number]: (each.start - 1000, each.end - 1000) for number, each in table}


def test_steps_follow_one_another_as_the_plan_orders_them() -> None:
    watched = Watched(SLOW)
    watched.tick(0)
    assert watched.expected == {"aside": (0, 3), "onwards": (3, 6), "away": (6, 9)}


def test_a_plan_that_nobody_follows_yet_is_shown_with_the_same_times() -> None:
    station = replace(SLOW, effects=tuple(replace(each, resource="station") for each in SLOW.effects))
    preview = plan_preview(
        station, Plan(TICKS, False, False), synchronise(station, {**station.initial_valuation, **AT_REST})
    )
    assert {step.ability: (step.start, step.end) for step in preview.steps} == {
        "aside": (0, 3),
        "onwards": (3, 6),
        "away": (6, 9),
    }


def test_a_start_that_no_effect_follows_takes_as_long_as_the_model_says() -> None:
    said = replace(SLOW.abilities["away"], duration=(1.0, 2.0))
    station = replace(SLOW, abilities={**SLOW.abilities, "away": said})
    there = synchronise(station, {**station.initial_valuation, "at": "there", "target": "there"})
    [step] = plan_preview(station, Plan(ticks(("", "away")), False, False), there).steps
    assert (step.start, step.end) == (0, 1.5)


def test_what_may_start_at_once_is_shown_so_whatever_else_is_under_way() -> None:
    """By the plan both come after what a person does, as each of its ticks waits for all that is expected in it."""
    two = automaton(
        {
            "place": Does(
                start=("asked := true",),
                enabled="not asked",
                executing="asked and not placed",
                finish="asked and placed",
            ),
            "turn": Does(start=("on := true",), enabled="not on", executing="turns", finish="on and turns"),
            "go": Does(start=("target := there",), enabled="turns", executing="at != target", finish="at == there"),
        },
        measured={"at": (PLACES, "here"), "placed": (BOOLEAN, False), "turns": (BOOLEAN, False)},
        output={"asked": (BOOLEAN, True), "on": (BOOLEAN, False), "target": (PLACES, "here")},
        effects={
            "places": ("asked and not placed", ("placed := true",)),
            "turning": ("on and not turns", ("turns := true",)),
            "goes": ("at != target", ("at := target",)),
        },
        goals={"come": "at == there and placed"},
    )
    seconds = {"places": 20.0, "turning": 0.5, "goes": 4.0}
    effects = tuple(replace(each, shortest=seconds[each.name], longest=seconds[each.name]) for each in two.effects)
    station = replace(two, effects=effects)
    plan = Plan(ticks(("places", "turn"), ("turning", "go"), ("goes", "")), False, False)
    preview = plan_preview(station, plan, synchronise(station, station.initial_valuation))
    assert [(step.ability, step.start) for step in preview.steps] == [("turn", 0), ("go", 0.5)]


def test_nothing_moves_on_while_nothing_happens() -> None:
    watched = Watched(SLOW)
    watched.tick(0)
    before = watched.expected
    watched.tick(2)
    assert watched.expected == before


def test_what_is_late_makes_what_follows_late() -> None:
    watched = Watched(SLOW)
    watched.tick(0)
    watched.tick(5, at="detour")
    assert watched.expected["onwards"][0] == 5
    assert watched.expected["away"][0] - watched.expected["onwards"][0] == 3


def test_runs_there_were_tell_more_than_the_model() -> None:
    watched = Watched(SLOW, ticks(("", "aside"), ("detour", "return"), ("here", "aside")) + TICKS[1:])
    watched.tick(0)
    watched.tick(1, at="detour")
    assert watched.expected == {"return": (1, 4), "aside": (4, 5), "onwards": (5, 8), "away": (8, 11)}


AGAIN = ticks(("", "aside"), ("detour", "return"), ("here", "aside")) + TICKS[1:]


def after_a_long_run(station: Automaton, disturb: Callable[[Executor], None] = lambda execution: None) -> float:
    """How long the next run of an ability is expected to take, of which one has taken 900 s."""
    watched = Watched(station, AGAIN)
    watched.tick(0)
    disturb(watched.execution)
    watched.tick(900, at="detour")
    watched.execution.change_mode(Mode.AUTOMATIC, "Eva", Timestamp(1900, 900))
    start, end = watched.expected["aside"]
    return end - start


def test_what_a_person_takes_is_no_duration_of_an_ability() -> None:
    assert after_a_long_run(SLOW) == 900
    aside = SLOW.abilities["aside"]
    asks = replace(aside, human=HumanTask("Push it aside.", "done"))
    person = replace(SLOW, abilities={**SLOW.abilities, "aside": asks})
    assert waiting_for_people(person) == {"aside"}
    assert after_a_long_run(person) == 3
    elsewhere = replace(SLOW.abilities["away"], human=HumanTask("Say where it is.", "at"))
    awaiting = replace(SLOW, abilities={**SLOW.abilities, "away": elsewhere})
    assert "aside" in waiting_for_people(awaiting)
    assert after_a_long_run(awaiting) == 3


def test_a_run_in_which_the_station_stood_tells_nothing_of_how_long_it_takes() -> None:
    assert after_a_long_run(SLOW, lambda execution: execution.change_mode(Mode.PAUSED, "Eva", Timestamp(1001, 1))) == 3
    late = replace(SLOW.abilities["aside"], timeouts=Timeouts(finish=30.0))
    assert after_a_long_run(replace(SLOW, abilities={**SLOW.abilities, "aside": late})) == 3


@pytest.mark.parametrize("plan_dropped", [True, False])
def test_without_a_plan_nothing_is_expected(plan_dropped: bool) -> None:
    execution, _ = beginning(SLOW, **AT_REST)
    timetable = Forecast(execution)
    timetable.update(1000)
    if plan_dropped:
        execution.plan.drop("for a test")
        timetable.update(1001)
    assert timetable.expected() == {}


def test_the_execution_is_left_as_it_is() -> None:
    """What is simulated is a run of its own."""
    execution: Executor = Watched(SLOW).execution
    before = dict(execution.state)
    Forecast(execution).update(1000)
    assert dict(execution.state) == before


def test_people_are_expected_to_do_one_thing_after_the_other_where_nothing_tells_when_they_are_done(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def untold(order: PlanCursor, run: CompiledRun, automaton: Automaton) -> Outlook:
        return replace(simulate_plan(order, run, automaton), ends={}, waits={})

    monkeypatch.setattr(forecast, "simulate_plan", untold)
    task = HumanTask("do it", "at")
    said = {name: replace(each, human=task, duration=(2.0, 4.0)) for name, each in SLOW.abilities.items()}
    watched = Watched(replace(SLOW, abilities=said))
    watched.tick(0)
    assert watched.expected == {"aside": (0, 3), "onwards": (3, 6), "away": (6, 9)}
