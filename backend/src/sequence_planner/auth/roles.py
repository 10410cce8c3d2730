"""Authorization model: roles of people, scopes of API keys, and the refusal raised by `auth`."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.texts.refused import Refused

# How `identity` says no.


class IdentityRefused(Refused):
    """The error that what was asked for is not done, and nothing has changed.

    `retry_after` is the number of seconds after which to try again makes sense.
    """

    def __init__(self, slug: str, detail: str, status: int = 409, *, retry_after: int | None = None) -> None:
        super().__init__(slug, detail, status)
        self.retry_after = retry_after


# What people and systems may do: roles of people, each of which includes those before it, and scopes of keys.


class Role(StrEnum):
    """A person's role; the order is that of the declaration."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    ENGINEER = "engineer"
    ADMINISTRATOR = "administrator"

    def includes(self, other: Role) -> bool:
        """Return whether who has this role may do what `other` may."""
        order = list(Role)
        return order.index(self) >= order.index(other)


class Scope(StrEnum):
    """Role of an API key."""

    READ = "read"  # the station as a viewer sees it
    AUDIT = "audit"  # the record of who did what
    ORDERS_READ = "orders-read"  # job orders, what became of them, and what the station can do
    ORDERS_WRITE = "orders-write"  # store and change job orders, and command them
    METRICS = "metrics"  # figures of the system's own, for those who watch over it
    WEBHOOKS = "webhooks"  # say who is told of events, and where
