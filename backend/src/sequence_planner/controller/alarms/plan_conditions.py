"""Alarms of what is done: plans that are missing, abilities that are late or given up, formulas that were violated."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from sequence_planner.automaton.automaton import Ability
from sequence_planner.controller.alarms.alarm import LATE, Cause, Consequences, listed
from sequence_planner.controller.alarms.device_conditions import MANY, UNHEARD, silent_key
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.recovery.explain import idle_since, waits_for
from sequence_planner.controller.recovery.side_effects import is_along
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.station import Priority
from sequence_planner.controller.views.wording import end_text, value_text
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.plan_tracker import violation
from sequence_planner.execution.state import OutOfService
from sequence_planner.execution.timeouts import in_the_past, overdue
from sequence_planner.execution.vocabulary import PlanStatus, Production, ServiceKind
from sequence_planner.language.syntax import variables
from sequence_planner.planning.problem import PlanAnswer

_STILL = "still:"
START_WITHIN = 5.0  # seconds in which the next start of what was taken begins, or it is said why not
END_WITHIN = 30.0  # seconds in which it comes to its end once nothing of it is left to be started


class PlanAlarms:
    """Looks at what `execution` does, and at which devices are `still`; `feeds` say which resources tell a measured
    variable.
    """

    def __init__(self, execution: Executor, feeds: Inputs, still: StallDetector, who_can: WhoCan) -> None:
        self._execution = execution
        self._told_still: frozenset[str] = frozenset()
        self._consequences = Consequences(execution, who_can)
        self._still = still
        self._feeds = feeds
        self._tellers = {
            name: frozenset(feeds.resource_of(topic) for topic in topics) for name, topics in feeds.sources.items()
        }

    def causes(self, planner_trouble: str | None, monotonic: float, untold: Collection[str] = ()) -> Iterator[Cause]:
        """All that there are now. What comes of it that the `untold` are silent is told no sooner than that."""
        yield from self._late(monotonic)
        yield from self._standing_still(monotonic)
        yield from self._given_up()
        yield from self._called_off()
        yield from self._waiting_errand(monotonic)
        if planner_trouble is not None:
            yield Cause(
                "planner",
                Priority.MEDIUM,
                planner_trouble,
                past=f"The planner did not work: {planner_trouble}",
                consequence=f"No new plan is made. {self._consequences.waiting(self._execution.active)}",
                action="Tell the maintainers of this station's model.",
            )
        elif self._execution.production is Production.STARTED:  # that there is no plan has no other cause
            yield from self._violated()
            if self._execution.conduct.silent.isdisjoint(untold):
                yield from self._missing()

    def _late(self, monotonic: float) -> Iterator[Cause]:
        """Abilities that take longer than they may; those that are planned anew then are called off instead."""
        automaton = self._execution.automaton
        for step in self._execution.plan.order.running:
            ability = automaton.abilities[step.ability]
            late = overdue(step, ability, monotonic)
            if late is None or (ability.timeouts.replan and self._execution.conduct.executes_operations):
                continue
            resource = automaton.resources[ability.resource]
            others = self._failures(self._still.keeping(ability, monotonic))
            receives = f"Check that {resource} receives its commands and is ready."
            yield Cause(
                f"{LATE}{ability.name}",
                Priority.MEDIUM,
                f"{resource}: {ability.title} {late}",
                self._consequences.waiting(self._consequences.held_up({ability.resource}), " until it does"),
                receives if "begun" in late else f"Look after {resource}.",
                follows=(*self._silences(ability), f"{_STILL}{ability.resource}", *others),
                past=f"{resource}: {ability.title} {in_the_past(late)}",
                of=frozenset({ability.resource}),
                waits=not self._still.has_to_act(ability),
            )

    def _standing_still(self, monotonic: float) -> Iterator[Cause]:
        """Resources that do not do what they should, though nothing of them is overdue."""
        automaton = self._execution.automaton
        running = [(step, automaton.abilities[step.ability]) for step in self._execution.plan.order.running]
        late = {ability.resource for step, ability in running if overdue(step, ability, monotonic)}
        still = self._still.devices(monotonic)
        # What was told stays the alarm, whatever becomes late with it meanwhile.
        self._told_still = frozenset(name for name in still if name in self._told_still or name not in late)
        for name, unchanged in sorted(still.items()):
            if name not in self._told_still:
                continue
            resource = automaton.resources[name]
            says = self._says(unchanged)
            yield Cause(
                f"{_STILL}{name}",
                Priority.MEDIUM,
                f"{resource} does not do what it should: it still says {says}",
                self._consequences.waiting(self._consequences.held_up({name}), " until it does"),
                f"Look after {resource}.",
                past=f"{resource} did not do what it should: it still said {says}",
                of=frozenset({name}),
            )
        for name, (unchanged, because) in sorted(self._still.explained(monotonic).items()):
            resource, says = automaton.resources[name], self._says(unchanged)
            yield Cause(
                f"{_STILL}{name}",
                Priority.MEDIUM,
                f"{resource} says {says}, which does not go together with it",
                self._consequences.waiting(self._consequences.held_up({name}), " until it does"),
                f"Look after {listed(sorted(automaton.resources[each] for each in because))}.",
                follows=self._failures(because),
                past=f"{resource} said {says}, which did not go together with it",
            )

    def _says(self, names: Collection[str]) -> str:
        """Return what is said of these variables."""
        automaton, state = self._execution.automaton, self._execution.state
        told = (each for each in sorted(names) if not is_along(automaton, each, names))
        known = {each: value for each in told if (value := state[each]) is not None}
        return listed(value_text(automaton, each, value) for each, value in known.items()) or "nothing"

    def _failures(self, resources: Collection[str]) -> tuple[str, ...]:
        """The alarms by which it is told that devices of these resources do nothing."""
        abilities, running = self._execution.automaton.abilities, self._execution.plan.order.running
        late = [step.ability for step in running if abilities[step.ability].resource in resources]
        return (*(f"{_STILL}{name}" for name in sorted(resources)), *(f"{LATE}{name}" for name in late))

    def _given_up(self) -> Iterator[Cause]:
        """Of each resource one: what it could not do, and is not asked for any more."""
        given_up: dict[str, list[OutOfService]] = {}
        for (of, name), each in self._execution.conduct.service.items():
            if of is ServiceKind.ABILITY and each.by is None:
                given_up.setdefault(self._execution.automaton.abilities[name].resource, []).append(each)
        for resource, gone in given_up.items():
            abilities = self._execution.automaton.abilities
            texts = [f"{abilities[each.name].title} {each.why}" for each in gone]
            past = [f"{abilities[each.name].title} {in_the_past(each.why)}" for each in gone]
            titles = listed(abilities[each.name].title for each in gone)
            yield Cause(
                f"given-up:{resource}",
                Priority.MEDIUM,
                f"{texts[0]}: it is given up" if len(texts) == 1 else f"{len(texts)} abilities are given up: {titles}",
                self._consequences.without({resource}),
                f"Look after {self._execution.automaton.resources[resource]}, then put {titles} back in service.",
                follows=tuple(dict.fromkeys(key for each in gone for key in self._silences(abilities[each.name]))),
                parts=() if len(texts) == 1 else tuple(texts),
                past=f"{past[0]}: it was given up" if len(past) == 1 else f"{len(past)} were given up: {titles}",
                past_parts=() if len(past) == 1 else tuple(past),
                of=frozenset({resource}),
            )

    def _called_off(self) -> Iterator[Cause]:
        for name, times in self._execution.conduct.tried.items():
            ability = self._execution.automaton.abilities[name]
            text = f"{ability.title} was not in time and was called off{f', {times} times' if times > 1 else ''}"
            yield Cause(
                f"tried:{name}",
                Priority.LOW,
                text,
                f"It is planned anew, and given up after {ability.timeouts.retries + 1} times.",
                f"Look after {self._execution.automaton.resources[ability.resource]}.",
                follows=self._silences(ability),
                past=text,
            )

    def _waiting_errand(self, monotonic: float) -> Iterator[Cause]:
        """Yield what a person has taken, and does not go on."""
        execution, errand = self._execution, self._execution.errand
        if errand is None or errand.ability is not None or (since := idle_since(execution, errand)) is None:
            return
        ahead, waited = execution.plan.order.ahead, monotonic - since
        if waited <= (START_WITHIN if ahead else END_WITHIN):
            return
        if ahead:
            title = execution.automaton.abilities[ahead[0].ability].title
            waits = listed(waits_for(execution, ahead[0].ability, self._feeds.heard_on)) or "nothing that is known"
            text = f"{title} has not started for {START_WITHIN:g} s: it waits for {waits}"
        else:
            condition = end_text(errand.goal, errand.into_safe)
            inside = ["the station to be back in its safe states"] if errand.into_safe else []
            waits = listed([*inside, *([condition] if condition else [])])
            text = f"What was taken has not come to its end for {END_WITHIN:g} s: it waits for {waits}"
        yield Cause(
            "errand-waits",
            Priority.MEDIUM,
            text,
            f"\u201c{errand.title}\u201d, which {errand.by} has taken, does not go on, and operations wait.",
            "See to what it waits for, or stop it and look at the ways back again.",
            past=f"“{errand.title}” did not go on for some time",
        )

    def _violated(self) -> Iterator[Cause]:
        for name, since in self._execution.pursued.violated.items():
            active = name in self._execution.active
            text = f"The local specification {violation(self._execution.automaton, name)}"
            yield Cause(
                f"local:{name}:{since.epoch}",
                Priority.MEDIUM,
                text,
                "It is not planned for any more." if active else "Its goal was reached all the same.",
                "Bring its goal about by hand." if active else "Check what was made meanwhile.",
                past=text,
            )

    def _missing(self) -> Iterator[Cause]:
        execution = self._execution
        plan, follows = execution.plan, self._silences(None)
        if not execution.conduct.executes_operations:
            return
        if plan.status is PlanStatus.NONE and (follows or not execution.blind):
            waiting = self._consequences.waiting(execution.active)
            past = "There was no plan"
            yield Cause("no-plan", Priority.MEDIUM, plan.reason, waiting, self._needed(), follows, past=past)
        elif plan.status is not PlanStatus.NONE and plan.answer is not None:
            yield from self._left_out(plan.answer, follows)

    def _needed(self) -> str:
        """Say what to do where there is no plan: what is out of service may be all that is missing."""
        automaton, service = self._execution.automaton, self._execution.conduct.service
        resources = [automaton.resources[name] for of, name in service if of is ServiceKind.RESOURCE]
        abilities = [automaton.abilities[name].title for of, name in service if of is ServiceKind.ABILITY]
        needs = "see what the active operations need."
        out = listed([*sorted(resources), *sorted(abilities)])
        return f"Put {out} back in service, or {needs}" if out else f"{needs[0].upper()}{needs[1:]}"

    def _left_out(self, answer: PlanAnswer, follows: tuple[str, ...]) -> Iterator[Cause]:
        """The active operations that the plan does not reach: because it cannot, and because nobody knows."""
        operations, active = self._execution.automaton.operations, self._execution.active
        undecided = [name for name in answer.undecided if name in active]
        excluded = [name for name in answer.left_out if name in active and name not in answer.undecided]
        waits = self._consequences.waiting
        if excluded:
            titles = ", ".join(operations[name].title for name in excluded)
            action = "It is proven that no plan reaches these goals together with the others, as things are."
            text, past = f"Left out of the plan: {titles}", f"Was left out of the plan: {titles}"
            yield Cause("left-out", Priority.LOW, text, waits(excluded), action, follows, past=past)
        if undecided:
            titles = ", ".join(operations[name].title for name in undecided)
            action = "No plan that reaches these goals too was found in time, and none is ruled out; it is tried again."
            text, past = f"Not in the plan yet: {titles}", f"Was not in the plan: {titles}"
            yield Cause("undecided", Priority.LOW, text, waits(undecided), action, follows, past=past)

    def _silences(self, ability: Ability | None) -> tuple[str, ...]:
        """The silences from which it can follow that an ability is late, or without one that there is no plan."""
        silent = self._execution.conduct.silent
        if ability is not None:
            awaited = frozenset[str]().union(*(self._tellers.get(name, ()) for name in _deciding(ability)))
            silent = silent & (awaited | {ability.resource})
        return (MANY, UNHEARD, *(silent_key(name) for name in sorted(silent))) if silent else ()


def _deciding(ability: Ability) -> set[str]:
    """The variables that decide whether the ability is under way, and whether it has finished."""
    guard = ability.executing if ability.finish_guard is None else ability.finish_guard
    return {*variables(ability.executing), *variables(guard)}
