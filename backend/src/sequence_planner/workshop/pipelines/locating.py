"""Where findings belong: from a line and column to the entry of a file that stands there."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Mapping

from sequence_planner.model.reading import Document, EntryPath
from sequence_planner.model.source import Finding


class Places:
    """The entries of one file in the order in which they stand."""

    def __init__(self, document: Document) -> None:
        # Where several begin at one place, the innermost is last; what an alias repeats belongs to its anchor.
        first: dict[tuple[int, int], EntryPath] = {}
        for path, place in document.places.items():
            at = (place.line, place.column)
            known = first.get(at)
            if known is None or path[: len(known)] == known:
                first[at] = path
        self._starts = sorted(first)
        self._paths = [first[start] for start in self._starts]

    def at(self, line: int, column: int) -> EntryPath:
        """The path of the entry that stands at a place."""
        index = bisect_right(self._starts, (line, column)) - 1
        return self._paths[index] if index >= 0 else ()


class Located:
    """Findings by the entries they are about; each is taken by the first who asks for it."""

    def __init__(self, documents: Mapping[str, Document], findings: Iterable[Finding]) -> None:
        self._left: dict[str, list[tuple[EntryPath, Finding]]] = {}
        self._elsewhere: list[Finding] = []
        places: dict[str, Places] = {}
        for finding in dict.fromkeys(findings):
            file = finding.place.file
            if file not in documents:
                self._elsewhere.append(finding)
                continue
            if file not in places:
                places[file] = Places(documents[file])
            path = places[file].at(finding.place.line, finding.place.column)
            self._left.setdefault(file, []).append((path, finding))

    def take(self, file: str, path: EntryPath) -> list[Finding]:
        """Those about an entry or what is in it."""
        taken: list[tuple[EntryPath, Finding]] = []
        left: list[tuple[EntryPath, Finding]] = []
        for at, finding in self._left.get(file, ()):
            (taken if at[: len(path)] == path else left).append((at, finding))
        if taken:
            self._left[file] = left
        return [finding for _, finding in taken]

    @property
    def rest(self) -> list[Finding]:
        """Those that nobody has taken."""
        return [*self._elsewhere, *(finding for left in self._left.values() for _, finding in left)]
