"""A process that publishes the state of the tank as fast as it is told to, until it is ended.

Arguments: the folder of the messages, the domain, messages per second, and a quality of service as JSON.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from pathlib import Path

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry

TOPIC, TYPE = "/tank/state", "tank_msgs/msg/State"
BATCH = 0.005  # seconds between two batches of messages


async def talk(messages: Path, domain: int, rate: float, quality: QualityOfService) -> None:
    registry = MessageRegistry.from_folder(messages)
    transport = open_transport("cyclonedds", registry, "talker", asyncio.get_running_loop(), domain)
    transport.advertise(TOPIC, TYPE, quality)
    began, said = time.monotonic(), 0
    while True:
        while said < (time.monotonic() - began) * rate:
            said += 1
            fields = {"mode": "on", "level": 0.5 + 1.5 * (said // 100 % 2), "count": said}
            transport.publish(TOPIC, TYPE, registry.encode(TYPE, fields))
        await asyncio.sleep(BATCH)


if __name__ == "__main__":
    folder, number, per_second, written = sys.argv[1:]
    of = QualityOfService.of(json.loads(written))
    asyncio.run(talk(Path(folder), int(number), float(per_second), of))
