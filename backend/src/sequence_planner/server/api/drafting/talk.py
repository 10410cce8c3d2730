"""Routes of what engineers say to one another about the draft and its revisions."""

from __future__ import annotations

from typing import Annotated, Self

from fastapi import Path
from pydantic import Field, model_validator

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.editor.schemas.draft import CommentsView, CommentView
from sequence_planner.editor.talk.comments import Comment, Verdict, append_comment, read_comments
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import JSON_ONLY, Actor, Body, Identity
from sequence_planner.server.errors import refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.drafts import HASH, TheWorkshop
from sequence_planner.server.services.reviews import review

MOST_COMMENTS = 200  # that are shown
VIEWER = allowed(Role.VIEWER, scope=Scope.READ)
ENGINEER = allowed(Role.ENGINEER)

router = interface("/model", tags=["model"], responses=refused(409, 503))
Id = Annotated[str, Path(pattern=f"^{HASH}$")]


class CommentBody(Body):
    """What is said of the draft."""

    text: Annotated[str, Field(min_length=1, max_length=5000)]


class ReviewBody(Body):
    """A verdict on a revision. Who wants changes says which."""

    verdict: Verdict
    text: Annotated[str, Field(max_length=5000)] = ""

    @model_validator(mode="after")
    def _says_which(self) -> Self:
        if self.verdict is Verdict.CHANGES_REQUESTED and not self.text.strip():
            raise ValueError("`text` says which changes you want")
        return self


@router.get("/comments", dependencies=[VIEWER])
async def comments(identity: Identity) -> CommentsView:
    """What was said of the draft, the newest 200 comments in the order in which they were made."""
    known = await identity.read(lambda connection: read_comments(connection, MOST_COMMENTS))
    return CommentsView(comments=[_comment_view(each) for each in known])


@router.post("/comments", status_code=201, dependencies=[ENGINEER, JSON_ONLY], responses=refused(422))
async def add_comment(body: CommentBody, shop: TheWorkshop, identity: Identity, actor: Actor) -> CommentView:
    """Say something of the draft to the other engineers; what was said stays."""
    draft, now = await shop.open(), identity.now()
    made = await identity.write(
        lambda connection: append_comment(connection, actor, draft.number, body.text, now), by=actor
    )
    shop.tell_comment(made.number)
    return _comment_view(made)


@router.post(
    "/revisions/{id}/reviews", status_code=201, dependencies=[ENGINEER, JSON_ONLY], responses=refused(403, 404, 422)
)
async def review_revision(id: Id, body: ReviewBody, shop: TheWorkshop, identity: Identity, actor: Actor) -> CommentView:
    """Approve a revision, want changes in it, or withdraw what one has said of it before; of each the last word counts.

    Where the model that runs has `deployment_approval: dual` only a revision is deployed that a person other than who
    saved it has approved, and in which nobody wants changes. 403 `same-person` for who saved it, `not-a-person` for
    a key or a demonstration; 409 `no-review` where there is nothing to withdraw.
    """
    return _comment_view(await review(shop, identity, id, body.verdict, body.text.strip(), actor))


def _comment_view(comment: Comment) -> CommentView:
    return CommentView(
        number=comment.number,
        time=comment.time,
        by=comment.by_name,
        draft=comment.draft,
        text=comment.text,
        revision=comment.revision,
        verdict=comment.verdict,
    )
