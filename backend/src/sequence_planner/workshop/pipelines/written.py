"""The pipelines of a draft as they are written, whether they make sense or not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from sequence_planner.model.reading import Document, EntryPath
from sequence_planner.workshop.pipelines.pruning import STAGES
from sequence_planner.workshop.pipelines.reading import Sketch, pipeline_name
from sequence_planner.workshop.pipelines.view import Part

_PARTS: Mapping[tuple[str, str], Part] = {("topics", "pipeline"): Part.TOPIC, ("flows", "pipeline"): Part.FLOW}
_OUT = frozenset({Part.REQUEST, Part.GOAL})
Role = Literal["incoming", "outgoing", "flow"]
Joining = Literal["branch", "interleave", "merge"]


class Written:
    """A pipeline as it is written: where, and what of it can be told without knowing whether it makes sense."""

    def __init__(
        self, sketch: Sketch, resource: str, document: Document, path: EntryPath, key: str, part: Part
    ) -> None:
        self.resource, self.document, self.path, self.part = resource, document, path, part
        self.file = document.file
        self.content = at(at(document.content, str(path[0])), str(path[1]))
        self.stages_path: EntryPath = (*path, key)
        self.stages = entries_of(self.content, key)
        self.cut = sketch.cut.get((self.file, self.stages_path))
        self.name = pipeline_name(resource, self.stages_path)
        self.id = self.name
        outgoing = part in _OUT or (part is Part.TOPIC and at(self.content, "direction") == "out")
        self.role: Role = "flow" if part is Part.FLOW else "outgoing" if outgoing else "incoming"
        type_ = at(self.content, "type")
        self.message = str(type_) if part is Part.TOPIC and type_ is not None else None


def written_pipelines(sketch: Sketch) -> Iterator[Written]:
    """All pipelines of all resources."""
    seen: set[str] = set()
    for resource, document in sketch.resources.items():
        for section, keys in STAGES.items():
            entries = at(document.content, section)
            for name in entries if isinstance(entries, dict) else ():
                for key in (*keys, "status") if section == "actions" else keys:
                    part = _PARTS.get((section, key)) or Part(key)
                    each = Written(sketch, resource, document, (section, str(name)), key, part)
                    if each.id in seen:
                        each.id = unique(f"{resource} {each.name}", seen)
                    seen.add(each.id)
                    if part is Part.STATUS:
                        each.stages = []
                    yield each


def sources_of(written: Written) -> Iterator[tuple[str | None, str, EntryPath]]:
    """The sources of a flow: alias, name and path."""
    if written.part is not Part.FLOW:
        return
    source, path = at(written.content, "from"), (*written.path, "from")
    match source:
        case dict():
            for alias, name in source.items():
                yield str(alias), str(name), (*path, str(alias))
        case list():
            for index, name in enumerate(source):
                yield None, str(name), (*path, index)
        case str():
            yield None, str(source), path


def joining_of(written: Written) -> Joining | None:
    """How a flow comes of its sources; None for what is none."""
    if written.part is not Part.FLOW:
        return None
    match at(written.content, "from"):
        case dict():
            return "merge"
        case list():
            return "interleave"
    return "branch"


def unique(id_: str, taken: set[str]) -> str:
    """The id, with a number where it is taken."""
    number, found = 2, id_
    while found in taken:
        number, found = number + 1, f"{id_} #{number}"
    taken.add(found)
    return found


def at(content: object, name: str) -> object:
    """The entry of a mapping; None where there is none."""
    return content.get(name) if isinstance(content, dict) else None


def entries_of(content: object, name: str) -> list[object]:
    """The list that an entry of a mapping is; empty where it is none."""
    found = at(content, name)
    return found if isinstance(found, list) else []
