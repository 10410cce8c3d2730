"""What the pages show of the command line is what the program prints."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from support.places import DOCS, REPOSITORY, SOURCES

TEXT = (DOCS / "command-line.md").read_text(encoding="utf-8")
EXPORT = (DOCS / "export.md").read_text(encoding="utf-8")
SESSION = re.compile(r"^```console\n\$ (.*)\n((?:.*\n)*?)```$", re.MULTILINE)
SESSIONS = [*SESSION.findall(TEXT), *SESSION.findall(EXPORT)]
KINDS = re.compile(r'"([a-z]+(?:-[a-z]+)+)"')


def test_there_is_something_to_try() -> None:
    assert len(SESSION.findall(TEXT)) >= 8
    assert len(SESSION.findall(EXPORT)) == 2


@pytest.mark.parametrize(("line", "printed"), SESSIONS)
def test_it_prints_what_is_shown(line: str, printed: str) -> None:
    program = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", line],
        cwd=REPOSITORY,
        env={**os.environ, "PATH": program},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.stdout == printed


def test_every_kind_of_warning_is_described() -> None:
    files = [
        *(SOURCES / "analysis" / "checks").glob("*.py"),
        SOURCES / "analysis" / "written.py",
        SOURCES / "scenarios" / "suspicions.py",
        SOURCES / "cli" / "model" / "check.py",
    ]
    kinds = {kind for file in files for kind in KINDS.findall(file.read_text(encoding="utf-8"))}
    rows = re.findall(r"^\| ((?:`[a-z-]+`(?:, )?)+) \|", TEXT, re.MULTILINE)
    described = {kind for row in rows for kind in re.findall(r"`([a-z-]+)`", row)}
    assert kinds == described - {"unreachable"}
    assert "relies-on-executing" in kinds
