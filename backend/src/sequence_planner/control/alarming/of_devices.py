"""Alarms of what is outside: devices that are not heard, not reached, or not understood."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping

from sequence_planner.control.alarm_view import Priority
from sequence_planner.control.alarming.cause import Cause
from sequence_planner.control.alarming.consequence import Consequences, listed
from sequence_planner.control.bad_input import Report, Reports
from sequence_planner.control.commander import Commander
from sequence_planner.control.execution import Execution
from sequence_planner.control.feeds import Feed, Feeds
from sequence_planner.control.moment import Moment
from sequence_planner.control.network_watch import NetworkWatch

PATIENCE = 15.0  # seconds after the start for devices to be heard first
MANY = "many-silent"
_MOST = 3  # so many devices, and half of all, fall silent at once only for one reason; or both of two
_DEFAULTS = "The device gets the default instead. Correct the pipeline."


class DeviceAlarms:
    """Looks at the links between `execution` and its devices."""

    def __init__(self, execution: Execution, feeds: Feeds, network: NetworkWatch, commander: Commander) -> None:
        self._execution = execution
        self._consequences = Consequences(execution)
        self._feeds = feeds
        self._network = network
        self._commander = commander
        self._began: float | None = None

    def causes(self, moment: Moment, unused: Collection[str]) -> Iterator[Cause]:
        """All that there are now. That an `unused` resource is silent is nothing to be told."""
        self._began = moment.monotonic if self._began is None else self._began
        yield from self._silences(moment.monotonic, unused)
        yield from self._mismatches()
        yield from self._rivals()
        yield from self._owed()
        for place, cause, report in self._feeds.reports.current(moment.monotonic):
            yield self._made_no_sense(place, cause, report, moment)
        yield from self._defaults(self._commander.reports, moment)

    def _silences(self, monotonic: float, unused: Collection[str]) -> Iterator[Cause]:
        """Of each silent resource one, however many of its topics are; and one of many silent resources."""
        used = set(map(self._feeds.resource_of, self._feeds.expected)) - set(unused)
        silent: dict[str, dict[str, Feed]] = {}
        for name in self._feeds.awaited(monotonic):
            resource, feed = self._feeds.resource_of(name), self._feeds.expected[name]
            if resource in used and not self._is_early(feed, monotonic):
                silent.setdefault(resource, {})[name] = feed
        many = len(silent) > 1 and (len(silent) == len(used) or len(silent) >= max(_MOST, len(used) / 2))
        if many:
            every = f"All {len(used)}" if len(silent) == len(used) else f"{len(silent)} of {len(used)}"
            yield Cause(
                MANY,
                Priority.HIGH,
                f"{every} devices are silent, so it is probably the network",
                self._consequences.without(silent.keys()),
                "Check what these devices share: the network, the power, and the ROS_DOMAIN_ID of their nodes.",
            )
        for resource, feeds in silent.items():
            # As a part of another alarm it is told by its text alone; what comes of it takes some time to find out.
            yield self._silence(resource, feeds, "" if many else self._consequences.without({resource}))

    def _is_early(self, feed: Feed, monotonic: float) -> bool:
        return feed.last is None and self._began is not None and monotonic - self._began < PATIENCE

    def _silence(self, resource: str, feeds: Mapping[str, Feed], consequence: str) -> Cause:
        texts = [_silence_of(name, feed, name in self._feeds.topics) for name, feed in feeds.items()]
        explained = [_mismatch_key(resource)] if feeds.keys() <= self._network.troubles.keys() else []
        alike = f"Nothing is heard on {len(feeds)} topics: the values of {resource} are unknown"
        return Cause(
            silent_key(resource),
            Priority.MEDIUM,
            f"{texts[0]}: the values of {resource} are unknown" if len(texts) == 1 else alike,
            consequence,
            f"Check that the node of {resource} runs and is reachable.",
            follows=(MANY, *explained),
            parts=() if len(texts) == 1 else tuple(texts),
        )

    def _mismatches(self) -> Iterator[Cause]:
        """Of each resource one: what was built from other definitions is so on every topic."""
        troubles: dict[str, list[str]] = {}
        for topic, trouble in self._network.troubles.items():
            troubles.setdefault(self._network.uses[topic].topic.resource, []).append(trouble)
        for resource, texts in troubles.items():
            yield Cause(
                _mismatch_key(resource),
                Priority.MEDIUM,
                texts[0] if len(texts) == 1 else f"{len(texts)} topics of {resource} are not understood: {texts[0]}",
                "Nothing passes between that node and the station there.",
                "Check which nodes run, and how they were built.",
                parts=() if len(texts) == 1 else tuple(texts),
            )

    def _rivals(self) -> Iterator[Cause]:
        texts = list(self._network.rivals.values())
        if texts:
            yield Cause(
                "rival",
                Priority.HIGH,
                texts[0] if len(texts) == 1 else f"Somebody else commands on {len(texts)} topics: {texts[0]}",
                self._consequences.standstill(),
                "Stop the other one, or this station.",
                parts=() if len(texts) == 1 else tuple(texts),
            )

    def _owed(self) -> Iterator[Cause]:
        """One of all commands that are not out: they go through the same network."""
        owed = self._commander.owed
        if not owed:
            return
        resources = {topic: self._commander.topics[topic].pipeline.topic.resource for topic in owed}
        texts = [f"{resources[topic]} has not been sent its command on {topic}: {why}" for topic, why in owed.items()]
        of_one = len(set(resources.values())) == 1
        yield Cause(
            "command",
            Priority.HIGH,
            texts[0] if len(texts) == 1 else f"{len(texts)} commands have not been sent: {texts[0]}",
            self._consequences.standstill(),
            "It is tried again. Check the network.",
            follows=(MANY, *map(silent_key, sorted(set(resources.values())) if of_one else ())),
            parts=() if len(texts) == 1 else tuple(texts),
        )

    def _made_no_sense(self, place: str, cause: str, report: Report, moment: Moment) -> Cause:
        """Of something that was said; of a silent topic or service it is said with its silence."""
        feed = (self._feeds.topics | self._feeds.answers).get(place)
        silent = feed is not None and not feed.fresh(moment.monotonic)
        values = [name for name, sources in self._feeds.sources.items() if place in sources]
        unknown = sorted(name for name in values if self._execution.state[name] is None)
        return Cause(
            _report_key(place, cause),
            Priority.MEDIUM,
            _counted(place, report, moment),
            f"Unknown because of it: {listed(unknown)}." if unknown else "It was passed over.",
            "Check the node that sends it.",
            follows=(silent_key(self._feeds.resource_of(place)),) if silent else (),
        )

    def _defaults(self, reports: Reports, moment: Moment) -> Iterator[Cause]:
        for place, cause, report in reports.current(moment.monotonic):
            text = _counted(place, report, moment)
            comes_of_it = "The device does not do what the station believes to have commanded."
            yield Cause(_report_key(place, cause), Priority.MEDIUM, text, comes_of_it, _DEFAULTS)


def silent_key(resource: str) -> str:
    """The key of the alarm that a resource is silent."""
    return f"silent:{resource}"


def _mismatch_key(resource: str) -> str:
    return f"network:{resource}"


def _report_key(place: str, cause: str) -> str:
    return f"message:{place}:{cause}"


def _silence_of(name: str, feed: Feed, is_topic: bool) -> str:
    what = "message" if is_topic else "answer"
    silence = f"No {what} yet" if feed.last is None else f"No {what} any more"
    why = f" ({feed.why})" if feed.abandoned and feed.why else ""
    return f"{silence} on {name}{why}"


def _counted(place: str, report: Report, moment: Moment) -> str:
    text = f"{place}: {report.text}"
    if report.count == 1:
        return text
    first, last = (time.strftime("%H:%M:%S", time.localtime(moment.epoch_of(t))) for t in (report.first, report.last))
    return f"{text} ({report.count} times, first at {first}, last at {last})"
