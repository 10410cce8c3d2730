"""The files of a draft, read as far as they can be: content with places, and helpers for content of any form."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache

from sequence_planner.model.paths import has_scenarios, resource_of, type_of
from sequence_planner.model.source import Finding, ModelError, SourceText
from sequence_planner.model.stages.marks import Marked, NameMark, NameUse
from sequence_planner.model.stages.registry import KINDS
from sequence_planner.model.types.expansion import Expansion
from sequence_planner.model.types.layers import WrittenOut
from sequence_planner.model.yaml.reader import EntryPath, YamlDocument, read_text

STATION = "station.yaml"
OPERATIONS = "operations.yaml"
SPECIFICATIONS = "specifications.yaml"
WORK_MASTERS = "work_masters.yaml"
MIMIC = "mimic.yaml"
_RESOURCES = "resources/"
_YAML = ".yaml"
_DEFINITION = re.compile(r"messages/(\w+/(msg|srv|action)/\w+)\.\2")


class ModelContent(Mapping[str, object]):
    """The things that the files of a model hold, by their paths. `skipped` says why a file could not be read as YAML.

    `definitions` are those of types of messages, by their files. `whole` is what resources hold that are instances,
    with all that they have of their types; `types` and `instances` are as they are written, by name and by file, and
    `layers` are each instance with its types, by file.
    """

    def __init__(self, files: Mapping[str, str]) -> None:
        self.texts = {file: text for file, text in files.items() if _is_read(file)}
        self.definitions = {file: text for file, text in files.items() if message_of(file) is not None}
        self.skipped: list[Finding] = []
        self._read: dict[str, YamlDocument] = {}
        for file, text in sorted(self.texts.items()):
            document, findings = _document(file, text)
            self.skipped += findings
            if document is not None:
                self._read[file] = document
        made = WrittenOut(self._read)
        self.whole = {file: each.content for file, each in made.documents.items()}
        self.types, self.instances, self.layers = made.types, made.instances, made.layers
        self._files_of = made.files_of
        self._paths: dict[str, dict[tuple[int, int], EntryPath]] = {}

    def __getitem__(self, file: str) -> object:
        return self._read[file].content

    def __iter__(self) -> Iterator[str]:
        return iter(self._read)

    def __len__(self) -> int:
        return len(self._read)

    def resources(self) -> Iterator[tuple[str, str, object]]:
        """Each resource: its name, its file and the content of that."""
        for file, content in self.whole.items():
            if (name := resource_of(file)) is not None:
                yield name, file, content

    def is_made_of(self, resource_file: str, file: str) -> bool:
        """Return whether what the file of a resource holds stands in a file: in itself, or in one of its types."""
        return file == resource_file or file in self._files_of.get(resource_file, ())

    def made_path(self, resource_file: str, file: str, path: EntryPath) -> EntryPath:
        """Return where an entry of a file stands in a resource that is made of it."""
        for layer in self.layers.get(resource_file, ())[1:]:
            if layer.written.document.file == file:
                return Expansion(resource_file, layer.arguments).made_path(path)
        return path

    def path_of(self, text: SourceText) -> EntryPath:
        """Return where a text stands in its file: at the entry that it is the name or the value of."""
        file = text.place.file
        if file not in self._paths:
            found = self._read[file]
            self._paths[file] = {
                (place.line, place.column): path
                for each in (found.places, found.values)
                for path, place in each.items()
            }
        return self._paths[file].get((text.place.line, text.place.column), ())


def file_of(resource: str) -> str:
    """The file that describes a resource."""
    return f"{_RESOURCES}{resource}{_YAML}"


def message_of(file: str) -> str | None:
    """The type of message that a file defines, such as `cell_msgs/msg/State`, or nothing for other files."""
    found = _DEFINITION.fullmatch(file)
    return None if found is None else found[1]


def _is_read(file: str) -> bool:
    return (
        file in (STATION, OPERATIONS, SPECIFICATIONS, WORK_MASTERS, MIMIC)
        or (resource_of(file) or type_of(file)) is not None
        or has_scenarios(file)
    )


# While a draft is edited, all of its files but one are as they were.
@lru_cache(2048)
def _document(file: str, text: str) -> tuple[YamlDocument | None, tuple[Finding, ...]]:
    try:
        return read_text(text, file), ()
    except ModelError as error:
        return None, tuple(error.findings)


def pairs(content: object) -> list[tuple[SourceText, object]]:
    """The entries of a mapping; none of anything else."""
    if not isinstance(content, dict):
        return []
    return [(key, value) for key, value in content.items() if isinstance(key, SourceText)]


def items(content: object) -> list[object]:
    """The entries of a list; none of anything else."""
    return content if isinstance(content, list) else []


def entry(content: object, *names: str) -> object:
    """Return what stands in a mapping, and in the mappings in it, under these names; nothing where there is none."""
    for name in names:
        content = content.get(name) if isinstance(content, dict) else None
    return content


def text_at(content: object, *names: str) -> SourceText | None:
    """The same, if it is a text."""
    found = entry(content, *names)
    return found if isinstance(found, SourceText) else None


def title_at(content: object, *names: str) -> SourceText | None:
    """The same of a title, which may be written by language: in English, or else in the first language."""
    found = entry(content, *names)
    said = {str(language): text for language, text in pairs(found) if isinstance(text, SourceText)}
    return text_at(content, *names) or said.get("en") or next(iter(said.values()), None)


def texts(content: object, path: EntryPath) -> Iterator[tuple[EntryPath, SourceText]]:
    """All texts in some content, names included, each with its path."""
    if isinstance(content, SourceText):
        yield path, content
    elif isinstance(content, dict):
        for key, value in content.items():
            yield (*path, str(key)), key
            yield from texts(value, (*path, str(key)))
    elif isinstance(content, list):
        for index, value in enumerate(content):
            yield from texts(value, (*path, index))


# The stages of a pipeline, and what their declarations say of each name and value in them.


MarkedStages = Sequence[tuple[int, str, list[Marked]]]


def marked_in(stages: object) -> MarkedStages:
    """Stages as written, each with its index, its kind, and what is marked in it. What is no stage is left out."""
    return [
        (index, str(kind), KINDS[kind].marked(content))
        for index, stage in enumerate(items(stages))
        for kind, content in pairs(stage)
        if kind in KINDS
    ]


def named_in(stages: MarkedStages, is_incoming: bool, *uses: NameUse) -> set[str]:
    """The names of which stages make one of these uses."""
    return {
        str(text)
        for _, _, marked in stages
        for text, _, mark in marked
        if isinstance(mark, NameMark) and mark.use(is_incoming) in uses
    }


def given_by(stages: MarkedStages) -> frozenset[str]:
    """All names that stages give to what they make, in an incoming pipeline."""
    return frozenset(name.partition("[")[0] for name in named_in(stages, True, NameUse.GIVEN))
