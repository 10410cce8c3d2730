"""Who is in control, and what only they may do; a demonstration and real devices."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from functools import partial

import pytest
from hypothesis import given

from core.choices import Choices, made_by
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import (
    ClearOverride,
    ReleaseControl,
    SetMode,
    SetOverride,
    StartProduction,
    TakeControl,
    WithdrawControl,
)
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.core.actor import SYSTEM, Actor, ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.vocabulary import Mode, Production
from support.cell import Arm, Bench, bench
from support.examples import examples
from support.people import ADAM, EVA, person

NOW = Timestamp(1000.0, 10.0)

KEY = Actor(kind=ActorKind.KEY, id="k1", name="MES")


def run(scenario: Callable[[Bench], Awaitable[None]]) -> None:
    async def whole() -> None:
        async with bench() as on:
            await scenario(on)

    asyncio.run(whole())


async def refusal(on: Bench, command: Command) -> CommandRefused:
    """Why the command is refused; it is."""
    with pytest.raises(CommandRefused) as refused:
        await on.controller.command(command)
    return refused.value


MOVING: tuple[Command, ...] = (
    StartProduction(actor=EVA),
    SetMode(actor=EVA, mode=Mode.AUTOMATIC),
    SetOverride(actor=EVA, name="arm.speed", fields={"speed": 1}),
    ClearOverride(actor=EVA, name="arm.speed"),
)


@pytest.mark.parametrize("command", MOVING, ids=lambda command: command.kind)
def test_what_moves_devices_is_for_who_is_in_control(command: Command) -> None:
    async def scenario(on: Bench) -> None:
        nobody = await refusal(on, command)
        assert (nobody.slug, nobody.status) == ("control-needed", 409)
        await on.controller.command(TakeControl(actor=ADAM))
        other = await refusal(on, command)
        assert other.slug == "control-needed"
        assert "Adam is in control" in other.detail
        assert on.controller.execution.production is Production.WAITING

    run(scenario)


def test_who_is_in_control_starts_production_and_goes_on() -> None:
    async def scenario(on: Bench) -> None:
        await on.controller.command(TakeControl(actor=EVA))
        await on.controller.command(StartProduction(actor=EVA))
        await on.controller.command(SetMode(actor=EVA, mode=Mode.PAUSED))
        await on.controller.command(SetMode(actor=EVA, mode=Mode.AUTOMATIC))
        assert on.controller.execution.production is Production.STARTED

    run(scenario)


def test_anybody_may_pause() -> None:
    async def scenario(on: Bench) -> None:
        await on.controller.command(TakeControl(actor=EVA))
        await on.controller.command(SetMode(actor=ADAM, mode=Mode.PAUSED))
        assert on.controller.execution.mode is Mode.PAUSED

    run(scenario)


def test_control_is_taken_over_knowingly_and_seen() -> None:
    async def scenario(on: Bench) -> None:
        await on.controller.command(TakeControl(actor=EVA))
        moved = await refusal(on, TakeControl(actor=ADAM))
        assert (moved.slug, moved.status) == ("control-changed", 409)
        assert "Eva" in moved.detail
        await on.controller.command(TakeControl(actor=ADAM, over=EVA.session))
        control = on.controller.view().control
        assert control is not None
        assert (control.session, control.name, control.taken_from) == (ADAM.session, "Adam", "Eva")
        assert (await refusal(on, ReleaseControl(actor=EVA))).slug == "control-needed"
        assert (await refusal(on, StartProduction(actor=EVA))).slug == "control-needed"
        await on.controller.command(ReleaseControl(actor=ADAM))
        assert on.controller.view().control is None

    run(scenario)


def test_two_sessions_of_one_person_are_not_one() -> None:
    async def scenario(on: Bench) -> None:
        await on.controller.command(TakeControl(actor=EVA))
        elsewhere = person("Eva", session="another browser")
        assert (await refusal(on, StartProduction(actor=elsewhere))).slug == "control-needed"

    run(scenario)


def test_control_ends_with_its_session_and_with_no_other() -> None:
    async def scenario(on: Bench) -> None:
        await on.controller.command(TakeControl(actor=EVA))
        await on.controller.command(WithdrawControl(actor=SYSTEM, session=str(ADAM.session)))
        assert on.controller.view().control is not None
        await on.controller.command(WithdrawControl(actor=SYSTEM, session=str(EVA.session)))
        assert on.controller.view().control is None
        assert on.controller.execution.production is Production.WAITING

    run(scenario)


def test_a_key_is_never_in_control() -> None:
    async def scenario(on: Bench) -> None:
        assert (await refusal(on, TakeControl(actor=KEY))).slug == "no-session"
        assert (await refusal(on, StartProduction(actor=KEY))).slug == "control-needed"

    run(scenario)


def test_a_demonstration_commands_emulated_devices_only() -> None:
    demo = person("Demonstration", kind=ActorKind.DEMONSTRATION)

    async def scenario(on: Bench) -> None:
        with Arm(on.network).saying("home"):
            await on.until(lambda: on.controller.view().variables["arm.pose"].value == "home")
            await on.controller.command(TakeControl(actor=demo))
            await on.controller.command(StartProduction(actor=demo))
            Arm(on.network, "real_arm")
            refused = await refusal(on, SetMode(actor=demo, mode=Mode.AUTOMATIC))
            assert (refused.slug, refused.status) == ("real-devices", 403)
            assert "/real_arm is on /arm/" in refused.detail
            await on.controller.command(SetMode(actor=demo, mode=Mode.PAUSED))
            assert on.controller.execution.mode is Mode.PAUSED

    run(scenario)


PEOPLE = [person(name) for name in ("Eva", "Adam", "Ida")]


def course(choices: Choices) -> list[tuple[str, Actor, str | None]]:
    """What people do, one after the other, and from whom they mean to take control."""
    acts, over = ["take", "release", "withdraw"], [None, *(each.session for each in PEOPLE)]
    return [(choices.pick(acts), choices.pick(PEOPLE), choices.pick(over)) for _ in range(choices.number(1, 12))]


@examples(200)
@given(made_by(course))
def test_control_is_one_sessions_and_changes_hands_only_as_asked(acts: list[tuple[str, Actor, str | None]]) -> None:
    """Against a plain account of who holds it."""
    desk, holder = ControlLock(), None
    for what, actor, over in acts:
        if what == "take":
            may = holder in (None, actor.session, over)
            done(partial(desk.take, TakeControl(actor=actor, over=over), NOW), may)
            holder = actor.session if may else holder
        elif what == "release":
            may = holder == actor.session
            done(partial(desk.release, ReleaseControl(actor=actor), NOW), may)
            holder = None if may else holder
        else:
            desk.withdraw(WithdrawControl(actor=SYSTEM, session=str(actor.session)), NOW)
            holder = None if holder == actor.session else holder
        view = desk.holder
        assert (view.session if view else None) == holder


def done(act: Callable[[], None], may: bool) -> None:
    """It is done, or refused if it may not be."""
    if may:
        act()
    else:
        with pytest.raises(CommandRefused):
            act()
