"""Peers that are killed, frozen and started again, as processes of their own."""

from __future__ import annotations

import signal

from ros_networks import Network, play, standard
from ros_processes import peer

from sequence_planner.ros.actions import ActionClient, GoalStatus, LostGoalError
from sequence_planner.ros.qos import QualityEvent, QualityOfService
from sequence_planner.ros.transport import NoAnswerError, Sample, Transport
from support.waiting import until_async

TEXT, ADD, FIBONACCI = "std_msgs/msg/String", "example_interfaces/srv/AddTwoInts", "example_interfaces/action/Fibonacci"
HELLO = standard().encode(TEXT, {"data": "hello"})
REQUEST = standard().encode(f"{ADD}_Request", {"a": 20, "b": 22})


async def answered(station: Transport) -> None:
    """Call until there is an answer: a request can be written to a server that is not there any more."""
    for _ in range(20):
        try:
            answer = await station.call("/add", ADD, REQUEST, 1.0)
        except NoAnswerError:
            continue
        assert standard().decode(f"{ADD}_Response", answer) == {"sum": 42}
        return
    raise AssertionError("the device never answered")


def test_a_device_that_is_killed_and_started_again_is_matched_again() -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        heard: list[Sample] = []
        station.advertise("/ping", TEXT, QualityOfService.RELIABLE)
        station.subscribe("/pong", TEXT, QualityOfService.RELIABLE, heard.extend)
        client = ActionClient(station, standard(), "/fibonacci", FIBONACCI)

        def echoed() -> bool:
            station.publish("/ping", TEXT, HELLO)
            return bool(heard)

        async with peer("device") as device:
            await until_async(echoed, "the device answers")
            await answered(station)
            goal = await client.send_goal({"order": 5}, 10.0)
            device.kill()
            await device.wait()
        heard.clear()
        async with peer("device"):
            await until_async(echoed, "the device that was started again answers")
            await answered(station)
            try:
                await goal.result(renewal=1.0)
            except LostGoalError as error:
                assert "has been started anew" in str(error)
            else:
                raise AssertionError("the goal of the killed device has ended")
            again = await client.send_goal({"order": 5}, 10.0)
            await again.cancel(10.0)
            assert (await again.result()).status == GoalStatus.CANCELED

    play("cyclonedds", scenario)


def test_a_device_that_hangs_loses_its_liveliness() -> None:
    async def scenario(network: Network) -> None:
        station = network.join("station")
        events: list[QualityEvent] = []
        heard: list[Sample] = []
        station.watch(events.append)
        station.advertise("/ping", TEXT, QualityOfService.RELIABLE)
        station.subscribe("/pong", TEXT, QualityOfService(liveliness=1.0), heard.extend)

        def echoed() -> bool:
            station.publish("/ping", TEXT, HELLO)
            return bool(heard)

        async with peer("device") as device:
            await until_async(echoed, "the device answers")
            assert events == []
            device.send_signal(signal.SIGSTOP)
            await until_async(lambda: events, "the station is told")
            assert [(event.topic, event.direction, event.kind) for event in events] == [
                ("/pong", "subscriber", "liveliness")
            ]
            device.send_signal(signal.SIGCONT)
            heard.clear()
            await until_async(echoed, "the device answers again")

    play("cyclonedds", scenario)
