"""What is found where the states that are reached are not computed: against the definition, and run by run."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import pytest
from hypothesis import assume, given
from hypothesis.errors import UnsatisfiedAssumption

from checks.test_supervised import Expected, with_operations
from core.choices import Choices, made_by
from core.random_expressions import equality
from core.replaying import replay
from sequence_planner.analysis.checks import large_reachability
from sequence_planner.analysis.checks.evidence import Evidence
from sequence_planner.analysis.checks.feasibility import UNKNOWN
from sequence_planner.analysis.checks.large_reachability import FarAnswers, FarInquiry, from_afar
from sequence_planner.analysis.checks.reachability import Questions
from sequence_planner.analysis.checks.supervised import subjects_of
from sequence_planner.analysis.finding import without_numbers
from sequence_planner.analysis.layered_ways import LayeredWay
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.language.evaluator import holds
from sequence_planner.language.syntax import Variable, conjunction
from sequence_planner.synthesis.approximation import around, composed
from sequence_planner.synthesis.reachability import reachable, reaching
from sequence_planner.synthesis.supervisor import Supervision, SynthesisError, alike, supervised, supervisor
from sequence_planner.synthesis.transition_relation import NodeLimit, Plant, together
from support.examples import examples


def asked(made: Automaton, known: Evidence | None = None) -> FarAnswers:
    supervision = supervised(made)
    safe = supervision.plant.diagrams.exported(supervision.safe)
    return from_afar(made, list(subjects_of(made)), safe, supervisor(supervision), 0.1, known)


def hold(made: Automaton, known: Evidence | None = None) -> Evidence | None:
    """Assert that what is found of `made` is what the definition says, and that its runs are ones that show it.

    What is `known` may be of another automaton. Returns what is known now.
    """
    expected = Expected(made)
    assume(expected.initial in expected.safe)
    answers = asked(made, known)
    findings = {each.subject.name: each for each in answers.findings}
    kinds = {name: each.kind for name, each in findings.items()}
    for ability in made.abilities.values():
        kind = None if ability.restart else expected.start(ability)
        words = {kind, None, UNKNOWN} if kind == "never-starts" else {kind}  # other checks may say so
        assert kinds.pop(ability.name, None) in words
    for operation in made.operations.values():
        kind = expected.operation(operation)
        nowhere = not expected.where(operation.precondition) & expected.all_ways or not (
            expected.where(operation.goal) & expected.closure(expected.helpful, safely=False)
        )
        assert kinds.pop(operation.name, None) in ({kind, None, UNKNOWN} if nowhere else {kind})
        finding = findings.get(operation.name)
        if finding is not None and finding.kind == "goal-out-of-reach":
            assert finding.trace is not None
            states = replay(made, finding.trace)
            assert {expected.key(state) for state in states} <= expected.safe
            assert holds(operation.precondition, states[-1])
            assert expected.key(states[-1]) not in expected.completing(expected.where(operation.goal))
    assert not kinds
    for finding in findings.values():
        if finding.trace is not None:
            replay(made, finding.trace)
    return answers.evidence


@examples(80)
@given(made_by(with_operations))
def test_what_is_found_from_afar_is_what_the_definition_says(made: Automaton) -> None:
    hold(made)


@examples(40)
@given(made_by(with_operations))
def test_it_is_so_too_where_each_question_is_a_long_one(made: Automaton) -> None:
    """Parts are made larger then, and states next to known runs are looked at one by one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(large_reachability, "_SOON", 0)
        hold(made)


def edited(choices: Choices, made: Automaton) -> Automaton:
    """`made` with one thing changed: a guard, a finish, an effect, an ability more, a precondition, a goal, a value."""
    scope = [Variable(name, variable.type) for name, variable in made.variables.items()]
    name = choices.pick(sorted(made.abilities))
    ability, condition = made.abilities[name], equality(choices, scope)
    match choices.number(0, 7):
        case 0:
            changed = replace(ability, start_guard=conjunction(ability.start_guard, condition))
        case 1:
            changed = replace(ability, start_guard=condition)
        case 2:
            changed = replace(ability, start_actions=ability.start_actions[1:])
        case 3:
            changed = replace(ability, finish_guard=None)
        case 4:
            left = choices.number(0, len(made.effects))
            return replace(made, effects=(*made.effects[:left], *made.effects[left + 1 :]))
        case 5:
            effects = [replace(each, guard=condition) if choices.chance(2) else each for each in made.effects]
            return replace(made, effects=tuple(effects))
        case 6:
            operation = replace(made.operations["g1"], precondition=condition, goal=equality(choices, scope))
            return replace(made, operations={**made.operations, "g1": operation})
        case _:
            return replace(made, specifications={})
    return replace(made, abilities={**made.abilities, name: changed})


def with_edits(choices: Choices) -> list[Automaton]:
    """A random station, and what becomes of it by some edits, one after the other."""
    versions = [with_operations(choices)]
    for _ in range(3):
        versions.append(edited(choices, versions[-1]))
    return versions


def with_tightened_guard(choices: Choices) -> tuple[Automaton, Automaton]:
    """A random station, and the same with a condition more for one start."""
    made = with_operations(choices)
    scope = [Variable(name, variable.type) for name, variable in made.variables.items()]
    ability = made.abilities[choices.pick(sorted(made.abilities))]
    tightened = replace(ability, start_guard=conjunction(ability.start_guard, equality(choices, scope)))
    return made, replace(made, abilities={**made.abilities, ability.name: tightened})


