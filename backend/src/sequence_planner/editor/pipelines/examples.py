"""Examples of draft pipelines: run, trial, record from a live station, and preview of edits."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import cast

from pydantic import JsonValue, ValidationError

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.controller.io.monitor import shown
from sequence_planner.editor.draft import applied
from sequence_planner.editor.pipelines.graph import DraftPipelines
from sequence_planner.editor.pipelines.reader import DraftReader
from sequence_planner.editor.pipelines.schemas import (
    DraftPipelineView,
    EntryView,
    Examples,
    LeftOutView,
    Preview,
    PreviewView,
    Recording,
    RecordingView,
    RunEdgeView,
    RunStepView,
    RunsView,
    RunView,
    Soundness,
    Trial,
    ValueView,
)
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.records.record import Record
from sequence_planner.model.documents import ExampleDocument, ExampleStepDocument
from sequence_planner.model.files import Files
from sequence_planner.model.paths import EditError
from sequence_planner.model.source import Finding
from sequence_planner.model.stages.base import Loadable
from sequence_planner.model.validation import findings_of
from sequence_planner.model.yaml.content import content_at
from sequence_planner.model.yaml.reader import EntryPath, YamlDocument
from sequence_planner.pipelines.chain_runtime import message_of
from sequence_planner.pipelines.examples import (
    ExampleMoment,
    GivenError,
    PipelineExample,
    Plain,
    agrees,
    bench_of,
    given_by,
    moment_of,
    plain,
)
from sequence_planner.pipelines.graph import Flow, IncomingPipeline, Joining, OutgoingPipeline
from sequence_planner.texts.message import Message, message

# What edits of a draft would bring about, before anybody makes them.

_LINE = re.compile(r'"line":\d+,"column":\d+')
_NUMBER = re.compile(r"stage \d+|line \d+|:\d+:\d+")


def preview(number: int, graph: DraftPipelines, files: Files, reader: DraftReader, question: Preview) -> PreviewView:
    """Return what would be otherwise; `reader` has read `files`, of which `graph` is made."""
    try:
        after = DraftPipelines(reader.beside().sketch(applied(files, question.edits)))
    except EditError as error:
        return PreviewView(number=number, refused=str(error), pipelines={}, gone=[], types={}, findings=[])
    before = {id_: _elsewhere(view) for id_, view in graph.pipelines.items()}
    changed = {id_: view for id_, view in after.pipelines.items() if _elsewhere(view) != before.get(id_)}
    return PreviewView(
        number=number,
        refused=None,
        pipelines=changed,
        gone=[id_ for id_ in graph.pipelines if id_ not in after.pipelines],
        types=after.types,
        findings=new_findings(graph, after),
    )


def _elsewhere(view: DraftPipelineView) -> str:
    """A pipeline without the lines in which it stands."""
    return _LINE.sub("", view.model_dump_json())


def new_findings(before: DraftPipelines, after: DraftPipelines) -> list[FindingDocument]:
    """Return what is found that was not there before, wherever it stands now."""
    known = Counter(map(_said, all_findings(before)))
    found = []
    for finding in all_findings(after):
        if known[_said(finding)] > 0:
            known[_said(finding)] -= 1
        else:
            found.append(finding)
    return found


def all_findings(graph: DraftPipelines) -> list[FindingDocument]:
    """Everything that is wrong."""
    found = list(graph.findings)
    for view in graph.pipelines.values():
        found += view.findings
        for stage in view.stages:
            found += stage.findings
        for source in view.sources:
            found += source.findings
    return found


def _said(finding: FindingDocument) -> tuple[str, str]:
    """A finding without what other lines and stages make of it."""
    return finding.file, _NUMBER.sub("", finding.message)


# Pipelines of a draft run on their own, in time that is told: their examples, and what somebody tries.


def pipeline_of(graph: DraftPipelines, id_: str) -> DraftPipelineView:
    """A pipeline. Raises `EditError` where there is none."""
    found = graph.pipelines.get(id_)
    if found is None:
        raise EditError(message("edit.no-pipeline", name=id_))
    return found


def obstacle(graph: DraftPipelines, view: DraftPipelineView) -> str | None:
    """Say why a pipeline cannot be run."""
    chain = graph.sketch.built.chains.get(view.name)
    if view.id != view.name or chain is None or not chain.is_sound or view.standing is Soundness.UNKNOWN:
        found = [each for stage in view.stages for each in stage.findings] or view.findings
        return found[0].said or found[0].message if found else message("obstacle.before")
    for stage in chain.stages:
        if isinstance(stage, Loadable) and (trouble := stage.loading_trouble()) is not None:
            return trouble
    return None


def run_examples(number: int, graph: DraftPipelines, question: Examples) -> RunsView:
    """Tell how examples end."""
    view = pipeline_of(graph, question.pipeline)
    chosen = [index for index, each in enumerate(view.examples) if question.name in (None, each.name)]
    if question.name is not None and not chosen:
        names = [each.name for each in view.examples]
        raise EditError(f"`{view.id}` has no example “{question.name}”{suggestion(question.name, names)}")
    what = obstacle(graph, view)
    return _runs(number, view, what, [] if what is not None else [run_example(graph, view, each) for each in chosen])


def _runs(number: int, view: DraftPipelineView, what: str | None, runs: list[RunView]) -> RunsView:
    said = what if isinstance(what, Message) else None
    return RunsView(number=number, pipeline=view.id, obstacle=what, obstacle_message=said, runs=runs)


def run_example(graph: DraftPipelines, view: DraftPipelineView, index: int) -> RunView:
    """Tell how an example ends that is written in the draft."""
    document = graph.sketch.documents[view.place.file]
    path: EntryPath = (*view.place.path, "examples", index)
    return run_written(graph, view, content_at(document.content, path), document, path, view.examples[index].place)


def run_written(
    graph: DraftPipelines,
    view: DraftPipelineView,
    content: object,
    document: YamlDocument,
    path: EntryPath,
    place: EntryView | None,
) -> RunView:
    """Tell how an example ends, `content` as it stands or could stand at the `path` of a document."""
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


def run_trial(number: int, graph: DraftPipelines, question: Trial) -> RunsView:
    """Results of these records."""
    view = pipeline_of(graph, question.pipeline)
    what = obstacle(graph, view)
    return _runs(number, view, what, [] if what is not None else [_tried(graph, view, question)])


def _tried(graph: DraftPipelines, view: DraftPipelineView, question: Trial) -> RunView:
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
    graph: DraftPipelines, view: DraftPipelineView, steps: Sequence[ExampleStepDocument], given: Sequence[Plain | None]
) -> Iterator[ExampleMoment]:
    """Yield what has come by each step. Raises `GivenError`."""
    sketch = graph.sketch
    bench = bench_of(view.name, sketch.built.pipelines, sketch.automaton, sketch.registry)
    try:
        for step, each in zip(steps, given, strict=True):
            yield moment_of(bench, step.at, each)
    finally:
        bench.chain.close()


def _step(
    view: DraftPipelineView, step: ExampleStepDocument, given: Plain | None, moment: ExampleMoment
) -> RunStepView:
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
    """Return what came, and what was expected; what is not there came as unknown."""
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


# Examples made of what a running station has heard or said.

LONGEST = 20_000  # characters of an example as JSON


def recorded(graph: DraftPipelines, question: Recording) -> RecordingView:
    """The example that a record makes: what was given, and of what came of it whatever comes of it in the draft too.

    Raises `EditError` where there is none.
    """
    view = pipeline_of(graph, question.pipeline)
    if view.examples_path is None:
        raise EditError("examples are of topics and flows, and this is a part of a service or of an action")
    if any(each.name == question.name for each in view.examples):
        raise EditError(f"`{view.id}` has an example “{question.name}” already: choose another name")
    if (why := obstacle(graph, view)) is not None:
        raise EditError(message("edit.pipeline-unusable", why=why))
    made = graph.sketch.built.pipelines
    node = made.outgoing.get(view.name) or made.node(view.name)
    given = _given(graph, node, question.first)
    came = _came(graph, view.name, given)
    station = _station(node, question.last)
    gives = {name: value for name, value in station.items() if name in came and agrees(came[name], value)}
    left_out = [
        LeftOutView(name=name, station=shown(value), draft=shown(came.get(name)))
        for name, value in station.items()
        if name not in gives
    ]
    if not gives:
        said = "of this record alone comes nothing in the draft that came of it on the station"
        raise EditError(f"{said}: write an example with `steps` instead")
    example: dict[str, JsonValue] = {"name": question.name, "given": given, "gives": gives}
    if (length := len(json.dumps(example))) > LONGEST:
        raise EditError(f"the record is too large for an example: it has {length} characters, at most {LONGEST}")
    return RecordingView(file=view.place.file, path=view.examples_path, example=example, left_out=left_out)


def _given(
    graph: DraftPipelines, node: IncomingPipeline | OutgoingPipeline | Flow, first: Mapping[str, JsonValue]
) -> dict[str, JsonValue]:
    """Return what an example gives, without what is as it is by itself."""
    known: dict[str, JsonValue] = {name: value for name, value in first.items() if value is not None}
    match node:
        case Flow(joining=Joining.MERGE):
            aliases: dict[str, JsonValue] = {}
            for name, value in known.items():
                alias, _, rest = name.partition(".")
                within = aliases.setdefault(alias, {})
                assert isinstance(within, dict)
                within[rest] = value
            return aliases
        case Flow():
            return known
        case OutgoingPipeline():
            initial = {name: graph.sketch.automaton.variables[full].initial for name, full in node.read.items()}
            return {name: value for name, value in known.items() if initial.get(name) != value}
    if (path := _not_finite(first)) is not None:
        raise EditError(f"{path.lstrip('.')} is not finite: write an example with `.nan` or `.inf` by hand instead")
    registry, type_name = graph.sketch.registry, node.topic.type_name
    usual = registry.decode(type_name, registry.encode(type_name, {}))
    return {name: value for name, value in known.items() if not agrees(usual.get(name), value)}


def _not_finite(value: JsonValue | Mapping[str, JsonValue], path: str = "") -> str | None:
    """Say where a message has a number that JSON has not; messages have no unknown values."""
    match value:
        case None:
            return path
        case Mapping():
            parts = ((f"{path}.{name}", each) for name, each in value.items())
        case list():
            parts = ((f"{path}[{index}]", each) for index, each in enumerate(value))
        case _:
            return None
    return next((found for at, each in parts if (found := _not_finite(each, at)) is not None), None)


def _came(graph: DraftPipelines, name: str, given: Plain | Mapping[str, JsonValue]) -> Plain:
    sketch = graph.sketch
    bench = bench_of(name, sketch.built.pipelines, sketch.automaton, sketch.registry)
    try:
        return moment_of(bench, 0.0, dict(given)).came
    except GivenError as error:
        raise EditError(f"the draft does not take the record: {error}") from error
    finally:
        bench.chain.close()


def _station(
    node: IncomingPipeline | OutgoingPipeline | Flow, last: Mapping[str, JsonValue] | None
) -> dict[str, JsonValue]:
    """Return what the station had at the end: variables or other fields that were given, or fields of the message."""
    if isinstance(node, OutgoingPipeline):
        # What it puts together are values of `last`, and so JSON.
        return cast("dict[str, JsonValue]", message_of(node, Record(dict(last or {}))))
    names = [each.field for each in node.writings]
    if not names:
        names = list(dict.fromkeys(name for stage in node.chain.stages for name in stage.gives)) or list(node.chain.end)
    return {name: (last or {}).get(name) for name in names}
