"""Supervisor synthesis by fixpoints on decision diagrams, also for a subset of the specifications."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from sequence_planner.automaton.automaton import Automaton, Timeouts
from sequence_planner.automaton.dependencies import cone_of_influence
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.language.syntax import TRUE, Expression, conjunction, conjuncts, variables
from sequence_planner.synthesis.bdd import Function
from sequence_planner.synthesis.diagnosis import Unmeetable, why_unmeetable
from sequence_planner.synthesis.reachability import reachable, reaching
from sequence_planner.synthesis.transition_relation import Nearness, NodeLimit, Plant

# The safe set by fixpoints on decision diagrams, and the supervisor that it makes.
#
# The safe set is the greatest set without forbidden states that nothing uncontrollable leaves, and from each state of
# which a state of rest can be reached inside it, without faults and without restart abilities.


class SynthesisError(Exception):
    """There is no supervisor; the text says why and what to do, the `reason` also for programs."""

    def __init__(self, reason: Unmeetable) -> None:
        super().__init__(reason)
        self.reason = reason

    def __str__(self) -> str:
        return "\n  ".join((self.reason.message, *self.reason.lines))


class Supervision:
    """The safe states of a plant, with and without which it is asked what can be reached.

    `safe` are these, where they have been computed over fewer variables already.
    """

    def __init__(self, plant: Plant, safe: StateSet | None = None) -> None:
        self.plant = plant
        self.forbidden = {
            specification.name: plant.where(specification.forbidden)
            for specification in plant.automaton.specifications.values()
            if plant.says((specification.forbidden,))
        }
        self._reached: dict[bool, Function] = {}
        self.safe = self._greatest_safe() if safe is None else plant.diagrams.imported(safe) & plant.diagrams.valid

    @property
    def possible(self) -> bool:
        """True if there is a supervisor: all initial states are safe."""
        return self.plant.initial & self.safe == self.plant.initial

    def reachable(self, supervised: bool, effort: NodeLimit | None = None) -> Function:
        """The states that the initial ones lead to, with or without the supervisor.

        Raises `TooMuchError` when that takes more than `effort`. They are kept.
        """
        if supervised not in self._reached:
            self._reached[supervised] = self._all_reachable(supervised, effort)
        return self._reached[supervised]

    def _all_reachable(self, supervised: bool, effort: NodeLimit | None) -> Function:
        plant = self.plant
        starts, uncontrollable = plant.all_starts, plant.uncontrollable
        if effort is not None:
            starts, uncontrollable = effort.limited(starts), effort.limited(uncontrollable)
        if not supervised:
            return reachable(plant.diagrams, plant.initial, [*uncontrollable, *starts])
        reached, before = plant.initial, None
        while reached != before:
            before = reached
            # From outside the safe states nothing is started; inside, nothing leads out of them.
            reached = reachable(plant.diagrams, reached, uncontrollable)
            reached |= reachable(plant.diagrams, reached & self.safe, [*uncontrollable, *starts], self.safe)
        return reached

    def guard(self, name: str) -> tuple[Function, Function]:
        """The safe states in which the start `name` may be taken, and those in which only the supervisor forbids it."""
        allowed = disallowed = self.plant.diagrams.false
        if name not in self.plant.starts:  # it changes nothing here
            ability = self.plant.automaton.abilities[name]
            written = (ability.enabled, ability.start_guard)
            return (
                self.plant.where(conjunction(*written)) if self.plant.says(written) else self.safe
            ) & self.safe, allowed
        for step in self.plant.starts[name]:
            allowed |= step.before(self.safe)
            disallowed |= step.before(self.plant.diagrams.valid & ~self.safe)
        return allowed & self.safe, disallowed & self.safe

    def _greatest_safe(self) -> Function:
        plant, diagrams = self.plant, self.plant.diagrams
        safe = diagrams.valid & ~diagrams.disjunction(self.forbidden.values())
        helpful = [*plant.helpful, *plant.all_starts]
        while True:
            unsafe = reaching(diagrams, diagrams.valid & ~safe, plant.uncontrollable)
            inside = diagrams.valid & ~unsafe
            safe = reaching(diagrams, plant.rest & inside, helpful, inside)
            if safe == inside:
                return safe


def synthesise(automaton: Automaton) -> Supervisor:
    """The maximally permissive supervisor of `automaton`. Raises `SynthesisError` if there is none."""
    return supervisor(supervised(automaton))


def tried(automaton: Automaton) -> Iterator[Supervisor | Unmeetable]:
    """The same for another process to hear, or why there is none."""
    try:
        yield synthesise(automaton)
    except SynthesisError as error:
        yield error.reason


def supervised(automaton: Automaton) -> Supervision:
    """The safe states of `automaton`, all initial ones among them. Raises `SynthesisError` if that cannot be."""
    supervision = Supervision(Plant(automaton, relevant(automaton)))
    if not supervision.possible:
        raise SynthesisError(why_unmeetable(supervision.plant, supervision.forbidden))
    return supervision


def supervisor(supervision: Supervision) -> Supervisor:
    """Return what is handed on: the safe set, and for each ability where it allows its start."""
    diagrams = supervision.plant.diagrams
    guards: dict[str, StateSet] = {}
    nearness = Nearness(supervision.plant.automaton, diagrams.names)
    for name in supervision.plant.starts:
        allowed, disallowed = supervision.guard(name)
        if disallowed.satisfiable():
            guards[name] = diagrams.exported(separated(supervision.plant, allowed, disallowed, nearness.around(name)))
    return Supervisor(diagrams.exported(supervision.safe), guards)


def separated(plant: Plant, yes: Function, no: Function, around: Iterable[frozenset[str]]) -> Function:
    """A set over few variables that has all of `yes`, and nothing of `no`, which is apart from it.

    They are sought in the first of the sets `around`, the last of which has all variables, that is enough; there
    variables are left out greedily, the last declared first.
    """
    diagrams = plant.diagrams
    for names in around:
        others = [name for name in diagrams.names if name not in names]
        some_yes, some_no = diagrams.exists(yes, others), diagrams.exists(no, others)
        if not (some_yes & some_no).satisfiable():
            yes, no = some_yes, some_no
            break
    needed = diagrams.support(yes) | diagrams.support(no)
    for name in reversed(list(plant.automaton.variables)):
        if name in needed:
            some_yes, some_no = diagrams.exists(yes, (name,)), diagrams.exists(no, (name,))
            if not (some_yes & some_no).satisfiable():
                yes, no = some_yes, some_no
    return min(yes, diagrams.valid_of(diagrams.support(no)) & ~no, ~no, key=lambda f: f.node_count())


def alike(one: Automaton, other: Automaton) -> bool:
    """Return whether the safe states of both are the same for certain: they differ at most in what does not bear on
    these.
    """
    return _bearing_on_safety(one) == _bearing_on_safety(other)


def _bearing_on_safety(automaton: Automaton) -> Automaton:
    """`automaton` without texts, times, and what it is to do: any operation may become active in any tick anyway."""
    untimed = Timeouts()
    return replace(
        automaton,
        title="",
        description="",
        resources={},
        operations={},
        work_masters={},
        abilities={
            name: replace(each, title="", timeouts=untimed, duration=None, human=None)
            for name, each in automaton.abilities.items()
        },
        effects=tuple(replace(each, shortest=0.0, longest=0.0) for each in automaton.effects),
    )


def relevant(automaton: Automaton) -> tuple[str, ...]:
    """The variables that the safe states depend on."""
    rest = automaton.rest if automaton.rest is not None else TRUE
    return with_initial(automaton, [*(s.forbidden for s in automaton.specifications.values()), rest])


def with_initial(automaton: Automaton, questions: list[Expression]) -> tuple[str, ...]:
    """The variables that can influence `questions`, and those that several initial states relate them to."""
    names = cone_of_influence(automaton, questions)
    for part in conjuncts(automaton.initial or TRUE):
        read = frozenset(variables(part))
        if not read <= set(names) and not read.isdisjoint(names):
            return with_initial(automaton, [*questions, part])
    return names


# Supervisors of some of a station's specifications, for those who ask which of them matter.


class FewerSpecifications:
    """The supervisor of `automaton` with only some of its specifications; `whole` is that of all of them.

    With fewer specifications more states are safe, so there is one whenever there is `whole`. Each is computed once.
    """

    def __init__(self, automaton: Automaton, whole: Supervisor) -> None:
        self._automaton = automaton
        self._known = {frozenset(automaton.specifications): whole}

    def __call__(self, names: frozenset[str]) -> Supervisor:
        """The supervisor of the specifications with these names."""
        if names not in self._known:
            kept = {name: each for name, each in self._automaton.specifications.items() if name in names}
            self._known[names] = synthesise(replace(self._automaton, specifications=kept))
        return self._known[names]
