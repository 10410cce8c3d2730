"""`synthesize`: compute the supervisor of a model, and print its guards or the automaton as JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated

import typer

from sequence_planner.analysis.guard_documents import GuardDocument, LiftedGuard
from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.automaton.automaton import Ability, Automaton, Effect
from sequence_planner.automaton.plain.events import NUMBER_SIGN, event_of
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.cli.analysing import (
    USUAL_DEADLINE,
    Deadline,
    Found,
    Limits,
    analysed,
    finding_document,
    finding_lines,
    read_within,
)
from sequence_planner.cli.options import FINDINGS, USUAL_MEMORY, AnyModel, AsJson, Memory, print_json
from sequence_planner.core.numerals import counted
from sequence_planner.language.printer import print_assignment, print_expression
from sequence_planner.language.syntax import TRUE, Assignment, Expression

# An automaton as JSON. Expressions are texts of the language; a variable that is unknown is null.

Json = dict[str, object]


Guards = Mapping[str, GuardDocument]  # by ability


def described_automaton(automaton: Automaton, guards: Guards, chosen: Callable[[str], bool]) -> Json:
    """Those parts whose names are chosen, and the effects of abilities among them; `guards` are what the supervisor
    adds to the starts of abilities.
    """
    reacting = {effect for ability, effects in automaton.reactions.items() if chosen(ability) for effect in effects}
    return {
        "name": automaton.name,
        "title": automaton.title,
        "one_at_a_time": automaton.one_at_a_time,
        "variables": {
            name: {
                "kind": variable.kind.value,
                "type": str(variable.type),
                "domain": list(variable.type.domain),
                "initial": variable.initial,
                "resource": variable.resource,
            }
            for name, variable in automaton.variables.items()
            if chosen(name)
        },
        "abilities": {
            name: _described_ability(ability, guards.get(name))
            for name, ability in automaton.abilities.items()
            if chosen(name)
        },
        "effects": {
            effect.name: _described_effect(effect)
            for effect in automaton.effects
            if chosen(effect.name) or effect.name in reacting
        },
        "operations": {
            name: {
                "title": operation.title,
                "precondition": print_expression(operation.precondition),
                "goal": print_expression(operation.goal),
                "local": _optional(operation.local),
                "priority": operation.priority,
                "repeat": operation.repeat,
            }
            for name, operation in automaton.operations.items()
            if chosen(name)
        },
        "specifications": {
            name: {"title": specification.title, "forbidden": print_expression(specification.forbidden)}
            for name, specification in automaton.specifications.items()
            if chosen(name)
        },
        "work_masters": {
            name: {
                "title": master.title,
                "operations": {step: sorted(before) for step, before in master.operations.items()},
                "alternatives": [[sorted(branch) for branch in branches] for branches in master.alternatives],
                "arbitrary": [[sorted(branch) for branch in branches] for branches in master.arbitrary],
                "brings": _described_actions(master.brings),
            }
            for name, master in automaton.work_masters.items()
            if chosen(name)
        },
        "rest": _optional(automaton.rest),
        "phases": {
            phase.value: [_transition(t) for t in transitions(automaton) if t.phase is phase and chosen(t.name)]
            for phase in Phase
        },
    }


def guard_lines(guard: GuardDocument | LiftedGuard) -> list[str]:
    """Say when the supervisor allows a start, for people."""
    if guard.guard is not None:
        return [guard.guard]
    if not guard.blocked:
        return ["see the states: no short condition says when"]
    return ["no short condition says when; not, among others, where", *(f"  {each}" for each in guard.blocked)]


def added_lines(guard: GuardDocument | LiftedGuard, rest: str = "rest") -> list[str]:
    """Say when the supervisor allows a start, and for what that is; with `rest` as the name of the states of rest."""
    return [*guard_lines(guard), f"(because of {', '.join(_reasons(guard, rest))})"]


def _described_ability(ability: Ability, guard: GuardDocument | None) -> Json:
    human = ability.human
    return {
        "title": ability.title,
        "resource": ability.resource,
        "enabled": print_expression(ability.enabled),
        "start": {"when": print_expression(ability.start_guard), "do": _described_actions(ability.start_actions)},
        "supervisor": None
        if guard is None
        else guard.model_dump(include={"specifications", "rest", "blocked"}) | {"when": guard.guard},
        "executing": print_expression(ability.executing),
        "finished": print_expression(ability.finished),
        "finish": None
        if ability.finish_guard is None
        else {"when": print_expression(ability.finish_guard), "do": _described_actions(ability.finish_actions)},
        "cancel": _described_actions(ability.cancel_actions),
        "restart": ability.restart,
        "moves": ability.moves,
        "human": None if human is None else {"task": human.text, "acknowledgement": human.acknowledgement},
        "timeouts": {
            "react": ability.timeouts.react,
            "finish": ability.timeouts.finish,
            "then": "replan" if ability.timeouts.replan else "alarm",
            "retries": ability.timeouts.retries,
        },
        "duration": ability.duration,
    }


def _described_effect(effect: Effect) -> Json:
    return {
        "resource": effect.resource,
        "kind": effect.kind,
        "when": print_expression(effect.guard),
        "do": _described_actions(effect.actions),
        "takes": [effect.shortest, effect.longest],
        "fault": effect.fault,
    }


def _transition(transition: Transition) -> Json:
    return {"name": transition.name, "reads": sorted(transition.reads), "writes": sorted(transition.writes)}


def _described_actions(actions: Iterable[Assignment]) -> list[str]:
    return [print_assignment(action) for action in actions]


def _optional(expression: Expression | None) -> str | None:
    return None if expression is None else print_expression(expression)


# `synthesize`: the supervisor of a model, and what it makes of the model.


def synthesize(
    model: AnyModel,
    deadline: Deadline = USUAL_DEADLINE,
    memory: Memory = USUAL_MEMORY,
    expanded: Annotated[
        bool, typer.Option("--expanded", help="Print each guard by itself, with all written out that the model names.")
    ] = False,
    json: AsJson = False,
) -> None:
    """Compute the supervisor of a model: how many states can be reached with and without it, and the guards it adds.

    Each guard is added to the one that is written; it holds for the states that can be reached. Guards are told in the
    words of the model: predicates, sets and relations by their names, and those that differ in the value of a parameter
    only as one. With --json: {model, reachable_states, supervised_states, supervised_at_most, guards: {ability or
    event: condition}, origins: {...}, lifted: [...], findings: [...], unfinished}; `guards` and `origins` are written
    out, `lifted` has them as they are told; null is what has not been computed, and a guard that only the states
    themselves say.
    The exit code is 1 when there are findings.
    """
    limits = Limits(deadline, memory)
    automaton = read_within(model, limits)
    found = analysed(automaton, limits, counts=True)
    if json:
        print_json(_document(automaton, found))
    else:
        typer.echo("\n".join(_synthesis_lines(automaton, found, expanded)))
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
        "lifted": None if document.lifted is None else [each.model_dump() for each in document.lifted],
        "findings": None if document.findings is None else list(map(finding_document, document.findings)),
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


def _synthesis_lines(automaton: Automaton, found: Found, expanded: bool) -> Iterator[str]:
    document = found.document
    yield f"{automaton.title}: {_counts(document)}"
    guards = document.guards or {}
    told = guards.items() if expanded else ((_title(each), each) for each in document.lifted or ())
    for title, guard in told:
        yield f"  {title}"
        yield from (f"    {line}" for line in guard_lines(guard))
        if reasons := _reasons(guard, "marked" if automaton.one_at_a_time else "rest"):
            yield f"    because of {', '.join(reasons)}"
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


def _title(guard: LiftedGuard) -> str:
    return guard.name if guard.index is None else f"{guard.name}, for {guard.index}"


def _reasons(guard: GuardDocument | LiftedGuard, rest: str) -> list[str]:
    return [*guard.specifications, *([rest] if guard.rest else [])]
