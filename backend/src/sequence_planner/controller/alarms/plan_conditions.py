"""Alarms of what is done: plans that are missing, abilities that are late or given up, formulas that were violated."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from sequence_planner.automaton.automaton import Ability
from sequence_planner.controller.alarms.alarm import Consequences
from sequence_planner.controller.alarms.kinds import (
    ERRAND_WAITS,
    GIVEN_UP,
    LEFT_OUT,
    LOCAL,
    MANY_SILENT,
    NEVER_HEARD,
    NO_PLAN,
    OVERDUE,
    PLANNER,
    SILENT,
    STILL,
    TRIED,
    UNDECIDED,
    Cause,
)
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.recovery.explain import idle_since, waits_for
from sequence_planner.controller.recovery.side_effects import is_along
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.wording import end_text, reason_text, title_text, value_text
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.plan_tracker import formula_of, why_none
from sequence_planner.execution.state import OutOfService
from sequence_planner.execution.timeouts import in_the_past, overdue
from sequence_planner.execution.vocabulary import PlanStatus, Production, ServiceKind
from sequence_planner.language.syntax import variables
from sequence_planner.planning.problem import PlanAnswer, Verdict
from sequence_planner.texts.message import Argument, Message, as_it_was, message

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
        yield from self._waiting_operator_plan(monotonic)
        if planner_trouble is not None:
            waiting = self._consequences.waiting(self._execution.active)
            yield PLANNER.cause("", {"trouble": planner_trouble, "waiting": waiting})
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
            what = "late.finished" if late.begun else "late.begun"
            yield OVERDUE.cause(
                ability.name,
                {
                    "resource": resource,
                    "ability": ability.title,
                    "late": message(what, seconds=late.within),
                    "late_past": message(f"{what}-past", seconds=late.within),
                    "consequence": self._until_it_does(ability.resource),
                    "action": message("late.check", resources=[resource])
                    if late.begun
                    else message("late.check-receives", resource=resource),
                },
                follows=(*self._silences(ability), STILL.key(ability.resource), *others),
                resources=[ability.resource],
                of=frozenset({ability.resource}),
                waits=not self._still.has_to_act(ability),
            )

    def _until_it_does(self, resource: str) -> Message:
        return self._consequences.waiting(self._consequences.held_up({resource}), until_it_does=True)

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
            yield self._still_cause(name, "still.stalled", unchanged, [name], of=frozenset({name}))
        for name, (unchanged, because) in sorted(self._still.explained(monotonic).items()):
            yield self._still_cause(name, "still.explained", unchanged, because, follows=self._failures(because))

    def _still_cause(
        self,
        name: str,
        what: str,
        unchanged: Collection[str],
        because: Collection[str],
        of: frozenset[str] = frozenset(),
        follows: tuple[str, ...] = (),
    ) -> Cause:
        resources = self._execution.automaton.resources
        values = self._says(unchanged)
        return STILL.cause(
            name,
            {
                "what": message(what, resource=resources[name], values=values),
                "what_past": message(f"{what}-past", resource=resources[name], values=values),
                "consequence": self._until_it_does(name),
                "action": message("late.check", resources=sorted(resources[each] for each in because)),
            },
            follows=follows,
            resources=[name],
            of=of,
        )

    def _says(self, names: Collection[str]) -> Argument:
        """Return what is said of these variables."""
        automaton, state = self._execution.automaton, self._execution.state
        told = (each for each in sorted(names) if not is_along(automaton, each, names))
        known = {each: value for each in told if (value := state[each]) is not None}
        return [value_text(automaton, each, value) for each, value in known.items()] or message("still.nothing")

    def _failures(self, resources: Collection[str]) -> tuple[str, ...]:
        """The alarms by which it is told that devices of these resources do nothing."""
        abilities, running = self._execution.automaton.abilities, self._execution.plan.order.running
        late = [step.ability for step in running if abilities[step.ability].resource in resources]
        return (*map(STILL.key, sorted(resources)), *map(OVERDUE.key, late))

    def _given_up(self) -> Iterator[Cause]:
        """Of each resource one: what it could not do, and is not asked for any more."""
        given_up: dict[str, list[OutOfService]] = {}
        for (of, name), each in self._execution.conduct.service.items():
            if of is ServiceKind.ABILITY and each.by is None:
                given_up.setdefault(self._execution.automaton.abilities[name].resource, []).append(each)
        for resource, gone in given_up.items():
            abilities = self._execution.automaton.abilities
            titles = [abilities[each.name].title for each in gone]
            texts = [
                message("given-up.failure", ability=title, why=as_it_was(each.why, "late."))
                for title, each in zip(titles, gone, strict=True)
            ]
            past = [
                message("given-up.failure", ability=title, why=as_it_was(in_the_past(each.why), "late."))
                for title, each in zip(titles, gone, strict=True)
            ]
            one = len(gone) == 1
            yield GIVEN_UP.cause(
                resource,
                {
                    "what": message("given-up.one", failure=texts[0])
                    if one
                    else message("given-up.many", count=len(gone), abilities=titles),
                    "what_past": message("given-up.one-past", failure=past[0])
                    if one
                    else message("given-up.many-past", count=len(gone), abilities=titles),
                    "consequence": self._consequences.without({resource}),
                    "resource": self._execution.automaton.resources[resource],
                    "abilities": titles,
                },
                follows=tuple(dict.fromkeys(key for each in gone for key in self._silences(abilities[each.name]))),
                parts=texts,
                past_parts=past,
                resources=[resource],
                of=frozenset({resource}),
            )

    def _called_off(self) -> Iterator[Cause]:
        for name, times in self._execution.conduct.tried.items():
            ability = self._execution.automaton.abilities[name]
            yield TRIED.cause(
                name,
                {
                    "ability": ability.title,
                    "times": message("tried.times", count=times) if times > 1 else "",
                    "most": ability.timeouts.retries + 1,
                    "resource": self._execution.automaton.resources[ability.resource],
                },
                follows=self._silences(ability),
                resources=[ability.resource],
            )

    def _waiting_operator_plan(self, monotonic: float) -> Iterator[Cause]:
        """Yield what a person has taken, and does not go on."""
        execution, operator_plan = self._execution, self._execution.operator_plan
        if (
            operator_plan is None
            or operator_plan.ability is not None
            or (since := idle_since(execution, operator_plan)) is None
        ):
            return
        ahead, waited = execution.plan.order.ahead, monotonic - since
        if waited <= (START_WITHIN if ahead else END_WITHIN):
            return
        if ahead:
            title = execution.automaton.abilities[ahead[0].ability].title
            waits = waits_for(execution, ahead[0].ability, self._feeds.heard_on)
            conditions: Argument = waits or message("errand-waits.nothing-known")
            what = message("errand-waits.start", ability=title, seconds=START_WITHIN, conditions=conditions)
        else:
            condition = end_text(operator_plan.goal, operator_plan.into_safe)
            inside = [message("errand-waits.safe")] if operator_plan.into_safe else []
            what = message(
                "errand-waits.end", seconds=END_WITHIN, conditions=[*inside, *([condition] if condition else [])]
            )
        yield ERRAND_WAITS.cause(
            "",
            {"what": what, "title": message("quoted", title=title_text(operator_plan.title)), "by": operator_plan.by},
        )

    def _violated(self) -> Iterator[Cause]:
        for name, since in self._execution.pursued.violated.items():
            active, operation = name in self._execution.active, self._execution.automaton.operations[name]
            yield LOCAL.cause(
                f"{name}:{since.epoch}",
                {
                    "formula": formula_of(self._execution.automaton, name),
                    "operation": operation.title,
                    "consequence": message("local.not-planned") if active else message("local.reached"),
                    "action": message("local.by-hand") if active else message("local.check"),
                },
            )

    def _missing(self) -> Iterator[Cause]:
        execution = self._execution
        plan, follows = execution.plan, self._silences(None)
        if not execution.conduct.executes_operations:
            return
        if plan.status is PlanStatus.NONE and (follows or not execution.blind):
            waiting = self._consequences.waiting(execution.active)
            yield NO_PLAN.cause(
                "", {"why": self._why_none(), "waiting": waiting, "action": self._needed()}, follows=follows
            )
        elif plan.status is not PlanStatus.NONE and plan.answer is not None:
            yield from self._left_out(plan.answer, follows)

    def _why_none(self) -> Message:
        plan = self._execution.plan
        if plan.answer is None or plan.reason not in (why_none(plan.answer, blind) for blind in (False, True)):
            return message("no-plan.other", reason=reason_text(plan.reason))
        if plan.reason == why_none(plan.answer, blind=True):
            return message("no-plan.unknown", reason=reason_text(plan.reason))
        if plan.answer.verdict is Verdict.NONE_AT_ALL:
            return message("no-plan.none", reason=reason_text(plan.reason))
        return message("no-plan.found", reason=reason_text(plan.reason))

    def _needed(self) -> Message:
        """Say what to do where there is no plan: what is out of service may be all that is missing."""
        automaton, service = self._execution.automaton, self._execution.conduct.service
        resources = [automaton.resources[name] for of, name in service if of is ServiceKind.RESOURCE]
        abilities = [automaton.abilities[name].title for of, name in service if of is ServiceKind.ABILITY]
        out = [*sorted(resources), *sorted(abilities)]
        return message("no-plan.put-back", titles=out) if out else message("no-plan.look")

    def _left_out(self, answer: PlanAnswer, follows: tuple[str, ...]) -> Iterator[Cause]:
        """The active operations that the plan does not reach: because it cannot, and because nobody knows."""
        operations, active = self._execution.automaton.operations, self._execution.active
        undecided = [name for name in answer.undecided if name in active]
        excluded = [name for name in answer.left_out if name in active and name not in answer.undecided]
        for kind, names in ((LEFT_OUT, excluded), (UNDECIDED, undecided)):
            if names:
                titles = ", ".join(operations[name].title for name in names)
                waiting = self._consequences.waiting(names)
                yield kind.cause("", {"operations": titles, "waiting": waiting}, follows=follows)

    def _silences(self, ability: Ability | None) -> tuple[str, ...]:
        """The silences from which it can follow that an ability is late, or without one that there is no plan."""
        silent = self._execution.conduct.silent
        if ability is not None:
            awaited = frozenset[str]().union(*(self._tellers.get(name, ()) for name in _deciding(ability)))
            silent = silent & (awaited | {ability.resource})
        return (MANY_SILENT.key(), NEVER_HEARD.key(), *map(SILENT.key, sorted(silent))) if silent else ()


def _deciding(ability: Ability) -> set[str]:
    """The variables that decide whether the ability is under way, and whether it has finished."""
    guard = ability.executing if ability.finish_guard is None else ability.finish_guard
    return {*variables(ability.executing), *variables(guard)}
