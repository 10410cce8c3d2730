"""Planning by projection: frozen irrelevant variables, goal-by-goal plans and partial-order merging."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from functools import cached_property

from sequence_planner.automaton.automaton import (
    Ability,
    Automaton,
    Effect,
    State,
    VariableDeclaration,
    reads,
    target,
)
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.transitions import Phase, Transition
from sequence_planner.core.immutable import Immutable, replace
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.syntax import (
    TRUE,
    And,
    Assignment,
    Constant,
    Expression,
    Implies,
    Not,
    Or,
    Variable,
    conjunction,
    conjuncts,
    variables,
)
from sequence_planner.language.types import EnumerationType, Value
from sequence_planner.planning.goals.pursuit import Goals, moved, settled
from sequence_planner.planning.heuristic.relaxed_plan import RelaxedPlan, Relevance, useful, written_by
from sequence_planner.planning.partial_states import PartialState, equalities
from sequence_planner.planning.portfolio.engine import Finding, PlanningTask
from sequence_planner.planning.problem import Contract, Plan, PlanTick
from sequence_planner.planning.sat.unrolling import Unrolling
from sequence_planner.planning.validation.acceptance import Acceptance, ReferenceRun
from sequence_planner.process.budget import Budget, SpentError
from sequence_planner.process.gc_tuning import collection_put_off

# What has to come before what in a run, so that the rest of it may come in another order, or at once.
#
# An event waits for those that have written what it relies on, and for those that relied on what it overwrites; all
# else in the run is left open (Bäckström 1998).


class CausalEvent(Immutable):
    """An effect, or with `start` a start, and the numbers of the events that it waits for."""

    name: str
    start: bool
    after: frozenset[int]


class CausalOrder:
    """The events of a run of one automaton, noted one after the other."""

    def __init__(self, automaton: Automaton) -> None:
        self.events: list[CausalEvent] = []
        self._predicates = automaton.flag_predicates
        self._writer: dict[str, int] = {}  # the last one of each variable
        self._readers: dict[str, list[int]] = defaultdict(list)  # since then

    def happens(self, effect: Effect, before: State) -> None:
        """Note an effect, with the state at the end of the tick before."""
        relied = set(self.relied_on(effect.guard, before))
        self._note(effect.name, False, relied, effect.actions, ())

    def starts(self, ability: Ability, before: State) -> None:
        """Note a start, with the state before it. What its finish writes counts as written from then on."""
        relied = set(self.relied_on(ability.enabled, before)).union(self.relied_on(ability.start_guard, before))
        self._note(ability.name, True, relied, ability.start_actions, ability.finish_actions)

    def relied_on(self, predicate: Expression, state: State) -> Iterator[str]:
        """Variables whose values in `state` alone give `predicate` its value there."""
        match predicate:
            case And(operands) | Or(operands):
                decisive = isinstance(predicate, Or)  # the truth value that one operand alone can give to the whole
                for part in next(([part] for part in operands if evaluate(part, state) is decisive), operands):
                    yield from self.relied_on(part, state)
            case Not(operand):
                yield from self.relied_on(operand, state)
            case Implies(left, right):
                yield from self.relied_on(Or((Not(left), right)), state)
            case Variable(name) if name in self._predicates:
                yield from self.relied_on(self._predicates[name], state)
            case _:
                for name in variables(predicate):
                    if name in self._predicates:
                        yield from self.relied_on(self._predicates[name], state)
                    else:
                        yield name

    def _note(
        self, name: str, start: bool, relied: set[str], now: Iterable[Assignment], later: Iterable[Assignment]
    ) -> None:
        number = len(self.events)
        relied.update(read for action in now for read in reads(action) if read not in self._predicates)
        written = set(map(target, (*now, *later)))
        after = {self._writer[each] for each in relied | written if each in self._writer}
        after.update(reader for each in written for reader in self._readers[each])
        self.events.append(CausalEvent(name, start, frozenset(after)))
        for each in relied:
            self._readers[each].append(number)
        for each in written:
            self._writer[each] = number
            self._readers[each] = []


# One order of starts for a tick in which most that can start together find their places.
#
# Who sets what another waits for comes before it, and who sets what keeps another from starting comes after it. Circles
# are broken somewhere, at the price that some starts wait for the next tick.


def likely_order(part: Automaton) -> tuple[Ability, ...]:
    """Each ability of `part` once."""
    before = _before(part.abilities)
    ordered: dict[str, Ability] = {}
    visited: set[str] = set()
    pending = [(name, False) for name in reversed(tuple(part.abilities))]
    while pending:
        name, done = pending.pop()
        if done:
            ordered[name] = part.abilities[name]
        elif name not in visited:
            visited.add(name)
            pending.append((name, True))
            pending += [(earlier, False) for earlier in before[name]]
    return tuple(ordered.values())


def _before(abilities: Mapping[str, Ability]) -> dict[str, dict[str, None]]:
    """For each ability those that should have their place before it."""
    guards = {name: _Guard(conjunction(ability.enabled, ability.start_guard)) for name, ability in abilities.items()}
    readers: dict[str, list[str]] = defaultdict(list)
    for name, guard in guards.items():
        for variable in guard.reading:
            readers[variable].append(name)
    before: dict[str, dict[str, None]] = {name: {} for name in abilities}
    for name, ability in abilities.items():
        written = set(map(target, ability.start_actions))
        for action in ability.start_actions:
            variable = target(action)
            for reader in readers[variable]:
                if reader == name:
                    continue
                if isinstance(action.value, Constant) and guards[reader].excludes(variable, action.value.value):
                    before[name][reader] = None
                elif not any(n not in written and guards[name].excludes(n, v) for n, v in guards[reader].equalities):
                    before[reader][name] = None
    return before


class _Guard:
    """The demands of a guard on variables, one by one."""

    def __init__(self, guard: Expression) -> None:
        self.reading: dict[str, list[Expression]] = defaultdict(list)  # parts by the variables that they read
        for part in conjuncts(guard):
            for name in dict.fromkeys(variables(part)):
                self.reading[name].append(part)
        self.equalities = tuple(equalities(guard))

    def excludes(self, name: str, value: Value) -> bool:
        """Return whether it cannot hold while the variable `name` has that value."""
        return any(evaluate(part, PartialState({name: value})) is False for part in self.reading.get(name, ()))


# The part of an automaton that is left when most variables are frozen: what writes the others, and no more.


def part_of(
    automaton: Automaton,
    supervisor: Supervisor,
    relevance: Relevance,
    state: State,
    loose: Set[str],
    asked: Iterable[Expression],
    serving: Iterable[str] | None = None,
) -> Automaton:
    """`automaton` without what would change another variable in `state` than those `loose`, and without the flags and
    variables that nothing of it, of the supervisor or of what is `asked` then reads.

    With `serving`, names of abilities and effects, also without what is of no use to these.
    """

    def kept(*actions: Assignment) -> bool:
        return all(target(action) in loose or _idle(action, state) for action in actions)

    writing = relevance.writing(loose)
    names = dict.fromkeys(move.name.rpartition(".")[0] for move in writing if move.phase is not Phase.SENSE)
    found = (automaton.abilities[name] for name in automaton.abilities if name in names)
    abilities = {each.name: each for each in found if kept(*each.start_actions, *each.finish_actions)}
    happening = {move.name for move in writing if move.phase is Phase.SENSE}
    effects = tuple(each for each in automaton.effects if each.name in happening and kept(*each.actions))

    part = replace(automaton, abilities=abilities, effects=effects)
    if serving is not None:
        part = useful(part, serving, asked)
    read = [*_read(part, supervisor), *(name for each in asked for name in variables(each))]
    if None in state.values():  # the flag that an ability is enabled is then more than its predicate
        read += (ability.flag("enabled") for ability in part.abilities.values())
    known = _with_flags(automaton, read)
    return replace(
        part,
        variables=_narrowed(part, state, known | loose),
        flags=tuple(flag for flag in automaton.flags if flag.name in known),
    )


def _read(part: Automaton, supervisor: Supervisor) -> Iterator[str]:
    """Yield what its abilities and effects read, and what the supervisor reads of them."""
    yield from supervisor.safe.names
    for ability in part.abilities.values():
        for predicate in (ability.enabled, ability.start_guard, ability.finish_guard or TRUE):
            yield from variables(predicate)
        for action in (*ability.start_actions, *ability.finish_actions):
            yield from reads(action)
        if (guard := supervisor.guards.get(ability.name)) is not None:
            yield from guard.names
    for effect in part.effects:
        yield from variables(effect.guard)
        for action in effect.actions:
            yield from reads(action)


def _narrowed(part: Automaton, state: State, names: Set[str]) -> dict[str, VariableDeclaration]:
    """The variables `names` and all that are written.

    Those of enumerations are without the values that they do not have and that nothing in `part` gives them.
    """
    values = written_by(part)
    narrowed: dict[str, VariableDeclaration] = {}
    for name, variable in part.variables.items():
        if name in names or name in values:
            if isinstance(variable.type, EnumerationType):
                possible = tuple(v for v in variable.type.values if v == state[name] or v in values[name])
                variable = replace(variable, type=EnumerationType(possible))
            narrowed[name] = variable
    return narrowed


def _with_flags(automaton: Automaton, names: Iterable[str]) -> set[str]:
    """With all that flags among `names` depend on."""
    predicates, found, pending = automaton.flag_predicates, set[str](), list(names)
    while pending:
        name = pending.pop()
        if name not in found:
            found.add(name)
            if name in predicates:
                pending.extend(variables(predicates[name]))
    return found


def _idle(action: Assignment, state: State) -> bool:
    """Return whether the action leaves the variable as it is in `state`; what is unknown stays so."""
    value = state[target(action)]
    return value is None or action.value == Constant(value)


# A plan of a small automaton, asked for once: of the fewest ticks, and without starts that it can do without.


class Shortest:
    """Looks for a plan of one task, and goes on where it was when the budget was spent.

    Whatever is known for certain becomes a clause, so that nothing else can be asked of its solver afterwards.
    """

    def __init__(self, unrolling: Unrolling, task: PlanningTask) -> None:
        self._unrolling = unrolling
        self._task = task
        self._searched = 0  # ticks up to which there is no plan
        unrolling.solver.add_clauses([literal] for literal in unrolling.given(task.state, task.circumstances))

    def plan(self, longest: int, budget: Budget) -> Plan | None:
        """A plan in at most `longest` ticks; None if there is none. Raises `SpentError`."""
        unrolling, task = self._unrolling, self._task
        while self._searched < longest:
            length = self._searched + 1
            unrolling.extend(length, budget)
            unrolling.solver.add_clauses([literal] for literal in unrolling.keeps(task.circumstances, length))
            wanted = [unrolling.reached(goal, length) for goal in task.goals]
            answer = unrolling.solver.solve(wanted, budget)
            if answer is None:
                raise SpentError
            if answer:
                unrolling.solver.add_clauses([literal] for literal in wanted)
                return Plan(self._without_needless(length, budget), minimal_ticks=False, minimal_starts=False)
            self._searched = length
        return None

    def _without_needless(self, length: int, budget: Budget) -> tuple[PlanTick, ...]:
        """The plan in the solver, less the starts without which the rest of it still is one, earlier ones first."""
        unrolling, solver = self._unrolling, self._unrolling.solver
        model = solver.model()
        starts = unrolling.starts(length)
        taken = set(starts).intersection(model)
        solver.add_clauses([-choice] for choice in starts if choice not in taken)
        for choice in unrolling.starts(length - 1):
            if choice not in taken:
                continue
            answer = solver.solve([-choice], budget)
            if answer is None:
                break
            if answer:
                model = solver.model()
                left_out = taken.difference(model)
                taken -= left_out
                solver.add_clauses([-each] for each in left_out)
            else:
                solver.add_clause([choice])
        return unrolling.read(length, length - 1, model)


# The engine that freezes all that a relaxed plan does not touch, and plans with the rest.
#
# What is left is small however large the station is. A plan of it counts only when it replays on the whole; as long as
# it does not, or there is none, more variables are let loose, and in the end other engines decide.

# A plan that is much longer than the relaxed one, in ticks, is left to others.
_LONGER, _MORE = 2, 4
# Of the variables, unless they are few; beyond, nothing is gained.
_MOST, _FEW = 0.7, 50


class SketchedPlan(Immutable):
    """A relaxed plan of `task`, its layers, and the variables that it writes."""

    task: PlanningTask
    relaxed: Sequence[Transition]
    layers: int
    written: frozenset[str]


class _Work:
    """The work begun on a task: the parts of the automaton still to be tried, and the one that is being tried."""

    def __init__(self, task: PlanningTask, longest: int, parts: Iterator[Automaton]) -> None:
        self.task = task
        self.longest = longest
        self.parts = parts
        self.shortest: Shortest | None = None


class Projection:
    """Fast plans for one automaton under one supervisor, by any contract; asked again, it goes on where it stopped."""

    name = "projection"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._relevance = Relevance(automaton)
        self._acceptance = Acceptance.of(automaton, supervisor)
        # Where nothing happens by itself, a search is sooner done.
        self._reacts = any(not effect.fault for effect in automaton.effects) or any(
            ability.finish_guard is not None for ability in automaton.abilities.values()
        )
        self._work: _Work | None = None

    @collection_put_off()
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan, if freezing what does not seem to matter leaves one that replays; nothing is proven of it."""
        if self._work is None or self._work.task is not task:
            outline = self.outline(task)
            if outline is None:
                return Finding()
            self.take_up(outline)
        assert self._work is not None
        try:
            plan = self._plan(self._work, budget)
        except SpentError:
            return Finding()
        self._work = None
        return Finding(plan)

    def outline(self, task: PlanningTask) -> SketchedPlan | None:
        """None if there is no relaxed plan of `task`, or this is no engine for it.

        The plan is made of what seems to matter if possible.
        """
        goals = [goal.predicate for goal in task.goals]
        for moves in self._moves(task, goals) if self._reacts else ():
            guess = RelaxedPlan(self._automaton, task.state, moves)
            relaxed = guess.towards(goals)
            if relaxed is not None:
                return SketchedPlan(task, relaxed, guess.layers, self._written(relaxed))
        return None

    def take_up(self, outline: SketchedPlan) -> None:
        """Begin to work on its task, which is asked for next."""
        longest = min(outline.task.bound, _LONGER * outline.layers + _MORE)
        self._work = _Work(outline.task, longest, self._parts(outline))

    def _plan(self, work: _Work, budget: Budget) -> Plan | None:
        """A plan of the first part that has one which replays. Raises `SpentError`."""
        while True:
            if work.shortest is None:
                budget.require()
                part = next(work.parts, None)
                if part is None:
                    return None
                work.shortest = Shortest(self._unrolling(work.task.state, part, budget), work.task)
            plan = work.shortest.plan(work.longest, budget)
            if plan is not None and self._acceptance.accepts(work.task, plan):
                return plan
            work.shortest = None

    def _unrolling(self, state: State, part: Automaton, budget: Budget) -> Unrolling:
        written = written_by(part)
        frozen = {n: value for n in part.variables if n not in written and (value := state[n]) is not None}
        unknown = frozenset(name for name in part.types if state[name] is None)
        order = likely_order(part)
        inside = self._supervisor.safe.includes(state)
        return Unrolling(part, self._supervisor, order, unknown, inside, frozen, oracles=frozenset(), budget=budget)

    def _parts(self, outline: SketchedPlan) -> Iterator[Automaton]:
        """The parts to be tried, from the smallest on: of the first only what serves the relaxed plan."""
        task = outline.task
        serving: list[str] | None = [_unit(move) for move in outline.relaxed]
        last: Set[str] = frozenset()
        for loose in self._loosened(outline):
            if loose == last or len(loose) > max(_MOST * len(self._automaton.variables), _FEW):
                return
            part = part_of(self._automaton, self._supervisor, self._relevance, task.state, loose, _asked(task), serving)
            yield part
            serving, last = None, loose

    def _moves(self, task: PlanningTask, goals: Sequence[Expression]) -> Iterator[Sequence[Transition]]:
        yield self._relevance.towards(goals, task.state, task.circumstances)
        yield self._relevance.counted_on(task.state, task.circumstances)

    def _loosened(self, outline: SketchedPlan) -> Iterator[frozenset[str]]:
        """Sets of variables to be let loose, each larger than the one before.

        First those that the relaxed plan writes, then those that it reads, and at last all that transitions touch which
        write one of these, and all that keeps starts of these.
        """
        yield outline.written
        loose = outline.written | read_variables(self._automaton, _asked(outline.task))
        yield loose.union(*map(self._touched, outline.relaxed))
        while True:
            loose = self._widened(loose)
            yield loose

    def _written(self, relaxed: Iterable[Transition]) -> frozenset[str]:
        return frozenset(name for move in relaxed for name in (*move.writes, *self._ending(move)))

    def _touched(self, move: Transition) -> frozenset[str]:
        values = (action.value for action in move.actions)
        conditions = (action.condition for action in move.actions if action.condition is not None)
        return move.writes | read_variables(self._automaton, (move.guard, *values, *conditions))

    def _ending(self, move: Transition) -> frozenset[str]:
        """Return what comes after a start in any case."""
        if move.phase is not Phase.START:
            return frozenset()
        return frozenset(map(target, self._automaton.abilities[move.name.removesuffix(".start")].finish_actions))

    def _widened(self, loose: frozenset[str]) -> frozenset[str]:
        found = set(loose)
        for move in self._relevance.writing(loose):
            found |= self._touched(move)
            guard = self._supervisor.guards.get(move.name.removesuffix(".start"))
            found |= set(() if guard is None else guard.names)
        return frozenset(found)


