"""Findings for people: where, what, and a run that shows it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection

from sequence_planner.analysis.document import FindingDocument, TraceDocument
from sequence_planner.counting import counted

_LONG = 10  # steps: of a run that is longer it is only said how long it is


def finding_lines(finding: FindingDocument, runs: bool = False) -> list[str]:
    """A finding, and its trace indented below it: a long one only where `runs` are asked for."""
    where = f"{finding.file}:{finding.line}:{finding.column}"
    told = [] if finding.trace is None else _told(finding.trace)
    if len(told) > _LONG and not runs:
        told = [f"a run of {len(told)} steps shows it, which `check --runs` prints"]
    return [f"{where}: {finding.severity}: {finding.message} [{finding.kind}]", *(f"  {line}" for line in told)]


def counts_line(findings: Collection[FindingDocument]) -> str:
    """How many findings there are, of which kinds."""
    kinds = Counter(finding.kind for finding in findings)
    return f"{counted(len(findings), 'finding')}: {', '.join(f'{number} {kind}' for kind, number in kinds.items())}"


def _told(trace: TraceDocument) -> list[str]:
    """The lines of a trace up to the first state that is forbidden: what comes after it is of less interest."""
    lines = [step.text for step in trace.steps]
    until = next((number for number, step in enumerate(trace.steps, start=1) if step.forbidden_by), len(lines))
    left = len(lines) - until
    return lines if left < 2 else [*lines[:until], f"and {left} further steps, which --json shows"]
