"""Routes of commands and queries: each is made of what its command or query declares (`controller.commands`).

A route makes one command with its actor and waits for the controller's word. 204 means that it was done, 201 with a
document what it made; where what stops devices was done and the journal does not have it yet, 200. A refusal is a
problem whose `type` ends in the controller's own slug. A body may say why, which is recorded. The route of a query
answers with its document.
"""

from __future__ import annotations

import inspect
from collections.abc import Awaitable, Callable, Mapping
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from fastapi import Query as InQuery
from pydantic import create_model
from pydantic.fields import FieldInfo

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.auth.watches import Watch
from sequence_planner.controller.commands.command import Command, Query, Route
from sequence_planner.controller.commands.registry import COMMANDS, QUERIES
from sequence_planner.controller.commands.tasks import TaskCommand
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.data_models import DataModel
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, Body, Controller, live_view
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.middleware import CARRIED_OUT, carried_out
from sequence_planner.server.interface import interface
from sequence_planner.texts.message import message

_NOT_GIVEN = ("actor", "kind")
Declaring = type[Command] | type[Query[Any]]


def add_routes(router: APIRouter, declared: Declaring) -> None:
    """Add the routes that a command or a query declares."""
    for route in declared.routes:
        _add(router, declared, route)


def _add(router: APIRouter, declared: Declaring, route: Route) -> None:
    fields = {name: info for name, info in declared.model_fields.items() if name not in _NOT_GIVEN}
    if (reason := fields.pop("reason", None)) is not None and route.may_say_why:
        fields["reason"] = reason  # what is asked for comes first
    words = {name: route.names.get(name, name) for name in fields}
    in_path = {name for name, word in words.items() if f"{{{word}}}" in route.path}
    body = _body(declared, route, {name: each for name, each in fields.items() if name not in in_path})
    parameters = [
        inspect.Parameter(
            words[name],
            inspect.Parameter.KEYWORD_ONLY,
            annotation=_parameter_type(route, name, info, Path() if name in in_path else InQuery()),
            default=info.get_default() if not info.is_required() and name not in in_path else inspect.Parameter.empty,
        )
        for name, info in fields.items()
        if route.method == "GET" or name in in_path
    ]
    answer = declared.answer_type() if issubclass(declared, Query) else declared.makes
    may_be_early = issubclass(declared, Command) and declared.harmless is not Command.harmless
    role = Role(route.role)
    router.add_api_route(
        route.path,
        _endpoint(declared, route, words, parameters, body, may_be_early=may_be_early),
        methods=[route.method],
        status_code=204 if answer is None else 200 if issubclass(declared, Query) else 201,
        tags=[route.tag],
        description=route.text or inspect.cleandoc(declared.__doc__ or ""),
        response_model=answer,
        responses=refused(*route.refusals) | (CARRIED_OUT if may_be_early else {}),
        dependencies=[
            *([] if body is None else [JSON_ONLY]),
            allowed(role, scope=Scope.READ if role is Role.VIEWER else None, watch=route.watch),
        ],
    )


def _body(declared: Declaring, route: Route, fields: Mapping[str, FieldInfo]) -> type[Body] | None:
    """The model of the body, None where there is none. Raises `ValueError` where another body has its name."""
    if not route.body:
        return None
    given: dict[str, Any] = {
        name: (route.types[name], ...) if name in route.types else (info.annotation, info)
        for name, info in fields.items()
    }
    if route.body not in _BODIES:
        made = create_model(route.body, __base__=Body, __doc__=route.body_text, __module__=__name__, **given)
        _BODIES[route.body] = given, made
    known, body = _BODIES[route.body]
    if known is not given and (repr(known), body.__doc__) != (repr(given), route.body_text):
        raise ValueError(f"{declared.__name__} has a body called {route.body}, and another one has another such body")
    return body


def _endpoint(
    declared: Declaring,
    route: Route,
    words: Mapping[str, str],
    parameters: list[inspect.Parameter],
    body: type[Body] | None,
    *,
    may_be_early: bool,
) -> Callable[..., Awaitable[Response | DataModel | None]]:
    """The function of the route, with the parameters that FastAPI is to find."""

    async def carry_out(client: ControllerClient, **given: Any) -> Response | DataModel | None:  # noqa: ANN401
        fields = {name: given[word] for name, word in words.items() if word in given}
        if body is not None:
            fields |= {name: getattr(given["body"], name) for name in body.model_fields}
        if issubclass(declared, Query):
            answer: DataModel = await client.ask(declared(**fields))
            return answer
        told = declared(actor=given["actor"], **fields)
        if route.watch and isinstance(told, TaskCommand):
            await _check_own(given["connection"].state.watch, told, client)
        if told.makes is not None:
            return await client.produce(told)
        recorded = await client.send(told)
        return carried_out(recorded) if may_be_early else None

    types: dict[str, Any] = {} if body is None else {"body": body}
    types |= {"client": Controller}
    if not issubclass(declared, Query):
        types |= {"connection": Request, "actor": Actor}
    more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=of) for name, of in types.items()]
    carry_out.__name__ = route.operation
    carry_out.__signature__ = inspect.Signature([*parameters, *more])  # type: ignore[attr-defined]
    return carry_out


def _parameter_type(route: Route, name: str, info: FieldInfo, where: Any) -> Any:  # noqa: ANN401
    return Annotated[route.types.get(name, info.annotation), *info.metadata, where]


async def _check_own(watch: Watch | None, command: TaskCommand, client: ControllerClient) -> None:
    """Refuse what is not asked of this watch now. A watch cannot fill the journal with what is refused."""
    if watch is None:
        return
    found = (await live_view(client)).tasks.get(command.task)
    if found is None:
        raise ProblemFound(409, "task-gone", message("refused.task-gone.look"))
    if found.resource != watch.resource:
        raise ProblemFound(
            403, "not-your-task", message("refused.not-your-task.watch", watch=watch.name, resource=watch.resource)
        )
    if found.revision != command.revision:
        raise ProblemFound(409, "task-changed", message("refused.task-changed.look"))


_BODIES: dict[str, tuple[dict[str, Any], type[Body]]] = {}  # by their names, with their fields

router = interface()
for _command in COMMANDS.values():
    add_routes(router, _command)
for _query in QUERIES.values():
    add_routes(router, _query)
