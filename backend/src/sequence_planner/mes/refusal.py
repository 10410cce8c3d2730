"""How this room says no."""

from __future__ import annotations

from collections.abc import Sequence

from sequence_planner.mes.states import OrderCommand


class OrderRefused(Exception):
    """What was asked of an order is not done, and nothing has changed.

    `slug`, `title`, `detail` and `status` are as in `control.commands.CommandRefused`; `allowed` are the commands that
    the order does allow, where another one was given.
    """

    def __init__(
        self, slug: str, title: str, detail: str, status: int = 409, *, allowed: Sequence[OrderCommand] = ()
    ) -> None:
        super().__init__(detail)
        self.slug = slug
        self.title = title
        self.detail = detail
        self.status = status
        self.allowed = tuple(allowed)
