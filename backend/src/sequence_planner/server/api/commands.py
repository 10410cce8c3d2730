"""Routes of commands: each is made of what its command declares (`controller.commands`).

A route makes one command with its actor and waits for the controller's word. 204 means that it was done; where what
stops devices was done and the journal does not have it yet, 200. A refusal is a problem whose `type` ends in the
controller's own slug. A body may say why, which is recorded.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Awaitable, Callable, Mapping
from typing import Annotated, Any

from fastapi import APIRouter, Path, Request, Response
from pydantic import create_model
from pydantic.fields import FieldInfo

from sequence_planner.auth.roles import Role
from sequence_planner.auth.watches import Watch
from sequence_planner.controller.commands.command import Command, Route
from sequence_planner.controller.commands.registry import COMMANDS
from sequence_planner.controller.commands.tasks import TaskCommand
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.actor import Actor as Acting
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, Body, Controller, live_view
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.http.middleware import CARRIED_OUT, carried_out
from sequence_planner.server.interface import interface

_NOT_GIVEN = ("actor", "kind")


def add_routes(router: APIRouter, command: type[Command]) -> None:
    """Add the routes that a command declares."""
    for route in command.routes:
        _add(router, command, route)


def _add(router: APIRouter, command: type[Command], route: Route) -> None:
    fields = {name: info for name, info in command.model_fields.items() if name not in _NOT_GIVEN}
    reason = fields.pop("reason")  # what is asked for comes first
    fields |= {"reason": reason} if route.may_say_why else {}
    named = {route.names.get(name, name): name for name in fields}
    in_path = {word: named[word] for word in re.findall(r"{(\w+)}", route.path)}
    body = _body(command, route, {name: each for name, each in fields.items() if name not in in_path.values()})
    may_be_early = command.harmless is not Command.harmless
    router.add_api_route(
        route.path,
        _endpoint(command, route, in_path, body, may_be_early=may_be_early),
        methods=[route.method],
        status_code=204,
        tags=[route.tag],
        description=route.text or inspect.cleandoc(command.__doc__ or ""),
        response_model=None,
        responses=refused(*route.refusals) | (CARRIED_OUT if may_be_early else {}),
        dependencies=[*([] if body is None else [JSON_ONLY]), allowed(Role(route.role), watch=route.watch)],
    )


def _body(command: type[Command], route: Route, fields: Mapping[str, FieldInfo]) -> type[Body] | None:
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
        raise ValueError(f"{command.__name__} has a body called {route.body}, and another command has another one")
    return body


def _endpoint(
    command: type[Command], route: Route, in_path: Mapping[str, str], body: type[Body] | None, *, may_be_early: bool
) -> Callable[..., Awaitable[Response | None]]:
    """The function of the route, with the parameters that FastAPI is to find."""

    async def give(connection: Request, client: ControllerClient, actor: Acting, **given: Any) -> Response | None:  # noqa: ANN401
        fields = {name: given[word] for word, name in in_path.items()}
        if body is not None:
            fields |= {name: getattr(given["body"], name) for name in body.model_fields}
        told = command(actor=actor, **fields)
        if route.watch and isinstance(told, TaskCommand):
            await _check_own(connection.state.watch, told, client)
        recorded = await client.send(told)
        return carried_out(recorded) if may_be_early else None

    types: dict[str, Any] = {word: _path_type(command.model_fields[name]) for word, name in in_path.items()}
    types |= {} if body is None else {"body": body}
    types |= {"connection": Request, "client": Controller, "actor": Actor}
    parameters = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, annotation=of) for name, of in types.items()]
    give.__name__ = route.operation
    give.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
    return give


def _path_type(info: FieldInfo) -> Any:  # noqa: ANN401
    return Annotated[info.annotation, *info.metadata, Path()]


async def _check_own(watch: Watch | None, command: TaskCommand, client: ControllerClient) -> None:
    """Refuse what is not asked of this watch now. A watch cannot fill the journal with what is refused."""
    if watch is None:
        return
    found = (await live_view(client)).tasks.get(command.task)
    if found is None:
        raise ProblemFound(409, "task-gone", "The task is gone", "Look at what is asked for now.")
    if found.resource != watch.resource:
        detail = f"{watch.name} is for the tasks of {watch.resource}, and this is none of them."
        raise ProblemFound(403, "not-your-task", "The task is somebody else's", detail)
    if found.revision != command.revision:
        raise ProblemFound(409, "task-changed", "The task has changed", "Look at what is asked for now.")


_BODIES: dict[str, tuple[dict[str, Any], type[Body]]] = {}  # by their names, with their fields

router = interface()
for _command in COMMANDS.values():
    add_routes(router, _command)
