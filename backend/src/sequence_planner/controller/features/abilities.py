"""Abilities: what each does now, and the alarms of those that are late, given up, or in conflict."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from typing import Final

from sequence_planner.automaton.automaton import Ability, target
from sequence_planner.automaton.dependencies import is_along
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import CONFLICT, GIVEN_UP, OVERDUE, STILL, TRIED, Cause, silences
from sequence_planner.controller.io.inputs import Inputs
from sequence_planner.controller.recovery.stalls import StallDetector
from sequence_planner.controller.views.station import AbilityView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.timeouts import Late, in_the_past, overdue
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.language.shorthand.titles import Words
from sequence_planner.language.syntax import Constant, variables
from sequence_planner.texts.message import Argument, Message, Wording, as_it_was, message

_IN_BRACES: Final = re.compile(r"\{([^{}]*)\}")


class Abilities:
    """Looks at what `execution` does, and at which devices are `still`; `feeds` say which resources tell a measured
    variable.
    """

    def __init__(self, execution: Executor, feeds: Inputs, still: StallDetector, consequences: Consequences) -> None:
        self._execution = execution
        self._told_still: frozenset[str] = frozenset()
        self._consequences = consequences
        self._still = still
        self._tellers = {
            name: frozenset(feeds.resource_of(topic) for topic in topics) for name, topics in feeds.sources.items()
        }
        self._conflicts: set[tuple[str, str, str]] = set()
        # Runs that do not go on, and those of them that a person has called off by a Hold since, which mends nothing.
        self._overdue: dict[str, Late] = {}
        self._halted: dict[str, Late] = {}
        self._executed: set[str] = set()  # of what runs, what was seen to execute

    def after_tick(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: a conflict is gone in the next one, and what came of it lasts until one of the two goes on."""
        gone_on = {*outcome.finished, *outcome.started}
        self._conflicts = {c for c in self._conflicts if gone_on.isdisjoint(c[:2])} | set(outcome.conflicts)
        for name in (*outcome.ended, *outcome.called_off):
            self._overdue.pop(name, None)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        running = {
            step.ability: None if step.started is None else step.started.epoch
            for step in self._execution.plan.order.running
        }
        state = self._execution.state
        views = {
            ability.name: AbilityView(
                resource=ability.resource,
                title=ability.title,
                human=ability.human is not None,
                restart=ability.restart,
                moves=ability.moves,
                enabled=_truth(state[ability.flag("enabled")]),
                executing=_truth(state[ability.flag("executing")]),
                finished=_truth(state[ability.flag("finished")]),
                running_since=running.get(ability.name),
            )
            for ability in self._execution.automaton.abilities.values()
        }
        return {"abilities": views}

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        self._follow(moment.monotonic)
        yield from self._late(moment.monotonic)
        yield from self._late_and_halted()
        yield from self._standing_still(moment.monotonic)
        yield from self._given_up()
        yield from self._called_off()
        yield from self._in_conflict()

    def _late(self, monotonic: float) -> Iterator[Cause]:
        """Abilities that take longer than they may; those that are planned anew then are called off instead."""
        automaton = self._execution.automaton
        for step in self._execution.plan.order.running:
            ability = automaton.abilities[step.ability]
            late = overdue(step, ability, monotonic)
            if late is None or (ability.timeouts.replan and self._execution.conduct.executes_operations):
                continue
            others = self._failures(self._still.keeping(ability, monotonic))
            told = self._run(ability, late, "late.finished" if late.begun else "late.begun")
            words = self._with_values(ability.late.not_finished if late.begun else ability.late.not_begun)
            yield self._late_cause(
                ability,
                late,
                told if words is None else message("late.named", words=words, run=told),
                self._consequences.waiting_for(ability.resource),
                self._check(ability, late),
                follows=(*self._silences(ability), STILL.key(ability.resource), *others),
                of=frozenset({ability.resource}),
                waits=not self._still.has_to_act(ability),
            )

    def _follow(self, monotonic: float) -> None:
        """Note which runs do not go on, and which of these a person has called off."""
        running = {step.ability: step for step in self._execution.plan.order.running}
        halts = self._execution.conduct.mode in (Mode.HOLD, Mode.RESTART)
        halted = {**self._halted, **self._overdue} if halts else {}
        self._halted = {name: late for name, late in halted.items() if name not in running}
        still = self._still.devices(monotonic)
        self._overdue = {}
        self._executed &= running.keys()
        for name, step in running.items():
            ability = self._execution.automaton.abilities[name]
            if self._execution.state[ability.flag("executing")] is True:
                self._executed.add(name)
            late = overdue(step, ability, monotonic)
            seconds = None if late is None else late.within
            if late is None and ability.resource in still and step.started is not None:
                seconds = round(monotonic - step.started.monotonic)
            if seconds is not None and ability.human is None:
                self._overdue[name] = Late(name in self._executed, seconds)

    def _late_and_halted(self) -> Iterator[Cause]:
        """Runs that were late when a person called them off: it is not known that what kept them is mended."""
        for name, late in self._halted.items():
            ability = self._execution.automaton.abilities[name]
            yield self._late_cause(
                ability,
                late,
                self._run(ability, late, "late.finished-halted" if late.begun else "late.begun-halted"),
                message("late.again"),
                (None if late.begun else self._by_hand(ability)) or self._check(ability, late),
                follows=self._silences(ability),
            )

    def _run(self, ability: Ability, late: Late, what: str) -> Message:
        resource = self._execution.automaton.resources[ability.resource]
        return message("late.run", resource=resource, ability=ability.title, late=message(what, seconds=late.within))

    def _check(self, ability: Ability, late: Late) -> Message:
        resource = self._execution.automaton.resources[ability.resource]
        if late.begun:
            return message("late.check", resources=[resource])
        return message("late.check-receives", resource=resource)

    def _by_hand(self, ability: Ability) -> Wording | None:
        """What a person does so that a run begins that did not, in the words of the model; None without any."""
        automaton = self._execution.automaton
        own = automaton.reactions.get(ability.name, ())
        for effect in automaton.effects:
            for action in effect.actions if effect.name in own and effect.kind == "starting" else ():
                if not isinstance(action.value, Constant):
                    continue
                how = sentences_of(automaton).tell_by_hand(target(action), action.value.value)
                if how is not None:
                    return how
        return None

    def _late_cause(
        self,
        ability: Ability,
        late: Late,
        what: Message,
        consequence: Argument,
        action: Argument,
        *,
        follows: tuple[str, ...],
        of: frozenset[str] = frozenset(),
        waits: bool = False,
    ) -> Cause:
        phase = "late.finished" if late.begun else "late.begun"
        return OVERDUE.cause(
            ability.name,
            {
                "what": what,
                "what_past": self._run(ability, late, f"{phase}-past"),
                "consequence": consequence,
                "action": action,
            },
            follows=follows,
            resources=[ability.resource],
            of=of,
            waits=waits,
            phase=phase,
        )

    def _with_values(self, text: Words) -> Wording | None:
        """A text of the model with what the values of the variables in it are called; None without one, and while a
        value is unknown.
        """
        state, sentences = self._execution.state, sentences_of(self._execution.automaton)
        told = dict(text) if "" not in text else {"en": text[""], "sv": text[""]}
        for name in {match[1] for each in told.values() for match in _IN_BRACES.finditer(each)}:
            if (value := state[name]) is None:
                return None
            called = sentences.call_value(name, value).words
            told = {language: each.replace(f"{{{name}}}", called[language]) for language, each in told.items()}
        return Wording(told) if told else None

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
                "consequence": self._consequences.waiting_for(name),
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
        return [sentences_of(automaton).tell_value(each, value) for each, value in known.items()] or message(
            "still.nothing"
        )

    def _failures(self, resources: Collection[str]) -> tuple[str, ...]:
        """The alarms by which it is told that devices of these resources do nothing."""
        abilities, running = self._execution.automaton.abilities, self._execution.plan.order.running
        late = [step.ability for step in running if abilities[step.ability].resource in resources]
        return (*map(STILL.key, sorted(resources)), *map(OVERDUE.key, late))

    def _given_up(self) -> Iterator[Cause]:
        """Of each resource one: what it could not do, and is not asked for any more."""
        abilities, service = self._execution.automaton.abilities, self._execution.conduct.service
        given_up = [each for (of, _), each in service.items() if of is ServiceKind.ABILITY and each.by is None]
        for resource in dict.fromkeys(abilities[each.name].resource for each in given_up):
            gone = [each for each in given_up if abilities[each.name].resource == resource]
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

    def _in_conflict(self) -> Iterator[Cause]:
        abilities = self._execution.automaton.abilities
        for one, other, variable in sorted(self._conflicts):
            yield CONFLICT.cause(
                f"{one}:{other}:{variable}",
                {
                    "one": one,
                    "other": other,
                    "variable": variable,
                    "consequence": self._consequences.of_values({variable}),
                },
                resources=dict.fromkeys(abilities[name].resource for name in (one, other) if name in abilities),
            )

    def _silences(self, ability: Ability) -> tuple[str, ...]:
        """The silences from which it can follow that an ability is late."""
        awaited = frozenset[str]().union(*(self._tellers.get(name, ()) for name in _deciding(ability)))
        return silences(self._execution.conduct.silent & (awaited | {ability.resource}))


def _deciding(ability: Ability) -> set[str]:
    """The variables that decide whether the ability is under way, and whether it has finished."""
    guard = ability.executing if ability.finish_guard is None else ability.finish_guard
    return {*variables(ability.executing), *variables(guard)}


def _truth(value: object) -> bool | None:
    return value if isinstance(value, bool) else None
