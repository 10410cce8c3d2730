"""The advisor's process as the controller meets it: one question after the other, and nobody waits too long."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import Awaitable, Callable

import pytest

from sequence_planner.automaton.tick import initial_state
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.planner_client import AdvisorClient
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.planning.problem import Contract, PlanRequest, Verdict, goals_of
from sequence_planner.planning.recovery.request import AdviceRequest, GoalPlanRequest
from support.automata import predicate_of
from support.cell import cell
from support.waiting import patience, until_async


def processes() -> list[Child]:
    return [child for child in children() if child.name == "adviser"]


def run(scenario: Callable[[AdvisorClient], Awaitable[None]]) -> None:
    async def live() -> None:
        station, supervisor = cell()
        advisor = AdvisorClient(station.automaton, supervisor)
        try:
            await scenario(advisor)
        finally:
            advisor.close()
        assert not processes()

    asyncio.run(live())


def fetching() -> PlanRequest:
    automaton = cell()[0].automaton
    goals = goals_of(automaton, ("fetch(left)",))
    return PlanRequest(dict(initial_state(automaton)), goals, contract=Contract.FAST)


def test_each_question_has_its_answer_whoever_else_asks() -> None:
    async def scenario(advisor: AdvisorClient) -> None:
        automaton = cell()[0].automaton
        state = initial_state(automaton)
        goal_plan = GoalPlanRequest(state, (), predicate_of(automaton, "arm.pose == out"))
        plan, offered, advice = await asyncio.gather(
            advisor.answer(fetching(), 20),
            advisor.answer(goal_plan, 20),
            advisor.answer(AdviceRequest(state, goals_of(automaton, ("fetch(left)",))), 20),
        )
        assert plan.verdict is Verdict.FOUND
        assert offered.offers[0].operator_plan is not None
        assert advice.offers[0].kind == "replan"

    run(scenario)


def test_who_waits_too_long_is_told_so_and_the_next_is_answered() -> None:
    async def scenario(advisor: AdvisorClient) -> None:
        await advisor.answer(fetching(), 20)
        (process,) = processes()
        assert process.pid is not None
        os.kill(process.pid, signal.SIGSTOP)
        began = time.monotonic()
        late = [asyncio.create_task(advisor.answer(fetching(), 0.3)) for _ in range(2)]
        for each in late:
            with pytest.raises(CommandRefused) as refused:
                await each
            assert (refused.value.slug, refused.value.status) == ("advisor-timeout", 504)
        assert time.monotonic() - began < patience(1)
        os.kill(process.pid, signal.SIGCONT)
        assert (await advisor.answer(fetching(), 20)).verdict is Verdict.FOUND

    run(scenario)


def test_one_that_is_killed_is_replaced_and_who_asked_is_told() -> None:
    async def scenario(advisor: AdvisorClient) -> None:
        await advisor.answer(fetching(), 20)
        (process,) = processes()
        assert process.pid is not None
        os.kill(process.pid, signal.SIGSTOP)  # so that it cannot answer before
        asking = asyncio.create_task(advisor.answer(fetching(), 20))
        await asyncio.sleep(0.1)
        process.kill()
        with pytest.raises(CommandRefused, match="Nothing was changed by asking") as refused:
            await asking
        assert (refused.value.slug, refused.value.status) == ("advisor-unavailable", 503)
        await until_async(lambda: [each.pid for each in processes()] not in ([], [process.pid]))
        assert (await advisor.answer(fetching(), 20)).verdict is Verdict.FOUND

    run(scenario)


def test_who_gives_up_makes_room_for_the_next() -> None:
    async def scenario(advisor: AdvisorClient) -> None:
        await advisor.answer(fetching(), 20)
        for _ in range(3):
            asking = asyncio.create_task(advisor.answer(fetching(), 20))
            await asyncio.sleep(0)
            asking.cancel()
            await asyncio.gather(asking, return_exceptions=True)
        assert (await advisor.answer(fetching(), 20)).verdict is Verdict.FOUND

    run(scenario)
