"""Whoever adds a stage declares it in one place: everything that the program must know of it follows from that."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from .hysteresis import RESOURCE

Said = dict[str, object]


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> Said:
    """What the program says of the stage `hysteresis`, which it does not have."""
    folder = tmp_path_factory.mktemp("hysteresis")
    command = [sys.executable, "-m", "pipelines.hysteresis", str(folder)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    found: Said = json.loads(done.stdout.splitlines()[-1])
    return found


def test_it_is_read_from_a_file_and_runs(said: Said) -> None:
    assert said["levels"] == [5, 5, 5, 8, 8, 5, 5]
    assert said["is_timed"] is False


def test_what_is_wrong_with_it_is_said_at_its_place(said: Said) -> None:
    assert said["wrong"] == [
        ["6:29: `/tank` → stage 1 `hysteresis`: `name` must be a number, and is text"],
        ["6:43: expected a number greater than 0, found `0`"],
        ["6:9: `width` is missing here", "6:36: `widht` is not known here; did you mean `width`?"],
        ["6:29: `/tank` → stage 1 `hysteresis`: there is no field `levle` here; did you mean `level`?"],
    ]


def test_a_variable_that_it_names_is_renamed_in_it(said: Said) -> None:
    stage = "      - hysteresis: {field: level, width: 2}"
    new = RESOURCE.replace(stage, "      - rename:\n          level: height\n" + stage.replace("level", "height"))
    assert said["renamed"] == {"resources/tank.yaml": new}


def test_it_is_suggested_where_there_is_a_number(said: Said) -> None:
    assert json.dumps(said["offered"]) == '[[{"hysteresis": {"field": "level", "width": 0.1}}, null]]'


def test_editors_know_its_form(said: Said) -> None:
    assert said["schema"] == {
        "type": "object",
        "title": "Hysteresis",
        "description": "A number goes on when it has moved by more than `width`; until then the old one does.",
        "properties": {
            "field": {"type": "string", "description": "The number."},
            "width": {"type": "number", "exclusiveMinimum": 0, "description": "How far it must have moved."},
        },
        "required": ["field", "width"],
        "additionalProperties": False,
    }
