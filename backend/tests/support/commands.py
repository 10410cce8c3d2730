"""Commands as a person gives them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from typer.testing import CliRunner

from sequence_planner.cli.main import app

PLAIN = """
{"name": "two-users", "variables": {"user": ["idle", "waits", "has"], "free": "bool"},
 "initial": "user == idle and free",
 "transitions": [
   {"event": "ask", "controllable": false, "guard": "user == idle", "set": {"user": "waits"}},
   {"event": "grab", "controllable": true, "guard": "user == waits and free", "set": {"user": "has", "free": false}},
   {"event": "drop", "controllable": true, "guard": "user == has", "set": {"user": "idle", "free": true}}],
 "forbidden": ["user == has and free"], "marked": "user == idle"}
"""


def command(*arguments: object, given: str | None = None) -> tuple[int, str, str]:
    """The exit code, standard output and standard error."""
    result = CliRunner().invoke(app, [str(argument) for argument in arguments], input=given)
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.exit_code, result.stdout, result.stderr


def as_json(*arguments: object, given: str | None = None) -> tuple[int, Any]:
    """The exit code and the document of a command with `--json`, which says nothing on standard error."""
    code, out, err = command(*arguments, "--json", given=given)
    assert err == ""
    return code, json.loads(out)


def plain(folder: Path) -> Path:
    file = folder / "two_users.efa.json"
    file.write_text(PLAIN, encoding="utf-8")
    return file
