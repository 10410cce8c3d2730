"""What can be seen of running pipelines: how much has passed each edge, and what last.

An edge leads to a stage, or from the last one to the end. While a pipeline runs, an edge only counts and keeps a
reference to the record; a view of it is made when somebody asks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.pipelines.record import Record
from sequence_planner.pipelines.stage import Override


@dataclass(slots=True)
class Edge:
    """What has passed an edge while the station runs; `at` is on the clock of the pipelines."""

    records: int = 0
    last: Record | None = None
    at: float | None = None

    def passed(self, record: Record, now: float) -> None:
        """A record passes."""
        self.records += 1
        self.last = record
        self.at = now


@dataclass(frozen=True)
class EdgeView:
    """One edge: where it leads (`3 discretise`, or the name of the end), and what has passed it.

    `held` are the records the stage has not let through so far: dropped, held back, or made one of several.
    """

    to: str
    records: int
    held: int
    last: Mapping[str, object] | None
    troubles: tuple[str, ...]
    at: float | None


@dataclass(frozen=True)
class PipelineView:
    """The pipeline of one topic or flow, from its source to its end; `repeated` messages said nothing new."""

    name: str
    sources: tuple[str, ...]
    edges: tuple[EdgeView, ...]
    repeated: int
    overrides: Mapping[str, Override | None]
