"""What is wrong with a station as an editor shows it: underlined, with what would mend it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from lsprotocol import types

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.language_server.documents.texts import DocumentText

SOURCE = "sequence-planner"
_SEVERITIES = {"error": types.DiagnosticSeverity.Error, "warning": types.DiagnosticSeverity.Warning}
# How findings say what to write in place of what stands there; `language.resolver` words most of them.
_MEANT = re.compile(r"did you mean `([^`]+)`\?")
_BESIDE = re.compile(r"a value stands beside its variable, as in `([^`]+)`")
_ONE_OF = re.compile(r"; write (?:one of )?([A-Za-z_][\w.()\[\]]*(?:(?:, | or )[A-Za-z_][\w.()\[\]]*)*)$")
_RENAME = re.compile(r"rename it to (\S+): this is not read")
_NAMED = re.compile(r"`([^`]+)`")
_MOST_CHOICES = 5


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
    if (culprit := _culprit(finding)) is not None:
        rest = text.row(finding.line - 1)[start - text.index_of(finding.line, 1) :]
        if found := re.search(rf"(?<!\w){re.escape(culprit)}(?!\w)", rest):
            return text.range(start + found.start(), start + found.end())
    return text.range(*text.word(start))


def _culprit(finding: FindingDocument) -> str | None:
    """What is wrong as it is written, where the finding says so."""
    named: list[str] = _NAMED.findall(finding.message.partition(";")[0])
    return named[-1] if named else None


class Replacement(NamedTuple):
    """A text to be written in place of what a finding is about."""

    text: str
    is_sure: bool


def replacements(finding: FindingDocument) -> Iterator[Replacement]:
    """Yield what would mend it in place of what `range_of` is about, as it says itself."""
    if _culprit(finding) is None:
        return
    if found := _MEANT.search(finding.message) or _BESIDE.search(finding.message):
        yield Replacement(found[1], True)
    elif found := _ONE_OF.search(finding.message):
        choices = re.split(r", | or ", found[1])
        for choice in choices[:_MOST_CHOICES]:
            yield Replacement(choice, len(choices) == 1)


def new_name(finding: FindingDocument) -> str | None:
    """The name that a file should have, where that is what is wrong."""
    found = _RENAME.search(finding.message) if finding.line == 1 else None
    return None if found is None else found[1]
