"""What the supervisor adds, as a part of a JSON document."""

from __future__ import annotations

from sequence_planner.core.data_models import DataModel


class Document(DataModel):
    """Base of all parts: immutable, and nothing beside what is declared."""


class GuardDocument(Document):
    """What the supervisor adds to the guards of `starts`; `guard` is null when only the states themselves say it.

    Then `blocked` are some conditions wherever one of which holds they must wait, the one nearest to the initial state
    first. `specifications` are those it comes from; with `rest`, some starts must wait because no state of rest could
    be reached any more.
    """

    guard: str | None
    literals: int | None
    starts: list[str]
    specifications: list[str]
    rest: bool
    blocked: list[str]


class LiftedGuard(Document):
    """Guards as they are told to people: of all `starts`, which `index` names where they are instances of one
    declaration, as in `all pair in bolt_pair`. A word of the index stands for the value of each, in `name` too.

    `guard`, `blocked` and `rest` are as those of a `GuardDocument`, and `specifications` are told together in the same
    way.
    """

    name: str
    index: str | None
    starts: list[str]
    guard: str | None
    blocked: list[str]
    specifications: list[str]
    rest: bool
