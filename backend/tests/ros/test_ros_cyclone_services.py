"""Services over cyclonedds: peers of another mapping are neither called nor answered."""

from __future__ import annotations

import pytest
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration
from ros_networks import Network, play, settle, standard
from structlog.testing import capture_logs

from sequence_planner.ros.call_header import CallHeader, with_header
from sequence_planner.ros.transport import NoServerError
from sequence_planner.ros.transports.cyclonedds_network import RawSample, raw_types, release
from support.network import DOMAIN
from support.waiting import until_async

ADD = "example_interfaces/srv/AddTwoInts"
REQUEST = standard().encode(f"{ADD}_Request", {"a": 1, "b": 2})
QOS = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(10))


RAW = raw_types(standard())(f"{ADD}_Request", called=True)


def foreign_request_topic(participant: DomainParticipant) -> Topic[RawSample]:
    return Topic(participant, "rq/addRequest", RAW)


def test_a_server_that_does_not_carry_serviceid_is_refused_before_anything_is_written() -> None:
    async def scenario(network: Network) -> None:
        station, device = network.join("station"), network.join("device")

        async def add(request: bytes) -> bytes:
            return standard().encode(f"{ADD}_Response", {"sum": 3})

        participant = DomainParticipant(DOMAIN)
        foreign = DataReader(participant, foreign_request_topic(participant), QOS)
        with pytest.raises(NoServerError, match=r"/add is served by a program .*no serviceid.*nothing was sent"):
            await station.call("/add", ADD, REQUEST, 5.0)
        # Even beside a server that could be called: the request would reach both.
        device.serve("/add", ADD, add)
        for _ in range(10):
            with pytest.raises(NoServerError, match="nothing was sent"):
                await station.call("/add", ADD, REQUEST, 5.0)
        await settle()
        assert foreign.take(10) == []
        release(foreign)
        await settle()
        answer = await station.call("/add", ADD, REQUEST, 5.0)
        assert standard().decode(f"{ADD}_Response", answer) == {"sum": 3}

    play("cyclonedds", scenario)


def test_requests_of_who_does_not_carry_clientid_are_dropped_and_logged_once() -> None:
    async def scenario(network: Network) -> None:
        device = network.join("device")
        heard: list[bytes] = []

        async def add(request: bytes) -> bytes:
            heard.append(request)
            return standard().encode(f"{ADD}_Response", {})

        device.serve("/add", ADD, add)
        participant = DomainParticipant(DOMAIN)
        topic = foreign_request_topic(participant)
        foreign = DataWriter(participant, topic, QOS)
        await until_async(foreign.get_matched_subscriptions, "the server is seen")
        with capture_logs() as logs:
            for number in range(5):
                foreign.write(RAW(with_header(CallHeader(1, number), REQUEST)))
            await until_async(lambda: logs, "the log says so")
            await settle()
        assert heard == []
        assert [(log["service"], log["log_level"]) for log in logs] == [("/add", "warning")]

    play("cyclonedds", scenario)
