"""What a command or a query declares in one place are its route and role, and of a command control and record."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Annotated, Any, Literal

import httpx
import pytest
from pydantic import Field

from sequence_planner.auth.roles import Role
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.audit import CommandAudit
from sequence_planner.controller.commands.bus import CommandBus, QueryBus
from sequence_planner.controller.commands.command import Command, CommandRefused, Query, Route, Why, answers, handles
from sequence_planner.controller.commands.execution import ReleaseControl, TakeControl, WithdrawControl
from sequence_planner.controller.commands.registry import COMMANDS, QUERIES
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.ipc import ControllerLink
from sequence_planner.controller.views.part import View
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.db.database import Database
from sequence_planner.journal.audit import read
from sequence_planner.journal.entry import Entry, Outcome
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.server.api.declared import add_routes
from sequence_planner.server.interface import interface
from sequence_planner.server.settings import Settings
from support.cell import IDENTITY, cell
from support.databases import journal
from support.server import Controller, Loop, Server


class SetLamp(Command):
    """Light a lamp. It takes control."""

    routes = (
        Route(
            "PUT",
            "/lamps/{lamp}",
            "set_lamp",
            tag="modes",
            body="LampBody",
            body_text="How bright it is to be, and why.",
            role="engineer",
        ),
    )
    kind: Literal["set-lamp"] = "set-lamp"
    for_control = True
    about = "lamp {lamp}"
    reason: Why
    lamp: Annotated[str, Field(max_length=20)]
    brightness: Annotated[int, Field(ge=0, le=9)]


class LampView(View):
    """A lamp as it is."""

    brightness: int
    together: int


class AskLamp(Query[LampView]):
    """How bright a lamp is, and how bright as many of them would be."""

    routes = (
        Route(
            "GET", "/lamps/{lamp}", "lamp", tag="modes", role="viewer", refusals=(404, 504), names={"number": "times"}
        ),
    )
    kind: Literal["ask-lamp"] = "ask-lamp"
    lamp: Annotated[str, Field(max_length=20)]
    number: Annotated[int, Field(ge=1, le=3)] = 2


class Lamps:
    """Those of a hall."""

    def __init__(self) -> None:
        self.brightness = {"door": 0}

    @handles(SetLamp)
    def set(self, command: SetLamp, moment: Timestamp) -> None:
        """Light it."""
        if command.lamp not in self.brightness:
            raise CommandRefused("no-lamp", f"There is no `{command.lamp}`.", 404, title="There is no such lamp")
        self.brightness[command.lamp] = command.brightness

    @answers(AskLamp)
    async def ask(self, query: AskLamp) -> LampView:
        """Look at it."""
        if query.lamp not in self.brightness:
            raise CommandRefused("no-lamp", f"There is no `{query.lamp}`.", 404, title="There is no such lamp")
        brightness = self.brightness[query.lamp]
        return LampView(brightness=brightness, together=query.number * brightness)


class Hall(Controller):
    """A controller with lamps, which records commands in a database and carries them out."""

    def __init__(self, loop: Loop, settings: Settings, database: Database) -> None:
        super().__init__(loop, settings.controller_socket)
        self.lamps, self.lock = Lamps(), ControlLock()
        self.audit = CommandAudit(database, lambda why: None)
        self.bus = CommandBus(
            (self.lamps, self.lock),
            (SetLamp, TakeControl, ReleaseControl, WithdrawControl),
            in_control=self.lock,
            require_one=lambda names: None,
            real_devices=list,
        )

        self.queries = QueryBus((self.lamps,), (AskLamp,))
        self.link = ControllerLink(settings.controller_socket, self.handle, self.queries.answer)

    async def handle(self, command: Command) -> None:
        async def act(command: Command) -> None:
            self.bus.execute(command, Timestamp.now())

        await self.audit.carry_out(command, dict, act)


@pytest.fixture
def database() -> Iterator[Database]:
    with journal() as database:
        yield database


@pytest.fixture
def controller(
    loop: Loop, settings: Settings, database: Database, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Controller]:
    monkeypatch.setitem(COMMANDS, "set-lamp", SetLamp)
    monkeypatch.setitem(QUERIES, "ask-lamp", AskLamp)
    controller = Hall(loop, settings, database)
    controller.start()
    yield controller
    controller.stop()
    loop.run(controller.audit.close())


@pytest.fixture
def lit(server: Server) -> Server:
    """The server, with the routes of the command and of the query."""
    router = interface()
    add_routes(router, SetLamp)
    add_routes(router, AskLamp)
    server.app.router.routes.extend(router.routes)
    return server


def light(client: httpx.Client, lamp: str = "door", **body: Any) -> httpx.Response:  # noqa: ANN401
    return client.put(f"/api/v1/lamps/{lamp}", json={"brightness": 7, "reason": "it is dark", **body})


def entries(database: Database) -> list[Entry]:
    """What is recorded, in order."""
    with database.reading() as connection:
        return [each.entry for each in read(connection)[::-1]]


def test_its_fields_are_those_of_the_route(lit: Server) -> None:
    operation = lit.app.openapi()["paths"]["/api/v1/lamps/{lamp}"]["put"]
    assert (operation["operationId"], operation["x-role"]) == ("set_lamp", "engineer")
    assert operation["description"] == "Light a lamp. It takes control."
    body = lit.app.openapi()["components"]["schemas"]["LampBody"]
    assert body["required"] == ["brightness", "reason"]
    assert body["properties"]["brightness"]["maximum"] == 9
    with lit.client(Role.ENGINEER) as engineer:
        assert light(engineer, brightness=10).json()["errors"][0]["field"] == "body.brightness"
        assert light(engineer, lamp="x" * 21).json()["errors"][0]["field"] == "path.lamp"
        assert light(engineer, reason=None).status_code == 422
        assert light(engineer, colour="red").json()["errors"][0]["field"] == "body.colour"


def test_its_role_and_who_is_in_control_decide_and_what_became_of_it_is_recorded(
    lit: Server, controller: Hall, database: Database
) -> None:
    with lit.client() as nobody, lit.client(Role.OPERATOR) as operator:
        assert (light(nobody).status_code, light(operator).status_code) == (401, 403)
    token, signed_in = lit.session(person := lit.person(Role.ENGINEER))
    with lit.client(token=token) as engineer:
        assert entries(database) == [], "whoever may not is not recorded"
        assert light(engineer).json()["type"] == "/problems/control-needed"
        actor = Actor(kind=ActorKind.PERSON, id=person.id, name=person.name, session=signed_in.session)
        controller.bus.execute(TakeControl(actor=actor, over=None), Timestamp.now())
        assert controller.lamps.brightness == {"door": 0}
        assert light(engineer).status_code == 204
        assert controller.lamps.brightness == {"door": 7}
        assert light(engineer, lamp="gate").json()["type"] == "/problems/no-lamp"
    assert [(each.subject, each.outcome, each.details.get("because")) for each in entries(database)] == [
        ("lamp door", Outcome.REQUESTED, None),
        ("lamp door", Outcome.REFUSED, "control-needed"),
        ("lamp door", Outcome.REQUESTED, None),
        ("lamp door", Outcome.DONE, None),
        ("lamp gate", Outcome.REQUESTED, None),
        ("lamp gate", Outcome.REFUSED, "no-lamp"),
    ]
    done = entries(database)[3]
    assert (done.actor.name, done.action, done.reason) == (person.name, "set-lamp", "it is dark")
    assert done.details == {"lamp": "door", "brightness": 7}


def test_a_query_is_asked_by_its_route_and_answered_with_its_document(lit: Server, controller: Hall) -> None:
    operation = lit.app.openapi()["paths"]["/api/v1/lamps/{lamp}"]["get"]
    assert (operation["operationId"], operation["x-role"]) == ("lamp", "viewer")
    answer = operation["responses"]["200"]["content"]["application/json"]["schema"]
    assert answer == {"$ref": "#/components/schemas/LampView"}
    asked = [(each["name"], each["in"], each["required"]) for each in operation["parameters"]]
    assert asked == [("lamp", "path", True), ("times", "query", False)]
    controller.lamps.brightness["door"] = 4
    with lit.client() as nobody, lit.client(Role.VIEWER) as viewer:
        assert nobody.get("/api/v1/lamps/door").status_code == 401
        assert viewer.get("/api/v1/lamps/door").json() == {"brightness": 4, "together": 8}
        assert viewer.get("/api/v1/lamps/door?times=3").json() == {"brightness": 4, "together": 12}
        assert viewer.get("/api/v1/lamps/door?times=4").json()["errors"][0]["field"] == "query.times"
        gone = viewer.get("/api/v1/lamps/gate")
        assert (gone.status_code, gone.json()["type"]) == (404, "/problems/no-lamp")


def test_a_command_that_nobody_handles_or_two_do_is_found_when_the_controller_is_built(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(COMMANDS, "set-lamp", SetLamp)
    station, supervisor = cell()

    async def built() -> None:
        transport = MemoryNetwork().join(station.registry, "sequence_planner", asyncio.get_running_loop())
        with journal() as database:
            build_controller(IDENTITY, station, supervisor, transport, database)

    with pytest.raises(ValueError, match="no feature handles SetLamp"):
        asyncio.run(built())
    lock = ControlLock()
    with pytest.raises(ValueError, match="SetLamp is handled twice"):
        CommandBus((Lamps(), Lamps(), lock), (), in_control=lock, require_one=lambda names: None, real_devices=list)
    with pytest.raises(ValueError, match="no feature handles AskLamp"):
        QueryBus((lock,), (AskLamp,))
