"""What the builder of a stage may know: the record before it, what is wanted of it, and where to say what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from sequence_planner.expressions.place import Place
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.paths import FieldPath, NoFieldError, find_field
from sequence_planner.pipelines.record import FieldType, RecordType


@dataclass(frozen=True)
class Context:
    """Where a stage stands.

    `is_incoming` holds for incoming topics and flows. `fields` are those of the record before the stage. `wanted` are
    the names for which there is a use at the end, with their types: the measured variables of the resource without its
    name (incoming), or the fields of the message (outgoing). A stage may give others, which a later one reads.
    `found` notes what is wrong at a place; it adds which pipeline and which stage.
    """

    is_incoming: bool
    fields: RecordType
    wanted: Mapping[str, FieldType]
    folder: Path
    place: Place
    found: Callable[[Place, str], None]

    def field(self, path: SourceText) -> tuple[FieldPath, FieldType] | None:
        """A field that the stage reads, by its path; None, and a finding, when there is none."""
        try:
            return find_field(self.fields, path)
        except NoFieldError as error:
            self.found(path.place, str(error))
            return None
