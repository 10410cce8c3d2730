"""`attach`: from a topic on the network to variables of a model."""

from __future__ import annotations

from dataclasses import dataclass
from dataclasses import replace as replace_fields
from functools import partial
from pathlib import Path
from typing import Annotated, Literal

import typer

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.cli.analysing import Limits, finding_lines
from sequence_planner.cli.model.check import check_model
from sequence_planner.cli.options import UNUSABLE, AsJson, StationFolder, print_json
from sequence_planner.cli.part_options import TransportOption
from sequence_planner.cli.station.controller import Domain, Seconds, look
from sequence_planner.editor.attach import AttachError, Attachment, FoundTopic, attachment, find_topic
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.pipelines.builder import load_messages
from sequence_planner.ros.transport import TransportError

LONGEST_CHECK = 10.0  # seconds for what synthesis finds; `check` takes longer


@dataclass(frozen=True)
class _Answer:
    """The outcome of attaching it. With `errors` the model could not be used afterwards, and has not been changed."""

    topic: FoundTopic
    difference: str
    made: bool
    findings: list[FindingDocument]
    errors: list[Finding]


def attach(
    model: StationFolder,
    topic: Annotated[str, typer.Argument(metavar="TOPIC", help="A topic that is on the network now, as /arm/state.")],
    resource: Annotated[str, typer.Option("--resource", help="The resource that gets it; it may be a new one.")],
    direction: Annotated[
        Literal["in", "out"] | None,
        typer.Option(help="From the device or to it; without it, `in` if somebody publishes the topic."),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only show what would be changed.")] = False,
    transport: TransportOption = "auto",
    domain: Domain = None,
    seconds: Seconds = 5.0,
    json: AsJson = False,
) -> None:
    """Turn a topic of the ROS network into variables of a model: enter it into a resource's document, and check.

    Fields that are truth values or small integers become variables; comments propose stages for others. A message
    type found on the network is written to messages/. A change after which the model could not be used is not made,
    and the exit code is 2; else it is 0, whatever `check` finds suspicious.
    With --json: {topic, type, direction, resource, made, difference, findings}, or {refused: {slug, detail}}.
    """
    try:
        registry = load_messages(load_station(model))
        find = partial(find_topic, registry=registry, name=topic, direction=direction, within=seconds)
        found = look(find, registry, transport, domain)
        answer = _attached(model, attachment(model, registry, found, resource), dry_run)
    except (AttachError, TransportError, ModelError) as error:
        slug = error.slug if isinstance(error, AttachError) else "unusable"
        if json:
            print_json({"refused": {"slug": slug, "detail": str(error)}})
        else:
            typer.echo(str(error), err=True)
        raise typer.Exit(UNUSABLE) from error
    _say(answer, resource, json)


def _attached(model: Path, change: Attachment, dry_run: bool) -> _Answer:
    """Try the change, and make it if the model can be used with it, and it is meant."""
    with change.made_on_copy(model) as (copy, difference):

        def real(file: str) -> str:
            return file.replace(str(copy), str(model))

        try:
            findings = check_model(copy, Limits(LONGEST_CHECK)).findings
        except ModelError as error:
            errors = [
                replace_fields(each, place=each.place._replace(file=real(each.place.file))) for each in error.findings
            ]
            return _Answer(change.topic, difference, False, [], errors)
        findings = [each.model_copy(update={"file": real(each.file)}) for each in findings]
    if not dry_run:
        difference = change.make(model)
    return _Answer(change.topic, difference, not dry_run, findings, [])


def _say(answer: _Answer, resource: str, json: bool) -> None:
    topic = answer.topic
    if json:
        told = {"topic": topic.name, "type": topic.type_name, "direction": topic.direction, "resource": resource}
        findings = [each.model_dump() for each in (*map(error_document, answer.errors), *answer.findings)]
        print_json({**told, "made": answer.made, "difference": answer.difference, "findings": findings})
    else:
        typer.echo(answer.difference, nl=False)
        for finding in answer.findings:
            typer.echo("\n".join(finding_lines(finding)))
        for error in answer.errors:
            typer.echo(str(error), err=True)
        if answer.errors:
            typer.echo("the model could not be used after this change, so it was not made", err=True)
    if answer.errors:
        raise typer.Exit(UNUSABLE)
