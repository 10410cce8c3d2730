"""`discretise` and `undiscretise` from documents."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import EnumerationType, IntegerRange
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import DiscretiseDocument, UndiscretiseDocument
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.record import FieldType, ListType
from sequence_planner.pipelines.stages.builders.common import only, wanted_type
from sequence_planner.pipelines.stages.discretising import DiscretiseStage, UndiscretiseStage
from sequence_planner.pipelines.stages.regions import Numbers, Points, Ranges, Regions, distance
from sequence_planner.pipelines.stages.values import REAL, is_numeric

Coordinates = Mapping[SourceText, Sequence[float]]
Bounds = tuple[float | None, float | None]


def build_discretise(document: DiscretiseDocument, context: Context) -> DiscretiseStage | None:
    """From numbers to names."""
    if not only(context, document.field.place, True, "discretise", "undiscretise"):
        return None
    found = context.field(document.field)
    names = [*(document.values or document.ranges or {})]
    names += [] if document.otherwise is None else [document.otherwise]
    type_ = wanted_type(context, document.variable) or EnumerationType(tuple(dict.fromkeys(map(str, names))))
    named = _are_names(context, document.field, names, type_)
    if found is None or not named or not isinstance(type_, EnumerationType):
        return None
    path, field = found
    regions = _regions(document, field, context)
    if regions is None:
        return None
    otherwise = None if document.otherwise is None else str(document.otherwise)
    variable, hysteresis = str(document.variable), document.hysteresis
    return DiscretiseStage(context.place, path, variable, type_, regions, otherwise, hysteresis, field)


def build_undiscretise(document: UndiscretiseDocument, context: Context) -> UndiscretiseStage | None:
    """From names to numbers."""
    if not only(context, document.field.place, False, "undiscretise", "discretise"):
        return None
    found = context.field(document.variable)
    axes = {len(point) for point in document.values.values()}
    field = wanted_type(context, document.field) or ListType(REAL, next(iter(axes)) if len(axes) == 1 else None)
    fits = _fit(context, document.field, document.values, field)
    if found is None or not _are_names(context, document.field, document.values, found[1]) or not fits:
        return None
    path, type_ = found
    missing = sorted(set(type_.values if isinstance(type_, EnumerationType) else ()) - set(map(str, document.values)))
    if missing:
        context.found(document.variable.place, f"no coordinates for {', '.join(missing)}")
        return None
    element = field.element if isinstance(field, ListType) else field
    points = {str(name): _coordinates(context, name, at, element) for name, at in document.values.items()}
    known = {name: point for name, point in points.items() if point is not None}
    return UndiscretiseStage(context.place, path, str(document.field), field, known) if known == points else None


def _coordinates(context: Context, name: SourceText, at: Sequence[float], type_: FieldType) -> Numbers | None:
    """A point as it is sent; None, and findings, where the field cannot have it."""
    if not isinstance(type_, IntegerRange):
        return tuple(at)
    strange = [number for number in at if not number.is_integer() or not type_.minimum <= number <= type_.maximum]
    for number in strange:
        context.found(name.place, f"`{name}` has the coordinate {number:g}, and the field has integers in {type_}")
    return None if strange else tuple(map(int, at))


def _are_names(context: Context, where: SourceText, names: Iterable[SourceText], type_: FieldType) -> bool:
    if not isinstance(type_, EnumerationType):
        message = f"points have names, so the variable must be an enumeration and not {type_}"
        context.found(where.place, message)
        return False
    strange = [name for name in names if name not in type_.values]
    for name in strange:
        context.found(name.place, f"`{name}` is none of {type_}{suggestion(name, type_.values)}")
    return not strange


def _regions(document: DiscretiseDocument, field: FieldType, context: Context) -> Regions | None:
    if document.ranges is not None:
        if not is_numeric(field):
            context.found(document.field.place, f"`{document.field}` is {field}, and ranges are of a single number")
            return None
        return _ranges(document.ranges, context)
    values, tolerance = document.values or {}, document.tolerance or 0.0
    if not _fit(context, document.field, values, field) or not _are_apart(context, values, tolerance):
        return None
    return Points({str(name): tuple(point) for name, point in values.items()}, tolerance)


def _fit(context: Context, name: SourceText, values: Coordinates, field: FieldType) -> bool:
    """Whether points have as many coordinates as the field has numbers, and no two are the same."""
    element = field.element if isinstance(field, ListType) else field
    if not is_numeric(element):
        context.found(name.place, f"`{name}` must be an array of numbers, or a number, and is {field}")
        return False
    lengths = {len(point) for point in values.values()}
    length = field.length if isinstance(field, ListType) else 1
    if len(lengths) != 1 or length not in (None, *lengths):
        context.found(name.place, f"all points need as many coordinates as `{name}` has: {field}")
        return False
    first: dict[tuple[float, ...], SourceText] = {}
    twins = [(point, twin) for point, at in values.items() if (twin := first.setdefault(tuple(at), point)) is not point]
    for point, twin in twins:
        context.found(point.place, f"`{point}` is at the same coordinates as `{twin}`")
    return not twins


def _are_apart(context: Context, values: Coordinates, tolerance: float) -> bool:
    near = [
        (one, other, apart)
        for (one, here), (other, there) in combinations(values.items(), 2)
        if (apart := distance(tuple(here), tuple(there))) <= tolerance
    ]
    for one, other, apart in near:
        message = f"`{other}` is only {apart:g} from `{one}`: the tolerance of {tolerance:g} does not tell them apart"
        context.found(other.place, message)
    return not near


def _ranges(ranges: Mapping[SourceText, Bounds], context: Context) -> Ranges | None:
    wrong = not ranges
    if not ranges:
        context.found(context.place, "`ranges` has no range: write at least one")
    for name, (least, greatest) in ranges.items():
        if least is not None and greatest is not None and least > greatest:
            context.found(name.place, f"the range of `{name}` ends before it begins: write the smaller number first")
            wrong = True
    for (one, here), (other, there) in combinations(ranges.items(), 2):
        if not wrong and _overlap(here, there):
            context.found(other.place, f"the range of `{other}` overlaps that of `{one}`")
            wrong = True
    return None if wrong else Ranges({str(name): bounds for name, bounds in ranges.items()})


def _overlap(one: Bounds, other: Bounds) -> bool:
    """Whether two ranges have more than one number in common."""
    least = max((bound for bound in (one[0], other[0]) if bound is not None), default=None)
    greatest = min((bound for bound in (one[1], other[1]) if bound is not None), default=None)
    return least is None or greatest is None or least < greatest
