"""One spell at a station: it is stopped in some ways, one after the other, and got back to work each time."""

from __future__ import annotations

import random
import tempfile
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from running.back_to_work.bolt_stops import BoltStops
from running.back_to_work.bolts import bolt_station
from running.back_to_work.engine import engine_station
from running.back_to_work.engine_stops import EngineStops
from running.back_to_work.person import Person
from running.back_to_work.stops import Stops

LONGEST_ENGINE = 400.0  # seconds


def bolt_ways(seed: str, number: int = 5) -> Counter[str]:
    """So many ways in a row, one of each kind among them. AssertionError for a dead end, or a wrong engine."""
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder, bolt_station(Path(folder)) as (station, hands):
        person = Person(station, hands)
        stops = BoltStops(station, person, chance, hands)
        person.do("POST", "production/start", {})
        return _gone_through(stops, number, lambda: (hands.bolts.engines, hands.bolts.wrong))


def engine_ways(seed: str, number: int = 5) -> Counter[str]:
    """The same in the hall."""
    chance = random.Random(seed)
    with (
        tempfile.TemporaryDirectory() as folder,
        engine_station(Path(folder), chance.randrange(1000)) as (station, hands),
    ):
        stops = EngineStops(station, Person(station, hands, serves=False), chance, hands)
        return _gone_through(stops, number, lambda: (hands.built, hands.wrong))


def _gone_through(stops: Stops, number: int, truth: Callable[[], tuple[int, list[str]]]) -> Counter[str]:
    """Stop and get back; then one more engine is built, and `truth` has how many were, and what was wrong."""
    person, ways = stops.person, stops.ways()
    try:
        for name in stops.drawn(number):
            meant, stop = ways[name]
            person.tell(f"-- {name}")
            stop()
            person.get_back(meant)
            person.seen[f"way: {name}"] += 1
        before, _ = truth()
        assert person.until(lambda: truth()[0] > before, LONGEST_ENGINE), "no engine is built any more"
        built, wrong = truth()
        assert not wrong, wrong
    except (AssertionError, LookupError, ValueError) as error:
        raise AssertionError("\n".join([*person.story, f"{type(error).__name__}: {error}"])) from None
    person.seen["engines built"] += built
    return +person.seen
