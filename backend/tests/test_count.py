"""The last line of a run: a run that is not clean never looks so."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from support.places import REPOSITORY

COUNT = REPOSITORY / ".ci" / "count.py"
PASSED, FAILED, ERROR, SKIPPED = (
    "<testcase/>",
    "<testcase><failure/></testcase>",
    "<testcase><error/></testcase>",
    "<testcase><skipped/></testcase>",
)


def count(folder: Path, status: int, **reports: str) -> tuple[str, int]:
    """The last line and the exit code for reports with these test cases; one of the tests that run alone is there."""
    for suite, cases in {**reports, "pytest-heavy": PASSED}.items():
        (folder / f"{suite}.xml").write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>")
    run = subprocess.run(
        [sys.executable, str(COUNT), str(folder), str(status)], capture_output=True, text=True, check=False
    )
    return run.stdout.splitlines()[-1], run.returncode


@pytest.mark.parametrize(
    ("cases", "status", "line", "code"),
    [
        (PASSED, 0, "4 passed, 0 failed", 0),
        (PASSED + SKIPPED, 0, "4 passed, 0 failed", 0),
        (FAILED, 2, "3 passed, 1 failed", 1),
        (ERROR + FAILED, 2, "3 passed, 2 failed", 1),
        (FAILED, 0, "3 passed, 1 failed", 1),
        (PASSED, 2, "4 passed, 1 failed", 1),
        ("", 0, "3 passed, 1 failed", 1),
        ("<broken", 2, "3 passed, 1 failed", 1),
    ],
)
def test_all_suites_are_summed(tmp_path: Path, cases: str, status: int, line: str, code: int) -> None:
    assert count(tmp_path, status, pytest=PASSED, vitest=PASSED, playwright=cases) == (line, code)


def test_a_suite_that_did_not_report_failed(tmp_path: Path) -> None:
    assert count(tmp_path, 0, pytest=PASSED, vitest=PASSED) == ("3 passed, 1 failed", 1)
