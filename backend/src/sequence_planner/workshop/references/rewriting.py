"""Names written otherwise in the text of a file, while every other byte of it stays."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping

from sequence_planner.expressions.place import Place
from sequence_planner.expressions.syntax import Span
from sequence_planner.model.editing import same
from sequence_planner.model.paths import EditError
from sequence_planner.model.reading import read_text
from sequence_planner.model.source import ModelError, SourceText
from sequence_planner.workshop.references.occurrences import Occurrence

# What is written at spans of a text.
_Changes = dict[Span, str]


def rewritten(text: str, content: object, changes: Iterable[tuple[Occurrence, str]]) -> str:
    """`text`, whose content is `content`, with other names at these places. Raises `EditError`."""
    by_place: dict[Place, tuple[SourceText, _Changes]] = {}
    for occurrence, name in changes:
        if occurrence.text is not None:
            by_place.setdefault(occurrence.text.place, (occurrence.text, {}))[1][occurrence.span] = name
    starts = _line_starts(text)
    pieces: list[tuple[int, int, str]] = []
    for place, (written, spans) in by_place.items():
        begin = starts[place.line - 1] + place.column - 1
        if not text.startswith(written.raw, begin):
            raise _cannot(place, "this text cannot be found again in the file")
        for span, name in spans.items():
            start, end = written.written(span)
            pieces.append((begin + start, begin + end, name))
    new = "".join(_joined(text, sorted(pieces)))
    _verify(new, content, {place: _put(written, spans) for place, (written, spans) in by_place.items()})
    return new


def _joined(text: str, pieces: list[tuple[int, int, str]]) -> Iterator[str]:
    at = 0
    for start, end, name in pieces:
        yield text[at:start]
        yield name
        at = end
    yield text[at:]


def _line_starts(text: str) -> list[int]:
    starts = [0]
    while (end := text.find("\n", starts[-1])) >= 0:
        starts.append(end + 1)
    return starts


def _put(text: SourceText, spans: _Changes) -> str:
    return "".join(_joined(str(text), sorted((span.start, span.end, name) for span, name in spans.items())))


def _verify(new: str, content: object, changed: Mapping[Place, str]) -> None:
    """Whether the new text is read as the old content with these changes and no others."""
    first = min(changed)
    try:
        found = read_text(new, first.file).content
    except ModelError as error:
        raise _cannot(first, f"it could not be read afterwards: {error.findings[0].message}") from error
    if not same(_changed(content, changed), found):
        raise _cannot(first, "something else would change with it")


def _changed(content: object, changed: Mapping[Place, str]) -> object:
    match content:
        case SourceText():
            return changed.get(content.place, str(content))
        case dict():
            return {_changed(key, changed): _changed(value, changed) for key, value in content.items()}
        case list():
            return [_changed(each, changed) for each in content]
    return content


def _cannot(place: Place, why: str) -> EditError:
    return EditError(f"the name at {place} cannot be written otherwise here: {why}; nothing was changed")


def by_file(changes: Iterable[tuple[Occurrence, str]]) -> dict[str, list[tuple[Occurrence, str]]]:
    """Changes by the file in which they are."""
    found: dict[str, list[tuple[Occurrence, str]]] = defaultdict(list)
    for occurrence, name in changes:
        if occurrence.text is not None:
            found[occurrence.where.file].append((occurrence, name))
    return found
