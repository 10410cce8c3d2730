"""A running station asks for a plan soon, then for better ones, and changes its mind only for a better one."""

from __future__ import annotations

import asyncio
from dataclasses import replace

import pytest

from controller.test_local_formulas import beginning
from controller.test_ticks import NOW
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, PlanStatus
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.problem import (
    Circumstances,
    Contract,
    Plan,
    PlanAnswer,
    PlanRequest,
    PlanTick,
    Verdict,
)
from support.automata import Does, automaton
from support.cell import Arm, bench
from support.simulated import PAIRS, Rig

PLACES = EnumerationType(("here", "detour", "there"))

# A carrier that goes there directly, or by a detour.
WAYS = automaton(
    {
        "directly": Does(start=("target := there",), enabled="at == here and target == here"),
        "aside": Does(start=("target := detour",), enabled="at == here and target == here"),
        "onwards": Does(start=("target := there",), enabled="at == detour and target == detour"),
        "ring": Does(start=("bell := true",), enabled="not bell"),
    },
    measured={"at": (PLACES, "here"), "rung": (BOOLEAN, False)},
    output={"target": (PLACES, "here"), "bell": (BOOLEAN, False)},
    effects={
        "arrives": ("target == there and at != there", ("at := there",)),
        "turns_aside": ("target == detour and at != detour", ("at := detour",)),
        "rings": ("bell and not rung", ("rung := true",)),
    },
    goals={"come": "at == there", "announce": "rung"},
    priorities={"come": 1},
)
AT_REST: dict[str, Value] = {"at": "here", "rung": False}


def ticks(*each: tuple[str, str]) -> tuple[PlanTick, ...]:
    """Ticks of which each has one effect, or none, and one start, or none."""
    return tuple(PlanTick((effect,) if effect else (), (start,) if start else ()) for effect, start in each)


DETOUR = ticks(("", "aside"), ("turns_aside", "onwards"), ("arrives", "ring"), ("rings", ""))
DIRECT = ticks(("", "directly"), ("arrives", "ring"), ("rings", ""))
ONLY_COME = ticks(("", "aside"), ("turns_aside", "onwards"), ("arrives", ""))


def found(plan: tuple[PlanTick, ...], goals: tuple[str, ...] = ("announce", "come")) -> PlanAnswer:
    """An answer of a planner."""
    left_out = tuple({"announce", "come"} - set(goals))
    return PlanAnswer(Verdict.FOUND, Plan(plan, False, False), goals, left_out, 0, 0.01)


def asked(execution: Executor) -> PlanRequest:
    """What is asked now, because it is needed."""
    request = execution.request(5)
    assert request is not None
    return request


def asked_better(execution: Executor) -> PlanRequest:
    """What is asked of a planner that has nothing else to do."""
    assert execution.request(5) is None
    request = execution.better(5)
    assert request is not None
    return request


@pytest.fixture
def following() -> Executor:
    """A station that has just adopted the detour."""
    execution, _ = beginning(WAYS, **AT_REST)
    assert execution.adopt(asked(execution), found(DETOUR))
    assert execution.plan.order.names == ("aside", "onwards", "ring")
    return execution


def test_a_plan_is_wanted_soon_then_the_best_one(following: Executor) -> None:
    execution, _ = beginning(WAYS, **AT_REST)
    assert execution.better(5) is None, "first there must be one"
    assert asked(execution).contract is Contract.FAST
    better = asked_better(following)
    assert better.contract is Contract.MINIMAL
    assert better.state == following.state
    assert following.better(5) is None, "it would be answered the same again"


def test_a_better_plan_takes_the_place_of_the_one_that_is_followed(following: Executor) -> None:
    following.adopt(asked_better(following), found(DIRECT))
    assert following.plan.order.names == ("directly", "ring")
    assert following.plan.reason == "re-planned: a better way was found"
    assert following.plan.replanned == 1
    replacement = following.plan.replacement
    assert replacement is not None
    assert (replacement.why, replacement.dropped) == (following.plan.reason, ("aside", "onwards"))
    new = [step.ability for step in following.plan.order.ahead if step.number in replacement.new]
    assert new == ["directly"], "that both ring is nothing new"


@pytest.mark.parametrize("other", [DETOUR, (PlanTick((), ()), *DETOUR)])
def test_one_that_is_as_good_or_longer_does_not(following: Executor, other: tuple[PlanTick, ...]) -> None:
    before = following.plan.order.copy()
    following.adopt(asked_better(following), found(other))
    assert following.plan.order == before, "else plans would take turns"
    assert following.plan.replanned == 0
    assert following.plan.replacement is None


def test_one_with_more_goals_does_and_one_with_fewer_does_not(following: Executor) -> None:
    execution, _ = beginning(WAYS, **AT_REST)
    execution.adopt(asked(execution), found(ONLY_COME, ("come",)))
    execution.adopt(asked_better(execution), found(DETOUR))
    assert execution.plan.order.goals == {"announce", "come"}
    following.adopt(asked_better(following), found((*DIRECT[:1], PlanTick(("arrives",), ())), ("come",)))
    assert following.plan.order.goals == {"announce", "come"}


def test_an_answer_is_not_taken_once_an_ability_it_may_hold_has_been_started(following: Executor) -> None:
    request = asked_better(following)
    assert "aside" in following.tick(AT_REST, NOW).started
    following.adopt(request, found(DETOUR))
    assert following.plan.order.names.count("aside") == 0


