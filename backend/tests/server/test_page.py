"""The files of the built page, and what is shown when there is none."""

from __future__ import annotations

import httpx
import pytest

from support.server import Server

from .test_acting import problem


@pytest.fixture
def built(server: Server) -> Server:
    """A server with a page as SvelteKit's static adapter lays it out."""
    page = server.settings.page
    (page / "_app" / "immutable").mkdir(parents=True)
    (page / "index.html").write_text("<title>Operate</title>")
    (page / "operator.html").write_text("<title>Operator view</title>")
    (page / "theme.js").write_text("1")
    (page / "_app" / "immutable" / "start.abc.js").write_text("2")
    (page.parent / "secret.html").write_text("not for you")
    return server


def test_without_a_build_the_page_says_how_to_make_one(client: httpx.Client) -> None:
    for path in ("/", "/operator"):
        answer = client.get(path)
        assert answer.status_code == 503
        assert "make run" in answer.text


def test_each_page_has_its_address(built: Server, client: httpx.Client) -> None:
    assert "Operate" in client.get("/").text
    assert "Operator view" in client.get("/operator").text
    assert client.get("/operator").headers["content-type"].startswith("text/html")
    assert client.head("/").status_code == 200


def test_only_what_carries_a_hash_in_its_name_is_kept(built: Server, client: httpx.Client) -> None:
    assert "immutable" in client.get("/_app/immutable/start.abc.js").headers["cache-control"]
    for path in ("/", "/operator", "/theme.js"):
        assert client.get(path).headers["cache-control"] == "no-cache"
    assert client.get("/_app/immutable/old.js").headers["cache-control"] == "no-store"


def test_a_file_that_did_not_change_is_not_sent_again(built: Server, client: httpx.Client) -> None:
    etag = client.get("/theme.js").headers["etag"]
    assert client.get("/theme.js", headers={"If-None-Match": etag}).status_code == 304


@pytest.mark.parametrize(
    ("accepted", "coding"),
    [
        ("gzip, deflate, br, zstd", "br"),
        ("gzip", "gzip"),
        ("br;q=0, gzip;q=0.5", "gzip"),
        ("BR; q=0.1", "br"),
        ("identity", None),
        ("", None),
    ],
)
def test_what_the_build_has_compressed_is_sent_so_to_whoever_takes_it(
    built: Server, client: httpx.Client, accepted: str, coding: str | None
) -> None:
    script = built.settings.page / "_app" / "immutable" / "start.abc.js"
    for suffix in (".br", ".gz"):
        script.with_name(script.name + suffix).write_bytes(suffix.encode())
    with client.stream("GET", "/_app/immutable/start.abc.js", headers={"Accept-Encoding": accepted}) as answer:
        sent = b"".join(answer.iter_raw())
    assert sent == {"br": b".br", "gzip": b".gz", None: b"2"}[coding]
    assert answer.headers.get("content-encoding") == coding
    assert answer.headers["content-type"].startswith("text/javascript")
    assert answer.headers["vary"] == "Accept-Encoding"
    assert "immutable" in answer.headers["cache-control"]


def test_what_is_not_compressed_is_sent_as_it_is(built: Server, client: httpx.Client) -> None:
    assert "content-encoding" not in client.get("/theme.js", headers={"Accept-Encoding": "br, gzip"}).headers


@pytest.mark.parametrize("path", ["/nothing", "/secret.html", "/..%2fsecret.html", "/%2e%2e/secret", "/_app", "/a%00b"])
def test_nothing_else_is_served(built: Server, client: httpx.Client, path: str) -> None:
    problem(client.get(path), 404, "not-found")


def test_a_name_that_no_file_can_have_is_not_found(built: Server, client: httpx.Client) -> None:
    for path in ("/" + "a" * 300, "/a" * 3000):
        problem(client.get(path), 404, "not-found")


def test_a_page_cannot_be_written(built: Server, client: httpx.Client) -> None:
    answer = client.post("/operator", json={})
    problem(answer, 405, "method-not-allowed")
    assert answer.headers["allow"] == "GET, HEAD"
