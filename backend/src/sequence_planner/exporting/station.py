"""A station as a plain automaton: its ticks by single transitions, exactly (`docs/semantics.md`, "Tick").

In the phase `stable` a state is one after step 3 or after a start: starts are taken there, operations become active or
not, and what is forbidden or marked counts. The uncontrollable `tick` leaves it for the steps of the reaction.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from sequence_planner.automaton.plain.events import NUMBER_SIGN
from sequence_planner.automaton.structure import (
    Ability,
    Automaton,
    Effect,
    Kind,
    Specification,
    VariableDeclaration,
    target,
)
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.exporting.cases import cases, condition_of, leaves, no_dispute
from sequence_planner.exporting.names import different
from sequence_planner.exporting.steps import Step, reaction
from sequence_planner.exporting.together import can_dispute
from sequence_planner.expressions.replacing import Replacements, replaced
from sequence_planner.expressions.simplification import simplify
from sequence_planner.expressions.syntax import (
    FALSE,
    TRUE,
    Assignment,
    Comparison,
    Constant,
    Expression,
    Not,
    Or,
    UnaryTemporal,
    Variable,
    conjunction,
    conjuncts,
)
from sequence_planner.expressions.types import BOOLEAN, EnumerationType, Type, Value


@dataclass(frozen=True)
class Taken:
    """A transition of the plain automaton, under the name of its event."""

    event: str
    controllable: bool
    guard: Expression
    actions: tuple[Assignment, ...]


def plain_of_station(automaton: Automaton) -> Automaton:
    """The plain automaton of a station, with flags replaced by their predicates.

    Its states in the phase `stable` are those of the station, and as safe. Restart abilities are left out. Faults are
    uncontrollable transitions as any other: that nobody counts on them is not said.
    """
    return _Sequence(automaton).automaton()


def remarks(automaton: Automaton) -> tuple[str, ...]:
    """What the plain automaton of a station does not say, if that makes a difference here."""
    faults = [effect.name for effect in automaton.effects if effect.fault]
    restart = [ability.name for ability in automaton.abilities.values() if ability.restart]
    local = [operation.name for operation in automaton.operations.values() if operation.local is not None]
    found = []
    if faults and automaton.rest is not None:
        found.append(
            f"faults count as a way back to rest there, which a station's supervisor never relies on: "
            f"{', '.join(faults)}"
        )
    if restart:
        found.append(f"restart abilities are left out: {', '.join(restart)}")
    if local:
        found.append(f"the `local` formulas of operations are left out: {', '.join(local)}")
    return tuple(found)


class _Sequence:
    def __init__(self, automaton: Automaton) -> None:
        self._automaton = automaton
        self._reaction = reaction(automaton)
        steps = self._reaction.steps
        kinds = [Phase.FINISH if step.finishes else Phase.SENSE for step in steps]
        words = ["stable", *(f"{kind}_{kinds[: i + 1].count(kind)}" for i, kind in enumerate(kinds))]
        values = tuple(different(words, str, automaton.variables).values())
        reserved = {*automaton.types, *(v for d in automaton.variables.values() for v in d.type.domain)}
        helpers = [f"{name}.before" for name in (*self._reaction.copies, *self._reaction.notes)]
        helpers += [f"{name}.taken" for name in self._reaction.marks]
        names = different(["phase", *helpers], str, {str(name) for name in reserved})
        self._phase = Variable(names["phase"], EnumerationType(values))
        self._copies = {
            name: Variable(names[f"{name}.before"], automaton.variables[name].type) for name in self._reaction.copies
        }
        self._notes = {name: Variable(names[f"{name}.before"], BOOLEAN) for name in self._reaction.notes}
        self._marks = {name: Variable(names[f"{name}.taken"], BOOLEAN) for name in self._reaction.marks}
        self._flags = _inlined(automaton, {})
        self._before = {**self._copies, **_inlined(automaton, self._copies)}

    def automaton(self) -> Automaton:
        source = self._automaton
        taken = [*self._starts(), *self._activities(), *self._ticks()]
        abilities, effects = _numbered(source.name, taken)
        initial = {v.name: (v.type, v.initial) for v in source.variables.values()} | self._idle()
        specifications = {
            name: Specification(name, s.title, self._stable(s.forbidden)) for name, s in source.specifications.items()
        }
        goals = [self._stable(operation.goal) for operation in source.operations.values()]
        return Automaton(
            name=source.name,
            title=source.title,
            description=source.description,
            resources={source.name: source.title},
            variables={
                name: VariableDeclaration(name, type_, Kind.ESTIMATED, value, None)
                for name, (type_, value) in initial.items()
            },
            abilities=abilities,
            flags=(),
            effects=effects,
            specifications=specifications,
            rest=None if source.rest is None else self._stable(source.rest),
            one_at_a_time=True,
            goals=tuple(UnaryTemporal("F", goal) for goal in goals),
        )

    def _idle(self) -> dict[str, tuple[Type, Value]]:
        """The helper variables, with the values that they have in the phase `stable`."""
        if not self._reaction.steps:
            return {}
        phases = self._phase.type.domain
        copies = {v.name: (v.type, self._automaton.variables[n].initial) for n, v in self._copies.items()}
        others: dict[str, tuple[Type, Value]] = {
            v.name: (v.type, False) for v in (*self._notes.values(), *self._marks.values())
        }
        return {self._phase.name: (self._phase.type, phases[0]), **copies, **others}

    def _stable(self, predicate: Expression) -> Expression:
        """A predicate about a state of the station."""
        return _both(self._at(0), replaced(predicate, self._flags))

    def _at(self, number: int) -> Expression:
        if not self._reaction.steps:
            return TRUE
        return Comparison("==", self._phase, Constant(self._phase.type.domain[number]))

    def _to(self, number: int) -> tuple[Assignment, ...]:
        """The phase becomes the one of that number; behind the last one, all is as it was."""
        values = self._phase.type.domain
        if number < len(values):
            return (Assignment(self._phase, Constant(values[number])),)
        return tuple(Assignment(Variable(name, t), Constant(value)) for name, (t, value) in self._idle().items())

    def _starts(self) -> Iterator[Taken]:
        for transition in transitions(self._automaton):
            if transition.phase is Phase.START and not transition.restart:
                name = transition.name.removesuffix(f".{Phase.START}")
                for guard, actions in cases(transition, self._flags):
                    yield Taken(name, True, _both(self._at(0), guard), actions)

    def _activities(self) -> Iterator[Taken]:
        for name in self._automaton.names(Kind.ACTIVITY):
            active = Variable(name, BOOLEAN)
            yield Taken(f"{name}.changes", False, self._at(0), (Assignment(active, Not(active)),))

    def _ticks(self) -> Iterator[Taken]:
        steps = self._reaction.steps
        if not steps:
            return
        kept = [Assignment(copy, Variable(name, copy.type)) for name, copy in self._copies.items()]
        kept += [Assignment(note, self._flags[name]) for name, note in self._notes.items()]
        yield Taken("tick", False, self._at(0), (*self._to(1), *kept))
        for number, step in enumerate(steps, start=1):
            parts = self._finish(step) if step.finishes else self._effects(step, steps[: number - 1])
            for event, guard, actions in parts:
                # What is set back at the end is not written as well.
                onward = {target(action): action for action in (*actions, *self._to(number + 1))}
                yield Taken(event, False, _both(self._at(number), guard), tuple(onward.values()))

    def _effects(self, step: Step, earlier: Sequence[Step]) -> Iterator[tuple[str, Expression, tuple[Assignment, ...]]]:
        marked = [e for before in earlier for e in before.members if e.name in self._marks]
        yield "pass", TRUE, ()
        for effect in step.members:
            own = (Assignment(self._marks[effect.name], TRUE),) if effect.name in self._marks else ()
            for guard, actions in cases(effect, self._before):
                agreed = [self._agrees(actions, each) for each in marked if can_dispute(effect, each)]
                if actions:
                    yield effect.name, conjunction(guard, *agreed), (*actions, *own)

    def _agrees(self, actions: Sequence[Assignment], earlier: Transition) -> Expression:
        """That `earlier` was not taken, or wrote what `actions` write; what it wrote is still there."""
        applies = {target(a): condition_of(a, self._before) for a in earlier.actions}
        same = [Or((Not(applies[target(a)]), leaves(a))) for a in actions if target(a) in applies]
        return Or((Not(self._marks[earlier.name]), conjunction(*same)))

    def _finish(self, step: Step) -> Iterator[tuple[str, Expression, tuple[Assignment, ...]]]:
        (finish,) = step.members
        seen = self._seen_by_finishes()
        agreed = [no_dispute(finish, other, seen) for other in step.opponents]
        allowed = conjunction(replaced(finish.guard, seen), *agreed)
        yield "pass", Not(allowed), ()
        for guard, actions in cases(finish, seen):
            yield finish.name, conjunction(guard, *agreed), actions

    def _seen_by_finishes(self) -> Replacements:
        """Measured variables are as sensed, all else is as before the tick."""
        measured = self._automaton.names(Kind.MEASURED)
        return {name: e for name, e in {**self._before, **self._notes}.items() if name not in measured}


def _inlined(automaton: Automaton, replacements: Replacements) -> dict[str, Expression]:
    """The predicate of each flag, over variables alone; with variables replaced."""
    found: dict[str, Expression] = {}
    for flag in automaton.flags:
        found[flag.name] = simplify(replaced(flag.predicate, {**replacements, **found}))
    return found


def _both(phase: Expression, condition: Expression) -> Expression:
    return simplify(conjunction(phase, *conjuncts(simplify(condition))))


def _numbered(resource: str, taken: Iterable[Taken]) -> tuple[dict[str, Ability], tuple[Effect, ...]]:
    """Transitions by their names, those of one event numbered as `plain_automaton` does."""
    abilities: dict[str, Ability] = {}
    effects: list[Effect] = []
    possible = [each for each in taken if each.guard != FALSE]
    events = different(((each.event, each.controllable) for each in possible), lambda key: key[0])
    seen = Counter[str]()
    for each in possible:
        event = events[each.event, each.controllable]
        seen[event] += 1
        name = event if seen[event] == 1 else f"{event}{NUMBER_SIGN}{seen[event]}"
        if each.controllable:
            abilities[name] = Ability(name, resource, event, TRUE, each.guard, each.actions, FALSE, FALSE, None, ())
        else:
            effects.append(Effect(name, resource, "uncontrollable", each.guard, each.actions))
    return abilities, tuple(effects)
