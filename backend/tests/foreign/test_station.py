"""A station whose devices are programs of another ROS 2 implementation: it commands them, and they drive its state."""

from __future__ import annotations

import asyncio
from pathlib import Path

from foreign.peers import FAST_DDS, built, running
from support.network import DOMAIN, free_port
from support.station import RunningStation, process
from support.waiting import until

MODEL = Path("models") / "robots_with_buffer"


def test_devices_on_fast_dds_do_the_work_of_the_station(tmp_path: Path) -> None:
    program = built(FAST_DDS)
    port, log = free_port(), tmp_path / "station.log"

    def known(station: RunningStation) -> bool:
        return station.up() and None not in (station.value("robot_1.at"), station.value("robot_2.at"))

    async def work(station: RunningStation) -> None:
        async with running(program, DOMAIN, "robot", "robot_1") as first:
            async with running(program, DOMAIN, "robot", "robot_2") as second:
                await asyncio.to_thread(until, lambda: known(station))
                assert station.post("production/start", {}).status_code == 204
                await asyncio.to_thread(until, lambda: station.completed("deliver_part") >= 2)
                assert station.get("alarms") == {}
            # What the devices know themselves, whatever the station believes.
            put, taken = first.lines.count("put on the buffer"), second.lines.count("taken from the buffer")
            delivered = second.lines.count("delivered")
            assert 2 <= delivered <= taken <= put <= taken + 2
            assert "dropped" not in first.lines + second.lines
            await asyncio.to_thread(until, lambda: station.value("robot_2.at") is None)
            assert station.value("robot_1.at") is not None
            await asyncio.to_thread(until, lambda: "/robot_2/state" in str(station.get("alarms")))

    try:
        with process(log, "run", str(MODEL), "--port", str(port)) as started:
            station = RunningStation(started, port, log)
            until(station.up)
            asyncio.run(work(station))
        assert started.returncode == 0
    except AssertionError as error:
        raise AssertionError(log.read_text()) from error
