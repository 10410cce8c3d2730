"""How a station is to execute, beside its state: what people have asked of it, and what the station has given up.

A value: each change makes a new one, so that a tick that fails leaves no trace, and a snapshot is one object.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any, Final

from sequence_planner.automaton.structure import Automaton, target
from sequence_planner.control.errand import Errand
from sequence_planner.control.jobs import Jobs
from sequence_planner.control.moment import Moment
from sequence_planner.control.vocabulary import Mode, Production, ServiceKind
from sequence_planner.expressions.types import Value
from sequence_planner.immutable import Immutable, replace
from sequence_planner.planning.plan import Circumstances


class Force(Immutable):
    """A forced variable; `real` is what it would be."""

    value: Value
    until: Moment
    by: str
    why: str
    real: Value | None


class OutOfService(Immutable):
    """What is out of service; `by` is None where the station has given an ability up itself."""

    of: ServiceKind
    name: str
    since: Moment
    by: str | None
    why: str


class LastErrand(Immutable):
    """How the last errand has ended, or the trial of an `ability`; `by` names who ended it, None for the station."""

    title: str
    done: bool
    why: str
    ended: Moment
    by: str | None = None
    ability: str | None = None


Service = Mapping[tuple[ServiceKind, str], OutOfService]

NOTHING: Final[Mapping[Any, Any]] = MappingProxyType({})


class Beginning(Immutable):
    """What is known as an execution begins: estimates and outputs that came back, as `values`.

    Nobody has seen since `unconfirmed_since` whether the estimates are still true; None where nothing came back. `done`
    are the operations that do not repeat and have been completed. It goes on in the same mode, with the same jobs, and
    steps as before: who had held the station finds it held. `revision` is higher than any that was shown before, so
    that nobody decides on a state of another life. `answers` are those of `Conduct`.
    """

    values: Mapping[str, Value]
    unconfirmed_since: float | None
    service: tuple[OutOfService, ...]
    done: frozenset[str]
    now: Moment
    mode: Mode = Mode.AUTOMATIC
    stepping: bool = False
    revision: int = 0
    jobs: Jobs = Jobs()
    answers: Mapping[str, Value] = NOTHING

    def as_the_model_says(self) -> Beginning:
        """The same with all variables as the model has them at first, which nobody need confirm."""
        return replace(self, values=NOTHING, unconfirmed_since=None, done=frozenset(), answers=NOTHING)


class Conduct(Immutable):
    """`steps` may be taken while it is `stepping`. `returned` are outputs that came back and nobody has decided on.

    `tried` counts for each ability how often it was called off because it was overdue, since it last did finish.
    `answers` are the estimates that somebody has confirmed or corrected, as they said, until operations go on with
    them.
    """

    mode: Mode = Mode.AUTOMATIC
    production: Production = Production.WAITING
    stepping: bool = False
    steps: int = 0
    service: Service = NOTHING
    forces: Mapping[str, Force] = NOTHING
    errand: Errand | None = None
    last_errand: LastErrand | None = None
    returned: frozenset[str] = frozenset()
    done: frozenset[str] = frozenset()
    tried: Mapping[str, int] = NOTHING
    silent: frozenset[str] = frozenset()  # resources that are not heard
    jobs: Jobs = Jobs()
    answers: Mapping[str, Value] = NOTHING

    @property
    def executes_operations(self) -> bool:
        """Whether operations are planned for and executed, or would be if it were not paused."""
        return self.errand is None and self.mode is not Mode.RESTART

    @property
    def may_start(self) -> bool:
        """Whether it allows any start."""
        if self.production is not Production.STARTED or (self.stepping and not self.steps):
            return False
        if self.errand is None:
            return self.mode is Mode.AUTOMATIC
        return self.mode is Mode.RESTART or (self.mode is Mode.PAUSED and not self.errand.restart)

    def idle_operations(self, automaton: Automaton) -> frozenset[str]:
        """The operations that do not become active."""
        return self.done | self.out_of(ServiceKind.OPERATION) | self.jobs.idle(automaton)

    def out_of(self, kind: ServiceKind) -> frozenset[str]:
        """The names of what is out of service, of one kind."""
        return frozenset(name for of, name in self.service if of is kind)

    def circumstances(self, automaton: Automaton) -> Circumstances:
        """In what plans are made and followed."""
        forced = self.forces.keys() & automaton.outputs
        barred = self.out_of(ServiceKind.ABILITY) | writing(automaton, forced)
        offline = self.silent | self.out_of(ServiceKind.RESOURCE)
        restart = self.errand is not None and self.errand.restart
        return Circumstances(offline=offline, restart=restart, barred=barred)

    def sensing(self, measured: Mapping[str, Value | None]) -> tuple[Mapping[str, Value | None], Conduct]:
        """The measured values as they are forced, and the conduct that keeps what these would be."""
        forced = self.forces.keys() & measured.keys()
        held = {name: self.forces[name].value for name in forced}
        return {**measured, **held} if forced else measured, self._with_real({name: measured[name] for name in forced})

    def keeping(
        self, values: Mapping[str, Value | None], outputs: Iterable[str]
    ) -> tuple[Mapping[str, Value | None], Conduct]:
        """What forced outputs are again after abilities wrote to them; the conduct keeps what they would be."""
        forced = [name for name in self.forces if name in outputs and values[name] != self.forces[name].value]
        held = {name: self.forces[name].value for name in forced}
        return held, self._with_real({name: values[name] for name in forced})

    def _with_real(self, real: Mapping[str, Value | None]) -> Conduct:
        changed = {name: value for name, value in real.items() if self.forces[name].real != value}
        if not changed:
            return self
        return replace(self, forces={**self.forces, **{n: replace(self.forces[n], real=v) for n, v in changed.items()}})

    def without_service(self, gone: Iterable[OutOfService]) -> Conduct:
        """With more out of service."""
        return replace(self, service={**self.service, **{(each.of, each.name): each for each in gone}})

    def started_one(self) -> Conduct:
        """After a start: with stepping, that step has been taken."""
        return replace(self, steps=self.steps - 1) if self.stepping else self


def writing(automaton: Automaton, outputs: Iterable[str]) -> frozenset[str]:
    """The abilities whose starts write one of the outputs."""
    forced = frozenset(outputs)
    if not forced:
        return forced
    return frozenset(
        ability.name
        for ability in automaton.abilities.values()
        if any(target(action) in forced for action in ability.start_actions)
    )
