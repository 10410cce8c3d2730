"""Routes that attach topics of the network to the draft of the model."""

from __future__ import annotations

import asyncio
import json
import sys
import tempfile
from asyncio.subprocess import PIPE
from pathlib import Path as LocalPath
from typing import Annotated, Any, Literal

from fastapi import Request
from pydantic import BaseModel, ConfigDict, Field, JsonValue
from starlette.concurrency import run_in_threadpool

from sequence_planner.analysis.report import FindingDocument
from sequence_planner.auth.roles import Role
from sequence_planner.core.secrets import environment
from sequence_planner.editor.draft import Edit, WriteText
from sequence_planner.journal.audit import append
from sequence_planner.journal.entry import Entry, Outcome
from sequence_planner.model.files import read_files, write_files
from sequence_planner.model.paths import EditError
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    Actor,
    AnswerModel,
    Identity,
)
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.drafts import refusal, workshop
from sequence_planner.server.services.editor import Workshop
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.texts.message import message

# Attaching a topic of the network to the draft of the model; the station itself goes on as it is.
#
# `sequence-planner attach` does it to a copy of the draft, as a process of its own: it joins the network and checks the
# model without holding the server up. What it has changed there becomes a change of the draft.

LONGEST = 60.0  # seconds
STATUS = {"no-topic": 404, "attached": 409, "not-written": 409}  # of refusals; others are 422

attachments_router = interface("/ros", tags=["ros"], dependencies=[allowed(Role.ENGINEER), JSON_ONLY])


class AttachmentBody(BaseModel):
    """A topic, and the resource that gets it, which may be a new one. Without a direction the network tells it.

    With `dry_run` nothing is changed.
    """

    model_config = ConfigDict(extra="forbid")
    topic: Annotated[str, Field(pattern=r"^(/[A-Za-z_][A-Za-z0-9_]*)+$", max_length=200)]
    resource: Annotated[str, Field(pattern=r"^[A-Za-z_][A-Za-z0-9_]*$", max_length=100)]
    direction: Literal["in", "out"] | None = None
    dry_run: bool = False


class AttachmentAnswer(AnswerModel):
    """What was changed in the draft, as `diff -u` shows it, or would be; and what `check` finds then.

    `made` is false for a dry run, and when one of the findings is an error: the model could not be used afterwards.
    `number` is that of the change of the draft, null where none was made.
    """

    topic: str
    type: str
    direction: Literal["in", "out"]
    resource: str
    made: bool
    number: int | None
    difference: str
    findings: list[FindingDocument]


@attachments_router.post("/attachments", responses=refused(404, 409, 504))
async def attach(body: AttachmentBody, request: Request, identity: Identity, actor: Actor) -> AttachmentAnswer:
    """Enter a topic that is on the network into the draft of the model; what runs does not change before a deployment.

    It is recorded before anything is changed, and again when its outcome is known.
    """
    settings, shop = request.app.state.settings, await workshop(request)
    lock: asyncio.Lock = request.app.state.attaching
    async with lock:
        if body.dry_run:
            return _told((await _tried(shop, settings.transport, body))[0], None)
        details: dict[str, JsonValue] = {"resource": body.resource, "direction": body.direction}
        entry = Entry(actor=actor, action="attach-topic", subject=f"topic {body.topic}", details=details)
        asked = await _record(identity, entry.model_copy(update={"outcome": Outcome.REQUESTED}), by=actor)
        outcome, number = Outcome.FAILED, None
        try:
            answer, edits = await _tried(shop, settings.transport, body)
            outcome = Outcome.REFUSED
            if answer.get("made"):
                number = await shop.change(edits, actor, f"{body.topic} belongs to {body.resource}")
                outcome = Outcome.DONE
        except EditError as error:
            raise refusal(error) from error
        finally:
            await _record(identity, entry.model_copy(update={"outcome": outcome, "about": asked}))
    return _told(answer, number)


async def _tried(shop: Workshop, transport: str, body: AttachmentBody) -> tuple[dict[str, Any], list[Edit]]:
    """Return what the command says of a copy of the draft, and what it has changed there."""
    draft = await shop.open()
    with tempfile.TemporaryDirectory(prefix="sequence-planner-attach-") as scratch:
        folder = LocalPath(scratch) / "model"
        await run_in_threadpool(write_files, draft.files, folder, shop.folder)
        answer = await _run(_arguments(folder, transport, body))
        after = await run_in_threadpool(read_files, folder)
    edits: list[Edit] = [
        WriteText(file=path, was=draft.files.get(path), text=text)
        for path, text in after.items()
        if draft.files.get(path) != text
    ]
    plain: dict[str, Any] = json.loads(json.dumps(answer).replace(f"{folder}/", ""))
    return plain, edits


async def _record(identity: IdentityService, entry: Entry, *, by: Actor | None = None) -> int:
    """Write an entry, if `by` still may act; its number."""
    now = identity.now()
    record = await identity.write(lambda connection: append(connection, entry, now), by=by)
    return record.number


def _told(answer: dict[str, Any], number: int | None) -> AttachmentAnswer:
    if "refused" in answer:
        slug, detail = answer["refused"]["slug"], answer["refused"]["detail"]
        raise ProblemFound(STATUS.get(slug, 422), slug, detail, title=message("refused.attach-refused"))
    return AttachmentAnswer.model_validate({**answer, "number": number})


def _arguments(model: LocalPath, transport: str, body: AttachmentBody) -> list[str]:
    arguments = [str(model), body.topic, "--resource", body.resource, "--transport", transport, "--json"]
    arguments += ["--direction", body.direction] if body.direction else []
    return [*arguments, "--dry-run"] if body.dry_run else arguments


async def _run(arguments: list[str]) -> dict[str, Any]:
    """Return what the command says."""
    command = [sys.executable, "-m", "sequence_planner.cli", "attach", *arguments]
    process = await asyncio.create_subprocess_exec(*command, stdout=PIPE, stderr=PIPE, env=environment())
    try:
        async with asyncio.timeout(LONGEST):
            out, err = await process.communicate()
    except TimeoutError:
        raise ProblemFound(
            504, "attach-timeout", message("refused.attach-timeout.given-up", seconds=f"{LONGEST:g}")
        ) from None
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
    try:
        found: dict[str, Any] = json.loads(out)
    except ValueError:
        raise RuntimeError(f"attach ended with code {process.returncode}: {err.decode(errors='replace')}") from None
    return found
