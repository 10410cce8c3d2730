"""How `identity` says no."""

from __future__ import annotations


class IdentityRefused(Exception):
    """What was asked for is not done, and nothing has changed.

    `slug` names the kind of problem for machines (the `type` of RFC 9457), `detail` says to a person what to do;
    `status` is the HTTP status that says the same, `retry_after` the seconds after which to try again makes sense.
    """

    def __init__(
        self, slug: str, title: str, detail: str, status: int = 409, *, retry_after: int | None = None
    ) -> None:
        super().__init__(detail)
        self.slug = slug
        self.title = title
        self.detail = detail
        self.status = status
        self.retry_after = retry_after
