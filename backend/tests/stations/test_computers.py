"""The computers of the hall, which `make hall` starts: one may die, as computers do, and the others go on."""

from __future__ import annotations

import asyncio
import sys

import pytest

from sequence_planner.simulation.truck_station.__main__ import outlived


def test_a_computer_that_dies_takes_no_other_with_it_and_the_world_takes_all(
    capsys: pytest.CaptureFixture[str],
) -> None:
    async def live() -> None:
        names = ("world", "ur10", "mircom")
        wait = (sys.executable, "-c", "import time; time.sleep(60)")
        processes = {name: await asyncio.create_subprocess_exec(*wait) for name in names}
        hall = asyncio.create_task(outlived(processes, {name: f"start {name}" for name in names}))
        processes["ur10"].kill()
        await processes["ur10"].wait()
        await asyncio.sleep(0.2)
        assert (hall.done(), processes["world"].returncode, processes["mircom"].returncode) == (False, None, None)
        processes["world"].kill()
        await asyncio.wait_for(hall, 20)
        assert processes["mircom"].returncode is not None

    asyncio.run(live())
    assert capsys.readouterr().err == "ur10 has ended, the others go on; to start it again: start ur10\n"
