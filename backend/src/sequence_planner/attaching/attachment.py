"""A topic entered into a station's model: what changes, tried on a copy, and then made."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from shutil import copytree
from tempfile import TemporaryDirectory

from sequence_planner.attaching.definitions import definition_files
from sequence_planner.attaching.errors import AttachError
from sequence_planner.attaching.names import check_resource, renamed
from sequence_planner.attaching.network import FoundTopic
from sequence_planner.attaching.proposals import Proposal, is_variable, proposals
from sequence_planner.attaching.writing import document, with_proposals, with_topic
from sequence_planner.model.paths import EditError
from sequence_planner.model.saving import digest, edit_file
from sequence_planner.pipelines.message_types import message_fields
from sequence_planner.pipelines.record import RecordType
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.station import ReadyStation, prepare_station


@dataclass(frozen=True)
class Attachment:
    """A change of a model that attaches a topic: entries of a resource's document, and definitions of messages.

    `expected` is the digest of the document that it was made for, None where there is none yet.
    """

    topic: FoundTopic
    document: PurePosixPath
    title: str
    entry: Mapping[str, object]
    measured: Mapping[str, object]
    proposals: tuple[Proposal, ...]
    definitions: Mapping[PurePosixPath, str]
    expected: str | None

    def make(self, folder: Path) -> str:
        """Change the model in `folder`; returns the differences of all files. Raises `AttachError`: nothing changed."""
        new = dict(self.definitions)
        if self.expected is None:
            new[self.document] = self._changed(f"title: {self.title}\n")
        written: list[Path] = []
        try:
            for name, text in new.items():
                path = folder / name
                path.parent.mkdir(parents=True, exist_ok=True)
                with path.open("x", encoding="utf-8") as file:
                    written.append(path)
                    file.write(text)
            difference = "".join(_new_file(folder / name, text) for name, text in new.items())
            if self.expected is not None:
                difference += edit_file(folder / self.document, self._changed, expected=self.expected)
        except (OSError, EditError) as error:
            for path in written:
                path.unlink(missing_ok=True)
            raise AttachError("not-written", f"{folder} cannot be changed: {error}") from error
        return difference

    @contextmanager
    def made_on_copy(self, folder: Path) -> Iterator[tuple[Path, str]]:
        """A copy of the model, for as long as the block lasts, with the change and its differences."""
        with TemporaryDirectory() as scratch:
            copy = copytree(folder, Path(scratch) / folder.resolve().name, ignore_dangling_symlinks=True)
            yield copy, self.make(copy).replace(str(copy), str(folder))

    def _changed(self, text: str) -> str:
        text = with_topic(text, self.topic, self.entry, self.measured)
        return with_proposals(text, self.topic, self.proposals)


def attachment(folder: Path, registry: MessageRegistry, topic: FoundTopic, resource: str) -> Attachment:
    """The change that attaches a topic to a resource, which may be new; `registry` knows the type.

    Fields that are variables by themselves become variables, under another name where theirs is taken. Where there are
    none, the first proposal is made. Raises `AttachError`, and `ModelError` for a station that cannot be used.
    """
    check_resource(resource)
    station = prepare_station(folder)
    incoming, outgoing = station.pipelines.sources, station.pipelines.outgoing
    used = incoming.get(topic.name) or outgoing.get(topic.name)
    if used is not None:
        raise AttachError("attached", f"{topic.name} belongs to `{used.topic.resource}` already")
    fields = message_fields(registry, topic.type_name)
    made, proposed = _made(fields, station, resource, topic)
    path = folder / "resources" / f"{resource}.yaml"
    return Attachment(
        topic,
        PurePosixPath("resources", path.name),
        resource.replace("_", " ").capitalize(),
        document(topic, [each.stage for each in made]),
        {each.variable: {"type": each.type} for each in made if each.variable is not None},
        tuple(proposed),
        definition_files(registry, topic.found_types, topic.source),
        digest(path) if path.is_file() else None,
    )


def _made(
    fields: RecordType, station: ReadyStation, resource: str, topic: FoundTopic
) -> tuple[list[Proposal], list[Proposal]]:
    """The stages that are needed, and those that are only proposed."""
    proposed = proposals(fields, topic.direction)
    direct = [name for name, field in fields.items() if is_variable(field)]
    others = renamed(direct, station, resource, topic.name, topic.direction)
    made = [Proposal({"rename": others})] if others else []
    if topic.direction == "in" and not direct:
        if not proposed:
            raise AttachError("nothing-to-measure", f"no field of {topic.type_name} can become a variable")
        made, proposed = proposed[:1], proposed[1:]
    return made, proposed


def _new_file(path: Path, text: str) -> str:
    lines = text.splitlines(keepends=True)
    return "".join(difflib.unified_diff([], lines, "/dev/null", str(path)))
