"""A station of many variables for the figures of the pages: its model, and nodes that say new values all the time.

`busy_station.py model FOLDER` writes the model; `busy_station.py speak FOLDER` speaks for its nodes until it is ended, on
the network that `ROS_DOMAIN_ID` names. There are `UNITS` units of `FIELDS` measured variables each. `BUSY` of them say
other values of all their variables ten times a second, the others repeat theirs once a second.
"""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.qos import QualityOfService

UNITS, FIELDS, BUSY = 100, 50, 10
PERIOD = 0.1  # seconds
VALUES = 10  # of each variable

TYPE = "busy_messages/msg/Fields"
NAMES = [f"f{number:02}" for number in range(FIELDS)]


def unit(number: int) -> str:
    """The name of a unit."""
    return f"unit_{number:03}"


def write(folder: Path) -> None:
    """Write the model into an empty folder."""
    (folder / "resources").mkdir(parents=True)
    (folder / "messages" / "busy_messages" / "msg").mkdir(parents=True)
    message = "".join(f"int8 {name}\n" for name in NAMES)
    (folder / "messages" / "busy_messages" / "msg" / "Fields.msg").write_text(message)
    (folder / "station.yaml").write_text(f"name: busy\ntitle: Busy station of {UNITS * FIELDS} variables\n")
    (folder / "operations.yaml").write_text("{}\n")
    (folder / "specifications.yaml").write_text("{}\n")
    measured = "".join(f"  {name}: {{type: 0..{VALUES - 1}, initial: 0}}\n" for name in NAMES)
    for number in range(UNITS):
        topic = f"topics:\n  /{unit(number)}/state: {{type: {TYPE}, direction: in, deadline: 5.0}}\n"
        text = f"title: Unit {number}\n{topic}measured:\n{measured}"
        (folder / "resources" / f"{unit(number)}.yaml").write_text(text)


async def speak(folder: Path) -> None:
    """Speak for all nodes."""
    registry = MessageRegistry.from_folder(folder / "messages")
    transport = open_transport("cyclonedds", registry, "busy_units", asyncio.get_running_loop())
    topics = [f"/{unit(number)}/state" for number in range(UNITS)]
    for topic in topics:
        transport.advertise(topic, TYPE, QualityOfService.RELIABLE)
    loop = asyncio.get_running_loop()
    began, step = loop.time(), 0
    while True:
        for number, topic in enumerate(topics):
            if number < BUSY or step % round(1 / PERIOD) == 0:
                value = (number + step if number < BUSY else number) % VALUES
                transport.publish(topic, TYPE, registry.encode(TYPE, dict.fromkeys(NAMES, value)))
        step += 1
        await asyncio.sleep(max(0.0, began + step * PERIOD - loop.time()))


if __name__ == "__main__":
    if sys.argv[1] == "model":
        write(Path(sys.argv[2]))
    else:
        asyncio.run(speak(Path(sys.argv[2])))
