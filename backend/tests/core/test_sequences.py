"""Sequences let operations be completed in the orders that they are about, and in no others: in free operation by the
preconditions that they expand to, and in a job by which of its operations are eligible.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.grounding.station import ground
from sequence_planner.automaton.tick import record_activity, update_operations
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.jobs import Job, Jobs
from sequence_planner.execution.state import ExecutionState
from sequence_planner.execution.vocabulary import JobState
from sequence_planner.language.types import Value
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import ModelError
from support.examples import examples

from .choices import Choices, made_by
from .sequence_language import Sop, Word, beginnings, sop, words

NOW = Timestamp(1.0, 1.0)
Names = frozenset[str]
Standing = tuple[Names, Names]  # what is done, and what is active
Moves = Callable[[Names, Names, Names], Names]  # what is active next: of what is done, ready, and active now


def station(names: list[str], operations: str, masters: str = "") -> Automaton:
    """Operations that can begin whenever the world is ready for them, and end whenever they have begun."""
    with TemporaryDirectory() as folder:
        declared = "".join(f"  {kind}_{name}: {{type: bool}}\n" for name in names for kind in ("ready", "done"))
        (Path(folder) / "station.yaml").write_text(f"name: s\nestimated:\n{declared}")
        written = "".join(f"{name}: {{precondition: ready_{name}, goal: done_{name}}}\n" for name in names)
        (Path(folder) / "operations.yaml").write_text(written + operations)
        if masters:
            (Path(folder) / "work_masters.yaml").write_text(masters)
        return ground(load_station(Path(folder)))


def subsets(names: Names) -> Iterator[Names]:
    for number in range(len(names) + 1):
        yield from map(frozenset, combinations(sorted(names), number))


def steps(moves: Moves, names: Names, at: Standing) -> set[tuple[str, Standing]]:
    """All that one tick can lead to, whatever the world is ready for, with what is completed in it, if anything."""
    done, active = at
    return {
        (completed, (now, moves(now, ready, active)))
        for completed in ("", *active)
        for now in (done | ({completed} - {""}),)
        for others in subsets(names - now - active)
        for ready in (others, others | now)
    }


def assert_same_orders(moves: Moves, whole: Sop) -> None:
    """Each order of completions that is possible is one of the sequence, each of these is possible, and none ends
    before it is over, least of all where the world is always ready.
    """
    names, language = frozenset(whole.names()), words(whole)
    known: dict[Standing, set[tuple[str, Standing]]] = {}

    def after(at: Standing) -> set[tuple[str, Standing]]:
        if at not in known:
            known[at] = steps(moves, names, at)
        return known[at]

    def closed(states: set[Standing]) -> frozenset[Standing]:
        found, pending = set(states), list(states)
        while pending:
            new = {to for completed, to in after(pending.pop()) if not completed} - found
            found |= new
            pending += new
        return frozenset(found)

    possible: set[Word] = set()
    pending: list[tuple[Word, frozenset[Standing]]] = [((), closed({(frozenset(), frozenset())}))]
    while pending:
        word, states = pending.pop()
        possible.add(word)
        onward: dict[str, set[Standing]] = {}
        for at in states:
            for completed, to in after(at):
                if completed:
                    onward.setdefault(completed, set()).add(to)
        pending += [((*word, completed), closed(to)) for completed, to in onward.items()]
    assert possible == beginnings(language)
    over = {frozenset(word) for word in language}
    always, onwards = set[Standing](), [(frozenset[str](), moves(frozenset(), names, frozenset()))]
    while onwards:
        done, active = onwards.pop()
        assert active or done in over
        after_each = {(done | {name}, moves(done | {name}, names, active)) for name in active} - always
        # What is done in this tick is seen to be active no more in the next one.
        onwards += {(now, moves(now, names, then)) for now, then in after_each}
        always |= after_each
    left = {at for at in known if at[0] not in over}
    while gone := {at for at in left if any(to not in left for _, to in after(at))}:
        left -= gone
    assert not left


def free(automaton: Automaton) -> Moves:
    """What the reference tick makes active."""

    def moves(done: Names, ready: Names, active: Names) -> Names:
        believed: Mapping[str, Value | None] = {
            **{name: name.removeprefix("done_") in done for name in automaton.variables if name.startswith("done_")},
            **{name: name.removeprefix("ready_") in ready for name in automaton.variables if name.startswith("ready_")},
        }
        return update_operations(automaton, record_activity(automaton, believed, active), active)

    return moves


@given(made_by(lambda choices: sop(choices, 5)))
@examples(600)
def test_preconditions_allow_the_orders_of_a_sequence(whole: Sop) -> None:
    automaton = station(list(whole.names()), f"s: {whole}\n")
    assert_same_orders(free(automaton), whole)


@given(made_by(lambda choices: sop(choices, 5)))
@examples(600)
def test_a_job_is_worked_in_the_orders_of_its_sequence(whole: Sop) -> None:
    names = list(whole.names())
    automaton = station(names, "", f"m: {whole}\n")
    # What has begun and is not done is active, as goals last and nothing else takes part.
    job = Job("1", "1", "m", NOW, JobState.RUNNING, begun=NOW)

    def moves(done: Names, ready: Names, active: Names) -> Names:
        began = replace(job, started=dict.fromkeys(done | active, NOW), completed=dict.fromkeys(done, NOW))
        conduct = ExecutionState(jobs=Jobs(by_order=True, taken=(began,)))
        possible = (active | ready) - done
        onward = possible - conduct.idle_operations(automaton, possible)
        (advanced,) = conduct.jobs.advanced(automaton, onward, done.__contains__, NOW).taken
        assert advanced.started.keys() == done | onward
        over = any(frozenset(word) == done for word in words(whole))
        assert (advanced.state is JobState.ENDED) == over
        return onward

    assert_same_orders(moves, whole)


def both(choices: Choices) -> tuple[Sop, Sop]:
    """Two orders of the same operations."""
    return sop(choices, 4), sop(choices, 4)


@given(made_by(both))
@examples(200)
def test_two_sequences_hold_together(pair: tuple[Sop, Sop]) -> None:
    """What both allow is possible, and nothing else, where they say what comes after what."""
    one, other = (_ordered(each) for each in pair)
    names = sorted({*one.names(), *other.names()})
    free_order = Sop("parallel", parts=tuple(Sop("operation", name) for name in names))
    in_both = frozenset(
        word
        for word in words(free_order)
        if all(tuple(name for name in word if name in each.names()) in words(each) for each in (one, other))
    )
    if not in_both:
        with pytest.raises(ModelError, match="order these in a circle"):
            station(names, f"s: {one}\nt: {other}\n")
        return
    automaton = station(names, f"s: {one}\nt: {other}\n")
    moves, possible = free(automaton), set[Word]()
    pending: list[tuple[Word, Standing]] = [((), (frozenset(), frozenset()))]
    while pending:
        word, (done, before) = pending.pop()
        active = moves(done, frozenset(names) - done, before)
        possible.add(word)
        pending += [((*word, name), (done | {name}, active - {name})) for name in active]
    assert possible == beginnings(in_both)


def _ordered(term: Sop) -> Sop:
    """Without choices."""
    kind = {"alternative": "sequence", "arbitrary": "parallel"}.get(term.kind, term.kind)
    return Sop(kind, term.name, tuple(map(_ordered, term.parts)))
