"""Counts the tests of all suites from the JUnit reports that they wrote: `count.py FOLDER STATUS`.

`STATUS` is the exit code of `make test`. The last line printed is `N passed, N failed`. A suite that wrote no report,
or ran no test, counts as one failure. So does a run that failed although every test passed: then a check that has no
tests of its own (lint, types, the page's types) found something, and a run that is not clean must never look so.
"""

from __future__ import annotations

import sys
from pathlib import Path
from xml.etree import ElementTree

SUITES = ("pytest", "pytest-heavy", "vitest", "playwright")


def count(report: Path) -> tuple[int, int, int]:
    """Passed, failed and skipped tests in one report; raises when it cannot be read."""
    cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    failed = sum(case.find("failure") is not None or case.find("error") is not None for case in cases)
    skipped = sum(case.find("skipped") is not None for case in cases)
    return len(cases) - failed - skipped, failed, skipped


def main(folder: Path, status: int) -> int:
    """Print the counts; returns the exit code of the run."""
    passed = failed = 0
    for suite in SUITES:
        try:
            ok, wrong, skipped = count(folder / f"{suite}.xml")
        except (OSError, ElementTree.ParseError):
            print(f"{suite}: no report")
            failed += 1
            continue
        print(f"{suite}: {ok} passed, {wrong} failed, {skipped} skipped")
        passed, failed = passed + ok, failed + (wrong if ok + wrong else 1)
    if status != 0 and failed == 0:
        print("a check without tests of its own failed: see above")
        failed = 1
    print(f"{passed} passed, {failed} failed")
    return 0 if failed == 0 and status == 0 else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), int(sys.argv[2])))
