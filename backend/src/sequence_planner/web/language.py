"""The language of guards and actions, for whoever writes them: what is wrong, what could stand there, what is meant."""

from __future__ import annotations

from fastapi import Response

from sequence_planner.identity.roles import Role, Scope
from sequence_planner.web.access import allowed
from sequence_planner.web.found import found
from sequence_planner.web.interface import interface
from sequence_planner.web.model import TheWorkshop
from sequence_planner.web.problems import refused
from sequence_planner.web.request_parts import JSON_ONLY
from sequence_planner.workshop.language_view import CompletionView
from sequence_planner.workshop.questions import (
    FormatView,
    HoverAnswer,
    LanguageQuestionKind,
    PlaceInText,
    ProblemsView,
    TextAt,
)

router = interface(
    "/model/language",
    tags=["model"],
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ), JSON_ONLY],
    responses=refused(409, 503),
)


@router.post("/check", response_model=ProblemsView)
async def check_text(body: TextAt, shop: TheWorkshop) -> Response:
    """What is wrong with a text, as the check of the whole draft would find it there."""
    return found(await shop.ask(LanguageQuestionKind.CHECK, body))


@router.post("/completion", response_model=CompletionView)
async def complete_text(body: PlaceInText, shop: TheWorkshop) -> Response:
    """What can stand at a place in a text."""
    return found(await shop.ask(LanguageQuestionKind.COMPLETION, body))


@router.post("/hover", response_model=HoverAnswer)
async def explain_text(body: PlaceInText, shop: TheWorkshop) -> Response:
    """What the name at a place in a text is."""
    return found(await shop.ask(LanguageQuestionKind.HOVER, body))


@router.post("/format", response_model=FormatView)
async def format_text(body: TextAt, shop: TheWorkshop) -> Response:
    """The text as it is written best; one that cannot be read stays as it is."""
    return found(await shop.ask(LanguageQuestionKind.FORMAT, body))
