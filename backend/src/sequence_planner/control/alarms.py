"""What wants a person's attention now. An alarm lasts as long as its cause; one cause makes one alarm."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

from sequence_planner.control.bad_input import Reports
from sequence_planner.control.commander import Commander
from sequence_planner.control.execution import Execution, TickOutcome
from sequence_planner.control.feeds import Feeds
from sequence_planner.control.moment import Moment
from sequence_planner.control.network_watch import NetworkWatch
from sequence_planner.control.outside import Outside
from sequence_planner.control.plan_reasons import violation
from sequence_planner.control.view import AlarmView, PlanStatus, Priority, Production
from sequence_planner.planning.plan import PlanAnswer


@dataclass(frozen=True)
class Cause:
    """Why there is an alarm. `key` stays the same as long as it is the same alarm."""

    key: str
    priority: Priority
    text: str
    action: str


class Alarms:
    """The alarms of a station; remembers since when each has been there."""

    def __init__(
        self, execution: Execution, outside: Outside, feeds: Feeds, network: NetworkWatch, commander: Commander
    ) -> None:
        self._execution = execution
        self._outside = outside
        self._feeds = feeds
        self._network = network
        self._commander = commander
        self._since: dict[str, float] = {}
        self._conflicts: set[tuple[str, str, str]] = set()
        self._reacted: set[int] = set()  # the running steps that have been seen executing
        self.restless: tuple[str, ...] = ()  # abilities that finish again and again although nothing new is measured
        self.unrecorded: str | None = None  # why commands cannot be recorded
        self.failures: dict[str, str] = {}  # what of the controller's own work fails, and how

    def note(self, outcome: TickOutcome) -> None:
        """After a tick: a conflict is gone in the next one, and what came of it lasts until one of the two goes on."""
        gone_on = {*outcome.finished, *outcome.started}
        self._conflicts = {c for c in self._conflicts if gone_on.isdisjoint(c[:2])} | set(outcome.conflicts)
        self._reacted = {
            step.number
            for step in self._execution.plan.order.running
            if step.number in self._reacted or self._executes(step.ability)
        }

    def current(self, planner_trouble: str | None, moment: Moment) -> dict[str, AlarmView]:
        """All alarms now."""
        causes = {
            cause.key: cause
            for part in (
                self._controller(),
                self._state(),
                _topics(self._feeds, moment.monotonic),
                _reports(self._feeds.reports, moment, "Check the node that sends it."),
                _reports(self._commander.reports, moment, "The device gets the default instead. Correct the pipeline."),
                _network(self._network, self._commander),
                _plan(self._execution, planner_trouble),
                _overdue(self._execution, self._reacted, moment.monotonic),
            )
            for cause in part
        }
        self._since = {key: self._since.get(key, moment.epoch) for key in causes}
        return {
            key: AlarmView(priority=c.priority, text=c.text, action=c.action, since=self._since[key])
            for key, c in causes.items()
        }

    def _executes(self, ability: str) -> bool:
        return self._execution.state[self._execution.automaton.abilities[ability].flag("executing")] is True

    def _controller(self) -> Iterator[Cause]:
        for what, how in self.failures.items():
            yield Cause(
                f"controller:{what}",
                Priority.HIGH,
                f"The controller fails at {what}: {how}",
                "It goes on trying. Bring the station to rest, and give the controller's log to its maintainers.",
            )
        if self.unrecorded is not None:
            yield Cause(
                "unrecorded",
                Priority.HIGH,
                f"Commands cannot be recorded: {self.unrecorded}",
                "They are refused, but for pausing. Make room for the station's database, or bring it back.",
            )
        if self.restless:
            yield Cause(
                "restless",
                Priority.MEDIUM,
                f"{', '.join(self.restless)} finish again and again although nothing new is measured",
                "Correct the model: after a finish its guard must no longer hold, or its actions change nothing.",
            )

    def _state(self) -> Iterator[Cause]:
        situation = self._outside.situation
        # What is only possible with values that are unknown has an alarm of its own: the topic is silent.
        if situation is not None and situation.certain:
            yield Cause(
                "unsafe-state",
                Priority.HIGH,
                self._outside.describe(situation),
                f"Nothing is started until it is back. {self._outside.way()}",
            )
        for one, other, variable in sorted(self._conflicts):
            yield Cause(
                f"conflict:{one}:{other}:{variable}",
                Priority.HIGH,
                f"{one} and {other} would finish with different values for {variable}",
                "Neither was applied. Correct the model.",
            )


def _topics(feeds: Feeds, monotonic: float) -> Iterator[Cause]:
    for name, feed in feeds.topics.items():
        resource = feed.pipeline.topic.resource
        if not feed.fresh(monotonic):
            silence = "No message yet" if feed.last is None else "No message any more"
            why = f" ({feed.why})" if feed.abandoned and feed.why else ""
            yield Cause(
                f"silent:{name}",
                Priority.MEDIUM,
                f"{silence} on {name}{why}: the values of {resource} are unknown",
                f"Check that the node of {resource} runs and is reachable.",
            )


def _reports(reports: Reports, moment: Moment, action: str) -> Iterator[Cause]:
    for place, cause, report in reports.current(moment.monotonic):
        text = f"{place}: {report.text}"
        if report.count > 1:
            first, last = (time.localtime(moment.epoch_of(each)) for each in (report.first, report.last))
            when = f"first at {time.strftime('%H:%M:%S', first)}, last at {time.strftime('%H:%M:%S', last)}"
            text += f" ({report.count} times, {when})"
        yield Cause(f"message:{place}:{cause}", Priority.MEDIUM, text, action)


def _network(network: NetworkWatch, commander: Commander) -> Iterator[Cause]:
    for topic, rival in network.rivals.items():
        yield Cause(
            f"rival:{topic}", Priority.HIGH, rival, "Nothing is started meanwhile. Stop the other one, or this station."
        )
    for topic, trouble in network.troubles.items():
        yield Cause(f"network:{topic}", Priority.MEDIUM, trouble, "Check which nodes run, and how they were built.")
    for topic, why in commander.owed.items():
        resource = commander.topics[topic].pipeline.topic.resource
        yield Cause(
            f"command:{topic}",
            Priority.HIGH,
            f"{resource} has not been sent its command on {topic}: {why}",
            "It is tried again, and nothing is started meanwhile. Check the network.",
        )


def _plan(execution: Execution, planner_trouble: str | None) -> Iterator[Cause]:
    if planner_trouble is not None:
        yield Cause("planner", Priority.MEDIUM, planner_trouble, "Tell the maintainers of this station's model.")
        return  # that there is no plan has this cause
    if execution.production is not Production.STARTED:
        return
    for name, since in execution.pursued.violated.items():
        active = name in execution.active
        yield Cause(
            f"local:{name}:{since.epoch}",
            Priority.MEDIUM,
            f"The local specification {violation(execution.automaton, name)}",
            "It is not planned for any more: bring its goal about by hand."
            if active
            else "Its goal was reached all the same: check what was made meanwhile.",
        )
    if execution.plan.status is PlanStatus.NONE and not execution.blind:  # a silent topic has an alarm of its own
        yield Cause("no-plan", Priority.MEDIUM, execution.plan.reason, "See what the active operations need.")
    elif execution.plan.status is not PlanStatus.NONE and execution.plan.answer is not None:
        yield from _left_out(execution, execution.plan.answer)


def _left_out(execution: Execution, answer: PlanAnswer) -> Iterator[Cause]:
    """The active operations that the plan does not reach: because it cannot, and because nobody knows."""
    operations, active = execution.automaton.operations, execution.active
    undecided = [operations[name].title for name in answer.undecided if name in active]
    excluded = [operations[name].title for name in answer.left_out if name in active and name not in answer.undecided]
    if excluded:
        text = f"Left out of the plan: {', '.join(excluded)}"
        action = "It is proven that no plan reaches these goals together with the others, as things are."
        yield Cause("left-out", Priority.LOW, text, action)
    if undecided:
        text = f"Not in the plan yet: {', '.join(undecided)}"
        action = "No plan that reaches these goals too was found in time, and none is ruled out; it is tried again."
        yield Cause("undecided", Priority.LOW, text, action)


def _overdue(execution: Execution, reacted: set[int], monotonic: float) -> Iterator[Cause]:
    for step in execution.plan.order.running:
        ability = execution.automaton.abilities[step.ability]
        if step.started is None:
            continue
        seconds = monotonic - step.started.monotonic
        react, finish = ability.timeouts.react, ability.timeouts.finish
        resource = execution.automaton.resources[ability.resource]
        if finish is not None and seconds > finish:
            executing = execution.state[ability.flag("executing")] is True
            what = "has not finished" if executing else "is not executing and has not finished"
            yield Cause(
                f"overdue:{step.ability}",
                Priority.MEDIUM,
                f"{ability.title} {what} within {finish:g} s",
                f"Look after {resource}.",
            )
        elif react is not None and seconds > react and step.number not in reacted:
            yield Cause(
                f"no-reaction:{step.ability}",
                Priority.MEDIUM,
                f"{ability.title} has not begun within {react:g} s",
                f"Check that {resource} receives its commands and is ready.",
            )