def _unit(move: Transition) -> str:
    """The effect or the ability that a transition is of."""
    return move.name if move.phase is Phase.SENSE else move.name.rpartition(".")[0]


def _asked(task: PlanningTask) -> list[Expression]:
    """The predicates and formulas of a task."""
    return [*task.circumstances.avoid, *(part for goal in task.goals for part in (goal.predicate, goal.local))]


# The engine that plans for several goals one after the other, and then lets the plans run beside each other.
#
# Each plan begins where the last one has ended, so that together they are one, however much they share. What need not
# wait comes as soon as it can: every event waits only for what it relies on, and for what relied on what it overwrites.
# Goals that have little in common are reached as soon so as if they were planned together, which would take far longer
# to do; others are left to engines that do that.

_MOST_SHARED = 0.25  # of the variables that a goal's relaxed plan writes, those that another's writes too
_LONGER_THAN_PARTS = 1.5  # than the longest of its parts a plan may be


class _GoalWork:
    """The work done on a task, from where its runs begin: the plans up to now for its goals, in their order."""

    def __init__(
        self, first: SketchedPlan, task: PlanningTask, goals: Goals, begun: ReferenceRun, order: CausalOrder
    ) -> None:
        self.task = task
        self.goals = goals  # still missing
        self.begun = begun
        self.order = order
        self.longest = 0  # ticks of one of the plans
        self.next = first.task


