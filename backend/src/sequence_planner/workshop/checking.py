"""What is found in a draft: that it cannot be used, or what is suspicious in it and what its supervisor adds.

It is found piece by piece, what needs least time first; whoever waits for all of it sees how far it has come.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from sequence_planner.analysis.analysis import COUNTING
from sequence_planner.analysis.document import FindingDocument, document_of, error_document, findings_of
from sequence_planner.analysis.finding import without_numbers
from sequence_planner.analysis.remembering import remembered_evidence
from sequence_planner.checking.checks import check_automaton
from sequence_planner.collection import collection_put_off
from sequence_planner.model.source import ModelError
from sequence_planner.start_findings import start_findings
from sequence_planner.start_needs import StartNeeds
from sequence_planner.station import prepare_station
from sequence_planner.workshop.check_view import CheckState, CheckView, SummaryView, listed, waiting
from sequence_planner.workshop.files import Files, write_files


def checked(number: int, files: Files, stages: Path | None, start: StartNeeds, folder: Path) -> Iterator[CheckView]:
    """All that is found of the files, again and again, each time more of it: also whether a station that is run as
    `start` says could be started with them. They are written into the empty `folder`, which is also where Python stages
    of the model `stages` are copied to.
    """
    write_files(files, folder, stages)
    with contextlib.chdir(folder):  # so that places bear the names that files have in the model
        begun = waiting(number).model_copy(update={"state": CheckState.CHECKING, "doing": "reading it"})
        yield from _found(begun, start)


def _found(view: CheckView, start: StartNeeds) -> Iterator[CheckView]:
    yield view
    try:
        station = prepare_station(Path())
        if wrong := station.failures() or start_findings(station, start):
            raise ModelError(wrong)
    except ModelError as error:
        errors = [error_document(finding) for finding in error.findings]
        yield view.model_copy(update={"state": CheckState.DONE, "doing": "", "findings": listed(errors)})
        return
    automaton = station.automaton
    summary = SummaryView(
        title=automaton.title,
        variables=len(automaton.variables),
        abilities=len(automaton.abilities),
        operations=len(automaton.operations),
        specifications=len(automaton.specifications),
    )
    view = view.model_copy(update={"summary": summary, "doing": "what is suspicious"})
    yield view
    with collection_put_off():
        warnings = findings_of(automaton, [*check_automaton(automaton, station.connections), *station.suspicions()])
    view = view.model_copy(update={"findings": listed(sorted(warnings, key=_place))})
    evidence = remembered_evidence(automaton)  # of what `check` has answered from afar: then it is soon proven again
    for analysis in without_numbers(automaton, far=evidence is not None, evidence=evidence):
        document = document_of(automaton, analysis)
        found = sorted([*warnings, *(document.findings or ())], key=_place)
        is_all = analysis.pending in (None, COUNTING)
        more = {
            "findings": listed(found),
            "doing": "" if is_all else analysis.pending,
            "state": CheckState.DONE if is_all else CheckState.CHECKING,
            "analysis": document.model_copy(update={"findings": None, "pending": None if is_all else analysis.pending}),
        }
        view = view.model_copy(update=more)
        yield view


def _place(finding: FindingDocument) -> tuple[str, int, int, str]:
    return finding.file, finding.line, finding.column, finding.kind
