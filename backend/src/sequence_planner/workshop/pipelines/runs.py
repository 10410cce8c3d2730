"""Pipelines of a draft run on their own, in time that is told: their examples, and what somebody tries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from pydantic import ValidationError

from sequence_planner.analysis.document import error_document
from sequence_planner.control.observing import shown
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.model.editing import content_at
from sequence_planner.model.flow_documents import ExampleDocument, ExampleStepDocument
from sequence_planner.model.paths import EditError
from sequence_planner.model.reading import Document, EntryPath
from sequence_planner.model.source import Finding
from sequence_planner.model.validation import findings_of
from sequence_planner.pipelines.benches import GivenError, Plain
from sequence_planner.pipelines.examples import (
    Moment,
    PipelineExample,
    agrees,
    bench_of,
    given_by,
    moment_of,
    plain,
)
from sequence_planner.pipelines.stage import Loadable
from sequence_planner.workshop.pipelines.graph import Graph
from sequence_planner.workshop.pipelines.questions import Examples, Trial
from sequence_planner.workshop.pipelines.view import (
    DraftPipelineView,
    EntryView,
    RunEdgeView,
    RunStepView,
    RunsView,
    RunView,
    Soundness,
    ValueView,
)


def pipeline_of(graph: Graph, id_: str) -> DraftPipelineView:
    """A pipeline. Raises `EditError` where there is none."""
    found = graph.pipelines.get(id_)
    if found is None:
        raise EditError(f"the draft has no pipeline `{id_}`")
    return found


def obstacle(graph: Graph, view: DraftPipelineView) -> str | None:
    """Why a pipeline cannot be run."""
    chain = graph.sketch.built.chains.get(view.name)
    if view.id != view.name or chain is None or not chain.is_sound or view.standing is Soundness.UNKNOWN:
        said = [each.message for stage in view.stages for each in stage.findings] or [
            each.message for each in view.findings
        ]
        return said[0] if said else "what stands before it cannot be used"
    for stage in chain.stages:
        if isinstance(stage, Loadable) and (trouble := stage.loading_trouble()) is not None:
            return trouble
    return None


def run_examples(number: int, graph: Graph, question: Examples) -> RunsView:
    """How examples end."""
    view = pipeline_of(graph, question.pipeline)
    chosen = [index for index, each in enumerate(view.examples) if question.name in (None, each.name)]
    if question.name is not None and not chosen:
        names = [each.name for each in view.examples]
        raise EditError(f"`{view.id}` has no example “{question.name}”{suggestion(question.name, names)}")
    what = obstacle(graph, view)
    runs = [] if what is not None else [run_example(graph, view, index) for index in chosen]
    return RunsView(number=number, pipeline=view.id, obstacle=what, runs=runs)


def run_example(graph: Graph, view: DraftPipelineView, index: int) -> RunView:
    """How an example ends that is written in the draft."""
    document = graph.sketch.documents[view.place.file]
    path: EntryPath = (*view.place.path, "examples", index)
    return run_written(graph, view, content_at(document.content, path), document, path, view.examples[index].place)


def run_written(
    graph: Graph,
    view: DraftPipelineView,
    content: object,
    document: Document,
    path: EntryPath,
    place: EntryView | None,
) -> RunView:
    """How an example ends, `content` as it stands or could stand at the `path` of a document."""
    name = content.get("name") if isinstance(content, dict) else None
    named = None if name is None else str(name)
    try:
        example = ExampleDocument.model_validate(content)
    except ValidationError as error:
        said = findings_of(error, document, path, ExampleDocument)
        return _refused(named, place, "; ".join(each.message for each in said), said)
    sketch = graph.sketch
    run = PipelineExample(view.name, example, sketch.built.pipelines, sketch.automaton, sketch.registry)
    steps: list[RunStepView] = []
    found: list[Finding] = []
    given = [given_by(step) for step in run.steps]
    try:
        for step, moment in zip(run.steps, _moments(graph, view, run.steps, given), strict=True):
            steps.append(_step(view, step, given[len(steps)], moment))
            found += [Finding(key.place, message) for key, message in run.disagreements(step, moment)]
    except GivenError as error:
        message = f"what is given does not fit: {error}"
        return _refused(named, place, message, [Finding(example.name.place, message)], steps)
    return RunView(
        name=named,
        place=place,
        passed=not found,
        refused=None,
        steps=steps,
        findings=[error_document(each) for each in found],
    )


def run_trial(number: int, graph: Graph, question: Trial) -> RunsView:
    """What comes of these records."""
    view = pipeline_of(graph, question.pipeline)
    what = obstacle(graph, view)
    runs = [] if what is not None else [_tried(graph, view, question)]
    return RunsView(number=number, pipeline=view.id, obstacle=what, runs=runs)


def _tried(graph: Graph, view: DraftPipelineView, question: Trial) -> RunView:
    moments = [each.at for each in question.steps]
    if moments != sorted(moments):
        return _refused(None, None, "the steps are to be in the order of time", [])
    documents = [ExampleStepDocument(at=each.at) for each in question.steps]
    given: list[Plain | None] = [None if each.given is None else dict(each.given) for each in question.steps]
    steps: list[RunStepView] = []
    try:
        for step, moment in zip(documents, _moments(graph, view, documents, given), strict=True):
            steps.append(_step(view, step, given[len(steps)], moment))
    except GivenError as error:
        return _refused(None, None, str(error), [], steps)
    return RunView(name=None, place=None, passed=None, refused=None, steps=steps, findings=[])


def _moments(
    graph: Graph, view: DraftPipelineView, steps: Sequence[ExampleStepDocument], given: Sequence[Plain | None]
) -> Iterator[Moment]:
    """What has come by each step. Raises `GivenError`."""
    sketch = graph.sketch
    bench = bench_of(view.name, sketch.built.pipelines, sketch.automaton, sketch.registry)
    try:
        for step, each in zip(steps, given, strict=True):
            yield moment_of(bench, step.at, each)
    finally:
        bench.chain.close()


def _step(view: DraftPipelineView, step: ExampleStepDocument, given: Plain | None, moment: Moment) -> RunStepView:
    return RunStepView(
        at=step.at,
        given=None if given is None else {name: shown(value) for name, value in given.items()},
        values=list(_values(step.gives, moment.came)),
        trouble=moment.trouble,
        edges=[
            RunEdgeView(
                id=edge.id,
                records=passed.records,
                last=None if passed.last is None else {name: shown(value) for name, value in passed.last.items()},
                troubles=list(passed.troubles),
            )
            for edge, passed in zip(view.edges, moment.edges, strict=True)
        ],
    )


def _values(gives: object, came: Plain) -> Iterable[ValueView]:
    """What came, and what was expected; what is not there came as unknown."""
    wanted = {str(key): value for key, value in gives.items()} if isinstance(gives, dict) else {}
    for name in dict.fromkeys((*wanted, *came)):
        expected = plain(wanted.get(name))
        yield ValueView(
            name=name,
            came=shown(came.get(name)),
            expected=shown(expected),
            right=(name in came and agrees(came[name], expected)) if name in wanted else None,
        )


def _refused(
    name: str | None,
    place: EntryView | None,
    why: str,
    findings: list[Finding],
    steps: list[RunStepView] | None = None,
) -> RunView:
    return RunView(
        name=name,
        place=place,
        passed=False if place is not None else None,
        refused=why,
        steps=steps or [],
        findings=[error_document(each) for each in findings],
    )