class GoalByGoal:
    """Fast plans for one automaton under one supervisor; asked again, it goes on where the budget was spent."""

    name = "goal by goal"

    def __init__(self, automaton: Automaton, supervisor: Supervisor) -> None:
        self._automaton = automaton
        self._supervisor = supervisor
        self._work: _GoalWork | None = None

    @collection_put_off()
    def solve(self, task: PlanningTask, budget: Budget) -> Finding:
        """A plan for several goals that are nearly independent; nothing for others, or by another contract."""
        if task.contract is not Contract.FAST or len(task.goals) < 2:
            return Finding()
        if self._work is None or self._work.task is not task:
            self._work = self._begun(task)
        work = self._work
        while work is not None and work.goals:
            plan = self._projection.solve(work.next, budget).plan
            if plan is None and budget.spent:
                return Finding()
            if plan is None or not self._taken(work, plan):
                work = None
        self._work = None
        return Finding(None if work is None else self._together(work))

    @cached_property
    def _projection(self) -> Projection:
        return Projection(self._automaton, self._supervisor)

    @cached_property
    def _acceptance(self) -> Acceptance:
        return Acceptance.of(self._automaton, self._supervisor)

    def _begun(self, task: PlanningTask) -> _GoalWork | None:
        """Nothing done yet, goals that seem to take longest first; None if they seem to have too much in common."""
        outlines: list[SketchedPlan] = []
        for goal in task.goals:
            outline = self._projection.outline(replace(task, goals=(goal,)))
            if outline is None:
                return None
            outlines.append(outline)
        times = Counter(name for outline in outlines for name in outline.written)
        if any(sum(times[name] > 1 for name in each.written) > _MOST_SHARED * len(each.written) for each in outlines):
            return None
        outlines.sort(key=lambda outline: -outline.layers)
        self._projection.take_up(outlines[0])
        goals = tuple(goal for outline in outlines for goal in outline.task.goals)
        run = self._acceptance.begin(task)
        self._acceptance.begin_at(outlines[0].task, run.fork(outlines[0].task.goals))
        return _GoalWork(outlines[0], task, goals, run, CausalOrder(self._automaton))

    def _taken(self, work: _GoalWork, plan: Plan) -> bool:
        """Go on with `plan`, noting what waits for what; whether that can be with all goals in mind."""
        course = self._acceptance.course(work.next, plan)
        if course is None:
            return False
        effects = {effect.name: effect for effect in self._automaton.effects}
        before, run = work.next.state, work.begun
        for point in course.way:
            tick, run = plan.ticks[point.tick], point.run
            if point.starts == 0:
                for name in tick.effects:
                    work.order.happens(effects[name], before)
                left = settled(work.goals, run.values)
            else:
                work.order.starts(self._automaton.abilities[tick.starts[point.starts - 1]], before)
                left = moved(work.goals, run.values)
            if left is None:
                return False
            before, work.goals = run.values, left
            if not left:
                break
        work.longest = max(work.longest, len(plan.ticks))
        work.next = replace(work.task, state=before, goals=work.goals[:1])
        self._acceptance.begin_at(work.next, run.fork(work.next.goals))
        return True

    def _together(self, work: _GoalWork) -> Plan | None:
        """The plan in which every event comes as soon as it may; None if it is too long, or none."""
        events, task = work.order.events, work.task
        run, pending, done = work.begun.fork(), list(range(len(events))), set[int]()
        self._acceptance.begin_at(task, work.begun)
        ticks: list[PlanTick] = []
        while run.goals:
            if len(ticks) >= min(_LONGER_THAN_PARTS * work.longest, task.longest):
                return None
            ready = {
                events[each].name: each for each in pending if not events[each].start and events[each].after <= done
            }
            effects = run.happening(ready)
            if not run.settle(effects):
                return None
            done.update(ready[name] for name in effects)
            starts: dict[str, None] = {}
            for number in pending if run.goals else ():
                event = events[number]
                if event.start and event.after <= done and event.name not in starts and run.may_start(event.name):
                    after = run.fork()
                    if after.start(event.name):
                        run = after
                        done.add(number)
                        starts[event.name] = None
            pending = _left(pending, done)
            ticks.append(PlanTick(effects, tuple(starts)))
        return Plan(tuple(ticks), minimal_ticks=False, minimal_starts=False)


def _left(pending: Iterable[int], done: set[int]) -> list[int]:
    return [number for number in pending if number not in done]
