"""What edits of a draft would bring about, before anybody makes them."""

from __future__ import annotations

import re
from collections import Counter

from sequence_planner.analysis.document import FindingDocument
from sequence_planner.model.paths import EditError
from sequence_planner.workshop.edits import applied
from sequence_planner.workshop.files import Files
from sequence_planner.workshop.pipelines.graph import Graph
from sequence_planner.workshop.pipelines.questions import Preview
from sequence_planner.workshop.pipelines.reading import Reader
from sequence_planner.workshop.pipelines.view import DraftPipelineView, PreviewView

_LINE = re.compile(r'"line":\d+,"column":\d+')
_NUMBER = re.compile(r"stage \d+|line \d+|:\d+:\d+")


def preview(number: int, graph: Graph, files: Files, reader: Reader, question: Preview) -> PreviewView:
    """What would be otherwise; `reader` has read `files`, of which `graph` is made."""
    try:
        after = Graph(reader.beside().sketch(applied(files, question.edits)))
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


def new_findings(before: Graph, after: Graph) -> list[FindingDocument]:
    """What is found that was not there before, wherever it stands now."""
    known = Counter(map(_said, all_findings(before)))
    found = []
    for finding in all_findings(after):
        if known[_said(finding)] > 0:
            known[_said(finding)] -= 1
        else:
            found.append(finding)
    return found


def all_findings(graph: Graph) -> list[FindingDocument]:
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
