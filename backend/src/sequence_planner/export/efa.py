"""Export of a station as a plain automaton (`*.efa.json`): each tick as single transitions."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations, product
from math import prod
from typing import Any, TypeVar

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    Kind,
    Specification,
    VariableDeclaration,
    target,
)
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.plain.events import NUMBER_SIGN, event_of
from sequence_planner.automaton.plain.steps import plain_transitions
from sequence_planner.automaton.tick import Writes, writes
from sequence_planner.automaton.transitions import Phase, Transition, transitions
from sequence_planner.export.case_splits import cases, condition_of, leaves, no_dispute
from sequence_planner.language.evaluator import holds
from sequence_planner.language.lexer import KEYWORDS
from sequence_planner.language.printer import print_expression
from sequence_planner.language.simplifier import simplify
from sequence_planner.language.substitution import Replacements, replaced
from sequence_planner.language.syntax import (
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
    occurrences,
    variables,
)
from sequence_planner.language.types import BOOLEAN, BooleanType, EnumerationType, IntegerRange, Type, Value

# Names that other notations can have, each different from all others.

T = TypeVar("T", bound=Hashable)

_SIGNS = re.compile(r"[^A-Za-z0-9_]+")


def word(name: str) -> str:
    """A word of letters, digits and `_` that resembles `name`: `bolts[left]` becomes `bolts_left`."""
    text = _SIGNS.sub("_", name).strip("_") if _SIGNS.search(name) else name
    return text if re.match(r"[A-Za-z_]", text) else f"n_{text}"


def dotted(name: str) -> str:
    """Words joined by dots that resemble `name`, none of them a word of the expression language."""
    parts = map(word, re.split(r"\.(?![^(\[]*[)\]])", name))
    return ".".join(f"{part}_" if part in KEYWORDS else part for part in parts)


def different(names: Iterable[T], form: Callable[[T], str], taken: Collection[str] = ()) -> dict[T, str]:
    """For each name one of that form that neither another one nor `taken` has: a number behind it makes it so."""
    found: dict[T, str] = {}
    used = set(taken)
    for name in dict.fromkeys(names):
        wanted = free = form(name)
        number = 1
        while free in used:
            number += 1
            free = f"{wanted}_{number}"
        used.add(free)
        found[name] = free
    return found


# The document of a plain automaton, `*.efa.json`, which `read_plain` reads back.


def names_in_document(automaton: Automaton) -> Mapping[str, str]:
    """Return how each variable is called in the document: as it is, if expressions can read that and mean no value by
    it.
    """
    types = {name: variable.type for name, variable in automaton.variables.items()}
    ambiguous = {n for n, type_ in types.items() if isinstance(type_, EnumerationType) and n in type_.values}
    return different(types, dotted, ambiguous)


def efa_document(automaton: Automaton) -> dict[str, Any]:
    """The document of a plain automaton; what is empty is left out. The invariant is part of its guards."""
    names = names_in_document(automaton)
    renamed = {n: Variable(names[n], v.type) for n, v in automaton.variables.items() if names[n] != n}
    document: dict[str, Any] = {
        "name": automaton.name,
        "variables": {names[name]: _domain(variable.type) for name, variable in automaton.variables.items()},
        "initial": _written(_initial(automaton), renamed),
        "transitions": list(_transitions(automaton, renamed)),
    }
    forbidden = [_written(s.forbidden, renamed) for s in automaton.specifications.values()]
    goals = [print_expression(replaced(goal, renamed)) for goal in automaton.goals]
    if forbidden:
        document["forbidden"] = forbidden
    if automaton.rest is not None:
        document["marked"] = _written(automaton.rest, renamed)
    if goals:
        document["goal"] = goals
    return document


def efa_text(automaton: Automaton) -> str:
    """The same as text, a transition on each line."""
    entries = (f"{json.dumps(key)}: {_laid_out(value)}" for key, value in efa_document(automaton).items())
    return "{\n" + ",\n".join(f"  {entry}" for entry in entries) + "\n}\n"


def _laid_out(value: object) -> str:
    if isinstance(value, list) and value:
        return "[\n" + ",\n".join(f"    {json.dumps(each, ensure_ascii=False)}" for each in value) + "\n  ]"
    if isinstance(value, dict) and value:
        parts = (f"    {json.dumps(key)}: {json.dumps(each)}" for key, each in value.items())
        return "{\n" + ",\n".join(parts) + "\n  }"
    return json.dumps(value, ensure_ascii=False)


def _initial(automaton: Automaton) -> Expression:
    if automaton.initial is not None:
        return automaton.initial
    return conjunction(*(_has(Variable(n, v.type), v.initial) for n, v in automaton.variables.items()))


def _has(variable: Variable, value: Value) -> Expression:
    if isinstance(value, bool):
        return variable if value else Not(variable)
    return Comparison("==", variable, Constant(value))


def _transitions(automaton: Automaton, renamed: Replacements) -> Iterator[dict[str, Any]]:
    for name, transition in plain_transitions(automaton).items():
        entry: dict[str, Any] = {"event": event_of(name), "controllable": transition.controllable}
        if transition.guard != TRUE:
            entry["guard"] = _written(transition.guard, renamed)
        if transition.actions:
            entry["set"] = dict(_updates(transition.actions, renamed))
        yield entry


def _updates(actions: Iterable[Assignment], renamed: Replacements) -> Iterator[tuple[str, bool | int | str]]:
    for action in actions:
        name = print_expression(renamed.get(target(action), action.target))
        yield name, action.value.value if isinstance(action.value, Constant) else _text(action.value, renamed)


def _domain(type_: Type) -> object:
    match type_:
        case BooleanType():
            return "bool"
        case IntegerRange(minimum, maximum):
            return {"min": minimum, "max": maximum}
        case EnumerationType(values):
            return list(values)


def _written(predicate: Expression, renamed: Replacements) -> bool | str:
    return predicate.value is True if isinstance(predicate, Constant) else _text(predicate, renamed)


def _text(expression: Expression, renamed: Replacements) -> str:
    return print_expression(replaced(expression, renamed))


# What effects that are taken one after another must know of the state before the tick.
#
# All effects of a tick read the state before it. One that reads what another writes can be taken before that one; only
# where two would each have to come first, a copy is kept of what they read.

Allowed = Mapping[str, Set[Value]]


@dataclass(frozen=True)
class ReactionOrder:
    """`copies` are variables whose value before the tick is kept; `locks` has for each effect variables that must not
    have been written before it; `contended` are those that several effects can write.
    """

    copies: frozenset[str]
    locks: Mapping[str, frozenset[str]]
    contended: frozenset[str]

    @property
    def marked(self) -> frozenset[str]:
        """The variables of which it must be known whether an effect of this tick has written them."""
        return self.contended.union(*self.locks.values())


def reaction_order(effects: Sequence[Transition], flags: Replacements) -> ReactionOrder:
    """Return what `effects` need, whose `flags` are replaced by their predicates."""
    read = {e.name: _read(e, flags) for e in effects}
    allowed = {e.name: allowed_values(replaced(e.guard, flags)) for e in effects}
    writers: dict[str, list[Transition]] = {}
    for effect in effects:
        for name in effect.writes:
            writers.setdefault(name, []).append(effect)
    later: dict[str, set[str]] = {effect.name: set() for effect in effects}
    for effect in effects:
        for name in read[effect.name] & writers.keys():
            later[effect.name] |= {
                other.name
                for other in writers[name]
                if other is not effect and not _exclude(allowed[effect.name], allowed[other.name])
            }
    copies = _reaction_copies(later, read, {effect.name: effect.writes for effect in effects})
    locks: dict[str, frozenset[str]] = {}
    for effect in effects:
        needed = _read_by_actions(effect, flags)
        for name in read[effect.name] & writers.keys():
            if any(_may_enable(other, name, allowed[effect.name]) for other in writers[name]):
                needed |= {name}
        locks[effect.name] = (needed & writers.keys()) - copies
    return ReactionOrder(copies, locks, frozenset(name for name, several in writers.items() if len(several) > 1))


def allowed_values(guard: Expression) -> dict[str, Set[Value]]:
    """The values of variables outside which some part of `guard` fails."""
    allowed: dict[str, Set[Value]] = {}
    for part in conjuncts(simplify(guard)):
        concerned = {variable.name: variable.type for variable in occurrences(part)}
        if len(concerned) == 1:
            ((name, type_),) = concerned.items()
            values = {value for value in type_.domain if holds(part, {name: value})}
            allowed[name] = allowed.get(name, values) & values
    return allowed


def writes_outside(transition: Transition, name: str, allowed: Allowed) -> bool:
    """Return whether it always writes a constant to the variable that is none of the `allowed` values."""
    return name in allowed and any(
        target(action) == name
        and action.condition is None
        and isinstance(action.value, Constant)
        and action.value.value not in allowed[name]
        for action in transition.actions
    )


def _may_enable(transition: Transition, name: str, allowed: Allowed) -> bool:
    return not writes_outside(transition, name, allowed)


def _exclude(one: Allowed, other: Allowed) -> bool:
    """Return whether no state satisfies both guards, as far as their parts over single variables tell."""
    return any(values.isdisjoint(other[name]) for name, values in one.items() if name in other)


def _reaction_copies(
    later: Mapping[str, Set[str]], read: Mapping[str, Set[str]], written: Mapping[str, Set[str]]
) -> frozenset[str]:
    """Return what is read and written within circles of effects, each of which would have to come before the next."""
    above = {name: _reached(name, later) for name in later}
    return frozenset(
        variable
        for name, others in later.items()
        for other in others
        if name in above[other]
        for variable in read[name] & written[other]
    )


def _reached(name: str, later: Mapping[str, Set[str]]) -> set[str]:
    found: set[str] = set()
    pending = [name]
    while pending:
        new = later[pending.pop()] - found
        found |= new
        pending.extend(new)
    return found


def _read(effect: Transition, flags: Replacements) -> frozenset[str]:
    return frozenset(variables(replaced(effect.guard, flags))) | _read_by_actions(effect, flags)


def _read_by_actions(effect: Transition, flags: Replacements) -> frozenset[str]:
    return _variables(
        replaced(part, flags) for a in effect.actions for part in (a.value, a.condition) if part is not None
    )


def _variables(expressions: Iterable[Expression]) -> frozenset[str]:
    return frozenset(name for expression in expressions for name in variables(expression))


# Whether two transitions can happen at once: would they write different values, does one say all that both do.
#
# Both are decided by trying all values of the variables concerned; beyond a number of them the answer is the careful
# one.

_MOST_VALUATIONS = 5000


def can_dispute(one: Transition, other: Transition) -> bool:
    """Return whether both may be enabled and write different values to one variable."""
    shared = one.writes & other.writes
    if not shared or all(_constant(one, name) == _constant(other, name) is not None for name in shared):
        return False
    pairs = _pairs(one, other)
    return pairs is None or any(not _agree(first, second) for first, second in pairs)


def one_suffices(one: Transition, other: Transition) -> bool:
    """Return whether what both do together, where they can, one of them does alone."""
    if one.writes == other.writes and len(one.writes) == 1:
        return True
    pairs = _pairs(one, other)
    if pairs is None:
        return False
    return all(
        not _agree(first, second) or first.items() <= second.items() or second.items() <= first.items()
        for first, second in pairs
    )


def _agree(first: Writes, second: Writes) -> bool:
    return all(first[name] == second[name] for name in first.keys() & second.keys())


def _constant(transition: Transition, name: str) -> Constant | None:
    """The constant that it always writes to the variable, if there is one."""
    values = [a.value if a.condition is None else None for a in transition.actions if target(a) == name]
    return values[0] if len(values) == 1 and isinstance(values[0], Constant) else None


def _pairs(one: Transition, other: Transition) -> Iterator[tuple[Writes, Writes]] | None:
    """Return what each writes, wherever both are enabled; None if there are too many valuations. Flags can be
    anything.
    """
    domains = {
        variable.name: variable.type.domain
        for transition in (one, other)
        for expression in _expressions(transition)
        for variable in occurrences(expression)
    }
    if prod(map(len, domains.values())) > _MOST_VALUATIONS:
        return None
    return _enabled_pairs(one, other, domains)


def _enabled_pairs(
    one: Transition, other: Transition, domains: dict[str, tuple[bool | int | str, ...]]
) -> Iterator[tuple[Writes, Writes]]:
    for values in product(*domains.values()):
        valuation = dict(zip(domains, values, strict=True))
        if holds(one.guard, valuation) and holds(other.guard, valuation):
            first, second = writes(one.actions, valuation), writes(other.actions, valuation)
            assert first is not None
            assert second is not None
            yield first, second


def _expressions(transition: Transition) -> Iterator[Expression]:
    yield transition.guard
    for action in transition.actions:
        yield action.value
        if action.condition is not None:
            yield action.condition


# The reaction of a tick, steps 1 to 3, as a sequence of steps that each take one transition or none.
#
# All effects read the state before the tick, all finishes the sensed state with the flags of the tick before. Taken one
# after another, a later one would read what an earlier one wrote; what it must still know is kept in helper variables:
# copies of variables, notes of flags, and marks of effects that later ones must agree with. The order is one that needs
# few of them.


@dataclass(frozen=True)
class ExportedStep:
    """Effects of which one is taken or none, or a finish, which is taken exactly where its guard holds.

    A finish is refused by those of `opponents` that hold with it and would write differently.
    """

    members: tuple[Transition, ...]
    opponents: tuple[Transition, ...] = ()

    @property
    def finishes(self) -> bool:
        """True if it is a finish."""
        return self.members[0].phase is Phase.FINISH

    @cached_property
    def writes(self) -> frozenset[str]:
        """The variables that it may write."""
        return frozenset(chain.from_iterable(member.writes for member in self.members))

    @cached_property
    def reads(self) -> frozenset[str]:
        """The variables and flags that its guards and actions read."""
        return frozenset(chain.from_iterable(each.reads for each in (*self.members, *self.opponents)))


@dataclass(frozen=True)
class ExportedReaction:
    """The steps in order, and what is kept of the state before the tick while they are taken."""

    steps: tuple[ExportedStep, ...]
    copies: tuple[str, ...]  # variables
    notes: tuple[str, ...]  # flags that finishes read
    marks: tuple[str, ...]  # effects


def reaction(automaton: Automaton) -> ExportedReaction:
    """The reaction of a station's tick. Finishes that do nothing are left out."""
    effects = _ordered(automaton, _effect_steps(automaton))
    finishes = _ordered(automaton, _finish_steps(automaton))
    steps = (*effects, *finishes)
    copies = _copies(automaton, steps)
    return ExportedReaction(
        steps,
        tuple(name for name in automaton.variables if name in copies),
        _notes(automaton, steps, copies),
        tuple(
            effect.name
            for index, step in enumerate(effects)
            for effect in step.members
            if any(can_dispute(effect, later) for after in effects[index + 1 :] for later in after.members)
        ),
    )


