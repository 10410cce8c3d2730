"""The error that something is not done: its kind for programs, and for people what it is and what to do about it."""

from __future__ import annotations

from sequence_planner.texts.message import Message, as_it_was, message


class Refused(Exception):
    """What was asked for is not done, and nothing has changed.

    `slug` names the kind of problem for machines (the `type` of RFC 9457), `title` and `detail` say it to a person with
    what to do; `status` is the HTTP status that says the same. Without a `title` it is that of its kind, which the
    catalogue has as `refused.` and the slug.
    """

    def __init__(self, slug: str, detail: str, status: int = 409, *, title: str | None = None) -> None:
        Exception.__init__(self, detail)  # one that is something else as well has its own beginning
        self.slug = slug
        self.title: Message = message(f"refused.{slug}") if title is None else as_it_was(title)
        self.detail: Message = as_it_was(detail)
        self.status = status
