"""What schemathesis finds: the server keeps to its own OpenAPI document, whoever asks and whatever is asked."""

from __future__ import annotations

import zlib
from collections.abc import Collection
from pathlib import Path

import pytest

from sequence_planner.auth.roles import Role
from support.examples import SHARE
from support.server import Server

from .fuzzing import documented, fuzz, station

EDGES = ("coverage",)  # each edge of each schema once, and methods that are none
UNREAD = {400, 405, 415}  # of requests that are refused before anybody asks who sends them
# What takes a secret, a model of the station, a person's resource, a demonstration, or what a running station makes in
# time.
NOT_GUESSED = {
    "POST /api/v1/wearables/offers",
    "GET /api/v1/history/checkpoint",
    "GET /api/v1/history/at",  # no run is recorded here
    "GET /api/v1/history/line",
    "POST /api/v1/setup",
    "POST /api/v1/session",
    "POST /api/v1/session/demonstration",
    "POST /api/v1/session/provider",
    "POST /api/v1/session/provider/answer",
    "PUT /api/v1/session/password",
    "POST /api/v1/ros/attachments",
    "POST /api/v1/wearables/pairing",
    "POST /api/v1/webhooks",  # to no host may be sent here
    "GET /api/v1/backups",  # there is no model to go with the database
    "POST /api/v1/backups",
    "GET /api/v1/storage",  # as of backups
    "POST /api/v1/storage/archive",
    "GET /api/v1/wearables/self",
    "GET /api/v1/wearables/names",
}


# It has none to edit either, and says so with 409: `test_model` and the campaign ask one that has.
OF_THE_MODEL = " /api/v1/model"
# What each may do is asked of each route by `test_access` as well.
IN_CAMPAIGNS = pytest.mark.skipif(SHARE < 1, reason="every edge of every route takes long: `make campaign` asks for it")
# This server has no model to look back with, and says so with 503; `tests/history` asks one that has.
WITHOUT_MODEL = {
    "GET /api/v1/history/{number}: Server error: ",
    "POST /api/v1/history/{number}/branch: Server error: ",
}


def roles(server: Server) -> dict[str, str]:
    """The least role of each operation, or what stands in its place."""
    paths = documented(server)["paths"]
    return {f"{verb.upper()} {path}": each["x-role"] for path, verbs in paths.items() for verb, each in verbs.items()}


def edges_of(operations: Collection[str]) -> set[str]:
    """The operations whose edges are asked for: a part of them outside campaigns, always the same one."""
    return {each for each in operations if SHARE >= 1 or zlib.crc32(each.encode()) % 6 == 0}


def test_an_administrator_finds_every_answer_as_it_is_described(tmp_path: Path) -> None:
    with station(tmp_path) as (server, _):
        operations = roles(server).keys()
        found = fuzz(server, Role.ADMINISTRATOR, examples=1, without_edges=operations - edges_of(operations))
        assert found.wrong.keys() <= WITHOUT_MODEL, found.wrong
        assert found.statuses.keys() == operations
    undone = {operation for operation, seen in found.statuses.items() if min(seen) >= 300 and "{" not in operation}
    assert {operation for operation in undone if OF_THE_MODEL not in operation} <= NOT_GUESSED


@IN_CAMPAIGNS
def test_nobody_is_let_in_but_where_everybody_may(tmp_path: Path) -> None:
    with station(tmp_path) as (server, _):
        found, least = fuzz(server, None, examples=1, phases=EDGES), roles(server)
    assert found.wrong == {}
    for operation, role in least.items():
        assert role in ("public", "beside") or found.statuses[operation].keys() <= UNREAD | {401}, operation


@IN_CAMPAIGNS
def test_a_viewer_only_looks(tmp_path: Path) -> None:
    with station(tmp_path) as (server, controller):
        found, least = fuzz(server, Role.VIEWER, examples=1, phases=EDGES), roles(server)
    assert found.wrong == {}
    for operation, role in least.items():
        allowed = UNREAD | {401, 403}
        assert role in ("public", "beside", "viewer") or found.statuses[operation].keys() <= allowed, operation
    assert controller.commands == []
