"""The things shown of the difference between two models, and of whether a running station can take another one."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.controller.views.part import Value, View


class Difference(StrEnum):
    """Change of a part."""

    NEW = "new"
    GONE = "gone"
    CHANGED = "changed"


class Changed(View):
    """A property of a part, `before` and `after`, in the words of the models; null is none. Where these are names for
    more, that is `…_expanded`.
    """

    part: str
    before: str | None
    after: str | None
    before_expanded: str | None
    after_expanded: str | None


class PartDifference(View):
    """A part of the model that is new, gone, or another one; `kind` is what it is, such as `ability`.

    Where the same is so of several instances of a declaration, `members` are all of them, `over` says which they are,
    as in `all pair in bolt_pair`, and a word stands in place of the value of each, in `name` too.
    """

    kind: str
    name: str
    over: str | None
    members: list[str]
    state: Difference
    parts: list[Changed]


class PlanDifference(View):
    """The starts by which an operation reaches its goal from the initial state; null without it, or a plan."""

    operation: str
    before: list[str] | None
    after: list[str] | None


class BehaviourDifference(View):
    """An ability that can start in one of the models only: after which starts in the one, `gained`, or in the other,
    `lost`; null where there is no such state.
    """

    ability: str
    gained: list[str] | None
    lost: list[str] | None


class ComparisonView(View):
    """How two models differ: in their texts, by path as `diff -u` shows it, and in what they do.

    The rest is null where one of them cannot be used; `obstacle` says why.
    """

    text: dict[str, str]
    parts: list[PartDifference] | None
    behaviour: list[BehaviourDifference] | None
    plans: list[PlanDifference] | None
    obstacle: str | None


class Taken(View):
    """A variable whose value does not go on as it is; `before` is null where it is new, `after` where it is gone."""

    name: str
    before: Value | None
    after: Value | None


class TransferView(View):
    """Whether a station in its present state can take another model: `legal` says that the state is safe there, and
    that what runs now is the same there.

    `changes` are the variables that are new, gone, or of other values; they begin as the model says. Where it is not
    legal, `violated` are the specifications that the state would violate, `under_way` the abilities that run now and
    would go on as other ones or as none, and `ways` the starts, first to last, of ways into the safe states.
    `obstacle` says why no station may run the model at all; null where one may.
    """

    legal: bool
    changes: list[Taken]
    violated: list[str]
    under_way: list[str]
    ways: list[list[str]]
    obstacle: str | None
