"""What synthesis finds of a model, as documents that are kept for the next look at it."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.analysis.analysis import COUNTING
from sequence_planner.analysis.checks.feasibility import UNKNOWN
from sequence_planner.analysis.finding import known_evidence, without_numbers
from sequence_planner.analysis.report import AnalysisDocument, document_of
from sequence_planner.analysis.store import key, read, write
from sequence_planner.automaton.automaton import Automaton


def documents(automaton: Automaton) -> Iterator[AnalysisDocument]:
    """Yield what is found without numbers of states, each time more of it; all of it at once where it is kept.

    It is kept but for what is unknown only as nobody looked far, which is done where answers from before help.
    """
    if (kept := read(key(automaton), AnalysisDocument)) is not None:
        yield kept
        return
    evidence = known_evidence(automaton)  # of what `check` has answered from afar: then it is soon proven again
    for found in without_numbers(automaton, far=evidence is not None, evidence=evidence):
        document = document_of(automaton, found)
        if found.pending == COUNTING:
            document = document.model_copy(update={"pending": None})
        if document.pending is None and all(each.kind != UNKNOWN for each in document.findings or ()):
            write(key(automaton), document)
        yield document
