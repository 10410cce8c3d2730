"""Alarms of a controller that runs: commands reach them, and the journal hears of them."""

from __future__ import annotations

import asyncio

import pytest

from sequence_planner.controller.commands.alarms import AcknowledgeAlarm
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.views.station import AlarmState
from sequence_planner.core.actor import SYSTEM
from support.cell import STATE, Arm, bench


def test_an_alarm_comes_is_acknowledged_and_goes() -> None:
    async def scenario() -> None:
        async with bench() as on:
            arm = Arm(on.network)
            with arm.saying("home"):
                await on.until(lambda: on.controller.execution.state["arm.pose"] == "home")
            arm.transport.close()
            await on.until(lambda: "silent:arm" in on.controller.view().alarms)
            alarm = on.controller.view().alarms["silent:arm"]
            assert (alarm.text, *alarm.parts) == ("Nothing heard from Arm", f"No more messages on {STATE}")
            command = AcknowledgeAlarm(actor=SYSTEM, alarm="silent:arm", since=alarm.since)
            await on.controller.command(command)
            known = on.controller.view().alarms["silent:arm"]
            assert (known.state, known.by) == (AlarmState.ACKNOWLEDGED, SYSTEM.name)
            with Arm(on.network).saying("home"):
                await on.until(lambda: "silent:arm" not in on.controller.view().alarms)
            with pytest.raises(CommandRefused) as refused:
                await on.controller.command(command)
            assert refused.value.slug == "alarm-gone"

    asyncio.run(scenario())
