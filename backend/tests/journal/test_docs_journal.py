"""What docs/journal.md shows is what works."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from journal.acts import EVA
from journal.happened import happened
from sequence_planner.db.database import Database
from sequence_planner.journal import run_journal
from sequence_planner.journal.retention import trim
from support.commands import command
from support.places import DOCS

TEXT = (DOCS / "journal.md").read_text(encoding="utf-8")


def _program(name: str, given: str, *arguments: str) -> tuple[int, str, str]:
    [block] = re.findall(rf"^```python {name}\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
    program = [sys.executable, "-c", block, *arguments]
    done = subprocess.run(program, input=given, capture_output=True, encoding="utf-8", check=False, timeout=60)
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def sqlite(tmp_path: Path) -> Iterator[Database]:
    database = Database.open(f"sqlite:///{tmp_path}/press/station.sqlite")
    database.upgrade()
    happened(database, range(1, 26))
    yield database
    database.close()


def _journal(sqlite: Database, *arguments: object) -> str:
    code, out, err = command("journal", *arguments, "--database", f"sqlite:///{sqlite.place}")
    assert (code, err) == (0, "")
    return out


def test_the_program_that_verifies_an_export(sqlite: Database) -> None:
    lines = _journal(sqlite, "export")
    with sqlite.reading() as connection:
        end = run_journal.end(connection)
    assert end is not None
    assert _program("verify.py", lines) == (0, f"{end.hash}\n", "")
    assert _program("verify.py", lines.replace('"torque": 1.0', '"torque": 2.0', 1))[0] == 1
    assert _program("verify.py", "".join(lines.splitlines(keepends=True)[1:]))[0] == 1
    trim(sqlite, 21.0, EVA)
    [before] = re.findall(r"records 20 to 25 behind the hash (\w+),", _journal(sqlite, "--verify"))
    assert _program("verify.py", _journal(sqlite, "export"), before) == (0, f"{end.hash}\n", "")
    assert _program("verify.py", _journal(sqlite, "export"))[0] == 1


def test_the_program_that_verifies_a_checkpoint(sqlite: Database) -> None:
    kept = _journal(sqlite, "checkpoint")
    assert _program("signed.py", kept) == (0, "25\n", "")
    code, _, err = _program("signed.py", kept.replace("25", "24", 1))
    assert code == 1
    assert "InvalidSignature" in err
