"""Every refusal is a problem document (RFC 9457): the same members, a stable `type`, and words for a person.

`type` is a reference below `/problems/`, by which a client decides: a new name of one goes into CHANGELOG.md. `detail`
is for reading. A document never shows a stack trace: what went wrong inside is written in the server's log.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from http import HTTPStatus
from typing import Any

import structlog
from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from fastapi.routing import iter_route_contexts
from pydantic import BaseModel, JsonValue
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Receive, Scope, Send
from starlette.types import Message as Event

from sequence_planner.auth.roles import IdentityRefused
from sequence_planner.controller.commands.command import CommandRefused, TextPlace
from sequence_planner.core.storage_error import StorageError
from sequence_planner.editor.processes import BodyError
from sequence_planner.mes.order import OrderCommand, OrderRefused
from sequence_planner.model.validation import members
from sequence_planner.process.task import WorkerError
from sequence_planner.texts.message import Message, as_it_was, message
from sequence_planner.texts.refused import Refused

LOG = structlog.get_logger(__name__)
MEDIA_TYPE = "application/problem+json"

SLUGS = {
    400: "bad-request",
    404: "not-found",
    405: "method-not-allowed",
    413: "body-too-large",
    500: "internal-error",
}
# What FastAPI says of a body that Python's parser of JSON gives up.
UNREAD = "There was an error parsing the body"
UNREADABLE = message("refused.bad-request.unreadable")
TITLES = {status: message(f"refused.{SLUGS[status]}") for status in (400, 404, 405)}
DETAILS = {404: message("refused.not-found.address"), 405: message("refused.method-not-allowed.allow")}


def refused(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Declares in the `responses` of a route with which status it may refuse, beside what concerns all routes."""
    return {status: {"description": "A problem"} for status in statuses}


class FieldError(BaseModel):
    """One place in a request that is not as it must be, e.g. `body.mode`, and what was expected there."""

    field: str
    expected: str


class Problem(BaseModel):
    """Why a request was refused.

    `errors` is empty unless `type` is `/problems/invalid-request`, `place` null unless it is `/problems/bad-predicate`.
    `allowed` are the commands that a job order does allow where `type` is `/problems/command-not-allowed`. The messages
    are `title` and `detail` for readers of other languages.
    """

    type: str
    title: str
    title_message: Message
    status: int
    detail: str
    detail_message: Message
    errors: list[FieldError]
    place: TextPlace | None
    allowed: list[OrderCommand]


class ProblemFound(Refused, HTTPException):
    """Raised anywhere in a request to answer it with a problem. FastAPI lets pass what is an `HTTPException`."""

    detail: Message

    def __init__(
        self,
        status: int,
        slug: str,
        detail: str,
        headers: Mapping[str, str] | None = None,
        errors: Sequence[FieldError] = (),
        *,
        title: str | None = None,
    ) -> None:
        HTTPException.__init__(self, status, detail, headers)
        Refused.__init__(self, slug, detail, status, title=title)
        self.errors = errors


def problem_response(
    status: int,
    slug: str,
    title: str,
    detail: str,
    *,
    errors: Sequence[FieldError] = (),
    place: TextPlace | None = None,
    allowed: Sequence[OrderCommand] = (),
    headers: Mapping[str, str] | None = None,
    more: Mapping[str, JsonValue] | None = None,
) -> Response:
    """The answer that carries a problem, with `more` members beside those of all problems (RFC 9457, section 3.2)."""
    problem = Problem(
        type=f"/problems/{slug}",
        title=title,
        title_message=as_it_was(title),
        status=status,
        detail=detail,
        detail_message=as_it_was(detail),
        errors=list(errors),
        place=place,
        allowed=list(allowed),
    )
    # In ASCII: a name that came with the request may hold what UTF-8 cannot write, such as half a surrogate pair.
    body = json.dumps({**(more or {}), **problem.model_dump()}, ensure_ascii=True)
    kept = {"Cache-Control": "no-store", **(headers or {})}
    return Response(body, status_code=status, media_type=MEDIA_TYPE, headers=kept)


def install(app: FastAPI) -> None:
    """Let `app` answer every refusal and every failure with a problem."""
    app.add_exception_handler(HTTPException, _http)
    app.add_exception_handler(RequestValidationError, _invalid)
    app.add_exception_handler(Refused, _refused)
    app.add_exception_handler(StorageError, _storage_unavailable)
    app.add_exception_handler(BodyError, _unexpected)
    app.add_exception_handler(WorkerError, _work_ended)


