"""`check`: whether a model can be used, and what is suspicious in it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import typer

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking.checks import check_automaton
from sequence_planner.checking.supervised import check_supervision
from sequence_planner.checking.unmeetable import unmeetable
from sequence_planner.checking.warning import ModelWarning
from sequence_planner.cli.loading import Model, load_model
from sequence_planner.cli.options import FINDINGS, UNUSABLE, AnyModel, AsJson, print_json
from sequence_planner.collection import collection_put_off
from sequence_planner.model.source import ModelError, Place
from sequence_planner.synthesis.supervision import SynthesisError, supervised, supervisor
from sequence_planner.synthesis.traces import Trace


@dataclass(frozen=True)
class Checked:
    """What was found in a model that can be used; no `supervisor` if there is none or it was not computed."""

    model: Model
    warnings: list[ModelWarning]
    supervisor: Supervisor | None


def check(model: AnyModel, json: AsJson = False) -> None:
    """Check a model: its documents, its pipelines, that its specifications can be met, and what is suspicious in it.

    Errors make a model unusable: they go to standard error, and the exit code is 2. Warnings, also that the
    specifications cannot be met, go to standard output, and the exit code is 1. Without either it is 0.
    A trace shows how something comes about, step by step; it is indented below the warning.
    With --json: {model, findings: [{severity, kind, file, line, column, message, trace}], summary}; a trace is
    {initial, forbidden_by, steps: [{kind, names, finished, changes, forbidden_by}]}, or null.
    """
    try:
        checked = checked_model(model, load_model(model))
    except ModelError as error:
        if json:
            findings = [_finding("error", "unusable", each.place, each.message) for each in error.findings]
            print_json({"model": str(model), "findings": findings, "summary": None})
        else:
            typer.echo(str(error), err=True)
        raise typer.Exit(UNUSABLE) from error
    if json:
        findings = [_warning(each, checked.model.automaton) for each in checked.warnings]
        print_json({"model": str(model), "findings": findings, "summary": _summary(checked)})
    else:
        _say(checked.warnings)
        typer.echo(_summary_line(checked))
    if checked.warnings:
        raise typer.Exit(FINDINGS)


@collection_put_off()
def checked_model(path: Path, model: Model) -> Checked:
    """All that can be found in a model that can be used."""
    warnings = check_automaton(model.automaton, model.connections)
    try:
        supervision = supervised(model.automaton)
    except SynthesisError as error:
        place = _specifications(path, model.automaton, error.reason.trace)
        return Checked(model, [*warnings, unmeetable(model.automaton, error.reason, place)], None)
    return Checked(
        model, sorted([*warnings, *check_supervision(model.automaton, supervision)]), supervisor(supervision)
    )


def _specifications(path: Path, automaton: Automaton, trace: Trace | None) -> Place:
    """Where the first specification that a trace breaks is written, or else all; of `rest`, where there are none."""
    broken = trace.breaks if trace is not None else ()
    if broken and broken[0] in automaton.places:
        return automaton.places[broken[0]]
    if path.is_file():
        return Place(str(path), 1, 1)
    file = path / "specifications.yaml"
    return Place(str(file if file.exists() else path / "station.yaml"), 1, 1)


def _say(warnings: Iterable[ModelWarning]) -> None:
    for warning in warnings:
        typer.echo(str(warning))
        if warning.trace is not None:
            for line in _told(warning.trace):
                typer.echo(f"  {line}")


def _told(trace: Trace) -> list[str]:
    """The lines of a trace up to the first state that is forbidden: what comes after it is of less interest."""
    lines = trace.lines()
    until = next((number for number, step in enumerate(trace.steps, start=1) if step.forbidden_by), len(lines))
    left = len(lines) - until
    return lines if left < 2 else [*lines[:until], f"and {left} further steps, which --json shows"]


def _warning(warning: ModelWarning, automaton: Automaton) -> dict[str, object]:
    trace = None if warning.trace is None else warning.trace.to_document(automaton)
    return _finding("warning", warning.kind, warning.place, warning.message, trace)


def _finding(
    severity: str, kind: str, place: Place, message: str, trace: dict[str, object] | None = None
) -> dict[str, object]:
    return {
        "severity": severity,
        "kind": kind,
        "file": place.file,
        "line": place.line,
        "column": place.column,
        "message": message,
        "trace": trace,
    }


def _summary(checked: Checked) -> dict[str, object]:
    automaton, supervisor = checked.model.automaton, checked.supervisor
    return {
        "title": automaton.title,
        "kind": "station" if checked.model.station is not None else "plain automaton",
        "variables": len(automaton.variables),
        "abilities": len(automaton.abilities),
        "effects": len(automaton.effects),
        "operations": len(automaton.operations),
        "specifications": len(automaton.specifications),
        "guarded_abilities": None if supervisor is None else sorted(supervisor.guards),
    }


def _summary_line(checked: Checked) -> str:
    automaton, supervisor = checked.model.automaton, checked.supervisor
    parts = f"{automaton.title}: {len(automaton.variables)} variables, "
    if checked.model.station is None:
        parts += f"{len(automaton.abilities)} controllable and {len(automaton.effects)} uncontrollable transitions"
        what = "transitions"
    else:
        parts += f"{len(automaton.abilities)} abilities, {len(automaton.operations)} operations"
        what = "abilities"
    guarded = "no supervisor" if supervisor is None else f"the supervisor guards {len(supervisor.guards)} {what}"
    return f"{parts}; {guarded}"
