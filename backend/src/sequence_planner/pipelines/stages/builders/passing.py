"""Stages through which fields pass, from documents: memory, times and overrides."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import EnumerationType, IntegerRange
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import (
    BoundsDocument,
    DebounceDocument,
    EveryDocument,
    OverrideDocument,
    RememberDocument,
    TimeoutDocument,
)
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import FieldType
from sequence_planner.pipelines.stages.builders.common import (
    are_alike,
    narrowest,
    only,
    passing,
    values_of,
    wanted_type,
)
from sequence_planner.pipelines.stages.overriding import Bounds, OverrideStage
from sequence_planner.pipelines.stages.remembering import FoldStage, RememberStage
from sequence_planner.pipelines.stages.timing import DebounceStage, LimitStage, TickStage, TimeoutStage
from sequence_planner.pipelines.stages.transparent import Passing
from sequence_planner.pipelines.stages.values import as_written, domain, is_numeric, written


def build_remember(document: RememberDocument, context: Context) -> RememberStage | None:
    """A variable that keeps the last value of another."""
    if not only(context, document.variable.place, True, "remember"):
        return None
    found = context.field(document.of)
    if found is None:
        return None
    path, given = found
    of = narrowest(context, path, given)
    type_ = wanted_type(context, document.variable) or of
    if not are_alike(of, type_):
        remedy = "make one of the other by a stage before this"
        context.found(document.of.place, f"`{path}` is {of} here, and `{document.variable}` is {type_}: {remedy}")
        return None
    ignored = {value: written(of, value) for value in document.ignored}
    for value, meant in ignored.items():
        if meant is None:
            near = suggestion(value, of.values) if isinstance(of, EnumerationType) else ""
            context.found(value.place, f"`{value}` is no value of `{document.of}`{near}")
    kept = set(domain(of) or ()) - set(ignored.values())
    if (holds := domain(type_)) is not None and (extra := kept - set(holds)):
        names = ", ".join(sorted(map(as_written, extra)))
        context.found(document.variable.place, f"`{document.variable}` cannot be {names}: put it into `except`")
        return None
    if None in ignored.values():
        return None
    return RememberStage(context.place, str(document.variable), type_, path, frozenset(ignored.values()))


def build_fold(names: Sequence[SourceText], context: Context) -> FoldStage | None:
    """Fields that keep their last value: those named, or all."""
    if not names:
        every = (Passing(FieldPath(name, name), type_) for name, type_ in context.fields.items())
        return FoldStage(context.place, tuple(every))
    fields = passing(context, names)
    return None if fields is None else FoldStage(context.place, fields)


def build_debounce(document: DebounceDocument, context: Context) -> DebounceStage | None:
    """Fields whose values count when they have been there for some time."""
    right = only(context, document.fields[0].place, True, "debounce")
    fields = passing(context, document.fields) if right else None
    return None if fields is None else DebounceStage(context.place, fields, document.seconds)


def build_timeout(document: TimeoutDocument, context: Context) -> TimeoutStage | None:
    """Fields that are unknown after a silence."""
    right = only(context, document.fields[0].place, True, "timeout")
    fields = passing(context, document.fields) if right else None
    return None if fields is None else TimeoutStage(context.place, fields, document.seconds)


def build_limit(document: EveryDocument, context: Context) -> LimitStage:
    """At most one record per time."""
    return LimitStage(context.place, (), document.every)


def build_tick(document: EveryDocument, context: Context) -> TickStage:
    """The last record again and again."""
    return TickStage(context.place, (), document.every)


def build_override(document: OverrideDocument, context: Context) -> OverrideStage | None:
    """Fields that a person may set. One that no record has yet must be a field of the message."""
    fields: list[Passing] = []
    bounds: dict[str, Bounds] = {}
    for name, written_bounds in document.fields.items():
        wanted = wanted_type(context, name)
        is_new = not context.is_incoming and wanted is not None and str(name) not in context.fields
        found = (FieldPath(str(name), str(name)), wanted) if is_new and wanted is not None else context.field(name)
        if found is None:
            continue
        path, type_ = found
        allowed = _bounds(context, name, written_bounds, narrowest(context, path, type_))
        if allowed is not None:
            fields.append(Passing(path, type_))
            bounds[str(name)] = allowed
    if len(fields) != len(document.fields):
        return None
    return OverrideStage(context.place, tuple(fields), str(document.name), bounds, document.expires)


def _bounds(context: Context, name: SourceText, document: BoundsDocument, type_: FieldType) -> Bounds | None:
    if document.between is None:
        among = values_of(context, type_, document.among or [], name.place)
        return None if among is None else Bounds(among=tuple(among))
    if not is_numeric(type_):
        context.found(name.place, f"`{name}` is {type_}, which is not between two numbers: write `in: [values]`")
        return None
    return Bounds(document.between) if _reachable(context, name.place, document.between, type_) else None


def _reachable(context: Context, place: Place, between: tuple[float, float], type_: FieldType) -> bool:
    if not isinstance(type_, IntegerRange):
        return True
    beyond = [bound for bound in between if not type_.minimum <= bound <= type_.maximum]
    for bound in beyond:
        context.found(place, f"the field ranges over {type_}, and cannot be {bound:g}")
    return not beyond
