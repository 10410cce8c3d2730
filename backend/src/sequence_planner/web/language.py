"""The language of guards and actions, for whoever writes them: what is wrong, what could stand there, what is meant."""

from __future__ import annotations

from fastapi import APIRouter

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.model import TheWorkshop, failed
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY
from sequence_planner.web.workshop import Workshop
from sequence_planner.workshop.language_view import CompletionView
from sequence_planner.workshop.processes import WorkEndedError
from sequence_planner.workshop.questions import (
    FormatView,
    HoverAnswer,
    LanguageAnswer,
    LanguageQuestionKind,
    PlaceInText,
    ProblemsView,
    TextAt,
)

router = APIRouter(
    prefix="/model/language",
    tags=["model"],
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ), JSON_ONLY],
    responses=refused(409, 503),
)


@router.post("/check")
async def check_text(body: TextAt, shop: TheWorkshop) -> ProblemsView:
    """What is wrong with a text, as the check of the whole draft would find it there."""
    answer = await _asked(shop, LanguageQuestionKind.CHECK, body)
    assert isinstance(answer, ProblemsView)
    return answer


@router.post("/completion")
async def complete_text(body: PlaceInText, shop: TheWorkshop) -> CompletionView:
    """What can stand at a place in a text."""
    answer = await _asked(shop, LanguageQuestionKind.COMPLETION, body)
    assert isinstance(answer, CompletionView)
    return answer


@router.post("/hover")
async def explain_text(body: PlaceInText, shop: TheWorkshop) -> HoverAnswer:
    """What the name at a place in a text is."""
    answer = await _asked(shop, LanguageQuestionKind.HOVER, body)
    assert isinstance(answer, HoverAnswer)
    return answer


@router.post("/format")
async def format_text(body: TextAt, shop: TheWorkshop) -> FormatView:
    """The text as it is written best; one that cannot be read stays as it is."""
    answer = await _asked(shop, LanguageQuestionKind.FORMAT, body)
    assert isinstance(answer, FormatView)
    return answer


async def _asked(shop: Workshop, kind: LanguageQuestionKind, asked: TextAt) -> LanguageAnswer:
    try:
        return await shop.ask(kind, asked)
    except WorkEndedError as error:
        raise failed(error) from error
