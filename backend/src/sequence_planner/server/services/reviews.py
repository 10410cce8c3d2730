"""Verdicts of people on revisions of the model."""

from __future__ import annotations

from sqlalchemy import Connection

from sequence_planner.auth.users import everybody
from sequence_planner.core.actor import Actor, ActorKind
from sequence_planner.editor.talk.approval import approvals_for, standing_verdicts
from sequence_planner.editor.talk.comments import Comment, Verdict, append_verdict, read_verdicts
from sequence_planner.server.services.editor import Workshop
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.texts.message import message
from sequence_planner.texts.refused import Refused


async def review(
    shop: Workshop, identity: IdentityService, revision: str, verdict: Verdict, text: str, by: Actor
) -> Comment:
    """Write what somebody thinks of a revision, and show that they have said it.

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
        return append_verdict(connection, by, draft.number, revision, verdict, text, identity.now())

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
