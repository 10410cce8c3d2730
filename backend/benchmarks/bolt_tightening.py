"""What the bolt tightening station costs: safe states, plans (warm beside fresh), ticks, the look-ahead at each start.

Run with `make bench`. Figures are medians; ratios are taken within the run.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from sequence_planner.automaton.automaton import Ability, Automaton, State
from sequence_planner.automaton.compiled_tick import CompiledRun
from sequence_planner.automaton.compiler import CompiledTick
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.tick import finish, initial_state, synchronise
from sequence_planner.planning.problem import Circumstances, Goal, Plan, goals_of
from sequence_planner.planning.sat.search import Search, SoughtPlans
from sequence_planner.planning.sat.start_order import sweep_order
from sequence_planner.planning.validation.lookahead import Lookahead
from sequence_planner.planning.validation.replay import Replay
from sequence_planner.process.budget import Budget
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise

MODEL = Path(__file__).parents[2] / "models" / "bolt_tightening"
PAIRS = ("bolt_pair_1", "bolt_pair_2", "bolt_pair_3")
REPEATS = 9


def median(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median time of `work`, in milliseconds."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append((time.perf_counter() - began) * 1000)
    return statistics.median(times)


def main() -> None:
    """Measure and print."""
    automaton = prepare_station(MODEL).automaton
    say("load and check the model", median(lambda: prepare_station(MODEL), 3))
    say("safe states and guards", median(lambda: synthesise(automaton), 3))
    supervisor = synthesise(automaton)
    say("sweep order", median(lambda: sweep_order(automaton, supervisor), 3))
    order = sweep_order(automaton, supervisor)
    warm = Search(automaton, supervisor, order, frozenset())
    for pairs in (PAIRS[:1], PAIRS):
        measure_plans(automaton, supervisor, order, warm, pairs)
    state = initial_state(automaton)
    tick = median(lambda: [synchronise(automaton, finish(automaton, state).state) for _ in range(100)]) / 100
    say("finish and synchronise, reference", tick, f"{1000 / tick:.0f} per second")


def measure_plans(
    automaton: Automaton, supervisor: Supervisor, order: Sequence[Ability], warm: Search, pairs: Sequence[str]
) -> None:
    """Plan the tightening of `pairs` from a station at home, with a warm solver and with fresh ones."""
    bolts = {f"bolts[{pair}]": "placed" for pair in pairs}
    state = synchronise(automaton, {**initial_state(automaton), **bolts})
    goals = goals_of(automaton, (f"tighten_bolt_pair({pair})" for pair in pairs))

    def plan(search: Search) -> Plan:
        found = search.plan(SoughtPlans(state, goals, Circumstances(), 60), Budget.seconds(60))
        assert found is not None
        return found

    found = plan(warm)
    what = f"plan {len(pairs)} pair(s): {len(found.ticks)} ticks, {len(found.starts)} starts"
    fresh_time = median(lambda: plan(Search(automaton, supervisor, order, frozenset())), 3)
    warm_time = median(lambda: plan(warm))
    say(f"{what}, fresh", fresh_time)
    say(f"{what}, warm", warm_time, f"fresh / warm = {fresh_time / warm_time:.1f}")
    measure_look_ahead(automaton, supervisor, state, goals, [name for _, name in found.starts])


def measure_look_ahead(
    automaton: Automaton, supervisor: Supervisor, state: State, goals: Sequence[Goal], order: Sequence[str]
) -> None:
    """Look ahead over all starts of a plan: by the reference tick, by the compiled one, and when it is known."""
    replay, compiled = Replay(automaton, supervisor), CompiledTick(automaton)
    run = CompiledRun(compiled, state)
    run.synchronise()

    def cold() -> None:
        Lookahead(compiled, supervisor).length(run, state, goals, order)

    known = Lookahead(compiled, supervisor)
    reference = median(lambda: replay.eagerly(state, state, goals, order))
    say("look-ahead over its starts, reference", reference)
    for what, work in (("cold", cold), ("known", lambda: known.length(run, state, goals, order))):
        time_taken = median(work)
        say(f"look-ahead over its starts, {what}", time_taken, f"reference / {what} = {reference / time_taken:.1f}")


def say(what: str, milliseconds: float, more: str = "") -> None:
    """Print one figure."""
    print(f"{what:<48} {milliseconds:10.3f} ms   {more}")


if __name__ == "__main__":
    main()
