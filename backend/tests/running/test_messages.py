"""Messages between two processes over real DDS: none is lost, and what they say is seen at once."""

from __future__ import annotations

import asyncio
import random
import re
import shutil
import time
from dataclasses import replace
from pathlib import Path

from sequence_planner.pipelines.runtime import RunningPipelines
from sequence_planner.simulation.messages import Message, spoken
from sequence_planner.station import ReadyStation, prepare_station
from support.examples import TIMED
from support.places import REPOSITORY
from support.station import MODEL, RunningStation, foreign_node, station
from support.waiting import until_async

BURSTS, BURST = 50, 20  # of messages of each topic
PAUSE = 0.05  # seconds between two bursts
SEEN_WITHIN = 5.0  # seconds


def test_no_message_is_lost_and_the_last_one_counts(tmp_path: Path) -> None:
    model = patient_model(tmp_path / "model")
    ready = prepare_station(model)
    topics = [each.topic for each in ready.pipelines.incoming.values()]
    drawn = random.Random(5)
    reference = RunningPipelines(ready.pipelines)

    async def devices(running: RunningStation) -> None:
        async with foreign_node() as (transport, registry):
            for topic in topics:
                # What is not confirmed yet is kept, however late a busy machine's processes have their turns.
                transport.advertise(topic.name, topic.type_name, replace(topic.quality, depth=BURSTS * BURST))
            await until_async(lambda: all(running.get("topics")[topic.name]["peers"] for topic in topics))
            for _ in range(BURSTS):
                for _ in range(BURST):
                    for topic in topics:
                        message = random_message(ready, topic.name, drawn)
                        reference.take(topic.name, message, time.monotonic())
                        transport.publish(topic.name, topic.type_name, registry.encode(topic.type_name, message))
                await asyncio.sleep(PAUSE)
            began = time.monotonic()
            expected = reference.values(dict.fromkeys(ready.pipelines.sources, True))
            heard = {topic.name: BURSTS * BURST for topic in topics}

            def seen() -> bool:
                said = running.get("topics")
                return {name: said[name]["messages"] for name in heard} == heard

            await until_async(seen)
            assert not TIMED or time.monotonic() - began < SEEN_WITHIN
            values = running.get("variables", "state")
            assert {name: values[name]["value"] for name in expected} == expected

    with station(tmp_path, model=model) as running:
        asyncio.run(devices(running))


def patient_model(folder: Path) -> Path:
    """The station, with topics that may be silent for a minute: what came last is known still when it is looked at."""
    shutil.copytree(REPOSITORY / MODEL, folder)
    for path in folder.glob("resources/*.yaml"):
        path.write_text(re.sub(r"deadline: [0-9.]+", "deadline: 60.0", path.read_text()))
    return folder


def random_message(ready: ReadyStation, topic: str, drawn: random.Random) -> Message:
    """What a device says in a random state of its own."""
    state = {
        **ready.automaton.initial_valuation,
        **{name: drawn.choice(list(ready.automaton.variables[name].type.domain)) for name in ready.pipelines.feeds},
    }
    return dict(spoken(ready.pipelines, topic, state, {}))
