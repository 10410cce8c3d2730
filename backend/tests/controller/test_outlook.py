"""What a plan leads to: which step makes another possible, and which steps are for which operation."""

from __future__ import annotations

from controller.test_local_formulas import beginning
from controller.test_receding_horizon import asked
from controller.test_timetable import AGAIN, AT_REST, TICKS, WAY
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.outlook import Outlook, simulate_plan
from sequence_planner.language.types import BOOLEAN, Value
from sequence_planner.planning.problem import Plan, PlanAnswer, PlanTick, Verdict
from support.automata import Does, automaton, predicate_of


def following(station: Automaton, plan: tuple[PlanTick, ...], goals: tuple[str, ...], **measured: Value) -> Executor:
    """An execution that has just adopted a plan."""
    execution, _ = beginning(station, **measured)
    answer = PlanAnswer(Verdict.FOUND, Plan(plan, False, False), goals, (), 0, 0.01)
    assert execution.adopt(asked(execution), answer)
    return execution


def course(*each: tuple[str, ...]) -> tuple[PlanTick, ...]:
    """Ticks, each an effect or none and what is started then."""
    return tuple(PlanTick((effect,) if effect else (), tuple(starts)) for effect, *starts in each)


def looked_through(execution: Executor) -> Outlook:
    return simulate_plan(execution.plan.order, execution.simulated(), execution.automaton)


def waits(execution: Executor, outlook: Outlook) -> dict[str, str]:
    """By the ability of a step, the one of the step that makes it possible; each runs once."""
    order = execution.plan.order
    names = {step.number: step.ability for step in (*order.past, *order.ahead)}
    return {names[number]: names[after] for number, after in outlook.after.items()}


def serving(execution: Executor, outlook: Outlook) -> dict[str, tuple[str, str]]:
    order = execution.plan.order
    names = {step.number: step.ability for step in (*order.past, *order.ahead)}
    return {goal: (names[first], names[last]) for goal, (first, last) in outlook.serves.items()}


def test_a_step_waits_for_the_one_whose_end_makes_it_possible() -> None:
    execution = following(WAY, TICKS, ("come",), **AT_REST)
    outlook = looked_through(execution)
    assert waits(execution, outlook) == {"onwards": "aside", "away": "onwards"}
    assert serving(execution, outlook) == {"come": ("aside", "away")}


def test_the_same_ability_waits_each_time_for_the_step_before() -> None:
    execution = following(WAY, AGAIN, ("come",), **AT_REST)
    outlook = looked_through(execution)
    first, *later = [step.number for step in execution.plan.order.ahead]
    assert outlook.after == {number: number - 1 for number in later}
    assert outlook.serves == {"come": (first, later[-1])}


# A person places a part, which a tool tightens; a camera looks at the place meanwhile, and a belt waits for its light.
STATION = automaton(
    {
        "place": Does(start=("asked := true",), enabled="not part", executing="asked", finish="asked and part"),
        "tighten": Does(start=("turns := true",), when="part", executing="turns", finish="turns and tight"),
        "look": Does(start=("lit := true",), executing="lit", finish="lit"),
        "leave": Does(start=("moves := true",), when="tight and lit", executing="moves", finish="moves and gone"),
    },
    measured=dict.fromkeys(("part", "tight", "gone"), (BOOLEAN, False)),
    output=dict.fromkeys(("asked", "turns", "lit", "moves"), (BOOLEAN, False)),
    effects={
        "put": ("asked and not part", ("part := true",)),
        "hold": ("turns and not tight", ("tight := true",)),
        "go": ("moves and not gone", ("gone := true",)),
    },
    goals={"placed": "part", "tightened": "tight", "released": "gone"},
)


def automaton_with_goals(*goals: str) -> Automaton:
    """The same station with other goals: `first`, and `second`."""
    names = ("first", "second")
    return replace(
        STATION,
        operations={
            name: replace(STATION.operations["placed"], name=name, goal=predicate_of(STATION, goal))
            for name, goal in zip(names, goals, strict=False)
        },
    )


