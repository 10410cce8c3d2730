"""Offers in the words of the people they are shown to."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.along import is_along
from sequence_planner.control.offer_view import (
    EffortView,
    OfferView,
    PlanPreviewView,
    PreviewStepView,
    ValueChangeView,
)
from sequence_planner.control.view import DiagnosisView
from sequence_planner.control.way_back_view import SpecificationView
from sequence_planner.expressions.printing import print_expression, print_value
from sequence_planner.expressions.syntax import TRUE, Expression
from sequence_planner.planning.advice.offer import Change, Offer, OfferKind
from sequence_planner.planning.plan import Plan
from sequence_planner.planning.reasons.diagnosis import Diagnosis, correction_text, member_text

MOST_NAMED = 3  # abilities in a title


def offer_view(automaton: Automaton, offer: Offer, id_: str, revision: int, obstacle: str | None) -> OfferView:
    """An offer as it is shown."""
    return OfferView(
        id=id_,
        revision=revision,
        kind=str(offer.kind),
        title=offer_title(automaton, offer),
        physical=_changes(told(automaton, offer.physical)),
        online=list(offer.online),
        in_service=list(offer.in_service),
        assumed=_changes(offer.assumed),
        corrections=_changes(offer.corrections),
        errand=None if offer.errand is None else plan_preview(automaton, offer.errand),
        ends=None if offer.errand is None else end_text(offer.goal, offer.into_safe),
        into_safe=offer.into_safe,
        operation=offer.operation,
        needs_restart=needs_restart(offer),
        unsupervised=offer.unsupervised,
        at_rest=offer.at_rest,
        breaks=[SpecificationView(name=name, title=automaton.specifications[name].title) for name in offer.breaks],
        then=None if offer.then is None else plan_preview(automaton, offer.then),
        goals=list(offer.goals),
        left_out=list(offer.left_out),
        claims=list(offer.claims),
        records=_changes(offer.records),
        only_if_checked=offer.only_if_checked,
        effort=EffortView(
            cost=offer.effort.cost,
            corrections=offer.effort.changes,
            physical=offer.effort.physical,
            returns=offer.effort.returns,
            starts=offer.effort.starts,
            seconds=offer.effort.seconds,
        ),
        obstacle=obstacle,
    )


def end_text(goal: Expression, into_safe: bool) -> str | None:
    """By what it is known that an errand has come to its end, beside that it is inside the safe states."""
    return None if into_safe and goal == TRUE else print_expression(goal)


def needs_restart(offer: Offer) -> bool:
    """Whether it can be taken in restart mode only: goals and resets by ordinary abilities go without."""
    ordinary = offer.kind in (OfferKind.GOAL, OfferKind.RESET)
    return offer.restart or offer.unsupervised or bool(offer.corrections) or (offer.errand is not None and not ordinary)


def offer_title(automaton: Automaton, offer: Offer) -> str:
    """What is to be done, in one line."""
    text = ", then ".join(_parts(automaton, offer)) or "go on as it is"
    if offer.only_if_checked:
        return f"Only if you have checked: {text}"
    return text[0].upper() + text[1:]


def _parts(automaton: Automaton, offer: Offer) -> Iterator[str]:
    returning = [automaton.resources[name] for name in offer.online]
    returning += [automaton.abilities[name].title for name in offer.in_service]
    if returning:
        yield f"bring {' and '.join(returning)} back"
    if offer.physical:
        records = f", so that {_each(offer.records, 'counts as')}" if offer.records else ""
        yield f"see to it that {_each(told(automaton, offer.physical), 'is')}{records}"
    if offer.only_if_checked:
        yield _each(offer.corrections, "is")
    elif offer.corrections:
        yield f"correct {_each(offer.corrections, 'to')}"
    if offer.operation is not None:
        yield f"reset {automaton.operations[offer.operation].title}"
    elif offer.kind is OfferKind.GOAL:
        yield f"bring about that {print_expression(offer.goal)}"
    elif offer.errand is not None and offer.errand.starts:
        titles = [automaton.abilities[name].title for _, name in offer.errand.starts]
        more = f" and {len(titles) - MOST_NAMED} more" if len(titles) > MOST_NAMED else ""
        yield f"start {', '.join(titles[:MOST_NAMED])}{more}"
    elif offer.errand is not None:
        safe = ["the station is back in its safe states"] if offer.into_safe else []
        condition = end_text(offer.goal, offer.into_safe)
        yield f"wait until {' and '.join([*safe, *([condition] if condition else [])])}"


def told(automaton: Automaton, changes: Iterable[Change]) -> list[Change]:
    """The changes that somebody brings about; the others come along with these."""
    every = list(changes)
    return [each for each in every if not is_along(automaton, each.name, _as_new(each, every))]


def _as_new(change: Change, changes: Iterable[Change]) -> list[str]:
    """The variables that become the same."""
    return [each.name for each in changes if each.new == change.new]


def _each(changes: Iterable[Change], word: str) -> str:
    return " and ".join(f"{change.name} {word} {print_value(change.new)}" for change in changes)


def plan_preview(automaton: Automaton, plan: Plan) -> PlanPreviewView:
    """A plan as it is shown before anybody follows it."""
    return PlanPreviewView(
        ticks=len(plan.ticks),
        steps=[_step(automaton, tick, name) for tick, name in plan.starts],
        minimal_ticks=plan.minimal_ticks,
        minimal_starts=plan.minimal_starts,
    )


def diagnosis_view(
    diagnosis: Diagnosis, out_of_service: Collection[str], answers: Collection[str] = ()
) -> DiagnosisView:
    """Why something cannot be done, and what would help; resources that do nothing can be `out_of_service`.

    Nothing is said otherwise of estimates for which somebody has given `answers`, and what can be done comes first.
    """
    reason, helpful = diagnosis.reason, []
    for correction in diagnosis.corrections:
        said = [change.name for change in correction.changes if change.value is not None]
        if not any(name in answers for name in said):
            text = correction_text(correction, out_of_service)
            helpful.append((bool(said), f"{text}, only if you have checked that it is so" if said else text))
    return DiagnosisView(
        members=[] if reason is None else [member_text(member, out_of_service) for member in reason.members],
        minimal=reason is not None and reason.minimal,
        corrections=[text for _, text in sorted(helpful, key=lambda each: each[0])],
    )


def _step(automaton: Automaton, tick: int, name: str) -> PreviewStepView:
    ability = automaton.abilities[name]
    return PreviewStepView(
        tick=tick,
        ability=name,
        title=ability.title,
        resource=ability.resource,
        human=ability.human is not None,
        restart=ability.restart,
    )


def _changes(changes: Iterable[Change]) -> list[ValueChangeView]:
    return [ValueChangeView(name=change.name, now=change.old, then=change.new) for change in changes]
