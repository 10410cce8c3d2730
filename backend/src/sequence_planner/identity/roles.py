"""What people and systems may do: roles of people, each of which includes those before it, and scopes of keys."""

from __future__ import annotations

from enum import StrEnum


class Role(StrEnum):
    """A person's role; the order is that of the declaration."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    ENGINEER = "engineer"
    ADMINISTRATOR = "administrator"

    def includes(self, other: Role) -> bool:
        """Whether who has this role may do what `other` may."""
        order = list(Role)
        return order.index(self) >= order.index(other)


class Scope(StrEnum):
    """What the bearer of a key may do."""

    READ = "read"  # the station as a viewer sees it
    AUDIT = "audit"  # the record of who did what
    ORDERS_READ = "orders-read"  # job orders, what became of them, and what the station can do
    ORDERS_WRITE = "orders-write"  # store and change job orders, and command them
    METRICS = "metrics"  # figures of the system's own, for those who watch over it
    WEBHOOKS = "webhooks"  # say who is told of events, and where
