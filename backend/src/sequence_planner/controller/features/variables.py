"""Variables: since when each has its value, and why each estimate is believed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from pydantic import JsonValue, ValidationError

from sequence_planner.automaton.automaton import Ability, Automaton, Kind, reads, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.lifting.spoken_names import SpokenNames
from sequence_planner.controller.commands.command import answers
from sequence_planner.controller.commands.queries import AboutNames
from sequence_planner.controller.views.details import NamesView, VariableNameView
from sequence_planner.controller.views.station import BeliefView, VariableKind, VariableView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.events import CalledOff, Confirmed, Corrected, Heard, ModeChanged, Ticked, TickOutcome
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.jobs import Job
from sequence_planner.execution.state import InitialState
from sequence_planner.language.syntax import Assignment, Expression, conjunction, variables
from sequence_planner.language.types import Value
from sequence_planner.texts.message import Title

# Why each estimated variable is believed to have its value: who wrote it, when, from which evidence.
#
# Nothing measures an estimate, so all that can be said for it is what was measured when it was written. What a person
# forces is no evidence, and what came back after a restart of the controller nobody has seen to be still true.

MODEL = "the model"  # writes what is so in the beginning
JOURNAL = "the journal"  # of what came back when nobody knows any more who wrote it

KIND = "beliefs"  # of the records of beliefs, as they are from then on: the first has all, and others what has changed
Tell = Callable[[Mapping[str, JsonValue]], None]


class Beliefs:
    """Listens to `execution`. `tell` hears of all beliefs when the first has changed, and then of each that has;
    `before` came back.
    """

    def __init__(
        self,
        execution: Executor,
        beginning: InitialState | None = None,
        before: Mapping[str, BeliefView] | None = None,
        tell: Tell = lambda beliefs: None,
    ) -> None:
        self._execution = execution
        self._automaton = execution.automaton
        self._estimates = frozenset(execution.automaton.names(Kind.ESTIMATED))
        self._tell = tell
        self._has_told = False
        self._beliefs = {name: _first(name, beginning, before or {}) for name in sorted(self._estimates)}
        execution.listeners.append(self.hear)

    def of(self, name: str) -> BeliefView:
        """Return why an estimate is believed."""
        return self._beliefs[name]

    def document(self) -> dict[str, JsonValue]:
        """All beliefs, as a record has them."""
        return _document(self._beliefs)

    @property
    def unconfirmed(self) -> bool:
        """True if there are estimates of which nobody has seen whether they are still true."""
        return any(belief.unconfirmed_since is not None for belief in self._beliefs.values())

    def hear(self, heard: Heard) -> None:
        """Take note of what has written estimates."""
        before = dict(self._beliefs)
        match heard.happening:
            case Ticked(now=now) if heard.outcome is not None:
                self._ticked(heard, heard.outcome, now)
            case Corrected(values=names, by=by, now=now, taken_back=unseen):
                for name in self._estimates.intersection(names):
                    self._beliefs[name] = _unmeasured(by, now) if name in unseen else _seen(by, now)
            case Confirmed(names=names, by=by, now=now):
                for name in self._estimates.intersection(names):
                    self._beliefs[name] = _seen(by, now)
            case ModeChanged(by=by, now=now) | CalledOff(by=by, now=now):
                for name in self._changed(heard):
                    self._beliefs[name] = _unmeasured(by, now)
        changed = {name: belief for name, belief in self._beliefs.items() if belief != before[name]}
        if changed:
            all_, self._has_told = not self._has_told, True
            self._tell(self.document() if all_ else _document(changed))

    def _ticked(self, heard: Heard, outcome: TickOutcome, now: Timestamp) -> None:
        """In their order: what a new product brought, who finished, who was called off, who started."""
        abilities, changed = self._automaton.abilities, self._changed(heard)
        for job in self._execution.conduct.jobs.under_way:
            if job.begun == now:
                self._brought(job, changed)
        for name in outcome.finished:
            ability = abilities[name]
            assert ability.finish_guard is not None
            # A finish guard can go on to hold; what is written once more then says nothing new.
            fresh = self._estimates if name in outcome.ended else changed
            for action in _taken(ability.finish_actions, fresh, changed):
                self._wrote(heard, ability, ability.finish_guard, action, now)
        for name in outcome.called_off:
            for action in _taken(abilities[name].cancel_actions, changed, changed):
                self._beliefs[target(action)] = _unmeasured(name, now)
        for name in outcome.started:
            ability = abilities[name]
            for action in _taken(ability.start_actions, self._estimates, changed):
                self._wrote(heard, ability, conjunction(ability.enabled, ability.start_guard), action, now)

    def _brought(self, job: Job, changed: frozenset[str]) -> None:
        """The product of the job is there; who ordered it says what it is like."""
        for action in self._automaton.work_masters[job.work_master].brings:
            if target(action) in changed:
                since = job.begun.epoch if job.begun is not None else 0.0
                belief = BeliefView(writer=f"job {job.id}", at=since, evidence=[], unconfirmed_since=None)
                self._beliefs[target(action)] = belief

    def _wrote(self, heard: Heard, ability: Ability, guard: Expression, action: Assignment, now: Timestamp) -> None:
        """The ability has written an estimate, as its `guard` held."""
        seen = self._evidence(heard, guard, action)
        forced = seen.keys() & self._execution.conduct.forces.keys()
        genuine = ((name, value) for name, value in seen.items() if name not in forced)
        self._beliefs[target(action)] = BeliefView(
            writer=ability.name,
            at=now.epoch,
            evidence=[
                sentences_of(self._automaton).write_value(name, value) for name, value in genuine if value is not None
            ],
            unconfirmed_since=now.epoch if forced else self._doubt(action),
        )

    def _evidence(self, heard: Heard, guard: Expression, action: Assignment) -> dict[str, Value | None]:
        """Return what was measured: the variables that are read, or else those that flags were set by in the tick
        before.
        """
        direct = [*variables(guard), *sorted(reads(action))]
        measured = [name for name in dict.fromkeys(direct) if self._is(name, Kind.MEASURED)]
        if measured:
            return {name: heard.after[name] for name in measured}
        behind = sorted(read_variables(self._automaton, (guard,)))
        return {name: heard.before[name] for name in behind if self._is(name, Kind.MEASURED)}

    def _doubt(self, action: Assignment) -> float | None:
        """Since when nobody has confirmed an estimate from which the value is computed."""
        read = self._estimates.intersection(variables(action.value))
        since = [self._beliefs[name].unconfirmed_since for name in read]
        return min((each for each in since if each is not None), default=None)

    def _changed(self, heard: Heard) -> frozenset[str]:
        return frozenset(name for name in self._estimates if heard.before[name] != heard.after[name])

    def _is(self, name: str, kind: Kind) -> bool:
        variable = self._automaton.variables.get(name)
        return variable is not None and variable.kind is kind


def _document(beliefs: Mapping[str, BeliefView]) -> dict[str, JsonValue]:
    return {name: belief.model_dump(mode="json") for name, belief in beliefs.items()}


def _taken(actions: Iterable[Assignment], names: frozenset[str], changed: frozenset[str]) -> Iterator[Assignment]:
    """The actions that write one of `names`. One with a condition has only if its variable has changed."""
    return (a for a in actions if target(a) in (names if a.condition is None else names & changed))


def _seen(by: str, now: Timestamp) -> BeliefView:
    """A person says so."""
    return BeliefView(writer=by, at=now.epoch, evidence=[], unconfirmed_since=None)


def _unmeasured(writer: str, now: Timestamp) -> BeliefView:
    """Calling off writes what is expected of it, and who takes a correction back what was there: nothing was measured
    that says so.
    """
    return BeliefView(writer=writer, at=now.epoch, evidence=[], unconfirmed_since=now.epoch)


def _first(name: str, beginning: InitialState | None, before: Mapping[str, BeliefView]) -> BeliefView:
    """Return what is known as the execution begins."""
    at = 0.0 if beginning is None else beginning.now.epoch
    since = None if beginning is None else beginning.unconfirmed_since
    if beginning is None or name not in beginning.values:
        return BeliefView(writer=MODEL, at=at, evidence=[], unconfirmed_since=since)
    known = before.get(name)
    if known is None:
        return BeliefView(writer=JOURNAL, at=at if since is None else since, evidence=[], unconfirmed_since=since)
    doubted = [each for each in (known.unconfirmed_since, since) if each is not None]
    return known.model_copy(update={"unconfirmed_since": min(doubted, default=None)})


def beliefs_from(content: Mapping[str, JsonValue]) -> dict[str, BeliefView]:
    """Return what such a record says; nothing where it is of a program that wrote it differently."""
    try:
        return {name: BeliefView.model_validate(written) for name, written in content.items()}
    except ValidationError:
        return {}


# What each variable is, and since when.


class Variables:
    """Those of `execution`; `feeds` names the topic behind each measured one."""

    def __init__(self, execution: Executor, feeds: Mapping[str, str], beliefs: Beliefs) -> None:
        self._execution = execution
        self._feeds, self._beliefs = feeds, beliefs
        self._since: dict[str, tuple[Value | None, float]] = {}
        self._last: dict[str, Value] = {}  # what those that have become unknown were before
        self._commanded: dict[str, str] = {}
        self.began: float | None = None
        """The first tick: a value of then may be as old as can be."""
        self._names: NamesView | None = None

    def after_tick(self, outcome: TickOutcome, moment: Timestamp) -> None:
        """After a tick: remember what has changed, and who commanded it."""
        automaton, now = self._execution.automaton, moment.epoch
        self.began = now if self.began is None else self.began
        changed = set()
        for name in automaton.variables:
            value, before = self._execution.state[name], self._since.get(name)
            if before is None or before[0] != value:
                if value is None and before is not None and before[0] is not None:
                    self._last[name] = before[0]
                self._since[name] = (value, now)
                changed.add(name)
        if not changed:
            return
        abilities = automaton.abilities
        acted = [
            *((name, abilities[name].finish_actions) for name in outcome.finished),
            *((name, abilities[name].cancel_actions) for name in outcome.called_off),
            *((name, abilities[name].start_actions) for name in outcome.started),
        ]
        self._commanded.update(
            {target(action): name for name, actions in acted for action in actions if target(action) in changed}
        )

    @answers(AboutNames)
    def spoken_names(self, query: AboutNames) -> NamesView:
        """What they are called. That is found out when somebody asks, and then kept: the model stays the same."""
        self._names = self._names or names_view(self._execution.automaton, self._feeds)
        return self._names

    def since(self, name: str) -> float | None:
        """Return when a variable was first seen with the value that it has; None before the first tick."""
        seen = self._since.get(name)
        return None if seen is None else seen[1]

    def commanded_by(self, name: str) -> str | None:
        """Return the ability that has written the value of an output; None where none has."""
        return self._commanded.get(name)

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"variables": self._views(), "unconfirmed": self._beliefs.unconfirmed}

    def _views(self) -> dict[str, VariableView]:
        views = {}
        for name, variable in self._execution.automaton.variables.items():
            if variable.kind is Kind.ACTIVITY:
                continue  # operations have a part of their own
            value = self._execution.state[name]
            since = self._since.get(name)
            views[name] = VariableView(
                resource=variable.resource,
                kind=VariableKind(variable.kind),
                value=value,
                domain=list(variable.type.domain),
                dual_approval=variable.dual_approval,
                since=since[1] if since else None,
                awaits=self._feeds.get(name) if value is None else None,
                last_known=self._last.get(name) if value is None else None,
                belief=self._beliefs.of(name) if variable.kind is Kind.ESTIMATED else None,
                commanded_by=self._commanded.get(name) if variable.kind is Kind.OUTPUT else None,
            )
        return views


def names_view(automaton: Automaton, topics: Mapping[str, str]) -> NamesView:
    """What the variables are called, with the topics that tell what they are, and what all other parts are."""
    spoken = SpokenNames(automaton)
    found: dict[str, VariableNameView] = {}
    words: dict[tuple[tuple[str, tuple[tuple[str, str], ...]], ...], int] = {}  # each once, with its place
    for name, variable in automaton.variables.items():
        if variable.kind is Kind.ACTIVITY:
            continue
        key = tuple((_as_key(value), tuple(each.items())) for value, each in spoken.all_entries(name).items())
        found[name] = VariableNameView(
            title=spoken.headings(name),
            values=words.setdefault(key, len(words)) if key else None,
            topic=topics.get(name) if variable.kind is Kind.MEASURED else None,
        )
    abilities = automaton.abilities.values()
    return NamesView(
        variables=found,
        values=[{value: dict(each) for value, each in key} for key in words],
        station=_by_language({"": automaton.title}).get("", {}),
        resources=_by_language(automaton.resources),
        abilities=_by_language({each.name: each.title for each in abilities}),
        tasks=_by_language({each.name: each.human.text for each in abilities if each.human is not None}),
        operations=_by_language({each.name: each.title for each in automaton.operations.values()}),
        specifications=_by_language({each.name: each.title for each in automaton.specifications.values()}),
        work_masters=_by_language({each.name: each.title for each in automaton.work_masters.values()}),
    )


def _by_language(titles: Mapping[str, str]) -> dict[str, dict[str, str]]:
    """The titles of those parts that have them by language, by name."""
    return {name: dict(title.words) for name, title in titles.items() if isinstance(title, Title)}


def _as_key(value: Value) -> str:
    """A value as a page writes it: `true`, `4`, `home`."""
    return str(value).lower() if isinstance(value, bool) else str(value)
