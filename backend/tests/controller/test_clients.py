"""Services and actions as devices: the real controller with emulated servers, and clients of servers that fail."""

from __future__ import annotations

import asyncio
import shutil
import time
from pathlib import Path

import pytest
from cyclonedds.domain import DomainParticipant
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from controller.asking import Asking, Stirrer
from controller.mixing import (
    FLUSH,
    FLUSH_TYPE,
    LEVEL,
    LEVEL_TYPE,
    STIR,
    Plant,
    alarms,
    living,
    mixer,
    play,
    start,
    value,
)
from sequence_planner.ros.actions import GoalStatus
from sequence_planner.ros.transports.cyclonedds_network import raw_types, release
from sequence_planner.station import prepare_station
from support.network import DOMAIN
from support.places import MIXER
from support.waiting import until_async

KINDS = ["memory", "cyclonedds"]


@pytest.mark.parametrize("kind", KINDS)
def test_an_operation_is_carried_out_with_services_and_an_action(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        devices, _ = plant.tank()
        controller = plant.controller(mixer()[1])
        with living(devices):
            await until_async(lambda: value(controller, "tank.stirring") == "idle", "no goal yet")
            assert value(controller, "tank.level") is None  # nothing is asked before production is started
            await start(controller)
            await until_async(lambda: value(controller, "tank.level") == 2, "the level is read")
            await until_async(lambda: value(controller, "tank.stirring") == "executing", "the goal is executed")
            await until_async(lambda: controller.view().operations["make"].completed == 1, "the operation is completed")
            await until_async(lambda: value(controller, "tank.flushed") is False, "nothing is asked any more")
        assert value(controller, "tank.stirring") == "idle"
        assert alarms(controller) == []

    play(kind, scenario)


def test_a_server_of_another_mapping_is_an_alarm_before_anything_is_asked_of_it() -> None:
    """It stands where rmw_fastrtps has a server: on the topic of requests, with nothing that tells its mapping."""

    async def scenario(plant: Plant) -> None:
        controller = plant.controller(mixer()[1])
        participant, registry = DomainParticipant(DOMAIN), plant.station.registry
        raw = raw_types(registry)(f"{FLUSH_TYPE}_Request")
        reader = DataReader(participant, Topic(participant, f"rq{FLUSH}Request", raw))

        def told() -> list[str]:
            return [each for each in alarms(controller) if "nothing is asked of it" in each]

        await until_async(told, "it is told")
        assert told()[0].startswith(f"another node serves {FLUSH} on Eclipse Cyclone DDS (rmw_cyclonedds_cpp)")
        release(reader)
        await until_async(lambda: not told(), "it is not told any more")

    play("cyclonedds", scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_goal_tells_its_feedback_its_end_and_its_result(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        server, asking = Stirrer(plant), Asking(plant)
        asking.set(stir=True, pace="fast")
        await until_async(lambda: asking.value("stirring") == "executing", "it executes")
        assert (server.taken, asking.value("mixture"), asking.value("turns")) == ([[2.0]], "separate", 0)
        assert server.work is not None
        server.work.feedback({"turned": 3.5})
        await until_async(lambda: asking.value("mixture") == "mixed", "feedback is measured")
        server.end(GoalStatus.SUCCEEDED, turns=4)
        await until_async(lambda: asking.value("stirring") == "succeeded", "it succeeds")
        assert asking.value("turns") == 4
        asking.set(stir=False)
        assert (asking.value("stirring"), asking.value("mixture"), asking.value("turns")) == ("idle", "separate", 0)
        assert [state for state in asking.seen if state != "accepted"] == ["idle", "executing", "succeeded", "idle"]
        asking.end()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_goal_is_cancelled_when_its_output_falls_and_the_next_waits_for_that(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        server, asking = Stirrer(plant), Asking(plant)
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "executing", "it executes")
        asking.set(stir=False)
        asking.set(stir=True)
        await until_async(lambda: len(server.taken) == 2, "the next goal is sent")
        assert server.cancelled == 1
        await until_async(lambda: asking.value("stirring") == "executing", "it executes")
        asking.set(stir=False)
        await until_async(lambda: asking.value("stirring") == "idle", "nothing is under way")
        assert (len(server.taken), server.cancelled) == (2, 2)
        asking.set(stir=True)
        asking.set(stir=False)  # before it was accepted
        await until_async(
            lambda: asking.value("stirring") == "idle" and server.cancelled == len(server.taken), "it is over"
        )
        asking.end()

    play(kind, scenario)


def test_a_goal_that_is_refused_is_not_sent_again() -> None:
    async def scenario(plant: Plant) -> None:
        server, asking = Stirrer(plant, accepts=False), Asking(plant)
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "rejected", "it is rejected")
        assert asking.reported(STIR) == [(f"{STIR} does not accept the goal", 1)]
        await asyncio.sleep(0.3)
        assert len(server.taken) == 1
        server.accepts = True
        asking.set(stir=False)
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "executing", "the next one is taken")
        asking.end()

    play("memory", scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_goal_for_a_server_that_is_not_there_is_lost_and_is_not_sent_to_one_that_comes(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        asking = Asking(plant)
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "lost", "it is lost")
        assert [text.split(" ")[0] for text, _ in asking.reported(STIR)] == ["nobody"]
        server = Stirrer(plant)
        await asyncio.sleep(1.0)
        assert (server.taken, asking.value("stirring")) == ([], "lost")
        asking.set(stir=False)
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "executing", "the next one is taken")
        asking.end()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_goal_is_lost_with_its_server_and_is_not_sent_to_one_that_is_started_anew(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        server, asking = Stirrer(plant), Asking(plant)
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "executing", "it executes")
        server.die()
        again = Stirrer(plant)
        await until_async(lambda: asking.value("stirring") == "lost", "it is lost")
        assert asking.value("mixture") == "separate"
        await asyncio.sleep(0.3)
        assert again.taken == []
        asking.end()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_a_controller_that_is_started_anew_sees_its_goal_and_sends_no_other(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        server, before = Stirrer(plant), Asking(plant)
        before.set(stir=True)
        await until_async(lambda: before.value("stirring") == "executing", "it executes")
        before.end()
        asking = Asking(plant)
        await until_async(lambda: asking.value("stirring") == "executing", "the goal is seen")
        asking.set(stir=True)
        await asyncio.sleep(0.3)
        assert len(server.taken) == 1
        asking.set(stir=False)
        await until_async(lambda: asking.value("stirring") == "idle", "the goal can be cancelled")
        assert (len(server.taken), server.cancelled) == (1, 1)
        asking.end()

    play(kind, scenario)


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_service_says_is_unknown_without_an_answer_and_reported_once(kind: str) -> None:
    async def scenario(plant: Plant) -> None:
        asking = Asking(plant)
        level = f"{LEVEL} response"
        await until_async(lambda: sum(count for _, count in asking.reported(level)) >= 2, "two calls have failed")
        assert len(asking.reported(level)) == 1
        assert (asking.value("level"), "tank" in asking.feeds.offline(asyncio.get_running_loop().time())) == (
            None,
            True,
        )
        calls = [0, 0]  # at once, and the most so far

        async def answer(request: bytes) -> bytes:
            calls[0] += 1
            calls[1] = max(calls)
            await asyncio.sleep(0.15)  # longer than from one call to the next
            calls[0] -= 1
            return plant.station.registry.encode(f"{LEVEL_TYPE}_Response", {"level": 3})

        transport = plant.join("tank")
        transport.serve(LEVEL, LEVEL_TYPE, answer)
        await until_async(lambda: asking.value("level") == 3, "it answers")
        await asyncio.sleep(0.5)
        assert calls[1] == 1
        transport.close()
        await until_async(lambda: asking.value("level") is None, "it is unknown")
        asking.end()

    play(kind, scenario)


def test_an_answer_that_makes_no_sense_is_unknown_and_counted() -> None:
    async def scenario(plant: Plant) -> None:
        answers = [b"\x00\x01\x00\x00", plant.station.registry.encode(f"{LEVEL_TYPE}_Response", {"level": 200})]

        async def answer(request: bytes) -> bytes:
            return answers[0]

        plant.join("tank").serve(LEVEL, LEVEL_TYPE, answer)
        asking = Asking(plant)
        level = f"{LEVEL} response"
        await until_async(lambda: asking.reported(level) and asking.reported(level)[0][1] >= 3, "it is counted")
        assert (asking.value("level"), len(asking.reported(level))) == (None, 1)
        answers.reverse()
        await until_async(lambda: len(asking.reported(level)) == 2, "another cause")
        assert asking.reported(level)[1][0] == "level is 200, and tank.level ranges over 0..3"
        assert asking.value("level") is None
        asking.end()

    play("memory", scenario)


def test_a_service_is_called_once_for_each_rise_and_forgotten_when_its_output_falls() -> None:
    async def scenario(plant: Plant) -> None:
        devices, transport = plant.tank()
        with living(devices):
            asking = Asking(plant)
            assert asking.value("flushed") is False
            asking.set(flush=True)
            await until_async(lambda: asking.value("flushed") is True, "it is done")
            asking.set(flush=False)
            assert asking.value("flushed") is False
            transport.close()
            asking.set(flush=True)
            await until_async(lambda: asking.value("flushed") is None, "nobody answers")
            assert len(asking.reported(f"{FLUSH} response")) == 1
            asking.set(flush=False)
            assert asking.value("flushed") is False
            asking.end()

    play("memory", scenario)


def test_an_emulated_action_is_aborted_by_hand_and_the_station_gets_out_of_it() -> None:
    async def scenario(plant: Plant) -> None:
        devices, _ = plant.tank()
        controller = plant.controller(mixer()[1])
        with living(devices):
            await start(controller)
            await until_async(lambda: value(controller, "tank.stirring") == "executing", "the goal is executed")
            devices.set_value("tank.stirring", "aborted")
            await until_async(lambda: value(controller, "tank.stirring") != "executing", "it is aborted")
            assert value(controller, "product") == "nothing"
            await until_async(lambda: controller.view().operations["make"].completed == 1, "it is done again")

    play("memory", scenario)


def test_an_emulated_tank_serves_one_goal_at_a_time() -> None:
    async def scenario(plant: Plant) -> None:
        devices, _ = plant.tank()
        with living(devices):
            asking, other = Asking(plant), Asking(plant)
            asking.set(stir=True)
            await until_async(lambda: asking.value("stirring") == "executing", "it executes")
            assert other.value("stirring") == "executing"
            await until_async(lambda: asking.value("stirring") == "succeeded", "it succeeds")
            assert (asking.value("turns"), asking.value("mixture")) == (4, "mixed")
            asking.end()
            other.end()

    play("memory", scenario)


def test_an_override_in_a_goal_is_taken_by_the_goals_to_come(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(MIXER, tmp_path / "mixer"))
    tank = folder / "resources" / "tank.yaml"
    added = (
        "      - constant: {share: 1.0}\n"
        "      - override: {name: share, fields: {share: {between: [0.1, 1.0]}}, expires: 60}\n"
    )
    written = tank.read_text(encoding="utf-8")
    tank.write_text(written.replace("    feedback:\n", f"{added}    feedback:\n"), encoding="utf-8")

    async def scenario(plant: Plant) -> None:
        server, asking = Stirrer(plant), Asking(plant)
        asking.clients.set_override(f"{STIR} goal", "share", {"share": 0.1}, time.monotonic(), "somebody")
        asking.set(stir=True)
        await until_async(lambda: asking.value("stirring") == "executing", "it executes")
        assert server.work is not None
        assert server.work.goal["share"] == 0.1
        asking.end()

    play("memory", scenario, prepare_station(folder))
