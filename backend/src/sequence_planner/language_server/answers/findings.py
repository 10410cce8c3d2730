"""What is wrong with a station as an editor shows it: underlined, with what would mend it."""

from __future__ import annotations

import re

from lsprotocol import types

from sequence_planner.analysis.report import FindingDocument, culprit
from sequence_planner.language_server.documents.texts import DocumentText

SOURCE = "sequence-planner"
_SEVERITIES = {"error": types.DiagnosticSeverity.Error, "warning": types.DiagnosticSeverity.Warning}
_RENAME = re.compile(r"rename it to (\S+): this is not read")


def diagnostics_of(findings: list[FindingDocument], text: DocumentText) -> list[types.Diagnostic]:
    """The findings of a document with this text."""
    return [
        types.Diagnostic(
            range=range_of(finding, text),
            message=finding.message,
            severity=_SEVERITIES.get(finding.severity, types.DiagnosticSeverity.Information),
            code=finding.kind,
            source=SOURCE,
        )
        for finding in findings
    ]


def range_of(finding: FindingDocument, text: DocumentText) -> types.Range:
    """What a finding is about: the name that it names last, if that stands there, or else the name or value there."""
    start = text.index_of(finding.line, finding.column)
    if (wrong := culprit(finding.message)) is not None:
        rest = text.row(finding.line - 1)[start - text.index_of(finding.line, 1) :]
        if found := re.search(rf"(?<!\w){re.escape(wrong)}(?!\w)", rest):
            return text.range(start + found.start(), start + found.end())
    return text.range(*text.word(start))


def new_name(finding: FindingDocument) -> str | None:
    """The name that a file should have, where that is what is wrong."""
    found = _RENAME.search(finding.message) if finding.line == 1 else None
    return None if found is None else found[1]
