"""Ticks per second of the compiled tick, beside a plain interpreter of closures and beside the reference.

Run with `make bench`. A tick takes 3 changed measured values, then finishes, synchronises, updates the operations, and
asks 3 abilities in turn whether they may start, and starts those that may. All three interpreters take the same ticks
and must come to the same state. Figures are by CPU time, and medians of rounds in each of which every interpreter has
its turn; ratios are taken within a round.
"""

from __future__ import annotations

import gc
import random
import resource
import statistics
import sys
import time
from collections.abc import Callable, Mapping
from typing import NamedTuple

from compared.closures import ClosureRun
from compared.ring import ring

from sequence_planner.automaton import tick as reference
from sequence_planner.automaton.automaton import Automaton, Kind, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.transitions import transitions
from sequence_planner.language.types import Value

SIZES = (200, 1000, 5000)
CHANGED = 3  # variables per tick
ASKED = 3  # abilities per tick
BATCHES = 2000
ROUNDS = 5
SECONDS = 0.5  # of each turn
MILLION = 1_000_000


class Batch(NamedTuple):
    """What a tick is given."""

    measured: Mapping[str, Value | None]
    asked: tuple[str, ...]


Ticks = Callable[[Batch], None]


def main() -> None:
    """Measure and print."""
    for size in SIZES:
        measure(size)
    measure_memory()


def measure(size: int) -> None:
    """One line for stations of about `size` transitions."""
    automaton = ring(size)
    began = time.process_time()
    compiled = CompiledTick(automaton)
    compiling = time.process_time() - began
    batches = random_batches(automaton)
    check_agreement(automaton, compiled, batches)
    takers = (
        compiled_ticks(CompiledRun(compiled, reference.initial_state(automaton))),
        closure_ticks(ClosureRun(automaton)),
        reference_ticks(ReferenceRun(automaton)),
    )
    rounds = [[speed(take, batches) for take in takers] for _ in range(ROUNDS)]
    fast, closures, slow = (statistics.median(each) for each in zip(*rounds, strict=True))
    times_closures = statistics.median(each[0] / each[1] for each in rounds)
    times_reference = statistics.median(each[0] / each[2] for each in rounds)
    print(
        f"{len(transitions(automaton)):5} transitions, {len(automaton.flags):5} flags: compiled in {compiling:.2f} s,"
        f" {fast:7.0f} ticks/s; closures {closures:6.0f}, ratio {times_closures:5.1f};"
        f" reference {slow:5.0f}, ratio {times_reference:5.0f}"
    )


def random_batches(automaton: Automaton) -> list[Batch]:
    """Batches in which every measured value given differs from the one before."""
    chance = random.Random(1)
    measured = automaton.names(Kind.MEASURED)
    abilities = list(automaton.abilities)
    now = {name: automaton.variables[name].initial for name in measured}
    batches: list[Batch] = []
    for _ in range(BATCHES):
        changes = {
            name: chance.choice([value for value in automaton.types[name].domain if value != now[name]])
            for name in chance.sample(measured, CHANGED)
        }
        now |= changes
        batches.append(Batch(changes, tuple(chance.sample(abilities, ASKED))))
    return batches


class ReferenceRun:
    """The reference as a run: a state and the operations that are active."""

    def __init__(self, automaton: Automaton) -> None:
        self.automaton = automaton
        self.state: State = reference.initial_state(automaton)
        self.active: frozenset[str] = frozenset()


def reference_ticks(run: ReferenceRun) -> Ticks:
    """Takes a tick of the reference."""
    automaton = run.automaton

    def take(batch: Batch) -> None:
        run.state = reference.synchronise(
            automaton, reference.finish(automaton, reference.sense(run.state, batch.measured)).state
        )
        run.active = reference.update_operations(automaton, run.state, run.active)
        for name in batch.asked:
            if reference.start_guard_holds(automaton.abilities[name], run.state):
                run.state = reference.start(automaton, run.state, automaton.abilities[name]) or run.state

    return take


def closure_ticks(run: ClosureRun) -> Ticks:
    """Takes a tick of the interpreter of closures."""

    def take(batch: Batch) -> None:
        run.sense(batch.measured)
        run.finish()
        run.synchronise()
        run.update_operations()
        for name in batch.asked:
            if run.may_start(name):
                run.start(name)

    return take


def compiled_ticks(run: CompiledRun) -> Ticks:
    """Takes a compiled tick."""
    active: frozenset[str] = frozenset()

    def take(batch: Batch) -> None:
        nonlocal active
        run.sense(batch.measured)
        run.finish()
        run.synchronise()
        active = run.update_operations(active)
        run.record_activity(active)
        for name in batch.asked:
            if name in run.startable():
                run.start(name)

    return take


def check_agreement(automaton: Automaton, compiled: CompiledTick, batches: list[Batch]) -> None:
    """All three come to the same state; a fast wrong one would be no news."""
    fast = CompiledRun(compiled, reference.initial_state(automaton))
    closures, slow = ClosureRun(automaton), ReferenceRun(automaton)
    takers = (compiled_ticks(fast), closure_ticks(closures), reference_ticks(slow))
    for batch in batches[:100]:
        for take in takers:
            take(batch)
        if not fast.state == closures.state == slow.state:
            raise AssertionError("the interpreters disagree")


def speed(take: Ticks, batches: list[Batch]) -> float:
    """Ticks per second."""
    count, began = 0, time.process_time()
    while (passed := time.process_time() - began) < SECONDS:
        for batch in batches[count % BATCHES : count % BATCHES + 20]:
            take(batch)
        count += 20
    return count / passed


def measure_memory() -> None:
    """What a million ticks leave behind."""
    automaton = ring(SIZES[0])
    batches = random_batches(automaton)
    run = CompiledRun(CompiledTick(automaton), reference.initial_state(automaton))
    take = compiled_ticks(run)
    for batch in batches:
        take(batch)
    for number in range(MILLION):
        take(batches[number % BATCHES])
        if number == MILLION // 10:
            early = held()
    late = held()
    print(
        f"a million ticks: {late[0] - early[0]:+} allocated blocks and {late[1] - early[1]:+} KiB of the process"
        " since the first hundred thousand"
    )


def held() -> tuple[int, int]:
    """Blocks of memory that are allocated, and the most KiB the process ever had."""
    gc.collect()
    return sys.getallocatedblocks(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == "__main__":
    main()