EVERYTHING = course(("", "place", "look"), ("put", "tighten"), ("hold", "leave"), ("go",))
GOALS = ("placed", "tightened", "released")
UNTOUCHED: dict[str, Value] = {"part": False, "tight": False, "gone": False}


def test_of_several_that_run_the_one_is_told_that_brings_what_is_missing_last() -> None:
    execution = following(STATION, EVERYTHING, GOALS, **UNTOUCHED)
    outlook = looked_through(execution)
    assert waits(execution, outlook) == {"tighten": "place", "leave": "tighten"}
    assert serving(execution, outlook) == {
        "placed": ("place", "place"),
        "tightened": ("tighten", "tighten"),
        "released": ("leave", "leave"),
    }


def test_what_runs_already_is_waited_for_too() -> None:
    execution = following(STATION, EVERYTHING, GOALS, **UNTOUCHED)
    execution.tick(UNTOUCHED, Timestamp(1001, 1))
    assert [step.ability for step in execution.plan.order.running] == ["place", "look"]
    assert waits(execution, looked_through(execution)) == {"tighten": "place", "leave": "tighten"}


def test_what_nothing_keeps_waits_for_no_step() -> None:
    without = course(("", "tighten", "look"), ("hold", "leave"), ("go",))
    execution = following(STATION, without, GOALS[1:], **UNTOUCHED | {"part": True})
    assert waits(execution, looked_through(execution)) == {"leave": "tighten"}


def test_a_start_can_be_what_another_waits_for() -> None:
    lit_last = course(("", "place"), ("put", "tighten"), ("hold", "look", "leave"), ("go",))
    execution = following(STATION, lit_last, GOALS, **UNTOUCHED)
    assert waits(execution, looked_through(execution))["leave"] == "look"


def test_what_a_device_does_by_a_command_is_by_the_step_that_gave_it() -> None:
    """The effect is of another device than the one whose ability is over at once."""
    slow = automaton(
        {
            "call": Does(start=("wanted := true",), enabled="not wanted"),
            "take": Does(start=("taken := true",), enabled="there and not taken"),
        },
        measured={"there": (BOOLEAN, False)},
        output={"wanted": (BOOLEAN, False), "taken": (BOOLEAN, False)},
        effects={"bring": ("wanted and not there", ("there := true",))},
        goals={"done": "taken"},
    )
    slow = replace(slow, effects=tuple(replace(effect, resource="belt") for effect in slow.effects))
    execution = following(slow, course(("", "call"), ("bring", "take")), ("done",), there=False)
    outlook = looked_through(execution)
    assert waits(execution, outlook) == {"take": "call"}
    assert serving(execution, outlook) == {"done": ("call", "take")}


def test_a_step_between_those_of_an_operation_is_not_for_it_where_another_alone_waits_for_it() -> None:
    seen = automaton_with_goals("tight", "lit")
    execution = following(
        seen, course(("", "place", "look"), ("put", "tighten"), ("hold",)), ("first", "second"), **UNTOUCHED
    )
    outlook = looked_through(execution)
    place, look, tighten = [step.number for step in execution.plan.order.ahead]
    assert outlook.serves == {"first": (place, tighten), "second": (look, look)}
    assert outlook.steps_for("first") == {place, tighten}
    assert outlook.steps_for("second") == {look}
    assert outlook.steps_for("unknown") == set()


def test_a_step_that_nothing_waits_for_is_for_the_operation_within_which_it_lies() -> None:
    execution = following(
        automaton_with_goals("tight"),
        course(("", "place", "look"), ("put", "tighten"), ("hold",)),
        ("first",),
        **UNTOUCHED,
    )
    assert looked_through(execution).steps_for("first") == {step.number for step in execution.plan.order.ahead}


def test_without_a_plan_there_is_nothing_to_say() -> None:
    execution, _ = beginning(STATION, **UNTOUCHED)
    assert looked_through(execution) == Outlook()


def test_it_says_the_same_whenever_it_is_asked_and_leaves_the_execution_alone() -> None:
    execution = following(STATION, EVERYTHING, GOALS, **UNTOUCHED)
    before = dict(execution.state)
    assert looked_through(execution) == looked_through(execution)
    assert dict(execution.state) == before
