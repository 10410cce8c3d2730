"""Answers to questions about the draft and the texts in it, by a process that keeps what it has read of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.language.schemas import CompletionView
from sequence_planner.editor.language.service import completion_view, hover_view, problem_view
from sequence_planner.editor.language.types.places import AskedPlace, text_place
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
from sequence_planner.editor.schemas.operations import operations_view
from sequence_planner.editor.schemas.picture import pictured
from sequence_planner.editor.symbols.index import parse_part
from sequence_planner.editor.symbols.rename import Usage, dependants, renamed, usages

# Files that are others since the last question, none for those that are gone; what is asked, and about what.
LanguageQuestion = tuple[Mapping[str, str | None], str, tuple[object, ...]]


def answer(draft: LanguageDraft, kind: LanguageQuestionKind, asked: TextAt) -> LanguageAnswer:
    """Return what is answered; what is no text that names stand in has nothing to be said of."""
    place = text_place(draft.lexicon, asked.file, tuple(asked.path), asked.parameters)
    offset = min(asked.offset, len(asked.text)) if isinstance(asked, PlaceInText) else 0
    if place is None:
        nothing: dict[LanguageQuestionKind, LanguageAnswer] = {
            LanguageQuestionKind.CHECK: ProblemsView(problems=()),
            LanguageQuestionKind.COMPLETION: CompletionView(start=offset, end=offset, options=()),
            LanguageQuestionKind.HOVER: HoverAnswer(hover=None),
            LanguageQuestionKind.FORMAT: FormatView(text=asked.text),
        }
        return nothing[kind]
    answers: dict[LanguageQuestionKind, Callable[[AskedPlace], LanguageAnswer]] = {
        LanguageQuestionKind.CHECK: lambda place: ProblemsView(
            problems=tuple(map(problem_view, place.problems(asked.text)))
        ),
        LanguageQuestionKind.COMPLETION: lambda place: completion_view(place.completion(asked.text, offset)),
        LanguageQuestionKind.HOVER: lambda place: HoverAnswer(
            hover=None if (found := place.hover(asked.text, offset)) is None else hover_view(found)
        ),
        LanguageQuestionKind.FORMAT: lambda place: FormatView(text=place.formatted(asked.text)),
    }
    return answers[kind](place)


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


def sequenced(draft: LanguageDraft, number: int) -> str:
    """Return the operations of the draft after change `number` and their order, as JSON of a `DraftOperationsView`."""
    usable = not draft.errors()
    automaton = None if draft.meant_last is None else draft.meant_last.automaton
    return operations_view(number, automaton, usable=usable).model_dump_json()


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
    "sequenced": sequenced,
    "pictured": pictured,
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
