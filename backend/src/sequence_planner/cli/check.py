"""`check`: whether a model can be used, and what is suspicious in it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from sequence_planner.analysis.document import FindingDocument, error_document, findings_of
from sequence_planner.checking.warning import ModelWarning, place
from sequence_planner.cli.analysing import USUAL_DEADLINE, Deadline, Found, Limits, checked, within
from sequence_planner.cli.findings import finding_lines
from sequence_planner.cli.loading import Model, load_model
from sequence_planner.cli.options import FINDINGS, UNUSABLE, USUAL_MEMORY, AnyModel, AsJson, Memory, print_json, refuse
from sequence_planner.counting import counted
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.start_findings import start_findings
from sequence_planner.start_needs import StartNeeds


@dataclass(frozen=True)
class Checked:
    """What was found in a model that can be used."""

    model: Model
    findings: list[FindingDocument]
    found: Found


def check(
    model: AnyModel,
    deadline: Deadline = USUAL_DEADLINE,
    memory: Memory = USUAL_MEMORY,
    emulator: Annotated[
        bool, typer.Option("--emulator", help="Emulated devices must be possible, as for `run --emulator`.")
    ] = False,
    json: AsJson = False,
) -> None:
    """Check a model: its documents, its pipelines, that its specifications can be met, and what is suspicious in it.

    The examples of the pipelines are carried out; one that fails is an error.
    Errors make a model unusable: they go to standard error, and the exit code is 2. Warnings, also that the
    specifications cannot be met, go to standard output, and the exit code is 1. Without either it is 0.
    A trace shows how something comes about, step by step; it is indented below the warning.
    With --json: {model, findings: [{severity, kind, file, line, column, message, trace}], summary}; a trace is
    {initial, forbidden_by, steps: [{kind, names, finished, changes, forbidden_by, text}]}, or null.
    """
    try:
        found = check_model(model, Limits(deadline, memory), emulator=emulator)
    except ModelError as error:
        if json:
            findings = [unusable(each) for each in error.findings]
            print_json({"model": str(model), "findings": findings, "summary": None})
        else:
            typer.echo(str(error), err=True)
        raise typer.Exit(UNUSABLE) from error
    if json:
        findings = [each.model_dump() for each in found.findings]
        print_json({"model": str(model), "findings": findings, "summary": _summary(found)})
    else:
        _say(found)
    if found.findings:
        raise typer.Exit(FINDINGS)


def check_model(path: Path, limits: Limits, *, emulator: bool = False) -> Checked:
    """All that is found in a model within `limits`. Raises `ModelError` when it cannot be used, and where its devices
    are to be emulated for what keeps them from it.
    """
    try:
        with within(limits.left):
            model = load_model(path)
            station = model.station
            wrong = [] if station is None else station.failures() or start_findings(station, StartNeeds(emulator))
            if wrong:
                raise ModelError(wrong)
    except TimeoutError:
        refuse(f"{path}: it could not be read within {limits.deadline:g} s: allow more with --deadline")
    automaton = model.automaton
    found = checked(automaton, model.connections, limits)
    warnings = [*found.suspicious, *([] if station is None else station.suspicions())]
    if found.unfinished is not None:
        where = place(automaton, *automaton.specifications, "rest")
        warnings.append(ModelWarning(where, "not-finished", found.unfinished))
    findings = [*findings_of(automaton, warnings), *(found.document.findings or ())]
    return Checked(model, sorted(findings, key=lambda each: (each.file, each.line, each.column, each.kind)), found)


def _say(checked: Checked) -> None:
    lines = [line for each in checked.findings for line in finding_lines(each)]
    typer.echo("\n".join([*lines, _summary_line(checked)]))


def unusable(finding: Finding) -> dict[str, object]:
    """A finding that makes a model unusable, as a document."""
    return error_document(finding).model_dump()


def _summary(checked: Checked) -> dict[str, object]:
    automaton = checked.model.automaton
    return {
        "title": automaton.title,
        "kind": "station" if checked.model.station is not None else "plain automaton",
        "variables": len(automaton.variables),
        "abilities": len(automaton.abilities),
        "effects": len(automaton.effects),
        "operations": len(automaton.operations),
        "specifications": len(automaton.specifications),
        "guarded_abilities": None if (guarded := _guarded(checked)) is None else sorted(guarded),
    }


def _guarded(checked: Checked) -> set[str] | None:
    """The starts that the supervisor restricts; None if that is not known, or there is none."""
    guarded = checked.found.document.guarded
    return None if guarded is None else set(guarded)


def _summary_line(checked: Checked) -> str:
    automaton = checked.model.automaton
    parts = f"{automaton.title}: {counted(len(automaton.variables), 'variable')}, "
    if checked.model.station is None:
        uncontrollable = counted(len(automaton.effects), "uncontrollable transition")
        parts += f"{len(automaton.abilities)} controllable and {uncontrollable}"
        what = "transition", "transitions"
    else:
        what = "ability", "abilities"
        parts += f"{counted(len(automaton.abilities), *what)}, {counted(len(automaton.operations), 'operation')}"
    if checked.found.document.supervised is False:
        return f"{parts}; no supervisor"
    guarded = _guarded(checked)
    if guarded is None:
        return f"{parts}; what the supervisor guards was not computed"
    return f"{parts}; the supervisor guards {counted(len(guarded), *what)}"
