"""What the real controller writes of two lives, with its planner in its own process, is replayed bit for bit."""

from __future__ import annotations

import asyncio

from sequence_planner.controller.commands.execution import SetMode, TakeControl
from sequence_planner.db.database import Database
from sequence_planner.execution.record.codec import BEGUN
from sequence_planner.execution.record.replay import replay
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.ros.transports.memory import MemoryNetwork
from support.cell import Arm, bench, cell
from support.databases import journal
from support.people import EVA


async def life(network: MemoryNetwork, database: Database) -> None:
    """The arm is sent out and gets there; the station is paused, held, and goes on."""
    arm = Arm(network)
    async with bench(network, database) as on:
        with arm.saying("home"):
            await on.until(lambda: on.controller.execution.state["arm.pose"] == "home")
            if not on.controller.view().undecided:
                await on.start()
                await on.until(lambda: "out" in arm.commands)
        with arm.saying("out"):
            await on.until(lambda: on.controller.execution.state["arm.pose"] == "out")
            await on.controller.command(TakeControl(actor=EVA))
            for mode in (Mode.PAUSED, Mode.HOLD, Mode.AUTOMATIC):
                await on.controller.command(SetMode(actor=EVA, mode=mode))
            await asyncio.sleep(0.3)
    arm.transport.close()


def test_what_the_controller_wrote_is_replayed() -> None:
    station, supervisor = cell()
    with journal() as database:
        for _ in range(2):
            asyncio.run(life(MemoryNetwork(), database))
        with database.reading() as connection:
            found = list(replay(WholeRun(connection), station.automaton, supervisor))
        assert found[-1].difference is None, found[-1].difference
        kinds = [each.record.kind for each in found]
        assert kinds.count(BEGUN) == 2
        assert {"ticked", "asked", "answered", "production-started", "mode-changed"} <= set(kinds)
