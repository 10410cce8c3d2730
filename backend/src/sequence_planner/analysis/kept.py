"""What synthesis finds of a model, kept for the next look at it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from sequence_planner.analysis.analysis import COUNTING, Analysis
from sequence_planner.analysis.checks.feasibility import UNKNOWN
from sequence_planner.analysis.finding import guards_of, known_evidence, without_numbers
from sequence_planner.analysis.report import AnalysisDocument, document_of
from sequence_planner.analysis.store import key, known_supervisor, read, write
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.planning.problem import Plan
from sequence_planner.synthesis.guards import SupervisorGuard
from sequence_planner.synthesis.supervisor import alike


def documents(automaton: Automaton) -> Iterator[AnalysisDocument]:
    """Yield what is found without numbers of states, each time more of it; all of it at once where it is kept.

    It is kept but for what is unknown only as nobody looked far, which is done where answers from before help.
    """
    if (kept := read(key(automaton), AnalysisDocument)) is not None:
        yield kept
        return
    evidence = known_evidence(automaton)  # of what `check` has answered from afar: then it is soon proven again
    for found in without_numbers(automaton, far=evidence is not None, evidence=evidence):
        if found.reached is not None:  # or else the guards may be longer ones than who compares models would find
            _keep(automaton, found)
        document = document_of(automaton, found)
        if found.pending == COUNTING:
            document = document.model_copy(update={"pending": None, "pending_message": None})
        if document.pending is None and all(each.kind != UNKNOWN for each in document.findings or ()):
            write(key(automaton), document)
        yield document


@dataclass(frozen=True)
class KeptGuards:
    """A supervisor with all that it adds to starts, and the states that are reached with it, if these are known."""

    supervisor: Supervisor
    guards: Mapping[str, SupervisorGuard]
    reached: StateSet | None


@dataclass(frozen=True)
class KeptPlans:
    """The shortest plans of operations from the initial state, by name; None where there is none."""

    plans: Mapping[str, Plan | None]


def with_guards(automaton: Automaton, other: Automaton | None = None) -> Analysis:
    """Return the supervisor of a model with its guards, kept or found now; without one, the warnings that say why.

    They are always found in the same way, so that those of two models can be compared: a check may have longer ones.
    Where those of an `other` model are kept that differs in nothing that bears on safety, they are the same.
    """
    of = key(automaton)
    kept = read(of, KeptGuards)
    if kept is None and other is not None and alike(other, automaton):
        kept = read(key(other), KeptGuards)
        if kept is not None:
            write(of, kept)
    if kept is not None:
        return Analysis(None, supervisor=kept.supervisor, guards=kept.guards, reached=kept.reached)
    *_, found = guards_of(automaton, frozenset(automaton.abilities), known_supervisor(automaton))
    _keep(automaton, found)
    return found


def with_supervisor(automaton: Automaton) -> Analysis:
    """Return the supervisor of a model, kept or found now, with none of its guards; without one, the warnings that say
    why.
    """
    known = known_supervisor(automaton)
    if known is None and (kept := read(key(automaton), KeptGuards)) is not None:
        known = kept.supervisor
    if known is not None:
        return Analysis(None, supervisor=known)
    *_, found = guards_of(automaton, frozenset())
    if found.supervisor is not None:
        write(key(automaton), found.supervisor)
    return found


def _keep(automaton: Automaton, found: Analysis) -> None:
    if found.supervisor is not None and found.guards is not None:
        write(key(automaton), KeptGuards(found.supervisor, found.guards, found.reached))