def _effect_steps(automaton: Automaton) -> list[ExportedStep]:
    """Effects that write common variables share a step where no two of them do more together than one does alone."""
    steps: list[list[Transition]] = []
    for group in _related([t for t in transitions(automaton) if t.phase is Phase.SENSE and t.writes]):
        first = len(steps)
        for effect in group:
            for members in steps[first:]:
                if all(one_suffices(effect, member) for member in members):
                    members.append(effect)
                    break
            else:
                steps.append([effect])
    return [ExportedStep(tuple(members)) for members in steps]


def _related(effects: Sequence[Transition]) -> list[list[Transition]]:
    """Effects that write common variables, also by way of others, are in one group."""
    groups: list[list[Transition]] = []
    for effect in effects:
        joined = [group for group in groups if any(member.writes & effect.writes for member in group)]
        groups = [group for group in groups if group not in joined]
        groups.append([*chain.from_iterable(joined), effect])
    return groups


def _finish_steps(automaton: Automaton) -> list[ExportedStep]:
    finishes = [t for t in transitions(automaton) if t.phase is Phase.FINISH and t.actions]
    opponents: dict[str, list[Transition]] = {finish.name: [] for finish in finishes}
    for one, other in combinations(finishes, 2):
        if can_dispute(one, other):
            opponents[one.name].append(other)
            opponents[other.name].append(one)
    return [ExportedStep((finish,), tuple(opponents[finish.name])) for finish in finishes]


