"""A device that a station knows nothing of, in a process of its own, until its input ends.

    python device.py DOMAIN MESSAGES

It publishes /press/state and /press/force, and listens on /press/command; MESSAGES is the folder of its definitions.
It is said on standard output when it is there.
"""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

from sequence_planner.ros.qos import QualityOfService
from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.types.type_discovery import serve_types


async def live(domain: int, messages: Path) -> None:
    registry = MessageRegistry.from_folder(messages)
    transport = open_transport("cyclonedds", registry, "press", asyncio.get_running_loop(), domain)
    transport.advertise("/press/state", "press_msgs/msg/PressState", QualityOfService.SENSOR_DATA)
    transport.advertise("/press/force", "std_msgs/msg/Float64", QualityOfService.LATCHED)
    transport.subscribe("/press/command", "press_msgs/msg/PressCommand", QualityOfService.RELIABLE, lambda batch: None)
    serve_types(transport, registry, "press")
    sys.stdout.write("there\n")
    sys.stdout.flush()
    await asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)
    transport.close()


if __name__ == "__main__":
    asyncio.run(live(int(sys.argv[1]), Path(sys.argv[2])))
