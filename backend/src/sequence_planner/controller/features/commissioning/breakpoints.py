"""Breakpoints: the station pauses after the tick in which a condition became true; no tick is held up."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import structlog

from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.commands.command import CommandRefused, handles
from sequence_planner.controller.commands.execution import RemoveBreakpoint, SetBreakpoint
from sequence_planner.controller.views.station import BreakpointView, MadeBreakpointView
from sequence_planner.controller.views.wording import read_predicate
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.language.evaluator import holds
from sequence_planner.language.printer import print_expression
from sequence_planner.language.syntax import Expression, variables
from sequence_planner.texts.message import message

LOG = structlog.get_logger(__name__)

MOST_BREAKPOINTS = 20


@dataclass
class _Breakpoint:
    """A condition and whose it is; `held` says whether it was true after the last tick, `hits` how often it became so
    since it was set.
    """

    condition: Expression
    written: str
    by: str
    since: float
    held: bool
    hits: int = 0
    last: float | None = None


class Breakpoints:
    """Has `execution` pause when a condition becomes true. They are forgotten when the controller begins anew."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        self._points: dict[str, _Breakpoint] = {}
        self._numbers = 0
        self._due: _Breakpoint | None = None  # for which the station is to pause now
        self._stopped: str | None = None  # the one at which it is paused

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"breakpoints": {name: BreakpointView(**self._said_of(name)) for name in self._points}}

    def _said_of(self, name: str) -> dict[str, Any]:
        each, sentences = self._points[name], sentences_of(self._execution.automaton)
        return {
            "condition": each.written,
            "sentence": message("sentence.so", condition=sentences.tell_so((each.condition,), each.written)),
            "by": each.by,
            "since": each.since,
            "hits": each.hits,
            "last": each.last,
            "stopped": name == self._stopped and self._execution.mode is Mode.PAUSED,
        }

    def take_note(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: see which conditions have become true. One of which that is not known is not."""
        state, mode = self._execution.state, self._execution.mode
        if mode is not Mode.PAUSED and self._due is None:  # several ticks may come before one looks whether to pause
            self._stopped = None
        for name, each in self._points.items():
            before, each.held = each.held, holds(each.condition, state)
            if each.held and not before:
                each.hits, each.last = each.hits + 1, moment.epoch
                if mode is Mode.AUTOMATIC and self._due is None:
                    self._due, self._stopped = each, name

    def pause(self, moment: Timestamp) -> None:
        """Pause, where a condition has become true while operations went on."""
        due, self._due = self._due, None
        if due is not None and self._execution.mode is Mode.AUTOMATIC:
            self._execution.change_mode(Mode.PAUSED, due.by, moment)
            LOG.info("breakpoint", condition=due.written)

    @handles(SetBreakpoint)
    def set_breakpoint(self, command: SetBreakpoint, moment: Timestamp) -> MadeBreakpointView:
        """Pause when that becomes true from now on, once more where it is already."""
        automaton = self._execution.automaton
        condition = read_predicate(automaton, command.condition)
        if not set(variables(condition)):
            raise CommandRefused("bad-predicate", message("refused.bad-predicate.constant"), 422)
        if len(self._points) >= MOST_BREAKPOINTS:
            raise CommandRefused(
                "too-many-breakpoints", message("refused.too-many-breakpoints.most", most=MOST_BREAKPOINTS)
            )
        self._numbers += 1
        name = str(self._numbers)
        self._points[name] = _Breakpoint(
            condition,
            print_expression(condition),
            command.actor.name,
            moment.epoch,
            holds(condition, self._execution.state),
        )
        return MadeBreakpointView(id=name, **self._said_of(name))

    @handles(RemoveBreakpoint)
    def remove_breakpoint(self, command: RemoveBreakpoint, moment: Timestamp) -> None:
        """Pause for that no more; a pause that came of it stays."""
        if self._points.pop(command.id, None) is None:
            raise CommandRefused("no-breakpoint", message("refused.no-breakpoint.gone"), 404)
