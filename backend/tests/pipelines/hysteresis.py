"""A stage that is declared here alone, and a process that asks all of the program about it.

It is a process of its own, since no other test is to find the stage among the kinds that there are.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from pydantic import Field

from editor.pipelines.drafts import graph_of
from sequence_planner.editor.pipelines.schemas import Fitting
from sequence_planner.editor.pipelines.suggestions import fits
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import renamed
from sequence_planner.language.records.field_paths import is_numeric
from sequence_planner.language.records.record import Record
from sequence_planner.model.files import read_files
from sequence_planner.model.json_schema import schema_of
from sequence_planner.model.source import ModelError, SourceText
from sequence_planner.model.stages.base import StageInstance
from sequence_planner.model.stages.marks import ExampleValue, NameMark, NameUse
from sequence_planner.model.stages.registry import add_kind
from sequence_planner.model.stages.support import PassingDeclaration, PassingStage
from sequence_planner.station import prepare_station

from .station_writing import Heard, write_station

MESSAGE = {"Tank": "uint8 level\nstring name\n"}
RESOURCE = """\
topics:
  /tank:
    type: tank_msgs/msg/Tank
    direction: in
    pipeline:
      - hysteresis: {field: level, width: 2} # of its height
"""
WRONG = ("{field: name, width: 2}", "{field: level, width: 0}", "{field: level, widht: 2}", "{field: levle, width: 2}")


class HysteresisDocument(PassingDeclaration):
    """A number goes on when it has moved by more than `width`; until then the old one does."""

    kind: ClassVar[str] = "hysteresis"
    about: ClassVar[str] = "A number counts when it has moved far enough; for incoming topics."
    direction: ClassVar = "incoming"
    is_timed: ClassVar[bool] = False

    field: Annotated[SourceText, NameMark(NameUse.KEPT, NameUse.KEPT, is_numeric, "a number")]
    """The number."""
    width: Annotated[float, Field(gt=0), ExampleValue(0.1)]
    """How far it must have moved."""

    def begin(self, stage: PassingStage) -> StageInstance:
        """Begin with no number."""
        return Hysteresis(stage, self.width)


@dataclass(slots=True)
class Hysteresis(StageInstance):
    """Has the number that counts."""

    stage: PassingStage
    width: float
    last: float | None = None

    def take(self, record: Record, now: float) -> Record:
        """The record with the number that counts."""
        (number,) = self.stage.get(record)
        if not isinstance(number, int | float):
            self.last = None
        elif self.last is None or abs(number - self.last) > self.width:
            self.last = number
        return self.stage.put(record, (self.last,))


def findings(station: Path, written: str) -> list[str]:
    """What is wrong with the station when the stage is written so."""
    file = station / "resources" / "tank.yaml"
    file.write_text(RESOURCE.replace("{field: level, width: 2}", written), encoding="utf-8")
    try:
        prepare_station(station)
    except ModelError as error:
        return [str(finding).removeprefix(f"{file}:") for finding in error.findings]
    return []


def main(folder: Path) -> None:
    """Say what the program knows of the stage."""
    station = write_station(folder, RESOURCE, MESSAGE)
    ready = prepare_station(station)
    heard = Heard(ready)
    files = dict(read_files(station))
    offered = fits(1, graph_of(files), Fitting(pipeline="/tank", edge=0, field="level")).stages
    said = {
        "levels": [heard.take("/tank", level=level)["tank.level"] for level in (5, 6, 7, 8, 9, 5, 4)],
        "is_timed": ready.pipelines.incoming["/tank"].chain.is_timed,
        "renamed": renamed(files, parse_part("variable:tank.level"), "height", ready.registry),
        "offered": [(each.stage, each.reason) for each in offered if each.kind == "hysteresis"],
        "schema": schema_of("resource")["$defs"]["HysteresisDocument"],
        "wrong": [findings(station, each) for each in WRONG],
    }
    sys.stdout.write(json.dumps(said))


if __name__ == "__main__":
    add_kind(HysteresisDocument)
    main(Path(sys.argv[1]))
