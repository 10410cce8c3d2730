"""A recording of ROS 2 traffic as `ros2 bag record` makes it: `recording.py MODEL FOLDER` writes one of the bolt tightening
station, in MCAP.

The robot comes to above the engine after 3 s. The nutrunner falls silent after 2 s, and one of its messages is garbled; the
planning scene is not recorded, and somebody talks on a topic of their own.
"""

from __future__ import annotations

import sys
from pathlib import Path

from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys.store import Typestore

from sequence_planner.simulation.messages import spoken
from sequence_planner.station import prepare_station

NS = 1_000_000_000
BEGAN = 1_700_000_000 * NS


def main(model: str, folder: str) -> None:
    """Write it."""
    station = prepare_station(Path(model))
    store = Typestore()
    declared = station.registry.declared().items()
    store.register({name: ([], fields) for name, fields in declared if name.split("/")[1] == "msg"})
    initial = station.automaton.initial_valuation
    with Writer(Path(folder), version=9, storage_plugin=StoragePlugin.MCAP) as writer:

        def said(topic: str, at: float, garbled: bool = False, **values: object) -> None:
            type_name = station.pipelines.incoming[topic].topic.type_name
            known = next((each for each in writer.connections if each.topic == topic), None)
            connection = known or writer.add_connection(topic, type_name, typestore=store)
            state = {**initial, **{name.replace("__", "."): value for name, value in values.items()}}
            data = station.registry.encode(type_name, spoken(station.pipelines, topic, state, {}))
            writer.write(connection, BEGAN + round(at * NS), data[:4] if garbled else data)

        talk = writer.add_connection("/talk", "std_msgs/msg/String", typestore=store)
        for tenth in range(80):
            at = tenth / 10
            said("/ur10/state", at, robot__pose="home" if tenth < 30 else "above_engine")
            if tenth < 20:
                said("/smart_nutrunner/state", at + 0.05, tenth == 7, nutrunner__tool_is_idle=True)
        writer.write(talk, BEGAN + 8 * NS, station.registry.encode("std_msgs/msg/String", {"data": "done"}))


if __name__ == "__main__":
    main(*sys.argv[1:])
