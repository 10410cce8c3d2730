"""Documents of a draft without what cannot be used in them: what is wrong in one place keeps nothing else from being
read.

pydantic alone says what is wrong. It is taken out, and the rest is looked at again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeVar

from pydantic import ValidationError

from sequence_planner.model.document_part import DocumentPart
from sequence_planner.model.reading import Document, EntryPath
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.model.validation import findings_of

D = TypeVar("D", bound=DocumentPart)

# Where the stages of an entry of each section stand.
STAGES: Mapping[str, tuple[str, ...]] = {
    "topics": ("pipeline",),
    "flows": ("pipeline",),
    "services": ("request", "response"),
    "actions": ("goal", "feedback", "result"),
}
# What an entry of each section cannot be without.
_NEEDED: Mapping[str, frozenset[str]] = {
    "topics": frozenset({"type", "direction"}),
    "flows": frozenset({"from"}),
    "services": frozenset({"type"}),
    "actions": frozenset({"type", "when", "status"}),
}
_OWN_NAMES = 2  # a section and the name of an entry


@dataclass
class Pruned:
    """What is wrong with a document, the lists of stages that are `cut` with the index of the first that is gone, and
    the entries that are `lost` as a whole.
    """

    findings: list[Finding] = field(default_factory=list)
    cut: dict[EntryPath, int] = field(default_factory=dict)
    lost: set[EntryPath] = field(default_factory=set)


def pruned(document: Document, content: dict[SourceText, object], kind: type[D]) -> tuple[D, Pruned]:
    """The document with what is usable of `content`, which is one of `kind` but for what is wrong in it."""
    result = Pruned()
    while True:
        try:
            return kind.model_validate(content), result
        except ValidationError as error:
            if not result.findings:
                result.findings += findings_of(error, document, (), kind)
            before = content
            for each in {tuple(map(_step, details["loc"])) for details in error.errors()}:
                content = _without(content, each, result)
            if content == before:
                return kind.model_validate({}), result


def _step(part: str | int) -> str | int:
    return str(part) if isinstance(part, str) else part


def _without(content: dict[SourceText, object], at: EntryPath, result: Pruned) -> dict[SourceText, object]:
    """Without the smallest part around a place that can be left out."""
    section = str(at[0]) if at else ""
    entries = _at(content, section)
    if len(at) < _OWN_NAMES or not isinstance(entries, dict):
        return {key: value for key, value in content.items() if key != section}
    name = str(at[1])
    entry = _at(entries, name)
    if isinstance(entry, dict):
        shorter = _without_part(section, entry, at, result)
        if shorter is not None:
            return {**content, _key(content, section): {**entries, _key(entries, name): shorter}}
    result.lost.add((section, name))
    left = {key: value for key, value in entries.items() if key != name}
    return {**content, _key(content, section): left}


def _without_part(
    section: str, entry: dict[SourceText, object], at: EntryPath, result: Pruned
) -> dict[SourceText, object] | None:
    """The entry without the part, or None where it is nothing without it."""
    if len(at) == _OWN_NAMES:  # what its parts say together makes no sense: those remain without which it is none
        kept = {*_NEEDED.get(section, ()), *STAGES.get(section, ()), "ignore"}
        left = {key: value for key, value in entry.items() if key in kept}
        return left if section in STAGES and len(left) < len(entry) else None
    part = at[_OWN_NAMES]
    stages = _at(entry, str(part))
    if part in STAGES.get(section, ()) and isinstance(stages, list) and len(at) > _OWN_NAMES + 1:
        index = at[_OWN_NAMES + 1]
        if isinstance(index, int):
            path = (*at[:_OWN_NAMES], part)
            result.cut[path] = min(index, result.cut.get(path, index))
            return {**entry, _key(entry, str(part)): stages[: result.cut[path]]}
    if part in entry and part not in _NEEDED.get(section, ()) and section in STAGES:
        if part in STAGES[section]:
            result.cut[(*at[:_OWN_NAMES], part)] = 0
        return {key: value for key, value in entry.items() if key != part}
    return None


def _at(mapping: Mapping[SourceText, object], name: str) -> object:
    return next((value for key, value in mapping.items() if key == name), None)


def _key(mapping: Mapping[SourceText, object], name: str) -> SourceText:
    """The key as it is written, with its place."""
    return next(key for key in mapping if key == name)
