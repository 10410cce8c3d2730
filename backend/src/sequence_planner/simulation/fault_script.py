"""A file of faults and when they begin, in seconds after the emulated devices have come up:

faults:
  - {at: 10, fault: robot silent for 5 s}
  - {at: 20.5, fault: clear}
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from sequence_planner.language.syntax import ExpressionError
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.yaml.reader import YamlDocument, read_yaml
from sequence_planner.simulation.faults import LONGEST, Clear, Fault, FaultReader

_FORM = "write `faults:` and below it entries such as `- {at: 10, fault: robot silent for 5 s}`"


@dataclass(frozen=True)
class Scripted:
    """An event that happens `at` so many seconds."""

    at: float
    what: Fault | Clear


def read_script(path: Path, reader: FaultReader) -> tuple[Scripted, ...]:
    """The faults of a file in the order in which they begin. Raises `ModelError` with the places of what is wrong."""
    document = read_yaml(path, str(path))
    content = document.content
    entries = content.get("faults") if isinstance(content, dict) and list(content) == ["faults"] else None
    if not isinstance(entries, list):
        raise ModelError([Finding(document.place(()), _FORM)])
    findings: list[Finding] = []
    script = [_entry(document, number, entry, reader, findings) for number, entry in enumerate(entries)]
    if findings:
        raise ModelError(findings)
    return tuple(sorted((each for each in script if each is not None), key=lambda each: each.at))


def _entry(
    document: YamlDocument, number: int, entry: object, reader: FaultReader, findings: list[Finding]
) -> Scripted | None:
    path = ("faults", number)
    if not isinstance(entry, dict) or set(entry) != {"at", "fault"}:
        findings.append(Finding(document.place(path), "an entry has `at` and `fault`, as in {at: 10, fault: clear}"))
        return None
    at, text = entry["at"], entry["fault"]
    if isinstance(at, bool) or not isinstance(at, int | float) or not math.isfinite(at) or not 0 <= at <= LONGEST:
        findings.append(Finding(document.place_of_value((*path, "at")), "`at` is a number of seconds, from 0"))
        return None
    if not isinstance(text, SourceText):
        findings.append(Finding(document.place_of_value((*path, "fault")), "`fault` is a text"))
        return None
    try:
        return Scripted(at, reader.read(text))
    except ExpressionError as error:
        findings.append(Finding(text.at(error.span), error.message))
        return None
