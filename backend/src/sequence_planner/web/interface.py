"""Where routes are declared: with their whole address and all that they have in common.

So the application takes them as they are. Routes that it included under a prefix would each be made once more by
FastAPI, which took longer than all else of making the application.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from fastapi import APIRouter, params
from fastapi.routing import APIRoute

from sequence_planner.web.openapi_refusals import PROBLEM_RESPONSES

PREFIX = "/api/v1"


def interface(
    prefix: str = "",
    *,
    tags: Sequence[str] = (),
    dependencies: Sequence[params.Depends] = (),
    responses: dict[int | str, dict[str, Any]] | None = None,
) -> APIRouter:
    """Routes of the interface for programs."""
    return beside_interface(PREFIX + prefix, tags=tags, dependencies=dependencies, responses=responses)


def beside_interface(
    prefix: str = "",
    *,
    tags: Sequence[str] = (),
    dependencies: Sequence[params.Depends] = (),
    responses: dict[int | str, dict[str, Any]] | None = None,
) -> APIRouter:
    """Routes with an address of their own."""
    return APIRouter(
        prefix=prefix,
        tags=list(tags),
        dependencies=dependencies,
        responses={**PROBLEM_RESPONSES, **(responses or {})},
        redirect_slashes=False,
        generate_unique_id_function=_operation,
    )


def _operation(route: APIRoute) -> str:
    """What generated clients call the operation of a route: the name of its function, which no other one has."""
    return route.name