async def _http(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    status = error.status_code
    title = TITLES.get(status) or HTTPStatus(status).phrase
    detail = DETAILS.get(status) or (UNREADABLE if error.detail == UNREAD else str(error.detail))
    headers = dict(error.headers or {})
    if status == 405 and (methods := _methods(request)):
        headers["Allow"] = ", ".join(sorted(methods))
    return problem_response(status, SLUGS.get(status, "refused"), title, detail, headers=headers)


def _methods(request: Request) -> set[str]:
    """The methods of all routes of the address: without this, only those of the first of them are named."""
    found: dict[str, set[str]] = {}
    for route in iter_route_contexts(request.app.routes):
        if route.methods and route.path is not None and route.path_regex.match(request.scope["path"]):
            found.setdefault(route.path, set()).update(route.methods)
    return found[min(found, key=lambda path: path.count("{"))] if found else set()


async def _invalid(request: Request, error: Exception) -> Response:
    assert isinstance(error, RequestValidationError)
    found = error.errors()
    if any(each["type"] == "json_invalid" for each in found):
        return _not_json(f"{found[0]['ctx']['error']} at character {found[0]['loc'][-1]}")
    body = getattr(request.scope.get("route"), "body_field", None)
    return _not_as_expected(members(found, None if body is None else body.field_info.annotation))


async def _unexpected(request: Request, error: Exception) -> Response:
    assert isinstance(error, BodyError)
    return _not_json(error.not_json) if error.not_json else _not_as_expected(error.wrong)


def _not_json(why: str) -> Response:
    return refusal_response(ProblemFound(400, "malformed-json", message("refused.malformed-json.why", why=why)))


def _not_as_expected(wrong: Iterable[tuple[str, str]]) -> Response:
    errors = [FieldError(field=place, expected=what) for place, what in wrong]
    detail = "; ".join(f"{each.field}: {each.expected}" for each in errors[:5])
    return refusal_response(ProblemFound(422, "invalid-request", detail, errors=errors))


async def _work_ended(request: Request, error: Exception) -> Response:
    assert isinstance(error, WorkerError)
    end = "" if error.why.endswith("?") else "."
    return refusal_response(
        ProblemFound(503, "worker-failed", message("refused.worker-failed.again", why=error.why, end=end))
    )


async def _refused(request: Request, error: Exception) -> Response:
    assert isinstance(error, Refused)
    return refusal_response(error)


def refusal_response(refused: Refused) -> Response:
    """The answer to what is not done."""
    headers: Mapping[str, str] | None = None
    if isinstance(refused, ProblemFound):
        headers = refused.headers
    elif isinstance(refused, IdentityRefused):
        headers = _identity_headers(refused)
    return problem_response(
        refused.status,
        refused.slug,
        refused.title,
        refused.detail,
        errors=refused.errors if isinstance(refused, ProblemFound) else (),
        place=refused.place if isinstance(refused, CommandRefused) else None,
        allowed=refused.allowed if isinstance(refused, OrderRefused) else (),
        headers=headers,
    )


def _identity_headers(refused: IdentityRefused) -> dict[str, str]:
    headers = {} if refused.retry_after is None else {"Retry-After": str(refused.retry_after)}
    if refused.status == 401:
        headers["WWW-Authenticate"] = "Bearer"  # RFC 9110 wants a challenge; this one makes no browser ask by itself
    return headers


async def _storage_unavailable(request: Request, error: Exception) -> Response:
    LOG.error("the database is not available", says=str(error))  # it names the place: not for who asks
    return refusal_response(ProblemFound(503, "storage-unavailable", message("refused.storage-unavailable.again")))


class ErrorMiddleware:
    """Answers with a problem when something inside failed, and writes the error to the log."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve one request."""
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        started = False

        async def watch(event: Event) -> None:
            nonlocal started
            started = started or event["type"] == "http.response.start"
            await send(event)

        try:
            await self.app(scope, receive, watch)
        except Exception:
            LOG.exception("a request failed", path=scope["path"])
            if started:
                raise  # too late for another answer: the connection is cut
            response = refusal_response(ProblemFound(500, SLUGS[500], message("refused.internal-error.log")))
            await response(scope, receive, send)
