"""Transfer of a running station's state to another model (what-if), and its simulated continuation."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import initial_state, synchronise
from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.controller.views.part import View
from sequence_planner.core.immutable import replace
from sequence_planner.editor.schemas.diff import Taken, TransferView
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.types import Value, contains
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.texts.message import Message

# Whether a station in its present state can take another model, and how it gets to where it can.

ADVISING = 5.0  # seconds


def transferred(automaton: Automaton, present: Mapping[str, Value | None]) -> State:
    """The state in which another model begins: what it has in common with the `present` one goes on, if its values are
    those of the model; what is unknown stays so.
    """
    kept = {
        name: present[name]
        for name, declared in automaton.variables.items()
        if name in present and (present[name] is None or contains(declared.type, present[name]))
    }
    return synchronise(automaton, {**initial_state(automaton), **kept})


def transfer(
    old: Automaton | None,
    automaton: Automaton,
    supervisor: Supervisor,
    present: Mapping[str, Value | None],
    running: Collection[str],
    *,
    reset: bool = False,
) -> TransferView:
    """Tell what would come of it, with abilities `running` as the `old` model has them; None for one that cannot be
    used.

    Where the station is `reset` it begins as the model says, and nothing of what runs goes on.
    """
    state = transferred(automaton, {} if reset else present)
    names = dict.fromkeys((*automaton.variables, *present))
    changes = [
        Taken(name=name, before=present.get(name), after=state[name] if name in automaton.variables else None)
        for name in names
        if name not in present or name not in automaton.variables or present[name] != state[name]
    ]
    before = {} if old is None else old.abilities
    going_on = () if reset else running
    under_way = [name for name in going_on if not _same(before.get(name), automaton.abilities.get(name))]
    safe = supervisor.safe.includes(state)
    violated = [
        specification.title
        for specification in automaton.specifications.values()
        if evaluate(specification.forbidden, state) is not False
    ]
    ways: list[list[str]] = []
    if not safe:
        advice = Advisor(automaton, supervisor).advise(AdviceRequest(state, (), deadline=ADVISING))
        ways = [
            [name for _, name in offer.operator_plan.starts]
            for offer in advice.offers
            if offer.operator_plan is not None
        ]
    return TransferView(
        legal=safe and not under_way,
        changes=changes,
        violated=violated,
        under_way=under_way,
        ways=ways,
        obstacle=None,
        obstacle_message=None,
    )


def untransferred(why: Message) -> TransferView:
    """Of a model that no station may run."""
    return TransferView(legal=False, changes=[], violated=[], under_way=[], ways=[], obstacle=why, obstacle_message=why)


def _same(one: Ability | None, other: Ability | None) -> bool:
    """Return whether they are the same but for what people call them."""
    return one is not None and other is not None and replace(one, title="") == replace(other, title="")


# What is shown of how a station would go on with another model.


class Run(View):
    """A run of an ability, in seconds from the beginning; `ended` is null where it was under way at the end."""

    ability: str
    title: str
    resource: str
    started: float
    ended: float | None


class Completed(View):
    """An operation reached its goal, so many seconds from the beginning."""

    operation: str
    title: str
    at: float


class WhatIfView(View):
    """`seconds` were simulated from the values `before` on, to those `after`; null is unknown.

    `safe` says whether it began in a safe state; from another one nothing is started. `active` are the operations under
    way at the end, and `unplanned` says why there was no plan then. `obstacle` says why nothing could be simulated.
    Both have their messages for readers of other languages.
    """

    seconds: float
    safe: bool
    runs: list[Run]
    completed: list[Completed]
    before: dict[str, ShownValue | None]
    after: dict[str, ShownValue | None]
    active: list[str]
    unplanned: str
    unplanned_message: Message | None
    obstacle: str | None
    obstacle_message: Message | None