def _ordered(automaton: Automaton, steps: Sequence[ExportedStep]) -> list[ExportedStep]:
    """Steps that write what many others read come late."""
    left, ordered = list(steps), list[ExportedStep]()
    while left:
        first = min(left, key=lambda step: len(_read_by(automaton, [o for o in left if o is not step]) & step.writes))
        left.remove(first)
        ordered.append(first)
    return ordered


def _read_by(automaton: Automaton, steps: Sequence[ExportedStep]) -> frozenset[str]:
    """Return what steps read of the state before the tick, apart from the flags that finishes do."""
    found = set[str]()
    for step in steps:
        found |= step.reads & automaton.variables.keys() if step.finishes else _inlined(automaton, step)
        if step.finishes:
            found -= set(automaton.names(Kind.MEASURED))
    return frozenset(found)


def _inlined(automaton: Automaton, step: ExportedStep) -> frozenset[str]:
    expressions: list[Expression] = []
    for member in step.members:
        expressions.append(member.guard)
        expressions.extend(action.value for action in member.actions)
        expressions.extend(action.condition for action in member.actions if action.condition is not None)
    return read_variables(automaton, expressions)


def _copies(automaton: Automaton, steps: Sequence[ExportedStep]) -> frozenset[str]:
    """Variables that a step reads as they were before the tick, and an earlier step writes."""
    written, found = set[str](), set[str]()
    for step in steps:
        found |= _read_by(automaton, [step]) & written
        written |= step.writes
    return frozenset(found)


