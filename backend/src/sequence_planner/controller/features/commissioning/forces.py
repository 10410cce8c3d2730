"""Forces: a measured variable or an output has a value that a person gives it, for a stated time.

For commissioning, where a device is not there yet, or must be made to do something. What is forced ends by itself.
"""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.automaton.automaton import Kind, State
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.alarms.kinds import FORCED, Cause
from sequence_planner.controller.commands.approvals import ForceVariable, ReleaseForce
from sequence_planner.controller.commands.command import CommandRefused, handles
from sequence_planner.controller.views.execution import force_views
from sequence_planner.controller.views.wording import hint_of
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import contains
from sequence_planner.planning.recovery_path import violated
from sequence_planner.texts.message import message

_FORCED = (Kind.MEASURED, Kind.OUTPUT)


class Forces:
    """Takes commands about the forces of `execution`."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"forces": force_views(self._execution.conduct)}

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        started = self._execution.production is Production.STARTED
        for name, force in self._execution.conduct.forces.items():
            resource = self._execution.automaton.variables[name].resource
            yield FORCED.cause(
                name,
                {
                    "so": sentences_of(self._execution.automaton).tell_value(name, force.value),
                    "by": force.by,
                    "why": force.why,
                    "consequence": message("forced.ignored") if started else message("forced.later"),
                },
                resources=[] if resource is None else [resource],
            )

    def check(self, command: ForceVariable) -> None:
        """Raises `CommandRefused` when it could not be carried out now."""
        self._require_known(command.name)
        variable = self._execution.automaton.variables[command.name]
        if variable.kind not in _FORCED:
            is_estimated = variable.kind is Kind.ESTIMATED
            id_ = "refused.not-forceable.correct" if is_estimated else "refused.not-forceable.kind"
            detail = message(id_, name=variable.name, kind=message(f"kind.{variable.kind}"))
            raise CommandRefused("not-forceable", detail, 422)
        if not contains(variable.type, command.value):
            raise CommandRefused(
                "not-in-domain",
                message(
                    "refused.not-in-domain.none",
                    name=variable.name,
                    domain=str(variable.type),
                    value=print_value(command.value),
                ),
                422,
            )
        self._require_safety(command)

    @handles(ForceVariable)
    def force(self, command: ForceVariable, moment: Timestamp) -> None:
        """Let the variable have the value for that time."""
        self.check(command)
        until = Timestamp(moment.epoch + command.seconds, moment.monotonic + command.seconds)
        self._execution.force(command.name, command.value, until, command.actor.name, command.reason)

    @handles(ReleaseForce)
    def release(self, command: ReleaseForce, moment: Timestamp) -> None:
        """Let the variable be as it comes."""
        self._require_known(command.name)
        if command.name in self._execution.conduct.forces:
            self._execution.release(command.name)

    def _require_known(self, name: str) -> None:
        known = self._execution.automaton.variables
        if name not in known:
            raise CommandRefused(
                "unknown-variable", message("refused.unknown-variable.name", name=name, hint=hint_of(name, known)), 404
            )

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
        if broken:
            named = [message("unsafe.specification", title=specifications[name].title) for name in broken]
            why = message("refused.force-unsafe.violates", specifications=named)
        elif self._certainly_outside(before):
            why = message("refused.force-unsafe.outside")
        else:
            why = message("refused.force-unsafe.forbidden")
        raise CommandRefused("force-unsafe", why)

    def _leaves(self, before: State, after: State, *, moving: bool) -> bool:
        safe = self._execution.supervisor.safe
        if safe.includes(after):
            return False
        if safe.includes(before):
            return True
        # While values are unknown neither may be certain; then it is refused where it makes the worse certain.
        return self._certainly_outside(after) and (moving or not self._certainly_outside(before))

    def _certainly_outside(self, state: State) -> bool:
        """Return whether no values of what is unknown make the state a safe one."""
        return bool(self._execution.supervisor.safe.nearest(state)) or bool(self._violated(state))

    def _violated(self, state: State) -> tuple[str, ...]:
        return violated(self._execution.automaton, state)
