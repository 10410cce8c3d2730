"""All checks of a model: effects, executing conditions, operations, human tasks and specifications."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

from sequence_planner.analysis.checks.connections import Connections, check_connections
from sequence_planner.analysis.checks.guards import (
    SatisfiabilityQuestion,
    UndecidedError,
    can_be_asked,
    check_alarms,
    check_conflicts,
    check_guards,
    differ,
    satisfying,
)
from sequence_planner.analysis.checks.warning import ModelWarning, described, families, listed, place
from sequence_planner.automaton.automaton import Ability, Automaton, Effect, Specification, target
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import FALSE, Constant, Expression, conjunction, conjuncts, variables
from sequence_planner.texts.message import message

# Effects under the same condition that leave a device in different states: a plan takes whichever suits it.


def check_effects(automaton: Automaton) -> Iterator[ModelWarning]:
    """Pairs of effects with one condition, neither a fault, that write different values to a variable."""
    said: set[tuple[str, str]] = set()
    alike: dict[frozenset[str], list[Effect]] = {}
    for effect in automaton.effects:
        if not effect.fault:
            alike.setdefault(frozenset(variables(effect.guard)), []).append(effect)
    for effects in alike.values():
        for one, other in combinations(effects, 2):
            names = without_arguments(one.name), without_arguments(other.name)
            if names in said or not (written := _contradictory(one, other)) or not _same(automaton, one, other):
                continue
            said.add(names)
            yield ModelWarning(
                place(automaton, other.name),
                "contradictory-effects",
                message("found.contradictory-effects", one=one.name, other=other.name, variables=listed(written)),
            )


def _same(automaton: Automaton, one: Effect, other: Effect) -> bool:
    """Return whether the one happens exactly where the other does, however that is written."""
    if set(conjuncts(one.guard)) == set(conjuncts(other.guard)):
        return True
    if not can_be_asked(automaton, one.guard, other.guard):
        return False
    try:
        return not differ(automaton, one.guard, other.guard) and satisfying(automaton, one.guard) is not None
    except UndecidedError:
        return False


def _contradictory(one: Effect, other: Effect) -> list[str]:
    """The variables to which both write, without a condition, and not the same."""
    written = {target(action): action for action in one.actions if action.condition is None}
    return [
        name
        for action in other.actions
        if action.condition is None and (name := target(action)) in written and written[name].value != action.value
    ]


# Finishes that rely on having seen their ability at work.
#
# A device can be faster than its messages: then `rules` is never seen, and a finish guard that implies it never holds
# (`docs/semantics.md`, "Tick"). That cannot happen when `rules` follows from the start, as it does when it reads
# the command that the start gives and nothing that a device still has to do.


def check_executing(automaton: Automaton) -> Iterator[ModelWarning]:
    """One warning for each written ability of which some instance relies on `executing`."""
    for family, names in families(automaton.abilities).items():
        for name in names:
            ability = automaton.abilities[name]
            if _needs_executing(automaton, ability) and (missing := _not_yet(automaton, ability)) is not None:
                condition = print_expression(missing)
                yield ModelWarning(
                    place(automaton, f"{name}.finish", name),
                    "relies-on-executing",
                    message("found.relies-on-executing", ability=family, condition=condition),
                )
                break


def _needs_executing(automaton: Automaton, ability: Ability) -> bool:
    """Return whether the finish guard implies that the ability was executing in the tick before."""
    guard, flag = ability.finish_guard, ability.flag("executing")
    if guard is None or flag not in variables(guard) or not can_be_asked(automaton, guard):
        return False
    question = SatisfiabilityQuestion(automaton)
    state = question.with_old_flags()
    finishes = question.reading.truth(guard, state).yes
    unseen = question.circuit.conjunction((finishes, state[flag].literal(False)))
    try:
        some, without = question.models(finishes, unseen)
    except UndecidedError:
        return False
    return some is not None and without is None


def _not_yet(automaton: Automaton, ability: Ability) -> Expression | None:
    """Return what of `executing` may be false right after a start, or None if it always holds then."""
    guard = conjunction(ability.enabled, ability.start_guard)
    values = [action.value for action in ability.start_actions]
    if not can_be_asked(automaton, guard, ability.executing, *values):
        return None
    question = SatisfiabilityQuestion(automaton)
    before = question.state()
    after = question.after(ability.start_actions, before)
    question.circuit.require(question.reading.truth(guard, before).yes)
    question.circuit.require(-question.reading.truth(ability.executing, after).yes)
    try:
        model = question.model()
    except UndecidedError:
        return None
    if model is None:
        return None
    seen = after.valuation(model)
    return next(part for part in conjuncts(ability.executing) if not evaluate(part, seen))


# Operations of which there are none, and local specifications that say nothing about the run.

_OPERATIONS_FILE = "operations.yaml"  # has a place where it is there and holds nothing


def check_operations(automaton: Automaton) -> Iterator[ModelWarning]:
    """A file of operations without any, and operations whose local specification reads nothing at all."""
    if not automaton.operations and _OPERATIONS_FILE in automaton.places:
        yield ModelWarning(automaton.places[_OPERATIONS_FILE], "no-operation", message("found.no-operation"))
    for family, names in families(automaton.operations).items():
        local = automaton.operations[names[0]].local
        if local is None:
            continue
        where = place(automaton, f"operation.{names[0]}.local")
        if not isinstance(local, Constant) and not any(variables(local)):
            said = message("found.empty-local-specification", formula=print_expression(local), operation=family)
            yield ModelWarning(where, "empty-local-specification", said)


# Tasks that nobody is ever asked for, and tasks of which a person could not tell which one is acknowledged.

MOST_REPORTED = 3  # pairs for each acknowledgement


def check_people(automaton: Automaton) -> Iterator[ModelWarning]:
    """Human abilities whose task is never open, and pairs with one acknowledgement that can be open at once."""
    yield from _never_open(automaton)
    sharing: dict[str, list[Ability]] = defaultdict(list)
    for ability in automaton.abilities.values():
        if ability.human is not None:
            sharing[ability.human.acknowledgement].append(ability)
    for acknowledgement, abilities in sharing.items():
        reported = 0
        for one, other in combinations(abilities, 2):
            both = conjunction(one.executing, other.executing)
            if reported == MOST_REPORTED or not can_be_asked(automaton, both):
                break
            try:
                state = satisfying(automaton, both)
            except UndecidedError:
                continue
            if state is None:
                continue
            reported += 1
            when = described(state, dict.fromkeys(variables(both)))
            said = message(
                "found.shared-acknowledgement",
                one=one.name,
                other=other.name,
                when=when,
                acknowledgement=acknowledgement,
            )
            yield ModelWarning(place(automaton, f"{other.name}.executing", other.name), "shared-acknowledgement", said)


def _never_open(automaton: Automaton) -> Iterator[ModelWarning]:
    for ability in automaton.abilities.values():
        if ability.human is not None and ability.executing == FALSE:
            said = message("found.task-never-open", ability=ability.name)
            yield ModelWarning(place(automaton, f"{ability.name}.executing", ability.name), "task-never-open", said)


# Specifications that forbid nothing: most often something else was meant.

_SPECIFICATIONS_FILE = "specifications.yaml"  # has a place where it is there and holds nothing


def check_specifications(automaton: Automaton) -> Iterator[ModelWarning]:
    """A file of specifications without any, and those of which no expansion forbids any state, reachable or not."""
    if not automaton.specifications and _SPECIFICATIONS_FILE in automaton.places:
        where = automaton.places[_SPECIFICATIONS_FILE]
        yield ModelWarning(where, "no-specification", message("found.no-specification"))
    written: dict[str, list[Specification]] = defaultdict(list)
    for specification in automaton.specifications.values():
        written[without_arguments(specification.name.partition(": ")[0])].append(specification)
    for name, expansions in written.items():
        if not any(_forbids(automaton, each) for each in expansions):
            said = message("found.forbids-nothing", specification=name)
            yield ModelWarning(place(automaton, expansions[0].name), "forbids-nothing", said)


def _forbids(automaton: Automaton, specification: Specification) -> bool:
    """Return whether the specification forbids anything, or is too hard a question."""
    forbidden = specification.forbidden
    try:
        return not can_be_asked(automaton, forbidden) or satisfying(automaton, forbidden) is not None
    except UndecidedError:
        return True


# All checks of a model.

# What each looks for, for people; those first that take least time.
CHECKS: Mapping[str, Callable[[Automaton], Iterable[ModelWarning]]] = {
    "formulas that say nothing": check_operations,
    "specifications that forbid nothing": check_specifications,
    "effects that contradict each other": check_effects,
    "tasks of people": check_people,
    "finishes that rely on `executing`": check_executing,
    "conditions that never hold": check_guards,
    "alarms that are always there": check_alarms,
}
CONFLICTS = "finishes that conflict"  # looked for last, as that can take long


@dataclass(frozen=True)
class CheckProgress:
    """The thing that is being looked for, None at the end, and what has been found since the `CheckProgress` before."""

    pending: str | None
    warnings: tuple[ModelWarning, ...] = ()


def looked(automaton: Automaton, connections: Connections | None = None) -> Iterator[CheckProgress]:
    """Yield what is soon found to be suspicious in a station's automaton; `connections` are those to its topics.

    A plain automaton has neither ticks nor devices, and no conditions of which these checks know the use.
    """
    if not automaton.one_at_a_time:
        if connections is not None:
            yield CheckProgress("variables without a use", tuple(check_connections(automaton, connections)))
        for what, check in CHECKS.items():
            yield CheckProgress(what)
            yield CheckProgress(what, tuple(check(automaton)))
    yield CheckProgress(None)


def conflicting(automaton: Automaton) -> Iterator[CheckProgress]:
    """The finishes that conflict, as they are found."""
    if not automaton.one_at_a_time:
        yield CheckProgress(CONFLICTS)
        yield from (CheckProgress(CONFLICTS, (warning,)) for warning in check_conflicts(automaton))
    yield CheckProgress(None)


def check_automaton(automaton: Automaton, connections: Connections | None = None) -> list[ModelWarning]:
    """All that is suspicious, by place."""
    found = [*looked(automaton, connections), *conflicting(automaton)]
    return sorted({warning for each in found for warning in each.warnings})
