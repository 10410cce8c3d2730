"""Verdicts of people on revisions of the model."""

from __future__ import annotations

from pydantic import JsonValue
from sqlalchemy import Connection

from sequence_planner.auth.users import everybody
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.editor.revision import Revision
from sequence_planner.editor.schemas.draft import WaitingRevisionView
from sequence_planner.editor.talk.approval import approvals_for, standing_verdicts
from sequence_planner.editor.talk.comments import Comment, Verdict, append_verdict, read_verdicts
from sequence_planner.journal import audit
from sequence_planner.journal.entry import LONGEST_REASON, LONGEST_SUBJECT, Entry
from sequence_planner.server.services.editor import Workshop
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.texts.message import message
from sequence_planner.texts.refused import Refused

ACTIONS = {
    Verdict.APPROVED: "revision-approved",
    Verdict.CHANGES_REQUESTED: "revision-changes-requested",
    Verdict.WITHDRAWN: "revision-verdict-withdrawn",
}
"""What the record of who did what calls each verdict."""


async def review(
    shop: Workshop, identity: IdentityService, revision: str, verdict: Verdict, text: str, by: Actor
) -> Comment:
    """Write what somebody thinks of a revision, also into the record of who did what, and show that they have said it.

    The server writes both in one transaction: there is no verdict without its record, whether the controller answers
    or not, and where the database cannot be written to there is neither.

    Raises `Refused` for who is no person or has saved it, and where there is no such revision, or nothing to withdraw;
    and `WorkerError`.
    """
    if by.kind is not ActorKind.PERSON:
        raise Refused("not-a-person", message("refused.not-a-person.demonstration"), 403)
    draft, (revisions, _, _) = await shop.open(), await shop.saved()
    known = next((each for each in revisions if each.id == revision), None)
    if known is None:
        raise Refused("no-revision", message("refused.no-revision.look"), 404)
    if known.is_by(by.id):
        raise Refused("same-person", message("refused.same-person.saved", name=known.name), 403)

    def decide(connection: Connection) -> Comment:
        counting = {each.by_id for each in standing_verdicts(known, read_verdicts(connection))}
        if verdict is Verdict.WITHDRAWN and by.id not in counting:
            raise Refused("no-review", message("refused.no-review.withdraw", name=known.name))
        now = identity.now()
        said = append_verdict(connection, by, draft.number, revision, verdict, text, now)
        audit.append(connection, _entry(said, verdict, known, by), now)
        return said

    made = await identity.write(decide, by=by)
    shop.tell_comment(made.number)
    return made


async def approvers(shop: Workshop, identity: IdentityService, revision: str, deployer: Actor) -> list[str]:
    """Return the names of those who have approved a revision, as far as that counts where `deployer` deploys it.

    Raises `WorkerError`.
    """
    verdicts = await identity.read(read_verdicts)
    people = [person.id for person in await identity.read(everybody)]
    found = next((each for each in (await shop.saved())[0] if each.id == revision), None)
    return [] if found is None else [each.by_name for each in approvals_for(found, verdicts, deployer.id, people)]


async def waiting_revision(shop: Workshop, identity: IdentityService, by: Actor) -> WaitingRevisionView | None:
    """Return the revision that the draft is, where another model runs, somebody else than `by` has saved it and nobody
    has given a verdict on it that counts. None for who is no person, and so approves nothing.

    While somebody wants changes it waits for who saved it, and not for an approval. Raises `WorkerError`.
    """
    if by.kind is not ActorKind.PERSON or (edited := await shop.edited_revision()) is None:
        return None
    revision, number = edited
    if revision.is_by(by.id) or standing_verdicts(revision, await identity.read(read_verdicts)):
        return None
    return WaitingRevisionView(id=revision.id, number=number, name=revision.name, by=revision.by, time=revision.time)


def _entry(said: Comment, verdict: Verdict, revision: Revision, by: Actor) -> Entry:
    """Return what the record says of a verdict; of a text that is too long for a reason it has all in its details."""
    details: dict[str, JsonValue] = {"revision": revision.id, "saved_by": revision.by, "comment": said.number}
    if len(said.text) > LONGEST_REASON:
        details["text"] = said.text
    return Entry(
        actor=by,
        action=ACTIONS[verdict],
        subject=f"revision {revision.name}"[:LONGEST_SUBJECT],
        details=details,
        reason=said.text[:LONGEST_REASON] or None,
    )
