"""Plans by hand: what is offered, what it takes to take it, and that nothing else is carried out."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from functools import partial

import pytest

from sequence_planner.automaton.automaton import HumanTask, Operation
from sequence_planner.controller.commands.command import CommandRefused, GivenValue
from sequence_planner.controller.commands.queries import AskAdvice, AskGoal, AskReset
from sequence_planner.controller.commands.recovery import ExecuteOperatorPlan
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.planner_client import AdvisorClient
from sequence_planner.controller.recovery import proposals
from sequence_planner.controller.recovery.consistency import ConsistencyMonitor
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.controller.recovery.proposals import Offers
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.views.proposals import OfferView
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.recovery.proposals import Advice, ProposalEffort
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.synthesis.supervisor import synthesise
from sequence_planner.texts.message import Title
from support.automata import Does, automaton, predicate_of
from support.people import EVA

PLACES = EnumerationType(("home", "work"))
RESTING = "at == target and not jammed"


def made(precondition: str = "loaded") -> Executor:
    """A cart that carries things from home to work; when it is jammed, only a rescue moves it."""
    cart = automaton(
        {
            "go": Does(("target := work",), f"at == home and {RESTING}", executing="at != target", finish="at == work"),
            "back": Does(
                ("target := home",), f"at == work and {RESTING}", executing="at != target", finish="at == home"
            ),
            "load": Does(("loaded := true", "delivered := false"), f"at == home and not loaded and {RESTING}"),
            "unload": Does(("loaded := false", "delivered := true"), f"at == work and loaded and {RESTING}"),
            "rescue": Does(("jammed := false",), "jammed", restart=True),
        },
        measured={"at": (PLACES, "home")},
        output={"target": (PLACES, "home")},
        estimated={"loaded": (BOOLEAN, False), "delivered": (BOOLEAN, False), "jammed": (BOOLEAN, False)},
        effects={
            "go.arrives": ("target == work and at == home", ("at := work",)),
            "back.arrives": ("target == home and at == work", ("at := home",)),
        },
        forbidden={"too much": "loaded and delivered"},
    )
    begins, delivered = predicate_of(cart, precondition), predicate_of(cart, "delivered")
    operation = Operation("deliver", "Deliver", begins, delivered)
    at = replace(cart.variables["at"], resource="station")
    cart = replace(cart, operations={"deliver": operation}, variables={**cart.variables, "at": at})
    return Executor(cart, synthesise(cart))


def test_what_only_weighs_takes_no_time() -> None:
    effort = ProposalEffort(changes=1, physical=1, starts=2, seconds=5.0, left_out=1, breaks=1, unsupervised=True)
    assert effort.time == 5 + 30 + 60 + 2 * 2
    assert effort.cost > effort.time


class Desk:
    """The station, and who offers what there is to do."""

    def __init__(self, advisor: AdvisorClient, execution: Executor) -> None:
        self.advisor, self.execution = advisor, execution
        doubting = ConsistencyMonitor(execution)
        corrections = Corrections(execution, advisor.answer, Beliefs(execution), doubting, lambda names: None)
        self.offers = Offers(execution, advisor, corrections.correct, doubting.impossible, StallDetector(execution))
        self.seconds = 0.0
        self.at: Value = "home"

    @property
    def now(self) -> Timestamp:
        return Timestamp(1000.0 + self.seconds, self.seconds)

    def tick(self, at: Value | None = None) -> tuple[str, ...]:
        """The abilities that a tick starts."""
        self.seconds += 0.1
        self.at = at or self.at
        return self.execution.tick({"at": self.at}, self.now).started

    def enter(self, mode: Mode) -> None:
        self.execution.change_mode(mode, "Eva", self.now)

    def correct(self, **values: Value) -> None:
        self.execution.correct(values, "Eva", "seen", self.now)

    def believe(self, **values: Value) -> None:
        """As an ability would have written it: nobody has said that it is so."""
        self.execution.state = self.execution.corrected(values)

    def take(
        self, offer: OfferView, starts: list[str] | None = None, corrections: dict[str, GivenValue] | None = None
    ) -> None:
        """Take it as it was shown, or with other things confirmed."""
        shown = [] if offer.errand is None else [step.ability for step in offer.errand.steps]
        changes = {change.name: change.then for change in offer.corrections}
        command = ExecuteOperatorPlan(
            actor=EVA,
            reason="to try it",
            offer=offer.id,
            starts=shown if starts is None else starts,
            corrections=changes if corrections is None else corrections,
        )
        self.offers.take(command, self.now)


def refused(slug: str, act: Callable[[], object], status: int = 409) -> str:
    """What is said."""
    with pytest.raises(CommandRefused) as found:
        act()
    assert (found.value.slug, found.value.status) == (slug, status)
    assert (found.value.place is not None) == (slug == "bad-predicate")
    return found.value.detail


async def refused_later(slug: str, asking: Awaitable[object], status: int = 409) -> str:
    with pytest.raises(CommandRefused) as found:
        await asking
    assert (found.value.slug, found.value.status) == (slug, status)
    return found.value.detail


@asynccontextmanager
async def desk(precondition: str = "loaded") -> AsyncIterator[Desk]:
    execution = made(precondition)
    advisor = AdvisorClient(execution.automaton, execution.supervisor)
    try:
        yield Desk(advisor, execution)
    finally:
        advisor.close()


def test_a_goal_by_hand_is_shown_confirmed_and_carried_out_as_it_was_shown() -> None:
    async def scenario() -> None:
        async with desk() as there:
            there.tick()
            offer = await there.offers.goal(AskGoal(predicate="at == work and not loaded"))
            assert offer.errand is not None
            assert [(step.ability, step.tick) for step in offer.errand.steps] == [("go", 1)]
            assert (offer.kind, offer.needs_restart, offer.ends) == ("goal", False, "at == work and not loaded")
            assert offer.obstacle == refused("production-not-started", lambda: there.take(offer))
            there.execution.start_production()
            assert "changed" in refused("stale-revision", lambda: there.take(offer))
            offer = await there.offers.goal(AskGoal(predicate="at == work"))
            assert offer.obstacle == refused("wrong-mode", lambda: there.take(offer))
            there.enter(Mode.PAUSED)
            offer = await there.offers.goal(AskGoal(predicate="at == work"))
            assert offer.obstacle is None
            refused("not-confirmed", lambda: there.take(offer, starts=[]))
            refused("not-confirmed", lambda: there.take(offer, corrections={"jammed": False}))
            refused("proposal-gone", lambda: there.take(offer.model_copy(update={"id": "another-1"})))
            assert there.execution.operator_plan is None
            there.take(offer)
            assert there.execution.operator_plan is not None
            assert (there.execution.operator_plan.by, there.execution.operator_plan.why) == ("Eva", "to try it")
            assert there.tick() == ("go",)
            await refused_later("plan-running", there.offers.goal(AskGoal(predicate="loaded")))
            await refused_later("plan-running", there.offers.advice(AskAdvice()))
            assert there.tick(at="work") == ()
            assert there.execution.operator_plan is None
            assert there.execution.conduct.last_operator_plan is not None
            assert there.execution.conduct.last_operator_plan.done
            assert there.execution.mode is Mode.PAUSED

    asyncio.run(scenario())


def test_what_cannot_be_offered_is_said() -> None:
    async def scenario() -> None:
        async with desk() as there:
            there.tick()
            text = await refused_later(
                "bad-predicate", there.offers.goal(AskGoal(predicate="loaded and att == work")), 422
            )
            assert text.startswith("character 12, `att`: ")
            await refused_later("bad-predicate", there.offers.goal(AskGoal(predicate="loaded and")), 422)
            await refused_later("goal-holds", there.offers.goal(AskGoal(predicate="at == home")))
            text = await refused_later("no-plan", there.offers.goal(AskGoal(predicate="loaded and delivered")))
            assert "There is no plan as long as all of this is so" in text
            await refused_later("unknown-operation", there.offers.reset(AskReset(operation="carry")), 404)

    asyncio.run(scenario())


def test_an_operation_is_reset_to_where_it_begins() -> None:
    async def scenario() -> None:
        async with desk() as there:
            there.execution.start_production()
            there.tick(at="work")
            there.correct(delivered=True)
            there.execution.correct({"target": "work"}, "Eva", "seen", there.now)
            there.enter(Mode.PAUSED)
            there.tick()
            offer = await there.offers.reset(AskReset(operation="deliver"))
            assert (offer.kind, offer.operation, offer.title) == ("reset", "deliver", "Reset Deliver")
            assert offer.errand is not None
            assert [step.ability for step in offer.errand.steps] == ["back", "load"]
            there.take(offer)
            assert there.tick() == ("back",)
            assert there.tick(at="home") == ("load",)
            there.tick()
            assert there.execution.operator_plan is None
            there.tick()
            assert "deliver" in there.execution.active

    asyncio.run(scenario())


def test_where_there_was_too_little_time_for_advice_asking_again_finds_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proposals, "AdviceRequest", partial(AdviceRequest, deadline=0.0))
    monkeypatch.setattr(proposals, "WAITING", 60.0)  # the advisor is only being started

    async def scenario() -> None:
        async with desk() as there:
            there.tick()
            hurried = await there.offers.advice(AskAdvice())
            assert (hurried.offers, hurried.complete) == ([], False)
            advice = await there.offers.advice(AskAdvice())
            assert advice.offers
            assert await there.offers.advice(AskAdvice()) is advice

    asyncio.run(scenario())


def test_where_there_was_time_for_corrections_alone_asking_again_finds_more(monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario() -> None:
        async with desk() as there:
            at_leisure = there.advisor.answer

            async def answer(request: AdviceRequest, deadline: float) -> Advice:
                advice = await at_leisure(request, deadline)
                if request.deadline >= proposals.LONGER:
                    return advice
                return replace(advice, offers=tuple(each for each in advice.offers if each.corrections), complete=False)

            monkeypatch.setattr(there.advisor, "answer", answer)
            monkeypatch.setattr(proposals, "WAITING", 60.0)  # the advisor is only being started
            there.execution.start_production()
            there.correct(loaded=True)
            there.tick()
            there.believe(jammed=True)
            there.tick()
            hurried = await there.offers.advice(AskAdvice())
            assert [bool(offer.corrections) for offer in hurried.offers] == [True]
            advice = await there.offers.advice(AskAdvice())
            assert any(offer.errand is not None and not offer.corrections for offer in advice.offers)
            assert await there.offers.advice(AskAdvice()) is advice

    asyncio.run(scenario())


def test_an_incomplete_answer_is_never_the_last_word_and_loses_nothing_that_was_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def scenario() -> None:
        async with desk() as there:
            at_leisure, asked = there.advisor.answer, 0

            async def answer(request: AdviceRequest, deadline: float) -> Advice:
                nonlocal asked
                advice = await at_leisure(request, deadline)
                asked += 1
                if asked > 2:
                    return advice
                # First what is done alone, which used to be the last word, then what is said alone.
                said = asked == 2
                part = tuple(each for each in advice.offers if bool(each.corrections) == said)
                return replace(advice, offers=part, complete=False)

            monkeypatch.setattr(there.advisor, "answer", answer)
            monkeypatch.setattr(proposals, "WAITING", 60.0)  # the advisor is only being started
            there.execution.start_production()
            there.correct(loaded=True)
            there.tick()
            there.believe(jammed=True)
            there.tick()
            first = await there.offers.advice(AskAdvice())
            assert first.offers
            assert not any(offer.corrections for offer in first.offers)
            assert not first.complete
            second = await there.offers.advice(AskAdvice())
            found = [offer.title for offer in second.offers]
            assert {offer.title for offer in first.offers} < set(found)
            assert second.offers[-1].corrections
            assert not second.complete
            third = await there.offers.advice(AskAdvice())
            assert third.complete
            assert await there.offers.advice(AskAdvice()) is third
            assert asked == 3

            # What was found in one mode is so in another, and is not looked for once more.
            there.enter(Mode.RESTART)
            entered = await there.offers.advice(AskAdvice())
            assert [offer.title for offer in entered.offers] == [offer.title for offer in third.offers]
            assert entered.revision == there.execution.revision > third.revision
            assert asked == 3
            there.take(next(offer for offer in entered.offers if not offer.corrections))

    asyncio.run(scenario())


def test_what_a_person_has_said_is_missing_a_person_may_put_in_by_hand_and_then_say_so(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(proposals, "WAITING", 60.0)  # the advisor is only being started

    async def scenario() -> None:
        execution = made(precondition="true")
        abilities = dict(execution.automaton.abilities)
        task = HumanTask(Title("Put it on the cart.", {"en": "Put it on the cart."}), "at")
        # The task is never asked for: only a person who acts without having been asked can do it.
        never = predicate_of(execution.automaton, "jammed and not jammed")
        done = replace(abilities["load"], finish_guard=never, finish_actions=abilities["load"].start_actions)
        abilities["load"] = replace(done, human=task, enabled=never, start_actions=())
        station = replace(execution.automaton, abilities=abilities)
        execution = Executor(station, synthesise(station))
        advisor = AdvisorClient(execution.automaton, execution.supervisor)
        try:
            there = Desk(advisor, execution)
            execution.start_production()
            there.tick()
            there.correct(loaded=True)
            there.correct(loaded=False)
            there.enter(Mode.RESTART)
            there.tick()
            advice = await there.offers.advice(AskAdvice())
            told = [*advice.offers, *advice.if_checked]
            (offer,) = (each for each in told if [change.name for change in each.corrections] == ["loaded"])
            assert offer.title == "Do it yourself: load"
            assert [str(change.by_hand) for change in offer.corrections] == ["Put it on the cart."]
            assert offer.obstacle is None
            there.take(offer)
            assert execution.state["loaded"] is True
        finally:
            advisor.close()

    asyncio.run(scenario())


def test_the_reset_of_an_operation_whose_beginning_holds_neither_starts_nor_awaits_anything() -> None:
    async def scenario() -> None:
        async with desk(precondition="at == home") as there:
            there.execution.start_production()
            there.tick()
            there.enter(Mode.PAUSED)
            offer = await there.offers.reset(AskReset(operation="deliver"))
            assert offer.errand is not None
            assert (offer.errand.steps, offer.errand.ticks) == ([], 0)

    asyncio.run(scenario())


def test_all_who_ask_at_once_get_one_answer_though_one_of_them_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(proposals, "WAITING", 60.0)  # the advisor is only being started

    async def scenario() -> None:
        async with desk() as there:
            there.tick()
            leaving, *staying = (asyncio.create_task(there.offers.advice(AskAdvice())) for _ in range(4))
            await asyncio.sleep(0)  # all have asked, and nobody can have answered
            leaving.cancel()
            first, *others = await asyncio.gather(*staying)
            assert first.offers
            assert all(each is first for each in others)
            assert leaving.cancelled()

    asyncio.run(scenario())


def test_the_advisor_offers_a_correction_and_a_restart_ability_and_each_can_be_taken(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def scenario() -> None:
        async with desk() as there:
            there.execution.start_production()
            there.correct(loaded=True)
            there.tick()
            there.believe(jammed=True)
            there.tick()
            assert there.execution.active == {"deliver"}
            said = next(offer for offer in (await there.offers.advice(AskAdvice())).offers if offer.corrections)
            assert said.obstacle == refused("not-in-restart", lambda: there.take(said))
            there.enter(Mode.RESTART)
            advice = await there.offers.advice(AskAdvice())
            assert [offer.obstacle for offer in advice.offers if offer.corrections] == [None]
            assert advice.revision == there.execution.revision
            assert await there.offers.advice(AskAdvice()) is advice, "the same question is not asked twice"
            monkeypatch.setattr(proposals, "MOST_KEPT", len(advice.offers))
            await there.offers.goal(AskGoal(predicate="not jammed"))  # and for it another offer is forgotten
            advice = await there.offers.advice(AskAdvice())
            rescue = next(offer for offer in advice.offers if offer.errand is not None and offer.errand.steps)
            correction = next(offer for offer in advice.offers if offer.corrections)
            assert [step.ability for step in rescue.errand.steps] == ["rescue"] if rescue.errand else False
            assert rescue.needs_restart
            assert rescue.then is not None
            assert {step.ability for step in rescue.then.steps} == {"go", "unload"}
            assert [(each.name, each.now, each.then) for each in correction.corrections] == [("jammed", True, False)]
            refused("not-confirmed", lambda: there.take(correction, corrections={}))
            refused("not-confirmed", lambda: there.take(correction, corrections={"jammed": 0}))
            there.take(correction)
            assert there.execution.state["jammed"] is False
            refused("stale-revision", lambda: there.take(rescue))
            there.correct(jammed=True)
            there.enter(Mode.PAUSED)
            advice = await there.offers.advice(AskAdvice())
            rescue = next(offer for offer in advice.offers if offer.errand is not None and offer.errand.steps)
            assert "Enter it" in refused("wrong-mode", lambda: there.take(rescue))
            there.enter(Mode.RESTART)
            advice = await there.offers.advice(AskAdvice())
            there.take(next(offer for offer in advice.offers if offer.errand is not None and offer.errand.steps))
            assert there.tick() == ("rescue",)
            there.tick()
            assert there.execution.operator_plan is None
            assert there.execution.mode is Mode.RESTART, "to leave it is another act"
            replan = (await there.offers.advice(AskAdvice())).offers[0]
            assert replan.kind == "replan"
            assert replan.obstacle == refused("nothing-to-execute", lambda: there.take(replan))

    asyncio.run(scenario())


def test_a_resource_comes_back_where_nobody_knows_whether_an_operation_can_begin() -> None:
    async def scenario() -> None:
        async with desk("loaded and at == work") as there:
            execution = there.execution
            execution.start_production()
            there.tick("work")
            there.correct(loaded=True)
            execution.tick({"at": None}, there.now, silent=frozenset({"station"}))
            assert not execution.active
            (offer,) = (await there.offers.advice(AskAdvice())).offers
            assert (offer.kind, offer.online, offer.goals) == ("physical", ["station"], ["deliver"])
            execution.set_service(ServiceKind.OPERATION, "deliver", False, "Eva", "not today", there.now)
            assert [offer.kind for offer in (await there.offers.advice(AskAdvice())).offers] == ["replan"]

    asyncio.run(scenario())


def test_what_somebody_has_said_is_contradicted_by_no_offer() -> None:
    async def scenario() -> None:
        async with desk() as there:
            there.execution.start_production()
            there.correct(loaded=True)
            there.tick()
            there.believe(jammed=True)
            there.tick()
            there.enter(Mode.RESTART)
            advice = await there.offers.advice(AskAdvice())
            said = {change.name for offer in (*advice.offers, *advice.if_checked) for change in offer.corrections}
            assert said == {"jammed"}, "that it is loaded was said"
            assert not advice.offers[0].corrections
            there.execution.confirm(frozenset({"jammed"}), "Eva", there.now)
            advice = await there.offers.advice(AskAdvice())
            assert advice.offers
            assert not any(offer.corrections for offer in (*advice.offers, *advice.if_checked))

    asyncio.run(scenario())
