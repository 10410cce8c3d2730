"""Answers to questions about the draft and the texts in it, by a process that keeps what it has read of it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.editor.language.completion import complete
from sequence_planner.editor.language.field import TextField as EditorField
from sequence_planner.editor.language.hover import hover
from sequence_planner.editor.language.schemas import CompletionView
from sequence_planner.editor.language.scope import Lexicon, messages_of
from sequence_planner.editor.language.service import (
    check,
    completion_view,
    formatted,
    hover_view,
    problem_view,
)
from sequence_planner.editor.model_graph import graph, graph_view, station_of
from sequence_planner.editor.processes import (
    FormatView,
    HoverAnswer,
    LanguageAnswer,
    LanguageQuestionKind,
    PlaceInText,
    ProblemsView,
    TextAt,
    encoded,
)
from sequence_planner.editor.schemas.check import listed
from sequence_planner.editor.schemas.draft import UsagesView, UsageView
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import Usage, dependants, renamed, usages
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.ros.types.errors import MessageDefinitionError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import Before, read_station

STATION, NOTHING = "station.yaml", "name: draft\n"

# Files that are others since the last question, none for those that are gone; what is asked, and about what.
LanguageQuestion = tuple[Mapping[str, str | None], str, tuple[object, ...]]


class LanguageDraft:
    """The draft while it is edited, and what its names mean. Its files are written into the empty `folder`.

    A file that cannot be used stands as it was when it could be: what is written elsewhere is not wrong because of it.
    What is the same as before is not read again.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, str] = {}
        self._usable: dict[str, str] = {}
        self._written: dict[str, str] = {}  # what the folder holds
        self._before = Before()
        self._lexicon: Lexicon | None = None

    def take(self, changed: Mapping[str, str | None]) -> None:
        """Take note of files that are others now."""
        for path, text in changed.items():
            if text is None:
                self._files.pop(path, None)
            else:
                self._files[path] = text
        if changed:
            self._lexicon = None

    @property
    def files(self) -> Files:
        """The files as they are."""
        return self._files

    @property
    def lexicon(self) -> Lexicon:
        """The meaning of names now."""
        if self._lexicon is None:
            self._lexicon = self._made()
        return self._lexicon

    def errors(self) -> list[Finding]:
        """Return what makes it unusable, all that a check of it finds before it builds pipelines."""
        with self._folder_of(self._files):
            try:
                read_station(Path(), self._before)
            except ModelError as error:
                return error.findings
        return []

    def messages(self) -> MessageRegistry | None:
        """The message types that it defines; None where they cannot be read."""
        with self._folder_of(self._files):
            definitions = Path("messages")
            try:
                return MessageRegistry.from_folder(definitions if definitions.is_dir() else None)
            except MessageDefinitionError:
                return None

    def _made(self) -> Lexicon:
        files = {STATION: NOTHING, **self._files}
        while True:
            with self._folder_of(files):
                try:
                    station = load_station(Path(), self._before.files)
                    self._usable = {path: text for path, text in files.items() if text != NOTHING}
                    return Lexicon.of(station, messages_of(station))
                except ModelError as error:
                    wrong = {finding.place.file for finding in error.findings}
            for path in wrong & files.keys() or files.keys() - {STATION}:
                files = self._without(files, path)

    def _without(self, files: Files, path: str) -> dict[str, str]:
        """With the file as it was when it could be used, or else without it."""
        others = {name: text for name, text in files.items() if name != path}
        usable = self._usable.get(path)
        if usable is not None and usable != files[path]:
            return {**others, path: usable}
        return {**others, STATION: NOTHING} if path == STATION else others

    @contextlib.contextmanager
    def _folder_of(self, files: Files) -> Iterator[None]:
        """Within the folder, which holds these files, so that places bear the names that files have in the model."""
        self._folder.mkdir(parents=True, exist_ok=True)
        for path in self._written.keys() - files.keys():
            (self._folder / path).unlink()
        write_files({path: text for path, text in files.items() if self._written.get(path) != text}, self._folder)
        self._written = dict(files)
        with contextlib.chdir(self._folder):
            yield


