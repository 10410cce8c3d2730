"""What an advisor offers: what a person changes, what is done in restart mode, and what production does then."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

from sequence_planner.automaton.structure import Automaton, Kind, State
from sequence_planner.expressions.syntax import TRUE, Expression
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable
from sequence_planner.planning.plan import Plan, PlanTick
from sequence_planner.planning.reasons.diagnosis import Diagnosis

# What each counts for, in seconds: the effort of an offer is the time it takes, and these beside it.
WEIGHTS = {
    "changes": 30.0,  # an estimate that a person looks up at the station and corrects
    "physical": 60.0,  # something that a person does at a device
    "returns": 90.0,  # a resource that a person brings back, or an ability put back into service
    "starts": 2.0,  # a start in restart mode, which a person has confirmed and watches
    "unsupervised": 60.0,  # starts outside the safe states
    "breaks": 300.0,  # a specification that is violated on the way
    "left_out": 600.0,  # a goal that is given up
}


class OfferKind(StrEnum):
    """What an offer asks for, besides what production does then."""

    REPLAN = "replan"  # nothing: production goes on as it is
    RESTART = "restart"  # an errand in restart mode
    RESET = "reset"  # an errand to the precondition of an operation
    CORRECTION = "correction"  # other values of estimates
    PHYSICAL = "physical"  # what only a person can do: at a device, or a resource or an ability back in service
    COMBINED = "combined"  # changes of both kinds, or changes and then an errand
    WAY_BACK = "way-back"  # an errand that begins outside the safe states
    GOAL = "goal"  # an errand that was asked for


class Change(Immutable):
    """A variable has the value `new` instead of `old`, which is None where it is not known."""

    name: str
    old: Value | None
    new: Value


class Effort(Immutable):
    """What an offer costs. `seconds` is how long its errand and then its plan are estimated to take."""

    changes: int = 0
    physical: int = 0  # what a person does at devices; one such act can change several measured variables
    elsewhere: int = 0  # of these acts, where another device is to be helped, or to come back
    returns: int = 0
    starts: int = 0  # of the errand
    seconds: float = 0.0
    left_out: int = 0
    breaks: int = 0
    unsupervised: bool = False

    @property
    def cost(self) -> float:
        """All of it, in seconds; see `WEIGHTS`."""
        return self.seconds + sum(weight * float(getattr(self, name)) for name, weight in WEIGHTS.items())


class Offer(Immutable):
    """A proven way back to work.

    First a person makes the `corrections` of estimates, brings the `physical` changes of measured variables about, and
    brings resources `online` and abilities `in_service`; of those resources it is `assumed` that they say what they
    last said. Then `errand` is carried out in restart mode, by written guards alone as long as the state is outside the
    safe states if it is `unsupervised`, until its `goal` holds; `end` is the state then. From there `then` is a plan
    without restart abilities for `goals`; it is None only where that was not proven for an errand that was asked for.
    `breaks` are specifications that the errand violates on its way although they were not violated before; `at_rest`
    says that it ends in one of the station's safe rest states, with devices that are where they were told to be. The
    corrections alone would have the goals that it `claims` reached, or nearer: that is for somebody to say who has
    checked it. What is done at devices can be what abilities wait for; what these note then it `records`. One
    `into_safe` begins outside the safe states, and is not at its end before it is inside.
    """

    kind: OfferKind
    end: State
    effort: Effort
    corrections: tuple[Change, ...] = ()
    physical: tuple[Change, ...] = ()
    online: tuple[str, ...] = ()
    in_service: tuple[str, ...] = ()
    assumed: tuple[Change, ...] = ()
    errand: Plan | None = None
    goal: Expression = TRUE
    operation: str | None = None
    restart: bool = False
    unsupervised: bool = False
    at_rest: bool = False
    breaks: tuple[str, ...] = ()
    then: Plan | None = None
    goals: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    claims: tuple[str, ...] = ()
    records: tuple[Change, ...] = ()
    into_safe: bool = False

    @property
    def only_if_checked(self) -> bool:
        """Whether it says that work is done which nobody has done."""
        return bool(self.claims)

    @property
    def rank(self) -> tuple[bool, int, bool, float]:
        """What comes first is least: what devices or people do before what is only said, what is done where something
        is wrong before what is done elsewhere, then what takes less.

        What says that work is done comes last, whatever it takes.
        """
        acts = bool(self.errand or self.physical or self.online or self.in_service)
        said = 0 if not self.corrections else 1 if acts else 2
        return self.only_if_checked, said, self.effort.elsewhere > 0, self.effort.cost


class Advice(Immutable):
    """Offers, in the order of their rank; `reasons` where there is none but what somebody has to have checked.

    Where it is `complete`, nothing of what is looked for was left undecided for want of time.
    """

    offers: tuple[Offer, ...]
    reasons: Diagnosis | None
    complete: bool
    seconds: float


def expected_seconds(automaton: Automaton, ticks: Iterable[PlanTick]) -> float:
    """How long a plan takes when each device needs the middle of the time its effects are declared with."""
    takes = {effect.name: (effect.shortest + effect.longest) / 2 for effect in automaton.effects}
    return sum(max((takes[name] for name in tick.effects), default=0.0) for tick in ticks)


def changes_between(automaton: Automaton, before: State, after: State, kind: Kind) -> tuple[Change, ...]:
    """The variables of a kind that have another value afterwards."""
    pairs = ((name, before[name], after[name]) for name in automaton.names(kind))
    return tuple(Change(name, old, new) for name, old, new in pairs if new is not None and new != old)
