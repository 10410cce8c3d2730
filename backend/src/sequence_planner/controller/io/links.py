"""The links to devices: which are heard, reached and understood, and the alarms of those that are not."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import (
    COMMAND,
    MANY_SILENT,
    MESSAGE,
    NETWORK,
    NEVER_HEARD,
    RIVAL,
    SILENT,
    AlarmKind,
    Cause,
)
from sequence_planner.controller.io.inputs import InputError, InputErrors, Inputs, InputTopic
from sequence_planner.controller.io.network import NetworkWatch
from sequence_planner.controller.io.outputs import Outputs
from sequence_planner.controller.recovery.who_can import WhoCan
from sequence_planner.controller.views.station import ResourceView, TopicView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import ServiceKind
from sequence_planner.texts.message import Argument, Message, as_it_was, message

GRACE = 30.0  # seconds after the start for devices to be heard first
STUMBLES = 10.0  # seconds for which one that was heard may be silent meanwhile: much begins at once
_MOST = 3  # so many devices, and half of all, fall silent at once only for one reason; or both of two


class DeviceLinks:
    """Looks at the links between `execution` and its devices."""

    def __init__(
        self,
        execution: Executor,
        feeds: Inputs,
        network: NetworkWatch,
        commander: Outputs,
        who_can: WhoCan,
        consequences: Consequences,
    ) -> None:
        self._execution = execution
        self._who_can = who_can
        self._consequences = consequences
        self._feeds = feeds
        self._network = network
        self._commander = commander
        self._began: float | None = None
        self.untold: Collection[str] = frozenset(execution.automaton.resources)
        """The resources whose silence is too young to be told."""
        self.silent: Sequence[str] = ()
        """The titles of the resources that are in use and not heard, as they were shown last."""

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """All that there are now. That a resource is silent which is out of service is nothing to be told."""
        self._who_can.look(self.untold, moment.monotonic)
        unused = self._execution.conduct.out_of(ServiceKind.RESOURCE)
        self._began = moment.monotonic if self._began is None else self._began
        yield from self._silences(moment.monotonic, unused)
        yield from self._mismatches()
        yield from self._rivals()
        yield from self._owed()
        for place, cause, report in self._feeds.reports.current(moment.monotonic):
            yield self._made_no_sense(place, cause, report, moment)
        yield from self._defaults(self._commander.reports, moment)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        resources, unused = self._resources(moment.monotonic), self._execution.conduct.out_of(ServiceKind.RESOURCE)
        self.silent = [each.title for name, each in resources.items() if not each.online and name not in unused]
        return {"resources": resources, "topics": self._topics(moment), "silent": self.silent}

    def _resources(self, monotonic: float) -> dict[str, ResourceView]:
        awaited: dict[str, list[str]] = {name: [] for name in self._execution.automaton.resources}
        for topic in self._feeds.awaited(monotonic):
            awaited[self._feeds.resource_of(topic)].append(topic)
        return {
            name: ResourceView(title=title, online=not awaited[name], awaited_topics=awaited[name])
            for name, title in self._execution.automaton.resources.items()
        }

    def _topics(self, moment: Timestamp) -> dict[str, TopicView]:
        views = {}
        for name, feed in self._feeds.topics.items():
            views[name] = TopicView(
                type=feed.pipeline.topic.type_name,
                direction="in",
                resource=feed.pipeline.topic.resource,
                last=moment.epoch_of(feed.last),
                messages=feed.messages,
                deadline=feed.pipeline.deadline,
                fresh=feed.fresh(moment.monotonic),
                peers=self._network.peers[name],
                **_trouble(self._network.troubles.get(name) or feed.trouble),
            )
        for name, command in self._commander.topics.items():
            views[name] = TopicView(
                type=command.pipeline.topic.type_name,
                direction="out",
                resource=command.pipeline.topic.resource,
                last=moment.epoch_of(command.last),
                messages=command.messages,
                deadline=None,
                fresh=command.last is not None,
                peers=self._network.peers[name],
                **_trouble(self._network.rivals.get(name) or self._network.troubles.get(name) or command.owed),
            )
        return views

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
        told: set[str] = set()  # as parts of an alarm of many
        for kind, resources in ((MANY_SILENT, lost), (NEVER_HEARD, unheard)):
            if _are_many(resources, silent, used):
                told.update(resources)
                yield self._together(kind, {name: silent[name] for name in resources}, len(used))
        for resource, feeds in silent.items():
            # As a part of another alarm it is told by its text alone; what comes of it takes some time to find out.
            consequence = "" if resource in told else self._consequences.without({resource})
            yield self._silence(resource, feeds, consequence, MANY_SILENT if resource in lost else NEVER_HEARD)

    def _together(self, kind: AlarmKind, silent: Mapping[str, Mapping[str, InputTopic]], used: int) -> Cause:
        titles = [self._execution.automaton.resources[name] for name in silent]
        some: dict[str, Argument] = {"resources": titles, "count": len(silent), "of": used}
        every = len(silent) == used
        return kind.cause(
            "",
            {
                "which": message("many-silent.all" if every else "many-silent.some", **some),
                "which_past": message("many-silent.all-past" if every else "many-silent.some-past", **some),
                "resources": titles,
                "consequence": self._consequences.without(silent),
            },
            resources=silent,
            topics=[topic for feeds in silent.values() for topic in feeds],
        )

    def _is_early(self, feed: InputTopic, monotonic: float) -> bool:
        """Return whether a silence need not be one yet: as a station begins much is begun beside it.

        One that was heard, and whose node went or broke its promise, is known to be silent.
        """
        if self._began is None or monotonic - self._began >= GRACE:
            return False
        if feed.last is None:
            return True
        return not feed.abandoned and monotonic - feed.last < (feed.pipeline.deadline or 0.0) + STUMBLES

    def _silence(
        self, resource: str, feeds: Mapping[str, InputTopic], consequence: Argument, follows: AlarmKind
    ) -> Cause:
        past = [_silence_of(name, feed, name in self._feeds.topics, over=True) for name, feed in feeds.items()]
        texts = [_silence_of(name, feed, name in self._feeds.topics) for name, feed in feeds.items()]
        explained = [NETWORK.key(resource)] if feeds.keys() <= self._network.troubles.keys() else []
        title = self._execution.automaton.resources[resource]
        expected = {name for name in self._feeds.expected if self._feeds.resource_of(name) == resource}
        if feeds.keys() >= expected:
            silence = message("silent.nothing", resource=title)
            silence_past = message("silent.nothing-past", resource=title)
        elif len(texts) == 1:
            silence, silence_past = texts[0], past[0]
        else:
            silence = message("silent.many", count=len(feeds), resource=title)
            silence_past = message("silent.many-past", count=len(feeds), resource=title)
        return SILENT.cause(
            resource,
            {
                "silence": silence,
                "silence_past": silence_past,
                "resource": title,
                "consequence": consequence,
            },
            follows=(follows.key(), *explained),
            parts=texts,
            past_parts=past,
            resources=[resource],
            topics=feeds,
            of=frozenset({resource}),
        )

    def _mismatches(self) -> Iterator[Cause]:
        """Of each resource one: what was built from other definitions is so on every topic."""
        troubles: dict[str, dict[str, Message]] = {}
        for topic, trouble in self._network.troubles.items():
            troubles.setdefault(self._network.resource_of(topic), {})[topic] = trouble
        for resource, by_topic in troubles.items():
            texts = list(by_topic.values())
            many = message("network.many", count=len(texts), resource=resource, first=texts[0])
            yield NETWORK.cause(
                resource,
                {"what": texts[0] if len(texts) == 1 else many, "resource": resource},
                parts=map(as_it_was, texts),
                resources=[resource],
                topics=by_topic,
            )

    def _rivals(self) -> Iterator[Cause]:
        rivals = self._network.rivals
        if rivals:
            texts = list(rivals.values())
            yield RIVAL.cause(
                "",
                {
                    "what": texts[0] if len(texts) == 1 else message("rival.many", count=len(texts), first=texts[0]),
                    "topics": ", ".join(rivals),
                    "consequence": self._consequences.standstill(),
                },
                parts=map(as_it_was, texts),
                resources=dict.fromkeys(self._resource_of(topic) for topic in rivals),
                topics=rivals,
            )

    def _owed(self) -> Iterator[Cause]:
        """One of all commands that are not out: they go through the same network."""
        owed = self._commander.owed
        if not owed:
            return
        resources = {topic: self._resource_of(topic) for topic in owed}
        texts = [message("command.one", resource=resources[topic], topic=topic, why=why) for topic, why in owed.items()]
        past = [message("command.one-past", resource=resources[topic], topic=topic) for topic in owed]
        one, of_one = len(texts) == 1, len(set(resources.values())) == 1
        silences = map(SILENT.key, sorted(set(resources.values())) if of_one else ())
        yield COMMAND.cause(
            "",
            {
                "what": texts[0] if one else message("command.many", count=len(texts), first=texts[0]),
                "what_past": past[0] if one else message("command.many-past", count=len(past)),
                "consequence": self._consequences.standstill(),
            },
            follows=(MANY_SILENT.key(), NEVER_HEARD.key(), *silences),
            parts=texts,
            past_parts=past,
            resources=dict.fromkeys(resources.values()),
            topics=owed,
        )

    def _resource_of(self, topic: str) -> str:
        return self._commander.topics[topic].pipeline.topic.resource

    def _made_no_sense(self, place: str, cause: str, report: InputError, moment: Timestamp) -> Cause:
        """Of something that was said; of a silent topic or service it is said with its silence."""
        feed = (self._feeds.topics | self._feeds.answers).get(place)
        silent = feed is not None and not feed.fresh(moment.monotonic)
        values = [name for name, sources in self._feeds.sources.items() if place in sources]
        unknown = sorted(name for name in values if self._execution.state[name] is None)
        what, resource = _counted(place, report, moment), self._feeds.resource_of(place)
        automaton = self._execution.automaton
        called, said = automaton.resources.get(resource, resource), sentences_of(automaton)
        return MESSAGE.cause(
            f"{place}:{cause}",
            {
                "what": message("message.received", resource=called, what=what),
                "what_past": message("message.received-past", resource=called, what=what),
                "consequence": message("message.unknown", variables=[said.call_variable(name) for name in unknown])
                if unknown
                else message("message.passed-over"),
                "action": message("message.check"),
            },
            follows=(SILENT.key(resource),) if silent else (),
            resources=[resource],
            topics=[place],
        )

    def _defaults(self, reports: InputErrors, moment: Timestamp) -> Iterator[Cause]:
        for place, cause, report in reports.current(moment.monotonic):
            what = _counted(place, report, moment)
            yield MESSAGE.cause(
                f"{place}:{cause}",
                {
                    "what": what,
                    "what_past": message("message.default-past", what=what),
                    "consequence": message("message.default"),
                    "action": message("message.correct"),
                },
                resources=[self._commander.topics[place].pipeline.topic.resource]
                if place in self._commander.topics
                else [],
                topics=[place],
            )


def _are_many(resources: Collection[str], silent: Collection[str], used: Collection[str]) -> bool:
    """Return whether so many of those that are used are silent at once that there is one reason for all."""
    return len(resources) > 1 and (len(silent) == len(used) or len(resources) >= max(_MOST, len(used) / 2))


def _silence_of(name: str, feed: InputTopic, is_topic: bool, over: bool = False) -> Message:
    what = "message" if is_topic else "answer"
    if over:
        return message(f"silent.no-{what}-past", topic=name)
    why = message("silent.why", why=feed.why) if feed.abandoned and feed.why else ""
    return message(f"silent.no-{what}-yet" if feed.last is None else f"silent.no-{what}", topic=name, why=why)


def _counted(place: str, report: InputError, moment: Timestamp) -> Message:
    times: Argument = ""
    if report.count > 1:
        span = (time.strftime("%H:%M:%S", time.localtime(moment.epoch_of(t))) for t in (report.first, report.last))
        first, last = span
        times = message("message.times", count=report.count, first=first, last=last)
    return message("message.said", topic=place, report=report.text, times=times)


def _trouble(trouble: str | None) -> dict[str, Any]:
    return {"trouble": trouble, "trouble_message": None if trouble is None else as_it_was(trouble)}
