"""Answers to questions about the pipelines of a draft, in a process of its own: Python stages run beside it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from pathlib import Path

from sequence_planner.editor.pipelines.examples import preview, recorded, run_examples, run_trial
from sequence_planner.editor.pipelines.graph import DraftPipelines, with_live_edges
from sequence_planner.editor.pipelines.reader import DraftReader
from sequence_planner.editor.pipelines.schemas import (
    DraftPipelinesView,
    DraftQuestion,
    Everything,
    Examples,
    Fitting,
    PipelineAnswer,
    Preview,
    Recording,
    Trial,
)
from sequence_planner.editor.pipelines.suggestions import fits
from sequence_planner.editor.processes import Changed, encoded, read_body
from sequence_planner.model.fields import main_text
from sequence_planner.model.files import STAGES
from sequence_planner.process.budget import Budget
from sequence_planner.process.gc_tuning import collection_put_off


class Version:
    """The files of a model, and what they mean."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True)
        self.folder = folder
        self.files: dict[str, str] = {}
        self.reader = DraftReader(folder)

    def take(self, changed: Changed, stages: Path) -> None:
        """Take note of files that are others now."""
        link = self.folder / STAGES
        if not link.exists() and (stages / STAGES).is_dir():
            link.symlink_to((stages / STAGES).resolve())
        for path, text in changed.items():
            if text is None:
                self.files.pop(path, None)
            else:
                self.files[path] = text
        if changed:
            self.__dict__.pop("graph", None)

    @cached_property
    def graph(self) -> DraftPipelines:
        """Its pipelines."""
        with collection_put_off():
            return DraftPipelines(self.reader.sketch(self.files))


class PipelineService:
    """The draft and the model that runs; `folder` is empty and its own."""

    def __init__(self, folder: Path) -> None:
        self._draft = Version(folder / "draft")
        self._running = Version(folder / "running")

    def told(self, asked: DraftQuestion) -> PipelineAnswer | tuple[PipelineAnswer]:
        """Return what is answered, in brackets where it is to stay a view. Raises as `answer` does."""
        found = self.answer(asked)
        return found if asked.as_json else (found,)

    def answer(self, asked: DraftQuestion) -> PipelineAnswer:
        """Return what is answered. Raises `EditError` for what is not there, and `BodyError`."""
        self._draft.take(asked.changed, asked.stages)
        self._running.take(asked.running, asked.stages)
        graph, number = self._draft.graph, asked.number
        question = read_body(Preview, asked.question) if isinstance(asked.question, bytes) else asked.question
        match question:
            case Everything():
                return self._everything(number)
            case Fitting():
                return fits(number, graph, question)
            case Preview():
                return preview(number, graph, self._draft.files, self._draft.reader, question)
            case Examples():
                return run_examples(number, graph, question)
            case Trial():
                return run_trial(number, graph, question)
            case Recording():
                return recorded(graph, question)

    def _everything(self, number: int) -> DraftPipelinesView:
        graph = self._draft.graph
        return DraftPipelinesView(
            number=number,
            variables=graph.variables,
            pipelines=with_live_edges(graph.pipelines, self._running.graph.pipelines),
            types=graph.types,
            resources={name: str(main_text(doc.title) or name) for name, doc in graph.sketch.station.resources.items()},
            findings=graph.findings,
            unread=list(graph.sketch.unread),
        )


def answering(folder: Path) -> Callable[[DraftQuestion, Budget], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    pipelines = PipelineService(folder)
    return lambda question, _: encoded(pipelines.told(question))
