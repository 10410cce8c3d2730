"""What the documentation names is there: pages and their parts, options and variables, routes and problems."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from sequence_planner.cli.lazy import LazyCommand
from sequence_planner.cli.main import app
from support.places import BACKEND, DOCS, REPOSITORY

PAGES = [REPOSITORY / "README.md", *sorted((DOCS).glob("*.md"))]
SOURCES = "".join(each.read_text(encoding="utf-8") for each in (BACKEND / "src").rglob("*.py"))
# Of `docker compose`, curl, pip and the like, which stand on a line with a command of ours.
OF_OTHERS = {"--system", "--home-dir", "--pty", "--uid", "--setenv", "--url", "--require-hashes", "--no-deps"}


def options(command: Any) -> set[str]:  # noqa: ANN401 - of a class that typer does not show
    found = {each for parameter in command.params for each in parameter.opts if each.startswith("--")}
    for each in getattr(command, "commands", {}).values():
        found |= options(each.command() if isinstance(each, LazyCommand) else each)
    return found


def routes() -> dict[str, set[str]]:
    paths = json.loads((REPOSITORY / "frontend" / "openapi.json").read_text(encoding="utf-8"))["paths"]
    return {re.sub(r"\{\w+\}", "{}", path.removeprefix("/api/v1")): set(verbs) for path, verbs in paths.items()}


def headings(page: Path) -> set[str]:
    """The anchors of a page, as they are made of its headings."""
    found = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", each.lower()).replace(" ", "-") for each in found}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
        if re.match(r"https?://", target):
            continue
        path, _, anchor = target.partition("#")
        other = page.parent / path if path else page
        assert other.exists(), target
        assert not anchor or anchor in headings(other), target


def test_options_of_commands_are_known() -> None:
    known = options(get_command(app)) | {"--help", "--version"} | OF_OTHERS
    for page in PAGES:
        for line in page.read_text(encoding="utf-8").splitlines():
            if "sequence-planner " in line:
                assert set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", line)) <= known, (page.name, line)


def test_variables_are_read_somewhere() -> None:
    for page in PAGES:
        for name in re.findall(r"\bSEQUENCE_PLANNER_([A-Z_]*[A-Z])\b", page.read_text(encoding="utf-8")):
            assert name.lower() in SOURCES or f"SEQUENCE_PLANNER_{name}" in SOURCES, (page.name, name)


def test_routes_are_there() -> None:
    known, seen = routes(), 0
    for page in PAGES:
        for verb, path in re.findall(r"`(GET|POST|PUT|PATCH|DELETE) (/[^\s`?]*)", page.read_text(encoding="utf-8")):
            if path.endswith(("…", "openapi.json")):
                continue
            plain = re.sub(r"\{[^}]*\}", "x", path.removeprefix("/api/v1"))
            # A part may be told by an example, such as the number of a record.
            fits = [each for each in known if re.fullmatch(each.replace("{}", "[^/]+"), plain)]
            assert any(verb.lower() in known[each] for each in fits), (page.name, verb, path)
            seen += 1
    assert seen > 50


def test_problems_are_raised_somewhere() -> None:
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        for slug in re.findall(r"\b[45]\d\d `([a-z]+(?:-[a-z]+)+)`", text):
            assert f'"{slug}"' in SOURCES, (page.name, slug)
