"""Who goes on by itself after a takeover, and who does not."""

from __future__ import annotations

import asyncio
import time
from contextlib import closing, suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Literal, cast

import pytest

from sequence_planner.controller import service
from sequence_planner.controller.commands.audit import CommandAudit
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import SetMode, StartProduction
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.features.automatic_start import go_on
from sequence_planner.controller.preparation import Preparation
from sequence_planner.controller.service import _follows
from sequence_planner.core.actor import SYSTEM
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode, Production
from sequence_planner.journal.last_accepted import LastEnding, Life
from sequence_planner.standby.lease import LeaseKeeper
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.places import SINGLE_BOLT


class Taking:
    """A station that has taken over: a real execution and its record; its devices and its network are told."""

    def __init__(self, database: Database) -> None:
        automaton = prepare_station(SINGLE_BOLT).automaton
        self.run = Executor(automaton, synthesise(automaton))
        self.recording = CommandAudit(database, lambda why: None)
        self.rivals = {"topic": "the station that died is still seen"}
        heard: Any = SimpleNamespace(blind=False)
        network = SimpleNamespace(rivals=self.rivals)
        self._controller: Any = SimpleNamespace(
            execution=heard, view=lambda: SimpleNamespace(undecided={}), devices=SimpleNamespace(network=network)
        )

    @property
    def controller(self) -> Controller:
        execution = self._controller.execution
        execution.production, execution.mode = self.run.production, self.run.mode
        return cast(Controller, self._controller)

    async def handle(self, command: Command) -> bool:
        await self.recording.carry_out(command, dict, self._act)
        return True

    async def _act(self, command: Command) -> None:
        if isinstance(command, StartProduction):
            self.run.start_production()
        elif isinstance(command, SetMode):
            self.run.change_mode(Mode(command.mode), "Anna", Timestamp.now())
        _ = self.controller


@pytest.mark.parametrize("mode", [None, Mode.PAUSED, Mode.HOLD])
def test_production_goes_on_by_itself_unless_somebody_has_stopped_the_station_meanwhile(
    tmp_path: Path, mode: Literal[Mode.PAUSED, Mode.HOLD] | None
) -> None:
    async def scenario(database: Database) -> Production:
        station = Taking(database)
        going = asyncio.create_task(go_on(station.controller, station.handle, "press-a", look_every=0.01))
        await asyncio.sleep(0.05)
        if mode is not None:
            await station.handle(SetMode(actor=SYSTEM, mode=mode))
        station.rivals.clear()  # nobody else is seen any more
        await asyncio.wait_for(going, 20.0)
        await station.recording.close()
        return station.run.production

    with closing(Database.open(f"sqlite:///{tmp_path}/station.sqlite")) as database:
        database.upgrade()
        expected = Production.STARTED if mode is None else Production.WAITING
        assert asyncio.run(scenario(database)) is expected


@pytest.mark.parametrize(
    ("stands_by", "later", "goes_on"), [(False, 0.0, False), (True, 0.0, False), (True, 61.0, True)]
)
@pytest.mark.parametrize("mode", [None, Mode.PAUSED, Mode.HOLD])
def test_who_was_refused_a_stop_before_the_station_was_ready_starts_production_by_hand(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    mode: Literal[Mode.PAUSED, Mode.HOLD] | None,
    stands_by: bool,
    later: float,
    goes_on: bool,
) -> None:
    went_on: list[str] = []

    async def going_on(controller: Controller, handle: object, before: str) -> None:
        went_on.append(before)

    monkeypatch.setattr(service, "go_on", going_on)

    async def scenario(database: Database) -> None:
        standing = SimpleNamespace(name="press-b", holder="press-a", active=False, trouble=None)
        epoch = None if stands_by else 2
        keeper: Any = SimpleNamespace(held=not stands_by, epoch=epoch, standing=standing, taken_from=None)
        socket, runs = tmp_path / "socket", prepare_station(SINGLE_BOLT)
        running: Any = SimpleNamespace(model=SINGLE_BOLT, socket=socket, emulated=False, start=False, station=runs)
        none: Any = None
        recording = CommandAudit(database, lambda why: None)
        life = service._Life(running, Preparation(), recording, database, keeper, none, none, Mode.AUTOMATIC)
        if mode is not None:
            with pytest.raises(CommandRefused, match="goes on by itself before a person starts") as refused:
                await life._handle(SetMode(actor=SYSTEM, mode=mode))
            assert refused.value.slug == ("on-standby" if stands_by else "preparing")
        keeper.taken_from, now = "press-a", time.monotonic
        monkeypatch.setattr(time, "monotonic", lambda: now() + later)
        alone = asyncio.create_task(asyncio.sleep(0))
        controller: Any = SimpleNamespace(take_command=lambda: None)
        station: Any = SimpleNamespace(goes_on=True)
        known: Any = SimpleNamespace(was_at_work=True)
        with suppress(TimeoutError):
            await asyncio.wait_for(life._take_command(station, controller, known, alone), 0.2)
        await recording.close()

    with closing(Database.open(f"sqlite:///{tmp_path}/station.sqlite")) as database:
        database.upgrade()
        asyncio.run(scenario(database))
    assert went_on == (["press-a"] if mode is None or goes_on else [])


@pytest.mark.parametrize(
    ("before", "now", "follows"), [(1, 2, True), (1, 3, False), (None, 2, False), (1, None, False)]
)
def test_what_a_station_knows_of_its_own_last_life_counts_only_where_nobody_commanded_since(
    before: int | None, now: int | None, follows: bool
) -> None:
    ended = LastEnding(True, life=Life(turn=1, number=1, hash="0" * 64, epoch=before))
    assert _follows(ended, cast(LeaseKeeper, SimpleNamespace(epoch=now))) is follows
