"""Record the golden journals anew, from real controllers with their planner and emulated devices, in real time.

    python -m golden.record [NAME]...

Without names all are recorded, one after the other, and models that no journal needs any more are removed.
"""

from __future__ import annotations

import asyncio
import logging
import random
import shutil
import sys
import tempfile
from collections import Counter
from pathlib import Path

import structlog

from golden.journals import JOURNALS, MODELS, MOST_BYTES, keep, model_of, names, records, replayed, write
from golden.life import devices, life, ready
from golden.scenarios import SCENARIOS, Scenario
from sequence_planner.db.database import Database
from sequence_planner.execution.record.recorder import model_digest
from sequence_planner.journal import run_journal
from sequence_planner.ros.transports.memory import MemoryNetwork
from support.databases import journal


def record(name: str) -> None:
    """Record one journal. AssertionError where it has not what it is for, or cannot be replayed."""
    scenario = SCENARIOS[name]
    with tempfile.TemporaryDirectory() as folder, journal() as database:
        models = _models(scenario, Path(folder))
        asyncio.run(_lives(name, scenario, models, database))
        with database.reading() as connection:
            run = run_journal.after(connection, 0, 1_000_000)
        for each in set(models):
            keep(model_digest(ready(each)[0].automaton), each)
    kinds = Counter(each.kind for each in run)
    assert scenario.kinds <= kinds.keys(), f"{name} has no {sorted(scenario.kinds - kinds.keys())}: {kinds}"
    write(name, run)
    assert (difference := replayed(records(name))) is None, difference
    size = (JOURNALS / f"{name}.jsonl.gz").stat().st_size
    told = ", ".join(f"{kind} {number}" for kind, number in kinds.most_common())
    print(f"{name}: {len(run)} records, {size} bytes; {told}")  # noqa: T201 - what whoever records waits for
    assert size <= MOST_BYTES, f"{name} is larger than {MOST_BYTES} bytes: let less happen in it"


async def _lives(name: str, scenario: Scenario, models: list[Path], database: Database) -> None:
    chance = random.Random(name)
    network = MemoryNetwork()
    async with devices(models[0], network, chance.randrange(1000)) as around:
        for script, folder in zip(scenario.lives, models, strict=True):
            async with life(folder, network, database, around, chance) as here:
                await script(here)


def _models(scenario: Scenario, folder: Path) -> list[Path]:
    """The model of each life."""
    if scenario.edit is None:
        return [scenario.station] * len(scenario.lives)
    deployed = folder / f"{scenario.station.name}_deployed"
    shutil.copytree(scenario.station, deployed)
    name, old, new = scenario.edit
    text = (deployed / name).read_text()
    assert old in text, scenario.edit
    (deployed / name).write_text(text.replace(old, new))
    return [*[scenario.station] * scenario.since, *[deployed] * (len(scenario.lives) - scenario.since)]


def main(asked: list[str]) -> None:
    """Record those that are asked for, or all."""
    structlog.configure(wrapper_class=structlog.make_filtering_bound_logger(logging.ERROR))
    MODELS.mkdir(parents=True, exist_ok=True)
    for name in asked or SCENARIOS:
        record(name)
    for name in set(names()) - SCENARIOS.keys():
        (JOURNALS / f"{name}.jsonl.gz").unlink()
    used = {model_of(each) for name in names() for each in records(name)} - {None}
    for file in MODELS.iterdir():
        if not any(str(digest).startswith(file.stem) for digest in used):
            file.unlink()


if __name__ == "__main__":
    main(sys.argv[1:])
