"""A transport that may not speak: nothing goes out, and what others say is heard all the same."""

from __future__ import annotations

import asyncio

import pytest

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transport import Sample, TellsServices, TransportError
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.ros.transports.routing import gated
from support.cell import cell

TOPIC, TYPE = "/arm/command", "std_msgs/msg/String"
TRIGGER = "std_srvs/srv/Trigger"
WORDS = b"\x00\x01\x00\x00\x03\x00\x00\x00go\x00"


def test_nothing_goes_out_unless_it_may_speak_at_that_very_moment() -> None:
    async def scenario() -> None:
        network, loop = MemoryNetwork(), asyncio.get_running_loop()
        registry = cell()[0].registry
        may_speak = False
        inner = network.join(registry, "station", loop)
        speaker, listener = gated(inner, lambda: may_speak), network.join(registry, "device", loop)
        heard: list[bytes] = []
        came = asyncio.Event()

        def hear(samples: object) -> None:
            assert isinstance(samples, list | tuple)
            heard.extend(each.data for each in samples if isinstance(each, Sample))
            came.set()

        listener.subscribe(TOPIC, TYPE, QualityOfService.RELIABLE, hear)
        speaker.advertise(TOPIC, TYPE, QualityOfService.RELIABLE)
        with pytest.raises(TransportError, match="does not hold the lease"):
            speaker.publish(TOPIC, TYPE, WORDS)
        with pytest.raises(TransportError, match="does not hold the lease"):
            await speaker.call("/arm/reset", TRIGGER, b"", 1.0)
        await asyncio.sleep(0.05)
        assert heard == []
        may_speak = True
        speaker.publish(TOPIC, TYPE, WORDS)
        await asyncio.wait_for(came.wait(), 5)
        assert heard == [WORDS]
        assert isinstance(speaker, TellsServices) == isinstance(inner, TellsServices)
        assert speaker.name == inner.name
        assert {each.topic for each in speaker.graph()} == {TOPIC}
        speaker.close()
        listener.close()

    asyncio.run(scenario())


def test_a_call_that_waited_for_its_server_is_not_sent_after_the_lease_has_ended() -> None:
    async def scenario() -> None:
        network, loop = MemoryNetwork(), asyncio.get_running_loop()
        registry, asked = cell()[0].registry, list[bytes]()
        may_speak = True
        speaker = gated(network.join(registry, "station", loop), lambda: may_speak)
        device = network.join(registry, "device", loop)
        call = asyncio.create_task(speaker.call("/arm/reset", TRIGGER, b"", 10.0))
        await asyncio.sleep(0.05)
        may_speak = False

        async def answer(request: bytes) -> bytes:
            asked.append(request)
            return b""

        device.serve("/arm/reset", TRIGGER, answer)
        with pytest.raises(TransportError, match="does not hold the lease"):
            await call
        assert asked == []
        may_speak = True
        await speaker.call("/arm/reset", TRIGGER, b"", 10.0)
        assert asked == [b""]
        speaker.close()
        device.close()

    asyncio.run(scenario())
