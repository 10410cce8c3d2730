"""Forces: a measured variable or an output has a value that a person gives it, for a stated time.

For commissioning, where a device is not there yet, or must be made to do something. What is forced ends by itself.
"""

from __future__ import annotations

from sequence_planner.automaton.structure import Kind, State
from sequence_planner.control.command_base import CommandRefused
from sequence_planner.control.execution import Execution
from sequence_planner.control.moment import Moment
from sequence_planner.control.restart_commands import ForceVariable, ReleaseForce
from sequence_planner.expressions.printing import print_value
from sequence_planner.expressions.resolution import suggestion
from sequence_planner.expressions.types import contains
from sequence_planner.planning.way_back import violated

ForceCommand = ForceVariable | ReleaseForce

_FORCED = (Kind.MEASURED, Kind.OUTPUT)


class Forcing:
    """Takes commands about the forces of `execution`."""

    def __init__(self, execution: Execution) -> None:
        self._execution = execution

    def carry_out(self, command: ForceCommand, moment: Moment) -> None:
        """Do what is asked for. Raises `CommandRefused`; nothing has changed then."""
        match command:
            case ForceVariable():
                self._force(command, moment)
            case ReleaseForce(name=name):
                self._require_known(name)
                if name in self._execution.conduct.forces:
                    self._execution.release(name)

    def check(self, command: ForceVariable) -> None:
        """Raises `CommandRefused` when it could not be carried out now."""
        self._require_known(command.name)
        variable = self._execution.automaton.variables[command.name]
        if variable.kind not in _FORCED:
            detail = f"`{variable.name}` is {variable.kind}, and only measured variables and outputs can be forced."
            if variable.kind is Kind.ESTIMATED:
                detail = f"{detail} If it is not true, correct it instead."
            raise CommandRefused("not-forceable", "It cannot be forced", detail, 422)
        if not contains(variable.type, command.value):
            detail = f"`{variable.name}` is one of {variable.type}, and {print_value(command.value)} is none of these."
            raise CommandRefused("not-in-domain", "No such value", detail, 422)
        self._require_safety(command)

    def _force(self, command: ForceVariable, moment: Moment) -> None:
        self.check(command)
        until = Moment(moment.epoch + command.seconds, moment.monotonic + command.seconds)
        self._execution.force(command.name, command.value, until, command.actor.name, command.reason)

    def _require_known(self, name: str) -> None:
        known = self._execution.automaton.variables
        if name not in known:
            detail = f"The station has no variable `{name}`{suggestion(name, known) or '.'}"
            raise CommandRefused("unknown-variable", "There is no such variable", detail, 404)

    def _require_safety(self, command: ForceVariable) -> None:
        """Raises `CommandRefused` when the force would lead out of the safe states, or farther where it is outside.

        From outside an output, which moves devices, is forced only back into them.
        """
        execution = self._execution
        before, after = execution.state, execution.corrected({command.name: command.value})
        broken = [name for name in self._violated(after) if name not in self._violated(before)]
        if not broken and not self._leaves(before, after, moving=command.name in execution.automaton.outputs):
            return
        specifications = execution.automaton.specifications
        named = " and ".join(f"“{specifications[name].title}” ({name})" for name in broken)
        if broken:
            why = f"It would violate {named}."
        elif self._certainly_outside(before):
            why = "The station is outside its safe states, and would be so with it too."
        else:
            why = "From there a device could bring about what is forbidden, or rest could no longer be reached."
        raise CommandRefused("force-unsafe", "That is not safe", f"{why} Nothing was forced.")

    def _leaves(self, before: State, after: State, *, moving: bool) -> bool:
        safe = self._execution.supervisor.safe
        if safe.includes(after):
            return False
        if safe.includes(before):
            return True
        # While values are unknown neither may be certain; then it is refused where it makes the worse certain.
        return self._certainly_outside(after) and (moving or not self._certainly_outside(before))

    def _certainly_outside(self, state: State) -> bool:
        """Whether no values of what is unknown make the state a safe one."""
        return bool(self._execution.supervisor.safe.nearest(state)) or bool(self._violated(state))

    def _violated(self, state: State) -> tuple[str, ...]:
        return violated(self._execution.automaton, state)
