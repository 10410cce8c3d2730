"""Where the repository has what tests read."""

from __future__ import annotations

from pathlib import Path
from typing import Final

REPOSITORY: Final = Path(__file__).parents[3]
BACKEND: Final = REPOSITORY / "backend"
SOURCES: Final = BACKEND / "src" / "sequence_planner"
TESTS: Final = BACKEND / "tests"
DOCS: Final = REPOSITORY / "docs"

MODELS: Final = REPOSITORY / "models"
BOLT_TIGHTENING: Final = MODELS / "bolt_tightening"
SINGLE_BOLT: Final = MODELS / "single_bolt"
TRUCK_ENGINE_STATION: Final = MODELS / "truck_engine_station"

# Stations of the tests alone.
STATIONS: Final = TESTS / "stations"
CELL: Final = STATIONS / "cell"
MIXER: Final = STATIONS / "mixer"
WORKED_EXAMPLE: Final = STATIONS / "worked_example"
