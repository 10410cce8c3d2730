"""Why not? Every condition in the way, with the variables that decide it and who could change them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace

import pytest

from controller.test_offers import Desk, made
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AskAbilityBlockers, AskGoalBlockers, AskOperationBlockers
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.planner_client import AdvisorClient
from sequence_planner.controller.recovery.explain import ConditionContext, HindranceKind, Involving, of_ability
from sequence_planner.controller.recovery.why_not import WhyNot
from sequence_planner.controller.views.details import ConditionView, ReasonView, WhyNotView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.types import BOOLEAN
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import PlanRequest
from sequence_planner.synthesis.guards import shown_guards
from sequence_planner.synthesis.supervisor import supervised, supervisor
from support.automata import Does, automaton, predicate_of
from support.places import BOLT_TIGHTENING, TRUCK_ENGINE_STATION

UNSUPERVISED = Supervisor(StateSet((), ()), {})


class Inquirer:
    """Somebody who asks about the cart."""

    def __init__(self, advisor: AdvisorClient, execution: Executor) -> None:
        self.desk = Desk(advisor, execution)
        around = ConditionContext({"at": "/cart/state"}, lambda name: 7.0, Beliefs(execution), dict)
        self.execution = execution
        self.why_not = WhyNot(execution, around, advisor)

    async def ability(self, name: str) -> WhyNotView:
        return self.why_not.ability(AskAbilityBlockers(name=name))

    async def operation(self, name: str = "deliver") -> WhyNotView:
        return self.why_not.operation(AskOperationBlockers(name=name))

    async def goal(self, predicate: str) -> WhyNotView:
        return await self.why_not.goal(AskGoalBlockers(predicate=predicate))

    def plan(self) -> None:
        request = self.execution.request(20)
        assert isinstance(request, PlanRequest)
        planner = Planner(self.execution.automaton, self.execution.supervisor)
        self.execution.adopt(request, planner.answer(request))


@asynccontextmanager
async def inquirer() -> AsyncIterator[Inquirer]:
    execution = made()
    advisor = AdvisorClient(execution.automaton, execution.supervisor)
    try:
        yield Inquirer(advisor, execution)
    finally:
        advisor.close()


def found(view: WhyNotView) -> list[tuple[str, str]]:
    return [(each.kind, each.text) for each in view.conditions]


def who(condition: ConditionView, variable: str) -> list[tuple[str, str]]:
    (involved,) = [each for each in condition.involved if each.name == variable]
    return [(each.how, each.name) for each in involved.changers]


def test_an_ability_says_all_that_is_in_its_way_and_who_could_change_it() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            desk, execution = asked.desk, asked.execution
            desk.tick()
            desk.enter(Mode.PAUSED)
            view = await asked.ability("unload")
            assert found(view) == [
                ("station", "production to be started"),
                ("station", "automatic mode: the station is paused"),
                ("written", "at == work"),
                ("written", "loaded"),
            ]
            assert view.summary == "It waits for 4 things."
            place, loaded = view.conditions[2:]
            (at,) = place.involved
            assert (at.name, at.value, at.wanted, at.since, at.topic) == ("at", "home", ["work"], 7.0, "/cart/state")
            assert who(place, "at") == [("effect", "go"), ("device", "station")]
            assert at.changers[1].title == "somebody at “station”"
            assert who(loaded, "loaded") == [("start", "load"), ("correction", "loaded")]
            execution.start_production()
            execution.set_service(ServiceKind.ABILITY, "unload", False, "Eva", "a test", desk.now)
            desk.enter(Mode.AUTOMATIC)
            assert found(await asked.ability("unload"))[0] == ("service", "unload to be put back in service")
            assert found(await asked.ability("rescue")) == [
                ("service", "restart mode, and a way back that has it"),
                ("written", "jammed"),
            ]
            desk.execution.tick({"at": None}, desk.now)
            (unheard,) = (await asked.ability("load")).conditions[:1]
            assert (unheard.text, who(unheard, "at")) == ("a message on /cart/state", [("message", "/cart/state")])
            with pytest.raises(CommandRefused) as refused:
                await asked.ability("fly")
            assert (refused.value.slug, refused.value.status) == ("unknown-ability", 404)

    asyncio.run(scenario())


def leaves(part: ReasonView) -> list[ReasonView]:
    return [leaf for each in part.parts for leaf in leaves(each)] if part.parts else [part]


def test_the_conditions_are_told_in_whole_as_trees() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            desk, execution = asked.desk, asked.execution
            execution.start_production()
            desk.tick()
            (enabled,) = (await asked.ability("unload")).trees
            assert (enabled.about, enabled.tree.kind, enabled.tree.holds) == ("enabled", "all", False)
            parts = {part.text: part for part in leaves(enabled.tree)}
            assert parts["at == work"].decides
            assert [each.name for each in parts["at == work"].involved] == ["at"]
            assert [(each.name, each.value) for each in parts["loaded"].reads] == [("loaded", False)]
            resting = [part for part in parts.values() if part.holds]
            assert resting
            assert not any(part.decides or part.involved for part in resting)
            (begins,) = (await asked.operation()).trees
            assert (begins.about, [leaf.text for leaf in leaves(begins.tree)]) == ("precondition", ["loaded"])
            desk.correct(loaded=True)
            desk.tick()
            (goal,) = (await asked.operation()).trees
            assert (goal.about, goal.tree.holds) == ("goal", False)
            asked.plan()
            assert desk.tick() == ("go",)
            running = await asked.ability("go")
            (end,) = running.trees
            assert (running.conditions, end.about) == ([], "finish")
            (arrived,) = leaves(end.tree)
            assert [(each.how, each.name) for each in arrived.involved[0].changers] == [
                ("effect", "go"),
                ("device", "station"),
            ]

    asyncio.run(scenario())


def test_what_must_end_is_wanted_otherwise_down_to_the_variables() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            asked.execution.start_production()
            asked.desk.correct(delivered=True)
            asked.desk.tick()
            done, begins = (await asked.operation()).trees
            assert (done.about, done.tree.wanted, done.tree.holds) == ("undone", False, True)
            (delivered,) = done.tree.involved
            assert (delivered.name, delivered.wanted, begins.about) == ("delivered", [False], "precondition")
            (tree,) = (await asked.goal("not (loaded or at == work)")).trees
            assert (tree.about, tree.tree.holds, [part.involved for part in leaves(tree.tree)]) == (
                "predicate",
                True,
                [[], []],
            )

    asyncio.run(scenario())


def test_somebody_acknowledges_a_task_and_the_clock_changes_what_goes_by_it() -> None:
    station = usable_automaton(BOLT_TIGHTENING)
    execution = Executor(station, UNSUPERVISED)
    execution.tick({"operator.acknowledged": False, "robot.pose": "home"}, Timestamp(0.0, 0.0))
    timed = frozenset({"robot.pose"})
    involving = Involving(execution, ConditionContext({}, lambda name: None, Beliefs(execution), dict, timed))
    (free,) = involving.among(predicate_of(station, "operator.acknowledged"))
    assert [(each.how, each.name) for each in free.changers] == [("task", "operator")]
    (pose,) = involving.among(predicate_of(station, "robot.pose == above_engine"))
    assert [each.how for each in pose.changers if each.how != "effect"] == ["clock", "device"]


def test_the_supervisor_and_the_plan_can_be_in_the_way() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            desk, execution = asked.desk, asked.execution
            execution.start_production()
            desk.tick()
            view = await asked.ability("go")
            assert [each.kind for each in view.conditions] == ["plan"]
            assert view.summary == "It may start, and the plan does not have it now."
            desk.correct(loaded=True)
            desk.tick()
            asked.plan()
            view = await asked.ability("go")
            assert (view.conditions, view.summary) == ([], "Nothing is in the way: it starts in the next tick.")
            assert desk.tick() == ("go",)
            assert (await asked.ability("go")).summary == "It runs."
            execution.set_stepping(True)
            assert ("station", "a step: the station goes step by step") in found(await asked.ability("unload"))

    asyncio.run(scenario())


def test_what_the_supervisor_adds_is_told_with_its_specification() -> None:
    both = automaton(
        {"one": Does(("first := true",), "not first"), "other": Does(("second := true",), "not second")},
        estimated={"first": (BOOLEAN, False), "second": (BOOLEAN, False)},
        forbidden={"both": "first and second"},
    )
    supervision = supervised(both)
    execution = Executor(both, supervisor(supervision))
    execution.correct({"first": True}, "Eva", "seen", Timestamp(0.0, 0.0))
    ability, guard = both.abilities["other"], shown_guards(supervision)["other"]
    (added,) = of_ability(execution, ability, {}, guard)
    assert (added.kind, added.text) == (HindranceKind.SUPERVISOR, "not first, because of: both")
    assert added.expression == predicate_of(both, "not first")
    (long,) = of_ability(execution, ability, {}, replace(guard, expression=None))
    assert long.text == "not first (the nearest state in which it may start), because of: both"
    assert long.expression == predicate_of(both, "not first")
    (unworded,) = of_ability(execution, ability, {}, None)
    assert unworded.text == "a safe start: both (both)"


def test_specifications_of_one_title_are_named_once() -> None:
    """Those that one of the model was written out to: one for each pair of bolts, for instance."""
    both = automaton(
        {"one": Does(("first := true",), "not first"), "other": Does(("second := true",), "not second")},
        estimated={"first": (BOOLEAN, False), "second": (BOOLEAN, False)},
        forbidden={"pair_1": "first and second", "pair_2": "first and second", "rest": "first and second"},
    )
    titles = {"pair_1": "One at a time", "pair_2": "One at a time", "rest": "Rest"}
    alike = {name: replace(each, title=titles[name]) for name, each in both.specifications.items()}
    both = replace(both, specifications=alike)
    supervision = supervised(both)
    execution = Executor(both, supervisor(supervision))
    execution.correct({"first": True}, "Eva", "seen", Timestamp(0.0, 0.0))
    guard = replace(shown_guards(supervision)["other"], specifications=tuple(titles))
    (added,) = of_ability(execution, both.abilities["other"], {}, guard)
    assert added.text == "not first, because of: One at a time and Rest"


def test_an_operation_says_why_it_is_not_active_or_how_far_it_is() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            desk, execution = asked.desk, asked.execution
            execution.start_production()
            desk.tick()
            view = await asked.operation()
            assert found(view) == [("written", "loaded")]
            assert view.summary == "It is not active. It waits for loaded."
            execution.set_service(ServiceKind.OPERATION, "deliver", False, "Eva", "a test", desk.now)
            assert found(await asked.operation())[0] == ("service", "Deliver to be put back in service")
            execution.set_service(ServiceKind.OPERATION, "deliver", True, "Eva", "a test", desk.now)
            desk.correct(loaded=True)
            desk.tick()
            asked.plan()
            view = await asked.operation()
            assert view.summary == "It is active, and the plan leads to its goal."
            assert found(view) == [("written", "delivered")]
            desk.enter(Mode.RESTART)
            assert "restart mode" in (await asked.operation()).summary
            desk.correct(loaded=False, delivered=True)
            desk.tick()
            view = await asked.operation()
            assert found(view) == [
                ("written", "not delivered: its goal holds"),
                ("written", "loaded"),
            ]
            assert view.summary == "Its goal holds now."
            assert view.conditions[0].sentence is None, "it does not wait until it comes undone"

    asyncio.run(scenario())


def test_a_goal_says_whether_the_station_could_reach_it() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            asked.desk.tick()
            assert (await asked.goal("at == home")).summary == "It holds."
            view = await asked.goal("at == work and delivered")
            assert found(view) == [("written", "at == work"), ("written", "delivered")]
            assert view.plan is not None
            assert [step.ability for step in view.plan.steps] == ["load", "go", "unload"]
            assert view.summary.endswith("The station could reach it with 3 starts.")
            never = await asked.goal("loaded and delivered")
            assert never.plan is None
            assert never.reasons is not None
            assert "the goal asked for" in never.reasons.members
            with pytest.raises(CommandRefused, match="character 1, `up`"):
                await asked.goal("up")

    asyncio.run(scenario())


def test_what_is_out_of_service_is_said_to_be_so_and_what_is_silent_to_be_offline() -> None:
    async def scenario() -> None:
        async with inquirer() as asked:
            desk, execution = asked.desk, asked.execution
            desk.tick()
            execution.set_service(ServiceKind.RESOURCE, "station", False, "Eva", "it squeaks", desk.now)
            reasons = (await asked.goal("at == work")).reasons
            assert reasons is not None
            assert "station is out of service" in reasons.members
            assert reasons.corrections == ["station in service"]
            execution.set_service(ServiceKind.RESOURCE, "station", True, "Eva", "oiled", desk.now)
            execution.tick({"at": "home"}, desk.now, silent=frozenset({"station"}))
            reasons = (await asked.goal("at == work")).reasons
            assert reasons is not None
            assert "station is offline" in reasons.members
            assert reasons.corrections == ["station online"]

    asyncio.run(scenario())


def test_what_has_a_name_is_told_by_it_with_what_does_not_hold_of_it_beside() -> None:
    """At the truck engine station: a predicate, what is said of each pair, and the turn in a sequence."""
    station = usable_automaton(TRUCK_ENGINE_STATION)
    execution = Executor(station, UNSUPERVISED)
    first, *others = [name for name in station.variables if name.startswith("bolts[")]
    values = {**initial_state(station), "ladder_frame": "on_engine", "agv.ref_pos": "station", first: "tightened"}
    execution.state = execution.published = synchronise(station, values)
    around = ConditionContext({}, lambda name: None, Beliefs(execution), dict)
    adviser = AdvisorClient(station, UNSUPERVISED)
    try:
        asked = WhyNot(execution, around, adviser)

        def condition(operation: str) -> ConditionView:
            return asked.operation(AskOperationBlockers(name=operation)).conditions[-1]

        tightened = condition("take_filter_tool")
        assert tightened.text == "all_tightened"
        assert tightened.expanded == " and ".join(f"{name} == tightened" for name in others)
        assert [each.name for each in tightened.involved] == others

        left = ", ".join(name.removeprefix("bolts[").removesuffix("]") for name in others)
        placed = condition("return_kit")
        assert placed.text == f"all pair in {{{left}}}: bolts[pair] != empty"
        assert placed.expanded == " and ".join(f"{name} != empty" for name in others)

        turn = condition("tighten_bolt_pair(AtBoltPair3TCPPose)")
        assert turn.text_message.id == "waits.sequence-behind"
        second = station.operations["tighten_bolt_pair(AtBoltPair2TCPPose)"].title
        assert turn.text == f"its turn in the sequence tighten_bolts, behind “{second}”"
        assert turn.expanded == "bolts[AtBoltPair2TCPPose] == tightened"
        assert [each.name for each in turn.involved] == ["bolts[AtBoltPair2TCPPose]"]
    finally:
        adviser.close()
