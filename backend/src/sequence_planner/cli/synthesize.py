"""`synthesize`: the supervisor of a model, and what it makes of the model."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

import typer

from sequence_planner.analysis.document import AnalysisDocument, GuardDocument
from sequence_planner.automaton.plain.events import NUMBER_SIGN, event_of
from sequence_planner.automaton.structure import Automaton
from sequence_planner.cli.analysing import USUAL_DEADLINE, Deadline, Found, Limits, analysed
from sequence_planner.cli.describing import guard_lines
from sequence_planner.cli.findings import finding_lines
from sequence_planner.cli.loading import usable_automaton
from sequence_planner.cli.options import FINDINGS, USUAL_MEMORY, AnyModel, AsJson, Memory, print_json
from sequence_planner.counting import counted
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import TRUE


def synthesize(
    model: AnyModel, deadline: Deadline = USUAL_DEADLINE, memory: Memory = USUAL_MEMORY, json: AsJson = False
) -> None:
    """Compute the supervisor of a model: how many states can be reached with and without it, and the guards it adds.

    Each guard is added to the one that is written; it holds for the states that can be reached. With --json: {model,
    reachable_states, supervised_states, supervised_at_most, guards: {ability or event: condition}, origins: {...},
    findings: [...], unfinished}; null is what has not been computed, and a guard that only the states themselves say.
    The exit code is 1 when there are findings.
    """
    limits = Limits(deadline, memory)
    automaton = usable_automaton(model)
    found = analysed(automaton, limits, counts=True)
    if json:
        print_json(_document(automaton, found))
    else:
        typer.echo("\n".join(_lines(automaton, found)))
    if found.document.findings or found.unfinished:
        raise typer.Exit(FINDINGS)


def _document(automaton: Automaton, found: Found) -> dict[str, object]:
    document = found.document
    guards = None if document.guards is None else dict(_all_guards(automaton, document.guards))
    return {
        "model": automaton.name,
        "reachable_states": document.reachable_states,
        "supervised_states": document.supervised_states,
        "supervised_at_most": document.supervised_at_most,
        "guards": guards,
        "origins": None if document.guards is None else {n: g.model_dump() for n, g in document.guards.items()},
        "findings": None if document.findings is None else [each.model_dump() for each in document.findings],
        "unfinished": found.unfinished,
    }


def _all_guards(automaton: Automaton, guards: Mapping[str, GuardDocument]) -> Iterator[tuple[str, str | None]]:
    """The guard of each ability or event, in order of declaration; `true` where the supervisor adds none."""
    restricted = {start: name for name, guard in guards.items() for start in guard.starts}
    split = {event_of(name) for name in guards if automaton.one_at_a_time and NUMBER_SIGN in name}
    numbers: Counter[str] = Counter()
    for ability in automaton.abilities.values():
        if ability.restart:
            continue
        event = event_of(ability.name) if automaton.one_at_a_time else ability.name
        numbers[event] += 1
        name = f"{event}{NUMBER_SIGN}{numbers[event]}" if event in split else event
        name = restricted.get(ability.name, name)
        if name in guards:
            yield name, guards[name].guard
        else:
            yield name, print_expression(TRUE)


def _lines(automaton: Automaton, found: Found) -> Iterator[str]:
    document = found.document
    yield f"{automaton.title}: {_counts(document)}"
    yield from _guards(document, "marked" if automaton.one_at_a_time else "rest")
    for finding in document.findings or ():
        yield from finding_lines(finding)
    if found.unfinished is not None:
        yield found.unfinished


def _counts(document: AnalysisDocument) -> str:
    if document.supervised is False:
        return "there is no supervisor"
    bound = document.supervised_at_most
    limited = "" if bound is None else f", at most {bound} of them with the supervisor"
    if document.reachable_states is None and document.pending is None:
        return f"more states can be reached than could be counted{limited}"
    reachable = "? states" if document.reachable_states is None else counted(document.reachable_states, "state")
    if bound is not None:
        return f"{reachable} can be reached{limited}"
    supervised = "?" if document.supervised_states is None else f"{document.supervised_states}"
    return f"{reachable} can be reached, {supervised} of them with the supervisor"


def _guards(document: AnalysisDocument, rest: str) -> Iterator[str]:
    for name, guard in (document.guards or {}).items():
        reasons = [*guard.specifications, *([rest] if guard.rest else [])]
        yield f"  {name}"
        yield from (f"    {line}" for line in guard_lines(guard))
        if reasons:
            yield f"    because of {', '.join(reasons)}"