def answer(draft: LanguageDraft, kind: LanguageQuestionKind, asked: TextAt) -> LanguageAnswer:
    """Return what is answered; what is no text that names stand in has nothing to be said of."""
    lexicon = draft.lexicon
    field = lexicon.field(asked.file, tuple(asked.path), asked.parameters)
    offset = min(asked.offset, len(asked.text)) if isinstance(asked, PlaceInText) else 0
    if field is None:
        nothing: dict[LanguageQuestionKind, LanguageAnswer] = {
            LanguageQuestionKind.CHECK: ProblemsView(problems=()),
            LanguageQuestionKind.COMPLETION: CompletionView(start=offset, end=offset, options=()),
            LanguageQuestionKind.HOVER: HoverAnswer(hover=None),
            LanguageQuestionKind.FORMAT: FormatView(text=asked.text),
        }
        return nothing[kind]
    answers: dict[LanguageQuestionKind, Callable[[EditorField], LanguageAnswer]] = {
        LanguageQuestionKind.CHECK: lambda field: ProblemsView(
            problems=tuple(map(problem_view, check(lexicon, field, asked.text)))
        ),
        LanguageQuestionKind.COMPLETION: lambda field: completion_view(complete(lexicon, field, asked.text, offset)),
        LanguageQuestionKind.HOVER: lambda field: HoverAnswer(
            hover=None if (found := hover(lexicon, field, asked.text, offset)) is None else hover_view(found)
        ),
        LanguageQuestionKind.FORMAT: lambda field: FormatView(text=formatted(field, asked.text)),
    }
    return answers[kind](field)


def errors(draft: LanguageDraft) -> list[FindingDocument]:
    """Return what makes the draft unusable, as far as it shows before pipelines are built."""
    return listed([error_document(finding) for finding in draft.errors()])


def renamed_files(draft: LanguageDraft, part: str, name: str) -> dict[str, str | None]:
    """The files that are others once a part has another name. Raises `EditError`."""
    return renamed(draft.files, parse_part(part), name, draft.messages())


def used(draft: LanguageDraft, part: str) -> UsagesView:
    """Return where a part is named. Raises `EditError`."""
    wanted, messages = parse_part(part), draft.messages()
    found, without = usages(draft.files, wanted, messages), dependants(draft.files, wanted, messages)
    return UsagesView(
        usages=list(map(_usage_view, found.found)),
        unwritten=list(map(_usage_view, found.unwritten)),
        dependants=list(map(_usage_view, without.found)),
        unread=[error_document(each) for each in (*found.skipped, *found.unread)],
        bound=found.bound,
    )


def tied(draft: LanguageDraft, number: int) -> str:
    """Return what is tied to what in the draft after change `number`, as JSON of a `GraphView`."""
    found = graph(draft.files, draft.messages())
    return graph_view(number, found, *station_of(draft.files)).model_dump_json()


def _usage_view(usage: Usage) -> UsageView:
    return UsageView(
        part=usage.part.id,
        file=usage.file,
        path=list(usage.path),
        line=usage.line,
        column=usage.column,
        length=usage.length,
        written=usage.written,
        used_by=usage.used_by,
        declares=usage.declares,
    )


# What can be asked of the draft, by the names that questions bear.
_ANSWERS: Mapping[str, Callable[..., object]] = {
    "answer": answer,
    "errors": errors,
    "renamed_files": renamed_files,
    "tied": tied,
    "used": used,
}


def answering(folder: Path) -> Callable[[LanguageQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    draft = LanguageDraft(folder / "draft")

    def answer(question: LanguageQuestion, _: object) -> object:
        changed, name, asked = question
        draft.take(changed)
        return encoded(_ANSWERS[name](draft, *asked))

    return answer
