"""`check`: whether a model can be used, and what is suspicious in it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from sequence_planner.analysis.guard_documents import Document
from sequence_planner.analysis.report import FindingDocument, error_document, findings_of
from sequence_planner.analysis.store import content_key, read, write
from sequence_planner.cli.analysing import (
    USUAL_DEADLINE,
    Deadline,
    DeadlinePassed,
    Found,
    Limits,
    checked,
    counts_line,
    finding_document,
    finding_lines,
    within,
)
from sequence_planner.cli.loading import LoadedModel, load_model
from sequence_planner.cli.options import (
    FINDINGS,
    UNUSABLE,
    USUAL_MEMORY,
    AnyModel,
    AsJson,
    Memory,
    print_json,
    refuse,
)
from sequence_planner.core.numerals import counted

if TYPE_CHECKING:
    from sequence_planner.model.source import Finding

STAGES = "stages"  # the folder of a model's own Python, of which nobody knows what it goes by


class Told(Document):
    """The answer of `check` about a model: its findings, and what it is like, for programs and for people."""

    findings: list[FindingDocument]
    summary: dict[str, object]
    questions: list[str]
    untitled: list[str]
    line: str


@dataclass(frozen=True)
class Checked:
    """The findings in a model that can be used."""

    model: LoadedModel
    findings: list[FindingDocument]
    found: Found


def check(
    model: AnyModel,
    deadline: Deadline = USUAL_DEADLINE,
    memory: Memory = USUAL_MEMORY,
    emulator: Annotated[
        bool, typer.Option("--emulator", help="Emulated devices must be possible, as for `run --emulator`.")
    ] = False,
    runs: Annotated[
        bool, typer.Option("--runs", help="Print also long runs that show something, step by step.")
    ] = False,
    titles: Annotated[
        bool, typer.Option("--titles", help="Print what has no title, and what people read in its place.")
    ] = False,
    json: AsJson = False,
) -> None:
    """Check a model: its documents, its pipelines, that its specifications can be met, and what is suspicious in it.

    The examples of the pipelines are carried out; one that fails is an error.
    Errors make a model unusable: they go to standard error, and the exit code is 2. Warnings, also that the
    specifications cannot be met, go to standard output, and the exit code is 1. Without either it is 0.
    A trace shows how something comes about, step by step; it is indented below the warning. Of one with more than ten
    steps only their number is printed without --runs.
    With --titles it says where a title is missing that sentences for people need. That is no warning.
    What is said of several instances of one declaration is one finding, in the words of the model.
    With --json: {model, findings: [{severity, kind, file, line, column, message, members, trace}], summary}; `members`
    are the instances where a finding is about several, and a trace is {initial, forbidden_by, steps: [{kind, names,
    finished, changes, forbidden_by, text}]}, or null.
    """
    limits = Limits(deadline, memory)
    told = _told_before(of := _key(model, emulator)) or _told(model, limits, of, emulator=emulator, json=json)
    if json:
        findings = list(map(finding_document, told.findings))
        print_json({"model": str(model), "findings": findings, "summary": told.summary})
    else:
        lines = [line for each in told.findings for line in finding_lines(each, runs)]
        counts = [counts_line(told.findings)] if told.findings else []
        untitled = told.untitled if titles else []
        typer.echo("\n".join([*lines, *counts, *untitled, *told.questions, told.line]))
    if told.findings:
        raise typer.Exit(FINDINGS)


def _key(model: Path, emulator: bool) -> str | None:
    """Return a key to what was checked; None where the same may be found otherwise another time."""
    content = None if (model / STAGES).exists() else content_key(model)
    return None if content is None else f"{content}{'-emulator' if emulator else ''}"


def _told_before(of: str | None) -> Told | None:
    return None if of is None else read(of, Told)


def _told(model: Path, limits: Limits, of: str | None, *, emulator: bool, json: bool) -> Told:
    """Return what is found now; it is kept if that is all, and nobody has changed the model meanwhile."""
    from sequence_planner.model.source import ModelError  # noqa: PLC0415

    try:
        found = check_model(model, limits, emulator=emulator)
    except ModelError as error:
        if json:
            findings = [unusable(each) for each in error.findings]
            print_json({"model": str(model), "findings": findings, "summary": None})
        else:
            typer.echo(str(error), err=True)
        raise typer.Exit(UNUSABLE) from error
    told = Told(
        findings=found.findings,
        summary=_summary(found),
        questions=_question_lines(found),
        untitled=[*_untitled_lines(found)],
        line=_summary_line(found),
    )
    if of is not None and found.found.unfinished is None and of == _key(model, emulator):
        write(of, told)
    return told


def check_model(path: Path, limits: Limits, *, emulator: bool = False) -> Checked:
    """All that is found in a model within `limits`. Raises `ModelError` when it cannot be used, and where its devices
    are to be emulated for what keeps them from it.
    """
    # Of a model that was checked before, what was found is told without them.
    from sequence_planner.analysis.checks.warning import ModelWarning, place  # noqa: PLC0415
    from sequence_planner.model.launch_requirements import StartNeeds  # noqa: PLC0415
    from sequence_planner.model.source import ModelError  # noqa: PLC0415
    from sequence_planner.simulation.start_findings import start_findings  # noqa: PLC0415

    try:
        with within(limits.left):
            model = load_model(path)
            station = model.station
            wrong = [] if station is None else station.failures() or start_findings(station, StartNeeds(emulator))
            if wrong:
                raise ModelError(wrong)
    except DeadlinePassed:
        refuse(f"{path}: it could not be read within {limits.deadline:g} s: allow more with --deadline", FINDINGS)
    automaton = model.automaton
    found = checked(automaton, model.connections, limits)
    suspicious = list(found.suspicious)
    if found.unfinished is not None:
        where = place(automaton, *automaton.specifications, "rest")
        suspicious.append(ModelWarning(where, "not-finished", found.unfinished))
    written = [] if station is None else station.suspicions()
    findings = [*findings_of(automaton, suspicious, written), *(found.document.findings or ())]
    return Checked(model, sorted(findings, key=lambda each: (each.file, each.line, each.column, each.kind)), found)


def unusable(finding: Finding) -> dict[str, object]:
    """A finding that makes a model unusable, as a document."""
    return finding_document(error_document(finding))


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
        "questions": None if (questions := checked.found.questions) is None else asdict(questions),
        "guarded_abilities": None if (guarded := _guarded(checked)) is None else sorted(guarded),
    }


def _question_lines(checked: Checked) -> list[str]:
    """Say how many questions are answered, where not everything is always possible."""
    questions = checked.found.questions
    if questions is None or not questions.impossible + questions.open:
        return []
    what = (
        ("start or operation", "starts and operations")
        if checked.model.station
        else ("event or goal", "events and goals")
    )
    number = counted(questions.possible + questions.impossible + questions.open, *what)
    return [f"{number}: {questions.possible} always possible, {questions.impossible} not, {questions.open} not known"]


def _untitled_lines(checked: Checked) -> Iterator[str]:
    """Say what of a station has no title; of a plain automaton nobody reads sentences at a station."""
    from sequence_planner.automaton.lifting.untitled import untitled_names  # noqa: PLC0415

    if checked.model.station is not None:
        for each in untitled_names(checked.model.automaton):
            yield f"{each.place}: `{each.name}` has no title: people read “{each.told}”"


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
