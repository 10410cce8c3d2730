"""The things shown of the difference between two models, and of whether a running station can take another one."""

from __future__ import annotations

from enum import StrEnum

from sequence_planner.controller.views.part import Value, View
from sequence_planner.editor.schemas.draft import OperationConditionView
from sequence_planner.texts.message import Message, message


class Difference(StrEnum):
    """Change of a part."""

    NEW = "new"
    GONE = "gone"
    CHANGED = "changed"


class Changed(View):
    """A property of a part, `before` and `after`, in the words of the models; null is none. Where these are names for
    more, that is `…_expanded`; where they are words of the program, they have messages for readers of other languages.

    Of a condition that both have, `added` are the parts that are new, `dropped` those that are gone.
    """

    part: str
    before: str | None
    after: str | None
    before_message: Message | None
    after_message: Message | None
    before_expanded: str | None
    after_expanded: str | None
    added: list[OperationConditionView]
    dropped: list[OperationConditionView]


class PartDifference(View):
    """A part of the model that is new, gone, or another one; `kind` is what it is, such as `ability`.

    Where the same is so of several instances of a declaration, `members` are all of them, `over` says which they are,
    as in `all pair in bolt_pair`, and a word stands in place of the value of each, in `name` too. `titles` are what
    people call the members.
    """

    kind: str
    name: str
    titles: list[Message]
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
    """An ability that can start in one of the models only: the new one `gains` such a state, or `loses` it; null is not
    known. `gained` and `lost` are the starts after which that is so; null where no run there was found.
    """

    ability: str
    gains: bool | None
    gained: list[str] | None
    loses: bool | None
    lost: list[str] | None


class ComparisonView(View):
    """How two models differ: in their texts, by path as `diff -u` shows it, and in what they do.

    While it is being found out, `doing` is what is compared now, with its message for readers of other languages, and
    what is not known yet is null; it is empty in the end. `seconds` is how long it has taken.

    `guards` are how many abilities the supervisor restricts, before and after, and `states` over how many states it was
    compared what may start where; null where they are not counted. `undecided` are the abilities of which it is not
    proven where they may start, and `unplanned` the operations whose plans are not known to be the shortest ones.

    All that is null in the end where one of them cannot be used; `obstacle` says why.
    """

    text: dict[str, str]
    parts: list[PartDifference] | None
    behaviour: list[BehaviourDifference] | None
    plans: list[PlanDifference] | None
    undecided: list[str] | None
    unplanned: list[str] | None
    guards: tuple[int, int] | None
    states: int | None
    doing: str
    doing_message: Message | None
    seconds: float
    obstacle: str | None
    obstacle_message: Message | None


def comparison_begun(text: dict[str, str]) -> ComparisonView:
    """What is known before the models are read."""
    doing = message("comparing.reading")
    return ComparisonView(
        text=text,
        parts=None,
        behaviour=None,
        plans=None,
        undecided=None,
        unplanned=None,
        guards=None,
        states=None,
        doing=doing,
        doing_message=doing,
        seconds=0.0,
        obstacle=None,
        obstacle_message=None,
    )


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
    obstacle_message: Message | None