def _notes(automaton: Automaton, steps: Sequence[ExportedStep], copies: frozenset[str]) -> tuple[str, ...]:
    """Flags that a finish reads, and that a variable that no copy is kept of would no longer tell."""
    written, found = set[str](), set[str]()
    for step in steps:
        if step.finishes:
            for name in step.reads - automaton.variables.keys():
                flag = automaton.flag_predicates[name]
                if read_variables(automaton, (flag,)) & written - copies:
                    found.add(name)
        written |= step.writes
    return tuple(flag.name for flag in automaton.flags if flag.name in found)


# A station as a plain automaton: its ticks by single transitions, exactly (`docs/semantics.md`, "Tick").
#
# In the phase `stable` a state is one after step 3 or after a start: starts are taken there, operations become active
# or not, and what is forbidden or marked counts. The uncontrollable `tick` leaves it for the steps of the reaction.


@dataclass(frozen=True)
class ExportedTransition:
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
    """Return what the plain automaton of a station does not say, if that makes a difference here."""
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
        self._flags = _inlined_station(automaton, {})
        self._before = {**self._copies, **_inlined_station(automaton, self._copies)}

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

    def _starts(self) -> Iterator[ExportedTransition]:
        for transition in transitions(self._automaton):
            if transition.phase is Phase.START and not transition.restart:
                name = transition.name.removesuffix(f".{Phase.START}")
                for guard, actions in cases(transition, self._flags):
                    yield ExportedTransition(name, True, _both(self._at(0), guard), actions)

    def _activities(self) -> Iterator[ExportedTransition]:
        for name in self._automaton.names(Kind.ACTIVITY):
            active = Variable(name, BOOLEAN)
            yield ExportedTransition(f"{name}.changes", False, self._at(0), (Assignment(active, Not(active)),))

    def _ticks(self) -> Iterator[ExportedTransition]:
        steps = self._reaction.steps
        if not steps:
            return
        kept = [Assignment(copy, Variable(name, copy.type)) for name, copy in self._copies.items()]
        kept += [Assignment(note, self._flags[name]) for name, note in self._notes.items()]
        yield ExportedTransition("tick", False, self._at(0), (*self._to(1), *kept))
        for number, step in enumerate(steps, start=1):
            parts = self._finish(step) if step.finishes else self._effects(step, steps[: number - 1])
            for event, guard, actions in parts:
                # What is set back at the end is not written as well.
                onward = {target(action): action for action in (*actions, *self._to(number + 1))}
                yield ExportedTransition(event, False, _both(self._at(number), guard), tuple(onward.values()))

    def _effects(
        self, step: ExportedStep, earlier: Sequence[ExportedStep]
    ) -> Iterator[tuple[str, Expression, tuple[Assignment, ...]]]:
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

    def _finish(self, step: ExportedStep) -> Iterator[tuple[str, Expression, tuple[Assignment, ...]]]:
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


def _inlined_station(automaton: Automaton, replacements: Replacements) -> dict[str, Expression]:
    """The predicate of each flag, over variables alone; with variables replaced."""
    found: dict[str, Expression] = {}
    for flag in automaton.flags:
        found[flag.name] = simplify(replaced(flag.predicate, {**replacements, **found}))
    return found


def _both(phase: Expression, condition: Expression) -> Expression:
    return simplify(conjunction(phase, *conjuncts(simplify(condition))))


def _numbered(resource: str, taken: Iterable[ExportedTransition]) -> tuple[dict[str, Ability], tuple[Effect, ...]]:
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
