"""A station of many pipelines for the figures of the page that shows them: its graph has `NODES` boxes, or a few more.

`pipelines_station.py model FOLDER` writes the model; `pipelines_station.py speak FOLDER` speaks for its nodes until it is
ended, on the network that `ROS_DOMAIN_ID` names: a message of each topic, ten times a second.
"""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

from sequence_planner.ros.transports.choice import open_transport
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.ros.qos import QualityOfService

NODES = 500
PERIOD = 0.1  # seconds
TYPE = "pipeline_messages/msg/Reading"
# Of each unit: a topic, three stages and five variables, and a flow of it and the unit before with a stage and a variable.
# All of these variables are others with each message.
BOXES = 12
UNITS = -(-NODES // BOXES)

RESOURCE = """\
title: Unit {number}
topics:
  /{name}/state:
    type: {type}
    direction: in
    deadline: 5.0
    pipeline:
      - discretise: {{field: level, variable: load, ranges: {{none: [null, 1], light: [1, 20], heavy: [20, null]}}}}
      - fold: [load]
      - expression: {{is_far: position > 0.5}}
flows:
  both:
    from: {{mine: /{name}/state, theirs: /{other}/state}}
    pipeline:
      - expression: {{clash: mine.is_far and theirs.is_far}}
measured:
  load: {{type: load}}
  is_far: {{type: bool}}
  count: {{type: 0..99}}
  rest: {{type: 0..99}}
  half: {{type: 0..99}}
  clash: {{type: bool}}
"""


def unit(number: int) -> str:
    """The name of a unit."""
    return f"unit_{number % UNITS:03}"


def write(folder: Path) -> None:
    """Write the model into an empty folder."""
    (folder / "resources").mkdir(parents=True)
    (folder / "messages" / "pipeline_messages" / "msg").mkdir(parents=True)
    message = folder / "messages" / "pipeline_messages" / "msg" / "Reading.msg"
    message.write_text("float64 level\nfloat64 position\nuint8 count\nuint8 rest\nuint8 half\n")
    station = f"name: pipelines\ntitle: Station of {UNITS * BOXES} boxes\nenumerations:\n  load: [none, light, heavy]\n"
    (folder / "station.yaml").write_text(station)
    (folder / "operations.yaml").write_text("{}\n")
    (folder / "specifications.yaml").write_text("{}\n")
    for number in range(UNITS):
        # The units stand in groups of five, each of which reads the one before.
        other = number - 1 if number % 5 else number + 4
        text = RESOURCE.format(number=number, name=unit(number), other=unit(other), type=TYPE)
        (folder / "resources" / f"{unit(number)}.yaml").write_text(text)


async def speak(folder: Path) -> None:
    """Speak for all nodes."""
    registry = MessageRegistry.from_folder(folder / "messages")
    loop = asyncio.get_running_loop()
    transport = open_transport("cyclonedds", registry, "pipeline_units", loop)
    topics = [f"/{unit(number)}/state" for number in range(UNITS)]
    for topic in topics:
        transport.advertise(topic, TYPE, QualityOfService.RELIABLE)
    began, step = loop.time(), 0
    while True:
        for number, topic in enumerate(topics):
            count = (number + step) % 100
            value = {
                "level": float(10 * (step % 3)),
                "position": float(step % 2),
                "count": count,
                "rest": 99 - count,
                "half": (count + 50) % 100,
            }
            transport.publish(topic, TYPE, registry.encode(TYPE, value))
        step += 1
        await asyncio.sleep(max(0.0, began + step * PERIOD - loop.time()))


if __name__ == "__main__":
    if sys.argv[1] == "model":
        write(Path(sys.argv[2]))
    else:
        asyncio.run(speak(Path(sys.argv[2])))