def test_that_there_is_nothing_better_changes_nothing(following: Executor) -> None:
    request = asked_better(following)
    following.adopt(request, PlanAnswer(Verdict.LATE, None, (), (), 3, 5.0))
    following.unanswered("the planner has ended", again=True)
    assert following.plan.status is PlanStatus.FOLLOWED
    assert following.plan.order.names == ("aside", "onwards", "ring")


def test_a_plan_is_followed_on_when_none_is_found_for_more_goals_in_time() -> None:
    execution, _ = beginning(WAYS, at="here", rung=True)
    execution.adopt(asked(execution), found(ONLY_COME, ("come",)))
    execution.tick(AT_REST, NOW)
    assert execution.active == {"announce", "come"}
    execution.adopt(asked(execution), PlanAnswer(Verdict.LATE, None, (), ("announce", "come"), 2, 5.0))
    assert execution.plan.status is PlanStatus.FOLLOWED
    assert execution.plan.answer is not None
    assert execution.plan.answer.left_out == ("announce",)
    assert execution.request(5) is None
    assert execution.better(5) is not None


def test_an_operation_that_becomes_active_again_is_planned_for_again(following: Executor) -> None:
    assert following.tick({"at": "here", "rung": True}, NOW).completed == {"announce"}
    assert following.request(5) is None
    assert following.tick(AT_REST, NOW).activated == {"announce"}
    assert {goal.name for goal in asked(following).goals} == {"announce", "come"}


def by_hand() -> Automaton:
    """The same carrier, which a robot pushes directly and an operator by the detour."""
    resources = {"directly": "robot", "aside": "operator", "onwards": "operator", "ring": "operator"}
    return replace(
        WAYS,
        resources={"robot": "robot", "operator": "operator", "station": "station"},
        abilities={name: replace(ability, resource=resources[name]) for name, ability in WAYS.abilities.items()},
    )


def test_while_a_robot_is_offline_an_operator_does_its_work() -> None:
    execution, planner = beginning(by_hand(), **AT_REST)
    request = asked(execution)
    execution.adopt(request, found(DIRECT))
    offline = Circumstances(frozenset({"robot"}))
    assert execution.tick(AT_REST, NOW, silent=offline.offline).started == ()
    assert execution.startable("directly") is None
    assert execution.plan.status is PlanStatus.BROKEN

    request = asked(execution)
    assert request.circumstances == offline
    assert execution.adopt(request, planner.answer(request))
    assert [name for name in execution.plan.order.names if name != "ring"] == ["aside", "onwards"]


def test_a_resource_is_offline_while_one_of_its_topics_is_silent() -> None:
    async def scenario() -> None:
        async with bench() as on:
            execution, arm = on.controller.execution, Arm(on.network)
            await on.until(lambda: execution.circumstances.offline == {"arm"})
            with arm.saying("home"):
                await on.until(lambda: not execution.circumstances.offline)
            await on.until(lambda: execution.circumstances.offline == {"arm"})

    asyncio.run(scenario())


def test_it_is_shown_what_kind_of_plan_is_followed_and_who_found_it() -> None:
    async def scenario() -> None:
        async with bench() as on:
            arm = Arm(on.network)
            with arm.saying("home"):
                assert on.controller.view().plan.contract is None
                await on.until(lambda: not on.controller.execution.circumstances.offline)
                await on.start()
                await on.until(lambda: on.controller.view().plan.contract is not None)
                assert on.controller.view().plan.engine

    asyncio.run(scenario())


def test_that_there_was_no_plan_is_asked_again_once_a_resource_is_back() -> None:
    execution, planner = beginning(by_hand(), **AT_REST)
    execution.tick(AT_REST, NOW, silent=frozenset({"robot", "operator"}))
    request = asked(execution)
    answer = planner.answer(request)
    assert answer.plan is None
    assert execution.adopt(request, answer)
    assert execution.plan.status is PlanStatus.NONE
    assert execution.request(5) is None
    execution.tick(AT_REST, NOW, silent=frozenset({"robot"}))
    assert asked(execution).circumstances.offline == {"robot"}


@pytest.mark.parametrize("seed", [0, 1])
def test_the_truck_station_assembles_as_fast_when_better_plans_are_asked_for(seed: int) -> None:
    """And while it carries on as planned there is nothing better: its plans are not exchanged."""
    rig = Rig(seed=seed)
    rig.start_production()
    assert rig.run(90, until=lambda: rig.completed.count("new_engine") >= 1)
    for pair in PAIRS:
        assert rig.completed.count(f"tighten_bolt_pair({pair})") == 1
        assert rig.started.count(f"robot.move_to_position({pair})") == 1


def test_goals_left_out_for_what_was_so_for_a_moment_are_asked_for_again(following: Executor) -> None:
    """A device was silent when the plan was asked for; all is as it was before when the answer comes."""
    following.change_mode(Mode.PAUSED, "Eva", NOW)  # so that nothing else changes
    asked_better(following)
    following.tick({"at": None, "rung": False}, NOW)
    assert following.plan.status is PlanStatus.BROKEN
    request = asked(following)
    following.tick(AT_REST, NOW)
    following.adopt(request, found(ONLY_COME, ("come",)))
    assert {goal.name for goal in asked_better(following).goals} == {"announce", "come"}
    assert following.better(5) is None
