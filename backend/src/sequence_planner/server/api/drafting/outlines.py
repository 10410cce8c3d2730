"""Routes of outlines, from which the model of a first station is made."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import Query, Response

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.editor.outline.beginning import templates
from sequence_planner.editor.outline.outline import Outline, OutlineView, TemplatesView
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    found,
)
from sequence_planner.server.errors import refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.drafts import TheWorkshop

VIEWER = allowed(Role.VIEWER, scope=Scope.READ)

router = interface("/model", tags=["model"], responses=refused(409, 503))


@router.get("/outlines", dependencies=[VIEWER])
async def outline_templates(language: Annotated[Literal["en", "sv"], Query()] = "en") -> TemplatesView:
    """Outlines of stations to begin a model with, with their titles in a language."""
    return templates(language)


@router.post("/outlines/preview", dependencies=[VIEWER, JSON_ONLY], response_model=OutlineView)
async def preview_outline(body: Outline, shop: TheWorkshop) -> Response:
    """The documents that an outline of a station becomes; nothing is changed. `POST /model/changes` takes them."""
    return found(await shop.outlined(body))
