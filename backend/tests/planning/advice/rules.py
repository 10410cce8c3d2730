"""The rules that every proposal after a fault keeps, so that a person can trust what is proposed first."""

from __future__ import annotations

import random
from collections import Counter
from dataclasses import dataclass
from functools import cache

from planning.advice.single_faults import Moment, asked, drawn, main_job
from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import finish, synchronise
from sequence_planner.controller.views.wording import offer_title
from sequence_planner.core.immutable import replace
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import Value
from sequence_planner.planning.recovery.advisor import Advisor
from sequence_planner.planning.recovery.proposals import RecoveryProposal
from sequence_planner.planning.recovery.request import AdviceRequest
from sequence_planner.planning.validation.replay import missing
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.places import MODELS

STATIONS = sorted(path.parent.name for path in MODELS.glob("*/station.yaml"))
ONLY_IF = "Only if you have checked: "


@dataclass(frozen=True)
class Tried:
    """A station with its warm advisor, and the moments of its main job."""

    automaton: Automaton
    supervisor: Supervisor
    advisor: Advisor
    moments: list[Moment]


@cache
def station(name: str) -> Tried:
    """A station of the models."""
    automaton = prepare_station(MODELS / name).automaton
    supervisor = synthesise(automaton)
    return Tried(automaton, supervisor, Advisor(automaton, supervisor), main_job(automaton, supervisor))


def after_a_fault(name: str, seed: str, deadline: float) -> Counter[str]:
    """One fault at a moment of the main job; somebody may have answered for some estimates.

    AssertionError where a proposal breaks a rule.
    """
    chance = random.Random(seed)
    tried = station(name)
    automaton, advisor = tried.automaton, tried.advisor
    moment, fault = drawn(automaton, tried.moments, chance)
    request = asked(automaton, moment, fault)
    estimates = automaton.names(Kind.ESTIMATED)
    answers = frozenset(chance.sample(estimates, chance.randint(0, min(2, len(estimates)))))
    request = replace(request, fixed=answers, deadline=deadline)
    advice = advisor.advise(request)
    for offer in advice.offers:
        keeps_the_rules(automaton, request, offer)
    kinds = [_place(offer) for offer in advice.offers]
    assert kinds == sorted(kinds), kinds
    first = "nothing" if not advice.offers else "only if checked" if kinds[0][0] else str(advice.offers[0].kind)
    return Counter({f"{name}: first {first}": 1, "proposals": len(kinds), f"after: {fault.kind}": 1})


def keeps_the_rules(automaton: Automaton, request: AdviceRequest, offer: RecoveryProposal) -> None:
    """What is said of the product contradicts nobody, is named, and is marked where it says that work is done."""
    values = {change.name: change.new for change in offer.corrections}
    assert not values.keys() & request.fixed, "somebody has answered otherwise"
    title = offer_title(automaton, offer)
    assert all(f"{name} is {print_value(value)}" in title.replace(" to ", " is ") for name, value in values.items())
    after = synchronise(automaton, {**request.state, **values})
    reached = [g.name for g in missing(request.goals, request.state) if holds(g.predicate, after)]
    assert set(reached) <= set(offer.claims)
    assert all(f"{name} is {print_value(value)}" in title for name, value in _noted(automaton, request, offer))
    assert offer.only_if_checked == bool(offer.claims) == title.startswith(ONLY_IF)
    assert not offer.only_if_checked or offer.corrections


def _noted(automaton: Automaton, request: AdviceRequest, offer: RecoveryProposal) -> list[tuple[str, Value]]:
    """What the next tick notes of the product because of what a person does at devices, before anything starts."""
    changes = (*offer.corrections, *offer.physical)
    told = {**request.state, **{change.name: change.new for change in changes}}
    noted = finish(automaton, told).state if offer.physical else told
    values = ((name, noted[name]) for name in automaton.names(Kind.ESTIMATED) if noted[name] != told[name])
    return [(name, value) for name, value in values if value is not None]


def _place(offer: RecoveryProposal) -> tuple[bool, int]:
    done = offer.operator_plan or offer.physical or offer.online or offer.in_service
    return offer.only_if_checked, 0 if not offer.corrections else 1 if done else 2
