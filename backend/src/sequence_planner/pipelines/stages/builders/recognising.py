"""`match` and `member` from documents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import get_args

from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import MatchDocument, MemberDocument
from sequence_planner.pipelines.context import Context
from sequence_planner.pipelines.paths import FieldPath
from sequence_planner.pipelines.record import ListType
from sequence_planner.pipelines.stages.builders.common import only, type_for, value_of, values_of
from sequence_planner.pipelines.stages.recognising import MatchNamesStage, MatchStage, MemberStage, Way
from sequence_planner.pipelines.stages.values import is_textual


def build_match(document: MatchDocument, context: Context) -> MatchStage | MatchNamesStage | None:
    """Texts recognised in one way, or listed by what they mean."""
    if not only(context, document.field.place, True, "match"):
        return None
    found = context.field(document.field)
    if found is None:
        return None
    path, type_ = found
    if not is_textual(type_):
        context.found(document.field.place, f"`{document.field}` is {type_}, and only texts are matched")
        return None
    if document.values is not None:
        return _names(document, document.values, path, context)
    ways: tuple[Way, ...] = get_args(Way)
    way, text = next((way, text) for way in ways if (text := getattr(document, way)) is not None)
    return MatchStage(context.place, path, str(document.variable), way, str(text))


def _names(
    document: MatchDocument, values: Mapping[SourceText, Sequence[SourceText]], path: FieldPath, context: Context
) -> MatchNamesStage | None:
    names = [*values, *([] if document.otherwise is None else [document.otherwise])]
    type_ = type_for(context, document.variable, names)
    meant = None if type_ is None else values_of(context, type_, names, document.variable.place)
    twice = _texts_with_two_meanings(values)
    for text, other in twice:
        context.found(text.place, f"`{text}` means `{other}` already")
    if type_ is None or meant is None or twice:
        return None
    meanings = {str(text): name for name, texts in zip(meant, values.values(), strict=False) for text in texts}
    otherwise = None if document.otherwise is None else meant[-1]
    return MatchNamesStage(context.place, path, str(document.variable), type_, meanings, otherwise)


def _texts_with_two_meanings(
    values: Mapping[SourceText, Sequence[SourceText]],
) -> list[tuple[SourceText, SourceText]]:
    first: dict[SourceText, SourceText] = {}
    listed = [(text, name) for name, texts in values.items() for text in texts]
    return [(text, other) for text, name in listed if (other := first.setdefault(text, name)) is not name]


def build_member(document: MemberDocument, context: Context) -> MemberStage | None:
    """Whether a list contains an item."""
    if not only(context, document.field.place, True, "member"):
        return None
    found = context.field(document.field)
    if found is None:
        return None
    path, type_ = found
    if not isinstance(type_, ListType):
        context.found(document.field.place, f"`{document.field}` is {type_}, and no list")
        return None
    item = value_of(context, type_.element, document.item, document.field.place)
    return None if item is None else MemberStage(context.place, path, type_, item, str(document.variable))
