"""A station outside its safe states: what is said of it, which way back is asked for, and what the page is told."""

from __future__ import annotations

import asyncio
from functools import cache

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.controller.recovery.safe_state import SafeStateDifference, SafeStateMonitor
from sequence_planner.controller.views.station import AlarmState, DifferenceView, SpecificationView, WayBackView
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import PlanStatus
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.recovery_path import WaysBack
from sequence_planner.synthesis.supervisor import synthesise
from sequence_planner.texts.message import message
from support.automata import Does, automaton
from support.cell import Arm, bench

PLACES = EnumerationType(("back", "between", "out"))
UNSAFE = "unsafe-state"

CHOOSE = str(message("way.choose"))


@cache
def press() -> tuple[Automaton, Supervisor]:
    """A press that must not be closed with its gate open, which only people open; a restart ability lifts it. Nor may
    its slide be between two places with the gate open, which it passes on its way out.
    """
    station = automaton(
        {
            "close": Does(start=("shut := true",), enabled="not shut and not gate_open"),
            "lift": Does(start=("shut := false",), enabled="shut and slide == out", restart=True),
            "slide_out": Does(start=("extend := true",), enabled="not extend and shut", restart=True),
        },
        measured={
            "gate_open": (BOOLEAN, False),
            "closed": (BOOLEAN, False),
            "lamp": (BOOLEAN, False),
            "slide": (PLACES, "out"),
        },
        output={"shut": (BOOLEAN, False), "extend": (BOOLEAN, True)},
        effects={
            "closes": ("shut and not closed", ("closed := true",)),
            "opens": ("not shut and closed", ("closed := false",)),
            "slides": ("extend and slide == back", ("slide := between",)),
            "is_out": ("extend and slide == between", ("slide := out",)),
        },
        forbidden={"caught": "closed and gate_open", "sliding": "slide == between and gate_open"},
    )
    return station, synthesise(station)


class Seen:
    """The press in a state, and the answers of the real search."""

    def __init__(self, **values: Value | None) -> None:
        station, supervisor = press()
        self.execution = Executor(station, supervisor)
        self.outside = SafeStateMonitor(self.execution)
        self._ways = WaysBack(station, supervisor.safe)
        self.change(**initial_state(station))
        self.change(**values)

    def change(self, **values: Value | None) -> None:
        self.execution.state = synchronise(self.execution.automaton, {**self.execution.state, **values})

    def ask(self) -> bool:
        """Whether there was something to ask; then it has been answered."""
        request = self.outside.request(deadline=20)
        if request is not None:
            self.outside.take(request, self._ways.answer(request))
        return request is not None

    @property
    def text(self) -> str:
        assert self.outside.situation is not None
        return str(self.outside.describe(self.outside.situation))


def test_in_a_safe_state_there_is_nothing_to_say_or_to_ask() -> None:
    seen = Seen()
    assert seen.outside.situation is None
    assert not seen.ask()


def test_what_is_violated_and_the_nearest_safe_state_are_named_at_once() -> None:
    seen = Seen(gate_open=True, closed=True, shut=True)
    assert seen.outside.situation is not None
    assert seen.outside.situation.violated == ("caught",)
    assert seen.outside.situation.differences == (SafeStateDifference("gate_open", now=True, safe=False),)
    assert "Violated: “caught”" in seen.text
    assert str(seen.outside.way()) == "A way back is being looked for."


def test_what_the_devices_could_violate_is_named_once_it_is_known() -> None:
    seen = Seen(gate_open=True, shut=True)
    assert "Nothing is violated yet" in seen.text
    assert "caught" not in seen.text
    assert seen.ask()
    assert "without any start the devices could violate “caught”" in seen.text


def test_a_way_back_may_start_restart_abilities() -> None:
    seen = Seen(gate_open=True, closed=True, shut=True)
    assert seen.ask()
    assert str(seen.outside.way()) == CHOOSE
    found = seen.outside.way_back_view()
    assert found is not None
    assert [step.ability for step in found.steps] == ["lift"]


def test_a_way_that_violates_something_says_so() -> None:
    seen = Seen(gate_open=True, closed=True, shut=True, slide="back", extend=False)
    assert seen.ask()
    found = seen.outside.way_back_view()
    assert found is not None
    assert [step.ability for step in found.steps] == ["slide_out", "lift"]
    assert [each.name for each in found.breaks] == ["sliding"]


def test_where_nothing_needs_to_be_started_it_is_said_what_is_awaited() -> None:
    seen = Seen(gate_open=True, closed=True)
    assert seen.ask()
    assert str(seen.outside.way()) == "Nothing needs to be started: it comes back by itself when not closed."


