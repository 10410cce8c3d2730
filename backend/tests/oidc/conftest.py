"""A station whose people sign in with a real provider. Both are started once for all tests here."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from sqlalchemy import delete

from oidc.providing import Brought, RealProvider, at_provider
from sequence_planner.auth.rate_limit import RefusalLog
from sequence_planner.auth.tables import ATTEMPTS, PEOPLE, PROVIDER_FLOWS, SESSIONS
from sequence_planner.journal.audit import read
from sequence_planner.journal.entry import Entry
from support.network import free_port
from support.server import Server, serving, settings_in

SESSION = "/api/v1/session"


@dataclass
class Scene:
    """The station and the provider."""

    server: Server
    provider: RealProvider
    begun: int

    def browser(self) -> httpx.Client:
        return httpx.Client(base_url=self.server.address, headers={"Origin": self.server.address})

    def begin(self, browser: httpx.Client, to: str = "/") -> str:
        answer = browser.post(f"{SESSION}/provider", json={"to": to})
        assert answer.status_code == 200, answer.text
        location: str = answer.json()["location"]
        return location

    def brought(self, browser: httpx.Client, login: str, to: str = "/") -> Brought:
        """What comes back to a browser that signs in at the provider."""
        with httpx.Client() as there:
            return at_provider(there, self.begin(browser, to), login)

    def finish(self, browser: httpx.Client, said: dict[str, str]) -> httpx.Response:
        return browser.post(f"{SESSION}/provider/answer", json=said)

    def sign_in(self, browser: httpx.Client, login: str, to: str = "/") -> httpx.Response:
        return self.finish(browser, self.brought(browser, login, to).said)

    def entries(self, action: str = "sign-in") -> list[Entry]:
        """What the journal says since the test began, the newest first."""
        with self.server.identity.database.reading() as connection:
            records = read(connection, action=action, limit=200)
        return [each.entry for each in records if each.number > self.begun]


@pytest.fixture(scope="session")
def standing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Server, RealProvider]]:
    folder: Path = tmp_path_factory.mktemp("station")
    settings = settings_in(folder)
    provider = RealProvider(free_port(), [f"http://127.0.0.1:{settings.port}", f"http://localhost:{settings.port}"])
    provider.start()
    with serving(replace(settings, provider=provider.settings())) as server:
        yield server, provider
    provider.stop()


@pytest.fixture
def scene(standing: tuple[Server, RealProvider]) -> Iterator[Scene]:
    """Nobody has signed in yet; the provider is as it was in the beginning."""
    server, provider = standing
    database: Any = server.identity.database
    with database.writing() as connection:
        for table in (SESSIONS, PEOPLE, ATTEMPTS, PROVIDER_FLOWS):
            connection.execute(delete(table))
    with database.reading() as connection:
        last = read(connection, limit=1)
    server.identity._memory.forget(lambda _: True)
    office = server.identity.provider
    assert office is not None
    office._limited = RefusalLog()
    provider.forget()
    yield Scene(server, provider, last[0].number if last else 0)
    server.identity.now = time.time
