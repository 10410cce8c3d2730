"""What is found where the states that are reached are not computed: against the definition, and run by run."""

from __future__ import annotations

import pytest
from hypothesis import assume, given

from checking.test_supervised import Expected, with_operations
from core.budget import examples
from core.choices import made_by
from core.replaying import replay
from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking import far
from sequence_planner.checking.far import from_afar
from sequence_planner.checking.possibility import UNKNOWN, Finding
from sequence_planner.checking.supervised import subjects_of
from sequence_planner.expressions.evaluation import holds
from sequence_planner.synthesis.approximation import around, composed
from sequence_planner.synthesis.plant import Plant, together
from sequence_planner.synthesis.saturation import reachable
from sequence_planner.synthesis.supervision import supervised, supervisor


def found(made: Automaton) -> list[Finding]:
    supervision = supervised(made)
    safe = supervision.plant.diagrams.exported(supervision.safe)
    return list(from_afar(made, list(subjects_of(made)), safe, supervisor(supervision), planning=0.1))


def hold(made: Automaton) -> None:
    """Assert that what is found of `made` is what the definition says, and that its runs are ones that show it."""
    expected = Expected(made)
    assume(expected.initial in expected.safe)
    findings = {each.subject.name: each for each in found(made)}
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


@examples(80)
@given(made_by(with_operations))
def test_what_is_found_from_afar_is_what_the_definition_says(made: Automaton) -> None:
    hold(made)


@examples(40)
@given(made_by(with_operations))
def test_it_is_so_too_where_each_question_is_a_long_one(made: Automaton) -> None:
    """Parts are made larger then, and states next to known runs are looked at one by one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(far, "_SOON", 0)
        hold(made)


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
