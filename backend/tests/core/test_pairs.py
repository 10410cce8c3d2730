"""What pairs of values prove of plain automata."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given

from sequence_planner.automaton.plain.meaning import plain_automaton
from sequence_planner.language.evaluator import holds
from sequence_planner.model.efa_document import read_plain
from sequence_planner.planning.pdr.invariants import check
from sequence_planner.planning.problem import goals_of
from sequence_planner.planning.single.derived import as_station, without_flags
from sequence_planner.planning.single.pairs import PairProver
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.examples import examples

from .choices import made_by
from .explicit_plain import ExplicitPlain
from .random_plain import document


@examples(200)
@given(made_by(document))
def test_what_pairs_exclude_is_never_reached_and_the_proof_passes_the_certificate(written: dict[str, Any]) -> None:
    explicit = ExplicitPlain(written)
    if not explicit.initial or not explicit.initial <= explicit.safe:
        return
    automaton = plain_automaton(read_plain(json.dumps(written), "example.efa.json"))
    supervisor, goals = synthesise(automaton), goals_of(automaton, automaton.operations)
    key = min(explicit.initial, key=str)
    derived, task = as_station(automaton, explicit.valuation(key), goals)
    if not task.goals:
        return
    budget = Budget.seconds(60)
    bare = without_flags(automaton)
    proof = PairProver(bare, supervisor).solve(task, budget).proof
    if proof is None:
        return
    reached = explicit.distances({key}, True)
    assert not any(all(holds(goal.predicate, explicit.valuation(each)) for goal in goals) for each in reached)
    check(derived, supervisor, task, proof, budget, whole=True)


def test_two_that_exclude_one_another_need_no_more_than_pairs() -> None:
    """Each of many users can have the one thing, which the delete relaxation takes for enough."""
    users = [f"user{number}" for number in range(6)]
    take = [{"event": f"take_{u}", "guard": "free", "set": {u: True, "free": False}} for u in users]
    give = [{"event": f"give_{u}", "guard": u, "set": {u: False, "free": True}} for u in users]
    written = {
        "name": "users",
        "variables": {**dict.fromkeys(users, "bool"), "free": "bool"},
        "initial": " and ".join(["free", *(f"not {user}" for user in users)]),
        "transitions": [{"controllable": True, **each} for each in (*take, *give)],
        "goal": ["F (user0 and user5)", "F (user5)"],
    }
    automaton = plain_automaton(read_plain(json.dumps(written), "users.efa.json"))
    supervisor, both = synthesise(automaton), goals_of(automaton, automaton.operations)
    budget = Budget.seconds(60)
    derived, task = as_station(automaton, automaton.initial_valuation, both[:1])
    engine = PairProver(without_flags(automaton), supervisor)
    proof = engine.solve(task, budget).proof
    assert proof is not None
    assert all(len(clause) <= 2 for clause in proof.invariant)
    check(derived, supervisor, task, proof, budget, whole=True)
    assert engine.solve(as_station(automaton, automaton.initial_valuation, both[1:])[1], budget).proof is None
