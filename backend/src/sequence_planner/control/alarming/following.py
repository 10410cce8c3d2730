"""What follows from what: a device that fails keeps others from finishing, and leads to states nobody wants.

Which alarm is a part of which is said by the alarms' own causes where they know; this adds what only the model tells:
what an effect waits for, what a specification speaks of, and which operations need a resource.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import replace

from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.alarming.cause import Cause
from sequence_planner.expressions.syntax import variables

UNSAFE = "unsafe-state"
LATE = "overdue:"
_PLANS = ("no-plan", "left-out", "undecided")


class Following:
    """Of one automaton; `touched` are the variables for which the state is unsafe, if it is."""

    def __init__(self, automaton: Automaton, touched: Callable[[], Collection[str]]) -> None:
        self._automaton = automaton
        self._touched = touched
        self._awaits = _awaits(automaton)

    def trace(self, causes: Iterable[Cause]) -> list[Cause]:
        """The causes, each with all that it follows from."""
        every = list(causes)
        failures = [cause for cause in every if cause.of]
        unsafe = any(cause.key == UNSAFE for cause in every)
        return [self._traced(cause, failures, unsafe) for cause in every] if failures or unsafe else every

    def _traced(self, cause: Cause, failures: Iterable[Cause], unsafe: bool) -> Cause:
        others = [failure for failure in failures if failure.key != cause.key]
        if cause.key == UNSAFE:
            about = self._resources(self._touched())
            found = [each.key for each in others if each.of & about]
        elif cause.about:
            found = [UNSAFE] if unsafe and not cause.about.isdisjoint(self._touched()) else []
        elif cause.key in _PLANS:
            found = [each.key for each in others] + ([UNSAFE] if unsafe else [])
        elif cause.waits:
            awaited = frozenset[str]().union(*(self._awaits.get(name, frozenset()) for name in cause.of))
            found = [each.key for each in others if each.of & awaited]
        else:
            return cause
        return replace(cause, follows=(*cause.follows, *found)) if found else cause

    def _resources(self, names: Iterable[str]) -> frozenset[str]:
        """Those of the variables, and of what flags among them depend on."""
        found: set[str] = set()
        seen: set[str] = set()
        to_see = list(names)
        while to_see:
            name = to_see.pop()
            if name in seen:
                continue
            seen.add(name)
            if (predicate := self._automaton.flag_predicates.get(name)) is not None:
                to_see += variables(predicate)
            elif (resource := self._automaton.variables[name].resource) is not None:
                found.add(resource)
        return frozenset(found)


def _awaits(automaton: Automaton) -> dict[str, frozenset[str]]:
    """For each resource those of others whose measured values its own effects wait for."""
    found: dict[str, set[str]] = {}
    for effect in automaton.effects:
        if not effect.fault:
            declared = (automaton.variables.get(name) for name in variables(effect.guard))
            of = {each.resource for each in declared if each is not None and each.resource is not None}
            found.setdefault(effect.resource, set()).update(of - {effect.resource})
    return {name: frozenset(others) for name, others in found.items()}
