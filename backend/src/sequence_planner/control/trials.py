"""Trying an ability: one run of it alone, under the same conditions as ever.

It is an errand, so operations wait for it, and the guards and the supervisor are as strict as in production. What may
start starts at once; what may not is refused, with all that is in its way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from sequence_planner.automaton.structure import Ability
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.errand import Errand, ErrandKind
from sequence_planner.control.execution import Execution
from sequence_planner.control.hindrances import of_ability
from sequence_planner.control.involving import Surroundings
from sequence_planner.control.moment import Moment
from sequence_planner.control.offer_refusals import errand_under_way
from sequence_planner.control.restart_commands import TryAbility
from sequence_planner.control.vocabulary import Mode, Production
from sequence_planner.expressions.syntax import TRUE
from sequence_planner.planning.plan import Plan, PlanTick


class Trials:
    """Has abilities of `execution` tried. `real_devices` names what speaks against these being emulated ones."""

    def __init__(
        self, execution: Execution, surroundings: Surroundings, real_devices: Callable[[], Sequence[str]]
    ) -> None:
        self._execution = execution
        self._around = surroundings
        self.real_devices = real_devices

    def carry_out(self, command: TryAbility, moment: Moment) -> None:
        """Have it started in the next tick. Raises `CommandRefused`; nothing has changed then."""
        ability = self._execution.automaton.abilities.get(command.ability)
        if ability is None:
            detail = f"The station has no ability `{command.ability}`. Look at those it has."
            raise CommandRefused("unknown-ability", "There is no such ability", detail, 404)
        if (refusal := self.refusal(ability)) is not None:
            raise refusal
        if not command.real_devices and (there := self.real_devices()):
            detail = f"{'; '.join(there)}. Confirm that real devices may move."
            raise CommandRefused("real-devices", "There are real devices", detail)
        self._execution.take_errand(_errand(ability, command, moment), moment)

    def refusal(self, ability: Ability) -> CommandRefused | None:
        """Why it cannot be tried now; None when it can."""
        execution = self._execution
        if execution.errand is not None:
            return errand_under_way(execution.errand)
        if execution.production is not Production.STARTED:
            detail = "No command is sent before production is started. Pause, then start production, then try it."
            return CommandRefused("production-waiting", "Production waits", detail)
        if execution.mode is not Mode.PAUSED:
            detail = f"The mode is {execution.mode}: an ability is tried while the station is paused. Pause it first."
            return CommandRefused("wrong-mode", "The mode is another one", detail)
        if lacking := list(dict.fromkeys(self._lacking(ability))):
            detail = f"{ability.title} waits for {'; '.join(lacking)}."
            return CommandRefused("not-startable", "It may not start now", detail)
        return None

    def _lacking(self, ability: Ability) -> Iterator[str]:
        execution = self._execution
        if execution.conduct.stepping and not execution.conduct.steps:
            yield "a step: the station goes step by step"
        yield from execution.obstacles
        guard = self._around.guards().get(ability.name)
        yield from (each.text for each in of_ability(execution, ability, self._around.feeds, guard))


def _errand(ability: Ability, command: TryAbility, moment: Moment) -> Errand:
    return Errand(
        kind=ErrandKind.TRIAL,
        title=f"Try: {ability.title}",
        plan=Plan((PlanTick((), (ability.name,)), PlanTick((), ())), minimal_ticks=False, minimal_starts=True),
        goal=TRUE if ability.finish_guard is None else ability.finish_guard,
        by=command.actor.name,
        why=command.reason or "",
        taken=moment,
        ability=ability.name,
    )
