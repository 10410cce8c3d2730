"""Findings for people: where, what, and a run that shows it."""

from __future__ import annotations

from sequence_planner.analysis.document import FindingDocument, TraceDocument


def finding_lines(finding: FindingDocument) -> list[str]:
    """A finding, and its trace indented below it."""
    where = f"{finding.file}:{finding.line}:{finding.column}"
    told = [] if finding.trace is None else _told(finding.trace)
    return [f"{where}: {finding.severity}: {finding.message} [{finding.kind}]", *(f"  {line}" for line in told)]


def _told(trace: TraceDocument) -> list[str]:
    """The lines of a trace up to the first state that is forbidden: what comes after it is of less interest."""
    lines = [step.text for step in trace.steps]
    until = next((number for number, step in enumerate(trace.steps, start=1) if step.forbidden_by), len(lines))
    left = len(lines) - until
    return lines if left < 2 else [*lines[:until], f"and {left} further steps, which --json shows"]
