"""One hour of simulated production, recorded in a journal and replayed from it: each state must be the one it was.

    python benchmarks/replaying.py [--minutes 60] [STATION]...

Stations are folders of models. Recording includes the emulated devices and the planner; replaying does not need them.
"""

from __future__ import annotations

import argparse
import asyncio
import tempfile
import time
from collections import Counter
from pathlib import Path

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.controller.restore import beginning
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.recorder import RunRecorder, model_digest
from sequence_planner.execution.record.replay import replay
from sequence_planner.history.simulated_station import SimulatedStation
from sequence_planner.journal.full_run import WholeRun
from sequence_planner.journal.writer import RunWriter
from sequence_planner.planning.planner import Planner
from sequence_planner.station import ReadyStation, prepare_station
from sequence_planner.synthesis.supervisor import synthesise

MODELS = Path(__file__).parents[2] / "models"
STATIONS = ("bolt_tightening", "truck_engine_station")
WRITTEN_BEHIND = 2000  # records; then the simulation, which is faster than any station, waits for the disk
LIMIT = 60.0  # seconds in which an hour must be replayed


async def record(station: ReadyStation, supervisor: Supervisor, database: Database, minutes: float) -> None:
    """Let the station produce, and write what happens."""
    execution = Executor(station.automaton, supervisor)
    writer = RunWriter(database, lambda: None)
    writer.start()
    now = Timestamp(1_800_000_000.0, 1000.0)
    simulated = SimulatedStation(station, execution, Planner(station.automaton, supervisor), now)
    recorder = RunRecorder(execution, writer.write, model_digest(station.automaton), clock=lambda: simulated.now.epoch)
    execution.start_production()
    began = time.perf_counter()
    for _ in range(round(minutes * 60)):
        simulated.run(1.0)
        await asyncio.sleep(0.05 if writer.waiting > WRITTEN_BEHIND else 0)
    print(f"  recorded {minutes:g} min in {time.perf_counter() - began:.1f} s: {recorder.last} records")
    await writer.close()


def again(station: ReadyStation, supervisor: Supervisor, database: Database) -> float:
    """Replay all of it. The seconds it took."""
    kinds: Counter[str] = Counter()
    size = 0
    began = time.perf_counter()
    with database.reading() as connection:
        for each in replay(WholeRun(connection), station.automaton, supervisor):
            assert each.difference is None, each.difference
            kinds[each.record.kind] += 1
            size += len(each.record.content)
    seconds = time.perf_counter() - began
    print(f"  replayed in {seconds:.1f} s, every digest as it was; {size / 1e6:.1f} MB of records")
    print("  " + ", ".join(f"{kind} {number}" for kind, number in kinds.most_common()))
    began = time.perf_counter()
    with database.reading() as connection:
        assert beginning(connection, station.automaton, Timestamp.now()) is not None
    print(f"  what a start needs of it is read in {(time.perf_counter() - began) * 1000:.1f} ms")
    return seconds


def main() -> None:
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("stations", nargs="*", default=STATIONS)
    parser.add_argument("--minutes", type=float, default=60.0)
    asked = parser.parse_args()
    late = []
    for name in asked.stations:
        print(name)
        station = prepare_station(MODELS / name)
        supervisor = synthesise(station.automaton)
        with tempfile.TemporaryDirectory() as folder:
            database = Database.open(f"sqlite:///{Path(folder) / 'station.sqlite'}")
            database.upgrade()
            asyncio.run(record(station, supervisor, database, asked.minutes))
            if again(station, supervisor, database) > LIMIT * asked.minutes / 60:
                late.append(name)
            database.close()
    if late:
        raise SystemExit(f"not replayed in time: {', '.join(late)}")


if __name__ == "__main__":
    main()
