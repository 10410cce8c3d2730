"""Answers to questions about the pipelines of a draft, in a process of its own: Python stages run beside it."""

from __future__ import annotations

import contextlib
from functools import cached_property, partial
from multiprocessing.connection import Connection
from pathlib import Path

from sequence_planner.collection import collection_put_off
from sequence_planner.workshop.asking import Changed, answered
from sequence_planner.workshop.bodies import read_body
from sequence_planner.workshop.files import STAGES
from sequence_planner.workshop.pipelines.fitting import fits
from sequence_planner.workshop.pipelines.graph import Graph
from sequence_planner.workshop.pipelines.live import with_live_edges
from sequence_planner.workshop.pipelines.previewing import preview
from sequence_planner.workshop.pipelines.questions import (
    Asked,
    Everything,
    Examples,
    Fitting,
    PipelineAnswer,
    Preview,
    Recording,
    Trial,
)
from sequence_planner.workshop.pipelines.reading import Reader
from sequence_planner.workshop.pipelines.recording import recorded
from sequence_planner.workshop.pipelines.runs import run_examples, run_trial
from sequence_planner.workshop.pipelines.view import DraftPipelinesView


class Version:
    """The files of a model, and what they mean."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True)
        self.folder = folder
        self.files: dict[str, str] = {}
        self.reader = Reader(folder)

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
    def graph(self) -> Graph:
        """Its pipelines."""
        with collection_put_off():
            return Graph(self.reader.sketch(self.files))


class Pipelines:
    """The draft and the model that runs; `folder` is empty and its own."""

    def __init__(self, folder: Path) -> None:
        self._draft = Version(folder / "draft")
        self._running = Version(folder / "running")

    def told(self, asked: Asked) -> PipelineAnswer | tuple[PipelineAnswer]:
        """What is answered, in brackets where it is to stay a view. Raises as `answer` does."""
        found = self.answer(asked)
        return found if asked.as_json else (found,)

    def answer(self, asked: Asked) -> PipelineAnswer:
        """What is answered. Raises `EditError` for what is not there, and `BodyError`."""
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
            resources={name: str(doc.title or name) for name, doc in graph.sketch.station.resources.items()},
            findings=graph.findings,
            unread=list(graph.sketch.unread),
        )


def answering(connection: Connection, folder: Path) -> None:
    """Answer questions until nobody is there any more."""
    pipelines = Pipelines(folder)
    with contextlib.suppress(EOFError, OSError):
        while True:
            asked: Asked = connection.recv()
            connection.send(answered(partial(pipelines.told, asked)))