def test_where_no_way_is_found_it_is_said_how_far_was_searched() -> None:
    seen = Seen(gate_open=True, closed=True, shut=True, slide=None)
    assert seen.ask()
    assert str(seen.outside.way()) == (
        f"No way back by starts alone was found within 40 ticks, with slide unknown. {CHOOSE}"
    )


def test_a_state_that_may_be_safe_awaits_what_is_unknown() -> None:
    seen = Seen(gate_open=True, closed=None)
    assert seen.outside.situation is not None
    assert not seen.outside.situation.certain
    assert "closed" in seen.outside.situation.awaited
    assert not seen.ask()


def test_a_way_is_asked_for_once_in_each_state_as_far_as_it_matters() -> None:
    seen = Seen(gate_open=True, closed=True)
    assert [seen.ask(), seen.ask()] == [True, False]
    known = seen.outside.answer
    seen.change(lamp=True)
    assert not seen.ask()
    assert seen.outside.answer is known
    seen.change(shut=True)
    assert seen.outside.answer is None
    assert seen.ask()
    seen.change(gate_open=False)
    assert seen.outside.situation is None
    assert not seen.ask()


def test_an_answer_that_comes_too_late_is_not_shown() -> None:
    seen = Seen(gate_open=True, closed=True)
    request = seen.outside.request(deadline=20)
    assert request is not None
    seen.change(shut=True)
    seen.outside.take(request, WaysBack(press()[0], press()[1].safe).answer(request))
    assert seen.outside.answer is None
    assert seen.ask()


def test_a_question_that_failed_is_asked_again_only_where_that_may_help() -> None:
    seen = Seen(gate_open=True, closed=True)
    request = seen.outside.request(deadline=20)
    assert request is not None
    seen.outside.unanswered(request, "the planner has ended", again=True)
    assert seen.outside.request(deadline=20) == request
    seen.outside.unanswered(request, "it does not replay", again=False)
    assert seen.outside.request(deadline=20) is None
    assert str(seen.outside.way()) == "No way back could be computed: it does not replay"


def test_a_device_moved_by_hand_raises_an_alarm_that_says_what_is_wrong_and_which_way_leads_back() -> None:
    async def scenario() -> None:
        async with bench() as on:
            arm, execution = Arm(on.network), on.controller.execution

            def shown() -> WayBackView:
                view = on.controller.view().way_back
                assert view is not None
                return view

            execution.state = {**execution.state, "parts[left]": "full"}
            assert UNSAFE not in on.controller.view().alarms
            assert (shown().awaits, shown().differences) == (["/arm/state"], [])
            assert shown().reason == "Safety unknown: nothing heard from Arm."

            with arm.saying("home"):
                await on.until(lambda: on.controller.view().way_back is None)
            with arm.saying("out"):  # by hand: it was not told to
                await on.until(lambda: UNSAFE in on.controller.view().alarms)
                first = on.controller.view().alarms[UNSAFE]
                assert "Violated: “never”" in first.text
                await on.until(lambda: shown().ticks is not None)
                assert (shown().ticks, shown().steps) == (1, [])
                assert shown().reason.startswith("Nothing needs to be started: it comes back by itself when ")

                execution.state = {**execution.state, "arm.goto": "out"}
                await on.until(lambda: bool(shown().steps))
                assert shown().violated == [SpecificationView(name="never", title="never")]
                assert shown().differences in (
                    [DifferenceView(name="arm.pose", now="out", safe="home")],
                    [DifferenceView(name="parts[left]", now="full", safe="empty")],
                )
                assert [(step.tick, step.ability) for step in shown().steps] == [(1, "arm.move(home)")]
                alarm = on.controller.view().alarms[UNSAFE]
                assert alarm.action == CHOOSE
                assert alarm.since == first.since
                assert arm.commands == []
            with arm.saying("home"):  # and the command is what it was
                execution.state = {**execution.state, "arm.goto": "home"}
                await on.until(lambda: on.controller.view().way_back is None)
                assert on.controller.view().alarms[UNSAFE].state is AlarmState.RETURNED

    asyncio.run(scenario())


def test_outside_the_safe_states_plans_are_made_as_before_and_nothing_is_started() -> None:
    """The arm has been told to go where it must not; it would reach a goal there."""

    async def scenario() -> None:
        async with bench() as on:
            arm, execution = Arm(on.network), on.controller.execution
            with arm.saying("home"):
                await on.until(lambda: execution.state["arm.pose"] == "home")
                execution.state = {**execution.state, "parts[left]": "full", "arm.goto": "out"}
                await on.start()
                await on.until(lambda: on.controller.view().plan.status is PlanStatus.FOLLOWED)
                await on.until(lambda: "devices could violate “never”" in on.controller.view().alarms[UNSAFE].text)
                assert "fetch(right)" in execution.active
                assert not execution.plan.order.past

    asyncio.run(scenario())