@examples(80)
@given(made_by(with_edits))
def test_after_an_edit_what_was_known_leads_to_what_the_definition_says(versions: list[Automaton]) -> None:
    known: Evidence | None = None
    for made in versions:
        with suppress(
            UnsatisfiedAssumption, SynthesisError
        ):  # it has no supervisor: what is known is of the one before
            known = hold(made, known) or known


@examples(240)  # a trap is seldom one that an edit has opened
@given(made_by(with_edits))
def test_after_an_edit_no_step_leads_out_of_a_trap_and_ways_lead_on(versions: list[Automaton]) -> None:
    """Whatever the answers are that rest on them: for each goal there is one of the two."""
    made, *others = versions
    known = proven(made)
    for other in others:
        inquiry = FarInquiry(about(other), NodeLimit(1 << 30), known.ordered(other.variables))
        inquiry.recall(known)
        within, steps = inquiry.perhaps_reached(), inquiry.limited(inquiry.plant, inquiry.plant.helpful)
        for trap in inquiry.traps:
            assert not any((step.after(trap) & within & ~trap).satisfiable() for step in steps)
        for way in inquiry.ways:
            leading = reaching(inquiry.diagrams, way.target & within, steps, within)
            assert not (way.states & within & ~leading).satisfiable()


@examples(80)
@given(made_by(with_tightened_guard))
def test_after_a_guard_was_tightened_it_is_known_what_does_not_need_it(versions: tuple[Automaton, Automaton]) -> None:
    """From all states from where no way met a start that is taken away."""
    made, other = versions
    known = proven(made)
    inquiry = FarInquiry(about(other), NodeLimit(1 << 30), known.ordered(other.variables))
    inquiry.recall(known)
    within, diagrams = inquiry.perhaps_reached(), inquiry.diagrams
    assume(not (diagrams.imported(known.reached[True]) & diagrams.valid & ~within).satisfiable())
    before = Plant(made, diagrams.names, diagrams=diagrams)
    steps = [*before.helpful, *before.all_starts]
    taken_away = diagrams.disjunction(
        before.where(conjunction(each.enabled, each.start_guard))
        & ~before.where(conjunction(other.abilities[name].enabled, other.abilities[name].start_guard))
        for name, each in made.abilities.items()
    )
    unneeded = within & ~reaching(diagrams, taken_away & within, steps, within)
    ways = {way.target: way.states for way in inquiry.ways}
    for target, layers in known.ways:
        leading = diagrams.imported(layers[-1]) & diagrams.valid & unneeded
        found = ways.get(diagrams.imported(target) & diagrams.valid, diagrams.false)
        assert not (leading & ~found).satisfiable()


@examples(80)
@given(made_by(with_edits))
def test_what_is_alike_has_the_same_safe_states(versions: list[Automaton]) -> None:
    made, *others = versions
    untold = replace(made, operations={}, title="another")
    assert alike(made, untold)
    sets = [Supervision(Plant(each, tuple(made.variables))) for each in (made, untold, *others)]
    safe = [each.plant.diagrams.exported(each.safe) for each in sets]
    for other, states in zip((untold, *others), safe[1:], strict=True):
        assert not alike(made, other) or states == safe[0]


def proven(made: Automaton) -> Evidence:
    """What leads to the goal of each operation, and what does not."""
    inquiry = FarInquiry(about(made), NodeLimit(1 << 30), tuple(made.variables))
    within, steps = inquiry.perhaps_reached(), inquiry.limited(inquiry.plant, inquiry.plant.helpful)
    for operation in made.operations.values():
        goal = inquiry.plant.where(operation.goal)
        layers = [goal & within]
        while (further := layers[-1] | inquiry.diagrams.disjunction(s.before(layers[-1]) for s in steps) & within) != (
            layers[-1]
        ):
            layers.append(further)
        inquiry.ways.append(LayeredWay.in_layers(goal, layers))
        inquiry.traps.append(within & ~layers[-1])
    return inquiry.evidence(Supervisor(inquiry.diagrams.exported(inquiry.safe), {}))


def about(made: Automaton) -> Questions:
    """All that is asked of it, with all its states called safe where it has no supervisor."""
    supervision = Supervision(Plant(made, tuple(made.variables)))
    safe = supervision.safe if supervision.possible else supervision.plant.diagrams.valid
    questions = [Variable(name, variable.type) for name, variable in made.variables.items()]
    return Questions(made, questions, supervision.plant.diagrams.exported(safe))


@examples(60)
@given(made_by(with_operations))
def test_no_more_states_are_reached_than_is_said_where_they_are_not_counted(made: Automaton) -> None:
    whole = Supervision(Plant(made, tuple(made.variables)))
    assume(whole.possible)
    *_, found = without_numbers(made, far=True, evidence=proven(made))
    assert found.supervised_at_most is not None
    assert found.supervised_at_most >= whole.plant.diagrams.count(whole.reachable(supervised=True))


@examples(60)
@given(made_by(with_operations))
def test_what_is_composed_of_parts_has_all_that_is_reached_and_no_step_leads_out(made: Automaton) -> None:
    plant = Plant(made, tuple(made.variables))
    starts = [step for steps in plant.starts.values() for step in steps]
    steps = [*plant.uncontrollable, *starts]
    exact = reachable(plant.diagrams, plant.initial, steps)
    groups = list(together(made))
    for parts in (groups, [], [*groups, *around(plant.diagrams, groups, 6)]):
        more = composed(plant.diagrams, plant.initial, steps, parts, plant.diagrams.valid)
        assert exact & ~more == plant.diagrams.false
        for step in steps:
            assert step.after(more) & plant.diagrams.valid & ~more == plant.diagrams.false
    whole = composed(plant.diagrams, plant.initial, steps, [tuple(made.variables)], plant.diagrams.valid)
    assert whole == exact
