"""The findings of synthesis about a model, piece by piece: whoever cannot wait for all of it has what there is."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import replace
from math import prod

from sequence_planner.analysis.analysis import COUNTING, FAR, FINDINGS, GUARDS, SAFE, WHY_NONE, Analysis
from sequence_planner.analysis.checks.connections import Connections
from sequence_planner.analysis.checks.evidence import Evidence
from sequence_planner.analysis.checks.rules import CheckProgress, conflicting, looked
from sequence_planner.analysis.checks.supervised import SupervisionQuestion
from sequence_planner.analysis.checks.unmeetable import unmeetable
from sequence_planner.analysis.checks.warning import ModelWarning, place
from sequence_planner.analysis.store import name_key, read
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.synthesis.diagnosis import why_unmeetable
from sequence_planner.synthesis.guards import Restrictions
from sequence_planner.synthesis.supervisor import Supervision, alike, relevant, supervisor
from sequence_planner.synthesis.transition_relation import NodeLimit, Plant, TooMuchError

MOST_COUNTING = 50_000_000  # nodes, see `Effort`: a station that runs has other things to do
_SOON = 2_000_000  # nodes, see `Effort`: whoever waits for guards does not notice


def analyses(
    automaton: Automaton,
    counting: int = MOST_COUNTING,
    far: bool = False,
    guards: bool = True,
    evidence: Evidence | None = None,
) -> Iterator[Analysis]:
    """Yield what is found of `automaton`, again and again, each time more of it.

    No more is spent on `counting` states than so much `NodeLimit`: with 0 they are not counted. Where they soon are,
    their numbers come first. What too many states bear on is found out only with `far`: it can take a minute, so that
    guards come before it; but with `evidence` of the model before an edit it is soon proven again, and is looked at
    first. Without `guards` these are what is left at last.
    """
    found = Analysis(SAFE)
    yield found
    known = evidence.supervisor if evidence is not None and alike(evidence.automaton, automaton) else None
    supervision = Supervision(Plant(automaton, relevant(automaton)), None if known is None else known.safe)
    if not supervision.possible:
        found = replace(found, pending=WHY_NONE)
        yield found
        found = replace(found, warnings=(_unmet(supervision),))
    else:
        found = replace(found, supervisor=known or supervisor(supervision), pending=FINDINGS)
        yield found
        found = _counted(found, supervision, min(counting, _SOON))
        yield found
        asked = SupervisionQuestion(automaton, supervision, evidence)
        made = found.supervisor
        assert made is not None
        if far and evidence is not None:
            asked.look_far(made)
        if asked.left:
            asked.look()
        found = replace(found, warnings=tuple(asked.warnings()), questions=asked.counts)
        if not asked.left:
            found = _bounded(found, automaton, asked.evidence)
        yield found
        restrictions = Restrictions(supervision, of_safe=evidence is not None and evidence.guards_of_safe)
        found = replace(found, guarded=tuple(start for starts in restrictions.starts.values() for start in starts))
        yield replace(found, evidence=None if asked.left else _for_next_time(asked, restrictions))
        if guards:
            found = replace(found, pending=GUARDS)
            yield found
            texts = {name: restrictions.guard(name) for name in restrictions.starts}
            found = replace(found, guards=texts, reached=_reached(supervision, restrictions))
        if far and asked.left:
            found = replace(found, pending=FAR)
            yield found
            asked.look_far(made)
            found = replace(found, warnings=tuple(asked.warnings()), questions=asked.counts)
            found = _bounded(found, automaton, asked.evidence)
            yield replace(found, evidence=_for_next_time(asked, restrictions))
        if not guards:
            yield replace(found, pending=GUARDS)
            return
    found = replace(found, pending=COUNTING)
    yield found
    found = _counted(found, supervision, counting)
    if found.supervisor is not None and found.supervised_states is None and found.supervised_at_most is None:
        found = _bounded(found, automaton, known_evidence(automaton))
    yield replace(found, pending=None)


def without_numbers(
    automaton: Automaton, guards: bool = True, far: bool = False, evidence: Evidence | None = None
) -> Iterator[Analysis]:
    """Yield what is found of `automaton` but for numbers of states, which few wait for; `guards` and `far` where
    wanted.
    """
    for found in analyses(automaton, counting=0, far=far, guards=guards, evidence=evidence):
        yield found
        if found.pending == COUNTING:
            return


def guards_of(automaton: Automaton, names: frozenset[str], known: Supervisor | None = None) -> Iterator[Analysis]:
    """The guards that the supervisor, which may be `known`, adds to the abilities of these names, and nothing else."""
    found = Analysis(SAFE)
    yield found
    supervision = Supervision(Plant(automaton, relevant(automaton)), None if known is None else known.safe)
    if not supervision.possible:
        yield replace(found, pending=None, warnings=(_unmet(supervision),))
        return
    found = replace(found, pending=GUARDS, supervisor=known or supervisor(supervision))
    yield found
    restrictions = Restrictions(supervision)
    wanted = [name for name, starts in restrictions.starts.items() if not names.isdisjoint(starts)]
    texts = {name: restrictions.guard(name) for name in wanted}
    yield replace(found, pending=None, guards=texts, reached=_reached(supervision, restrictions))


def everything(
    automaton: Automaton, connections: Connections | None, synthesis: bool, evidence: Evidence | None = None
) -> Iterator[CheckProgress | Analysis]:
    """Yield what the checks find, and what synthesis finds where it is asked for, without numbers of states and guards.

    What may take longest comes last.
    """
    yield from looked(automaton, connections)
    if synthesis:
        yield from without_numbers(automaton, guards=False, far=True, evidence=evidence)
    yield from conflicting(automaton)


def _reached(supervision: Supervision, restrictions: Restrictions) -> StateSet | None:
    """Return what is reached with the supervisor; None where the guards had to do without."""
    if restrictions.of_safe:
        return None
    return supervision.plant.diagrams.exported(supervision.reachable(supervised=True))


def _unmet(supervision: Supervision) -> ModelWarning:
    automaton = supervision.plant.automaton
    why = why_unmeetable(supervision.plant, supervision.forbidden)
    broken = () if why.trace is None else why.trace.breaks
    return unmeetable(automaton, why, place(automaton, *broken, "rest", *automaton.specifications))


def _counted(found: Analysis, supervision: Supervision, most: int) -> Analysis:
    """With the numbers of states that are not known yet, as far as so much `NodeLimit` goes."""
    if not most or (found.reachable_states is not None and found.supervised_states is not None):
        return found
    effort = NodeLimit(most)
    with contextlib.suppress(TooMuchError):
        whole = _of_all_variables(supervision)
        count = whole.plant.diagrams.count
        if found.reachable_states is None:
            found = replace(found, reachable_states=count(whole.reachable(supervised=False, effort=effort)))
        if found.supervisor is not None:
            found = replace(
                found, supervised_at_most=None, supervised_states=count(whole.reachable(supervised=True, effort=effort))
            )
    return found


def known_evidence(automaton: Automaton) -> Evidence | None:
    """Return what answers about the model of this name rested on when it was last looked at."""
    return read(name_key(automaton), Evidence)


def _for_next_time(asked: SupervisionQuestion, restrictions: Restrictions) -> Evidence | None:
    """Return what answers rest on, for the model after an edit."""
    return None if asked.evidence is None else replace(asked.evidence, guards_of_safe=restrictions.of_safe)


def _bounded(found: Analysis, automaton: Automaton, evidence: Evidence | None) -> Analysis:
    """With what `evidence` of this very automaton says of how many states are reached, where that is not known."""
    if found.supervised_states is not None or evidence is None or evidence.automaton != automaton:
        return found
    if (reached := evidence.reached.get(True)) is None:
        return found
    others = (each for name, each in automaton.variables.items() if name not in reached.names)
    return replace(found, supervised_at_most=reached.count * prod(len(each.type.domain) for each in others))


def _of_all_variables(supervision: Supervision) -> Supervision:
    automaton, diagrams = supervision.plant.automaton, supervision.plant.diagrams
    if len(diagrams.names) == len(automaton.variables):
        return supervision
    return Supervision(Plant(automaton, tuple(automaton.variables)), diagrams.exported(supervision.safe))
