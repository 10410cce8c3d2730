"""What a browser is told about every answer, and about the documents of the build besides."""

from __future__ import annotations

import asyncio
import dataclasses
from pathlib import Path

import httpx
import pytest

from sequence_planner.server.http.middleware import document_policy
from sequence_planner.server.http.page_files import PageFiles
from support.server import Server

HASH = "'sha256-pODQO96uX/EpWyr2+2ROQmWa44F+aFLu14EKEhc5T/0='"
DOCUMENT = (
    f'<!doctype html><meta http-equiv="content-security-policy" content="default-src \'self\'; '
    f"style-src-attr 'unsafe-hashes' 'sha256-S8=='; frame-ancestors *; connect-src *; style-src 'self' 'sha256-T9=='; "
    f"script-src 'self' {HASH}\">"
)


def rules(policy: str) -> dict[str, str]:
    return dict(each.partition(" ")[::2] for each in policy.split("; "))


@pytest.mark.parametrize("path", ["/", "/healthz", "/api/v1/station", "/api/v1/nothing"])
def test_nothing_is_loaded_run_or_framed_that_is_not_ours(client: httpx.Client, path: str) -> None:
    headers = client.get(path).headers
    policy = rules(headers["content-security-policy"])
    assert policy["default-src"] == policy["script-src"] == policy["connect-src"] == "'self'"
    assert policy["frame-ancestors"] == policy["object-src"] == policy["frame-src"] == "'none'"
    assert "camera=()" in headers["permissions-policy"]
    assert "screen-wake-lock=(self)" in headers["permissions-policy"]
    assert "vibrate" not in headers["permissions-policy"]
    assert "strict-transport-security" not in headers  # plain HTTP on the loopback
    if path != "/":
        assert headers["cache-control"] == "no-store"


def test_a_document_of_the_build_may_run_its_own_scripts_and_no_more(server: Server, client: httpx.Client) -> None:
    (server.settings.page / "index.html").write_text(DOCUMENT)
    (server.settings.page / "theme.js").write_text("1")
    first = client.get("/")
    policy = rules(first.headers["content-security-policy"])
    assert policy["script-src"] == f"'self' {HASH}"
    assert policy["style-src"] == "'self' 'sha256-T9=='"
    assert policy["style-src-attr"] == "'unsafe-hashes' 'sha256-S8=='"
    assert (policy["connect-src"], policy["frame-ancestors"]) == ("'self'", "'none'")
    again = client.get("/", headers={"If-None-Match": first.headers["etag"]})
    assert again.status_code == 304
    assert again.headers["content-security-policy"] == first.headers["content-security-policy"]
    assert HASH not in client.get("/theme.js").headers["content-security-policy"]


def test_who_reads_pages_is_told_by_a_page_that_an_address_leads_nowhere(server: Server, client: httpx.Client) -> None:
    (server.settings.page / "index.html").write_text(DOCUMENT)
    (server.settings.page / "404.html").write_text(DOCUMENT)
    typed = client.get("/operate", headers={"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"})
    assert (typed.status_code, typed.text, typed.headers["cache-control"]) == (404, DOCUMENT, "no-cache")
    assert HASH in typed.headers["content-security-policy"]
    asked = client.get("/operate", headers={"Accept": "*/*"})
    assert (asked.status_code, asked.headers["content-type"]) == (404, "application/problem+json")


def test_a_document_without_a_policy_of_its_own_gets_ours(tmp_path: Path) -> None:
    document = tmp_path / "index.html"
    document.write_text("<!doctype html>")
    assert rules(document_policy(document))["script-src"] == "'self'"


def test_a_wall_stands_in_one_page_with_those_of_the_stations_that_are_named(tmp_path: Path) -> None:
    document = tmp_path / "wall.html"
    document.write_text(DOCUMENT)
    policy = rules(document_policy(document, ("https://press.example", "https://weld.example:8443")))
    assert policy["frame-src"] == policy["frame-ancestors"] == "'self' https://press.example https://weld.example:8443"
    alone = rules(document_policy(document))
    assert {name: rule for name, rule in policy.items() if rule != alone[name]}.keys() == {
        "frame-src",
        "frame-ancestors",
    }


@pytest.mark.parametrize("path, framed", [("/wall", True), ("/", False), ("/state", False)])
def test_no_page_but_the_wall_stands_within_another(server: Server, path: str, framed: bool) -> None:
    page = server.settings.page
    for name in ("index", "wall", "state"):
        (page / f"{name}.html").write_text(DOCUMENT)
    beside = dataclasses.replace(server.settings, wall_beside=("HTTPS://Press.example:443/",)).beside

    async def ask() -> httpx.Response:
        files = httpx.ASGITransport(PageFiles(page, beside))
        async with httpx.AsyncClient(transport=files, base_url=server.settings.address) as client:
            return await client.get(path)

    ancestors = rules(asyncio.run(ask()).headers["content-security-policy"])["frame-ancestors"]
    assert ancestors == ("'self' https://press.example" if framed else "'none'")
