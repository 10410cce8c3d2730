"""`expression` and `filter` from documents."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.syntax import ExpressionError
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.record import RecordType
from sequence_planner.pipelines.stages.calculation.reading import Calculation, read_calculation, read_condition
from sequence_planner.pipelines.stages.computing import ExpressionStage, FilterStage
from sequence_planner.pipelines.stages.values import as_written

Scalar = SourceText | bool | int | float


def build_expression(texts: Mapping[SourceText, Scalar], context: Context) -> ExpressionStage | None:
    """`{name: expression}`, all over the record as it is before the stage."""
    read = {str(name): _read(read_calculation, text, name.place, context) for name, text in texts.items()}
    known = {name: calculation for name, calculation in read.items() if calculation is not None}
    return ExpressionStage(context.place, known) if len(known) == len(read) else None


def build_filter(text: SourceText | bool, context: Context) -> FilterStage | None:
    """A condition on records."""
    condition = _read(read_condition, text, context.place, context)
    return None if condition is None else FilterStage(context.place, condition)


def _read(
    reader: Callable[[str, RecordType], Calculation], text: Scalar, place: Place, context: Context
) -> Calculation | None:
    try:
        return reader(text if isinstance(text, str) else as_written(text), context.fields)
    except ExpressionError as error:
        context.found(text.at(error.span) if isinstance(text, SourceText) else place, error.message)
        return None
