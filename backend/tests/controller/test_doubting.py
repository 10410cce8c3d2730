"""When a person is asked: not for what passes, not by what is forced, and not before it is known what never is."""

from __future__ import annotations

import asyncio
import contextlib
import time

from sequence_planner.analysis.mutual_exclusion import MOST_BITS, NeverTogether, find_never_together
from sequence_planner.controller.recovery.consistency import SETTLED, ConsistencyMonitor
from sequence_planner.core.clock import Timestamp
from sequence_planner.language.types import BOOLEAN
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.simulated import Rig, truck_engine
from support.waiting import patience

from .corrected import WHY, Station, what_is_never_together

BOLT = "bolts[bolt_pair_2]"


def contradictory(known: NeverTogether | None) -> Station:
    """A bolt is believed to be there, and has just been asked for."""
    station = Station(known)
    station.execution.start_production()
    wrong = {BOLT: "placed", "operator.requested_pair": "bolt_pair_2"}
    station.execution.state = station.execution.corrected(wrong)
    return station


def asked(station: Station, now: float) -> list[str]:
    station.doubting.look(now)
    return [question.variable for question in station.doubting.questions]


def test_a_contradiction_that_lasts_is_asked_about_until_it_has_gone() -> None:
    station = contradictory(what_is_never_together())
    assert asked(station, 100.0) == []
    assert asked(station, 100.0 + SETTLED / 2) == []
    assert asked(station, 100.0 + SETTLED) == [BOLT]
    station.execution.correct({BOLT: "empty"}, "Eva", WHY, station.now)
    assert asked(station, 101.0 + SETTLED) == []
    station.execution.correct({BOLT: "placed"}, "Eva", WHY, station.now)
    assert asked(station, 102.0 + SETTLED) == []
    assert asked(station, 102.0 + 2 * SETTLED) == []  # somebody has just said so


def test_who_has_looked_is_not_asked_again_while_that_counts() -> None:
    station = contradictory(what_is_never_together())
    station.doubting.look(100.0)
    assert asked(station, 100.0 + SETTLED) == [BOLT]
    station.execution.confirm(frozenset({BOLT}), "Eva", station.now)
    assert asked(station, 101.0 + SETTLED) == []


def test_what_is_forced_asks_nobody() -> None:
    station = contradictory(what_is_never_together())
    station.execution.force("operator.requested_pair", "bolt_pair_2", Timestamp(2000.0, 1010.0), "Eva", WHY)
    assert asked(station, 100.0) == []
    assert asked(station, 200.0) == []


def test_nobody_is_asked_before_it_is_known_what_never_is() -> None:
    station = contradictory(None)
    assert asked(station, 100.0) == []
    assert asked(station, 200.0) == []
    assert station.doubting.impossible() == frozenset()


def test_a_station_at_work_asks_nothing() -> None:
    rig = Rig()
    doubting = ConsistencyMonitor(rig.execution, what_is_never_together())
    rig.start_production()

    def wondering() -> bool:
        doubting.look(rig.now)
        return bool(doubting.questions)

    assert not rig.run(60, wondering)
    assert rig.completed


def test_what_is_not_found_in_time_is_not_looked_for_again() -> None:
    lamps = {f"lamp_{number}": (BOOLEAN, False) for number in range(MOST_BITS + 1)}
    large = automaton(
        {"shine": Does(start=("lamp_0 := true", "lit := true"))}, output=lamps, estimated={"lit": (BOOLEAN, False)}
    )
    found = asyncio.run(find_never_together(large, synthesise(large), 0.0))
    assert found == NeverTogether(frozenset(), None), "which is kept"
    assert contradictory(found).doubting.impossible() == frozenset()


def test_another_process_finds_it_and_can_be_stopped() -> None:
    station, supervisor, _ = truck_engine()

    async def find() -> NeverTogether | None:
        return await find_never_together(station.automaton, supervisor, 60.0)

    assert asyncio.run(find()) == what_is_never_together()

    async def stop() -> None:
        doubting = ConsistencyMonitor(Station().execution)
        doubting.begin(after=0.0)
        await asyncio.sleep(0.3)
        doubting.close()
        assert doubting._search is not None
        with contextlib.suppress(asyncio.CancelledError):
            await doubting._search

    began = time.monotonic()
    asyncio.run(stop())
    assert time.monotonic() - began < patience(30)
