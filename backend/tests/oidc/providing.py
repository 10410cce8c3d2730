"""A real provider of OpenID Connect on the loopback, and the browser of somebody who signs in there."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from dataclasses import dataclass
from typing import Any
from urllib.parse import parse_qs, urljoin, urlsplit

import httpx
import pytest

from sequence_planner.auth.oidc.settings import ProviderSettings
from sequence_planner.auth.roles import Role
from support.places import REPOSITORY

E2E = REPOSITORY / "e2e"
SCRIPT = E2E / "station" / "provider.mjs"
CLIENT, SECRET = "station", "a secret: with + signs % and more"
PEOPLE: dict[str, dict[str, Any]] = {
    "ada": {"preferred_username": "Ada", "name": "Ada L", "groups": ["station-admins", "station-operators"]},
    "otto": {"preferred_username": "Otto", "groups": ["station-operators"]},
    "nils": {"preferred_username": "Nils", "groups": ["sales"]},
}
FORM = re.compile(r'action="([^"]+)"')


class RealProvider:
    """The process, which is told by lines what is to be other."""

    def __init__(self, port: int, stations: list[str]) -> None:
        self.port = port
        self.issuer = f"http://127.0.0.1:{port}"
        self.people = dict(PEOPLE)
        self._stations = stations
        self._process: subprocess.Popen[str] | None = None

    def settings(self, *, others: Role | None = None) -> ProviderSettings:
        return ProviderSettings(
            issuer=self.issuer,
            client=CLIENT,
            secret=SECRET,
            title="Works ID",
            roles=((Role.ADMINISTRATOR, "station-admins"), (Role.OPERATOR, "station-operators")),
            others=others,
        )

    def start(self, key: str = "first") -> None:
        """Begin, with a new key of this name."""
        self._process = subprocess.Popen(
            [node(), str(SCRIPT)],
            cwd=E2E,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        client = {"client": CLIENT, "secret": SECRET, "station": self._stations}
        assert self._said({"port": self.port, **client, "people": self.people, "key": key}) == "ready\n"

    def stop(self) -> None:
        if self._process is not None:
            self._process.communicate(timeout=10)
            self._process = None

    def tell(self, **change: object) -> None:
        assert self._said(change) == "changed\n"

    def say(self, login: str, **claims: object) -> None:
        """Claims about somebody from now on."""
        self.people[login] = {**self.people.get(login, {}), **claims}
        self.tell(people=self.people)

    def forget(self) -> None:
        """Be as in the beginning."""
        self.people = dict(PEOPLE)
        self.tell(people=self.people, forge=None)

    def _said(self, line: object) -> str:
        process = self._process
        assert process is not None
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(json.dumps(line) + "\n")
        process.stdin.flush()
        return process.stdout.readline()


def node() -> str:
    """The Node that runs the provider; the test is skipped where there is none, or no provider."""
    found = shutil.which("node")
    if found is None:
        pytest.skip("there is no node to run the provider with")
    if not (E2E / "node_modules" / "oidc-provider").exists():
        pytest.skip("oidc-provider is not installed: npm ci in e2e")
    return found


@dataclass(frozen=True)
class Brought:
    """What the provider sends back with the browser: the address of the page, and what stands in it."""

    page: str
    said: dict[str, str]


def at_provider(browser: httpx.Client, location: str, login: str) -> Brought:
    """Sign in at the provider, as a browser does, until it leads back to the station."""
    provider = urlsplit(location).netloc
    answer = browser.get(location)
    for _ in range(10):
        if answer.is_redirect:
            location = urljoin(str(answer.url), answer.headers["location"])
            if urlsplit(location).netloc != provider:
                parts = urlsplit(location)
                said = {name: values[0] for name, values in parse_qs(parts.query).items()}
                return Brought(parts._replace(query="").geturl(), said)
            answer = browser.get(location)
        else:
            form = FORM.search(answer.raise_for_status().text)
            assert form is not None, answer.text
            fields = {"prompt": "login", "login": login, "password": "any"}
            answer = browser.post(urljoin(str(answer.url), form[1]), data=fields)
    raise AssertionError("the provider does not lead back")
