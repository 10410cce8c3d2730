"""Actors: a person in a session, a watch, a system with a key, or the program itself."""

from __future__ import annotations

from enum import StrEnum

from pydantic import Field

from sequence_planner.core.data_models import DataModel


class ActorKind(StrEnum):
    """Kind of an actor."""

    PERSON = "person"
    DEMONSTRATION = "demonstration"  # whoever sits at a demonstration; may command emulated devices only
    WATCH = "watch"
    KEY = "key"
    SYSTEM = "system"  # the program itself, as when a demonstration starts production


class Actor(DataModel):
    """Who does something, and from where.

    `id` never changes and is never used again; `name` is what people read. `session` is the public id of a person's
    session, which is what holds control; `address` is that of the other end of the connection.
    """

    kind: ActorKind
    id: str = Field(min_length=1, max_length=200)
    name: str = Field(min_length=1, max_length=200)
    session: str | None = Field(default=None, max_length=200)
    address: str | None = Field(default=None, max_length=200)


SYSTEM = Actor(kind=ActorKind.SYSTEM, id="sequence-planner", name="Sequence Planner")
