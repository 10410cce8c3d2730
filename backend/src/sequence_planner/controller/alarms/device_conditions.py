"""Alarms of what is outside: devices that are not heard, not reached, or not understood."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping

from sequence_planner.controller.alarms.alarm import Cause, Consequences, listed
from sequence_planner.controller.io.inputs import InputError, InputErrors, Inputs, InputTopic
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.station import Priority
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor

GRACE = 30.0  # seconds after the start for devices to be heard first
STUMBLES = 10.0  # seconds for which one that was heard may be silent meanwhile: much begins at once
MANY = "many-silent"
UNHEARD = "never-heard"
_MOST = 3  # so many devices, and half of all, fall silent at once only for one reason; or both of two
_DEFAULTS = "The device gets the default instead. Correct the pipeline."


class DeviceAlarms:
    """Looks at the links between `execution` and its devices."""

    def __init__(
        self, execution: Executor, feeds: Inputs, network: NetworkWatch, commander: Outputs, who_can: WhoCan
    ) -> None:
        self._execution = execution
        self._consequences = Consequences(execution, who_can)
        self._feeds = feeds
        self._network = network
        self._commander = commander
        self._began: float | None = None
        # Resources whose silence is too young to be told.
        self.untold: Collection[str] = frozenset(execution.automaton.resources)

    def causes(self, moment: Timestamp, unused: Collection[str]) -> Iterator[Cause]:
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
        """Of each silent resource one, however many of its topics are; and one of many silent resources.

        What many that were heard share can have failed them. Those that were never heard may not have been started.
        """
        used = set(map(self._feeds.resource_of, self._feeds.expected)) - set(unused)
        silent: dict[str, dict[str, InputTopic]] = {}
        early: set[str] = set()
        for name in self._feeds.awaited(monotonic):
            resource, feed = self._feeds.resource_of(name), self._feeds.expected[name]
            if self._is_early(feed, monotonic):
                early.add(resource)
            elif resource in used:
                silent.setdefault(resource, {})[name] = feed
        self.untold = early - silent.keys()
        lost = [each for each, feeds in silent.items() if any(feed.last is not None for feed in feeds.values())]
        unheard = [each for each in silent if each not in lost]
        told: dict[str, str] = {}  # by resource, the alarm of many that it is a part of
        if _are_many(lost, silent, used):
            told |= dict.fromkeys(lost, MANY)
            yield self._together(
                MANY,
                Priority.HIGH,
                lost,
                "No contact with",
                "There was no contact with",
                "Check what they share: power, network, and the ROS_DOMAIN_ID of their nodes.",
            )
        if _are_many(unheard, silent, used):
            told |= dict.fromkeys(unheard, UNHEARD)
            yield self._together(
                UNHEARD,
                Priority.MEDIUM,
                unheard,
                "Nothing has been heard since the controller began of",
                "For some time after the controller began nothing was heard of",
                "Start them, or check their power, network and ROS_DOMAIN_ID.",
            )
        for resource, feeds in silent.items():
            # As a part of another alarm it is told by its text alone; what comes of it takes some time to find out.
            consequence = "" if resource in told else self._consequences.without({resource})
            yield self._silence(resource, feeds, consequence, MANY if resource in lost else UNHEARD)

    def _together(
        self, key: str, priority: Priority, resources: Collection[str], text: str, past: str, action: str
    ) -> Cause:
        titles = listed(self._execution.automaton.resources[name] for name in resources)
        consequence = self._consequences.without(resources)
        return Cause(key, priority, f"{text} {titles}", consequence, action, past=f"{past} {titles}")

    def _is_early(self, feed: InputTopic, monotonic: float) -> bool:
        """Return whether a silence need not be one yet: as a station begins much is begun beside it.

        One that was heard, and whose node went or broke its promise, is known to be silent.
        """
        if self._began is None or monotonic - self._began >= GRACE:
            return False
        if feed.last is None:
            return True
        return not feed.abandoned and monotonic - feed.last < (feed.pipeline.deadline or 0.0) + STUMBLES

    def _silence(self, resource: str, feeds: Mapping[str, InputTopic], consequence: str, follows: str) -> Cause:
        past = [_silence_of(name, feed, name in self._feeds.topics, over=True) for name, feed in feeds.items()]
        texts = [_silence_of(name, feed, name in self._feeds.topics) for name, feed in feeds.items()]
        explained = [_mismatch_key(resource)] if feeds.keys() <= self._network.troubles.keys() else []
        title = self._execution.automaton.resources[resource]
        alike, alike_past = (f"Nothing {was} heard on {len(feeds)} topics of {title}" for was in ("is", "was"))
        return Cause(
            silent_key(resource),
            Priority.MEDIUM,
            f"{texts[0]}: the values of {title} are unknown" if len(texts) == 1 else f"{alike}: its values are unknown",
            consequence,
            f"Check that the node of {title} runs and is reachable.",
            follows=(follows, *explained),
            parts=() if len(texts) == 1 else tuple(texts),
            past=past[0] if len(past) == 1 else alike_past,
            of=frozenset({resource}),
            past_parts=() if len(past) == 1 else tuple(past),
        )

    def _mismatches(self) -> Iterator[Cause]:
        """Of each resource one: what was built from other definitions is so on every topic."""
        troubles: dict[str, list[str]] = {}
        for topic, trouble in self._network.troubles.items():
            troubles.setdefault(self._network.resource_of(topic), []).append(trouble)
        for resource, texts in troubles.items():
            yield Cause(
                _mismatch_key(resource),
                Priority.MEDIUM,
                texts[0] if len(texts) == 1 else f"{len(texts)} links to {resource} are not understood: {texts[0]}",
                "Nothing passes between that node and the station there.",
                "Check which nodes run, how they were built, and with which RMW_IMPLEMENTATION they were started.",
                parts=() if len(texts) == 1 else tuple(texts),
                past=f"Something on the topics of {resource} was not understood",
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
                past=f"Somebody else commanded on {', '.join(self._network.rivals)}",
            )

    def _owed(self) -> Iterator[Cause]:
        """One of all commands that are not out: they go through the same network."""
        owed = self._commander.owed
        if not owed:
            return
        resources = {topic: self._commander.topics[topic].pipeline.topic.resource for topic in owed}
        texts = [f"{resources[topic]} has not been sent its command on {topic}: {why}" for topic, why in owed.items()]
        past = [f"{resources[topic]} was not sent its command on {topic} in time" for topic in owed]
        of_one = len(set(resources.values())) == 1
        yield Cause(
            "command",
            Priority.HIGH,
            texts[0] if len(texts) == 1 else f"{len(texts)} commands have not been sent: {texts[0]}",
            self._consequences.standstill(),
            "It is tried again. Check the network.",
            follows=(MANY, UNHEARD, *map(silent_key, sorted(set(resources.values())) if of_one else ())),
            parts=() if len(texts) == 1 else tuple(texts),
            past=past[0] if len(past) == 1 else f"{len(past)} commands were not sent in time",
            past_parts=() if len(past) == 1 else tuple(past),
        )

    def _made_no_sense(self, place: str, cause: str, report: InputError, moment: Timestamp) -> Cause:
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
            past=f"Made no sense: {_counted(place, report, moment)}",
        )

    def _defaults(self, reports: InputErrors, moment: Timestamp) -> Iterator[Cause]:
        for place, cause, report in reports.current(moment.monotonic):
            text = _counted(place, report, moment)
            comes_of_it = "The device does not do what the station believes to have commanded."
            past = f"The device got the default: {text}"
            yield Cause(_report_key(place, cause), Priority.MEDIUM, text, comes_of_it, _DEFAULTS, past=past)


def _are_many(resources: Collection[str], silent: Collection[str], used: Collection[str]) -> bool:
    """Return whether so many of those that are used are silent at once that there is one reason for all."""
    return len(resources) > 1 and (len(silent) == len(used) or len(resources) >= max(_MOST, len(used) / 2))


def silent_key(resource: str) -> str:
    """The key of the alarm that a resource is silent."""
    return f"silent:{resource}"


def _mismatch_key(resource: str) -> str:
    return f"network:{resource}"


def _report_key(place: str, cause: str) -> str:
    return f"message:{place}:{cause}"


def _silence_of(name: str, feed: InputTopic, is_topic: bool, over: bool = False) -> str:
    what = "message" if is_topic else "answer"
    if over:
        return f"For some time no {what} came on {name}"
    silence = f"No {what} yet" if feed.last is None else f"No {what} any more"
    why = f" ({feed.why})" if feed.abandoned and feed.why else ""
    return f"{silence} on {name}{why}"


def _counted(place: str, report: InputError, moment: Timestamp) -> str:
    text = f"{place}: {report.text}"
    if report.count == 1:
        return text
    first, last = (time.strftime("%H:%M:%S", time.localtime(moment.epoch_of(t))) for t in (report.first, report.last))
    return f"{text} ({report.count} times, first at {first}, last at {last})"
