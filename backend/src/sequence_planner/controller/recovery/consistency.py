"""Consistency of estimates and measurements: contradictions, and undecided restored outputs."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from math import inf, prod

import structlog

from sequence_planner.analysis.mutual_exclusion import NeverTogether, Pair, find_never_together
from sequence_planner.analysis.store import key, read, write
from sequence_planner.automaton.automaton import Automaton, Effect, Kind, State, target
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.lifting.sentences import sentences_of
from sequence_planner.automaton.state_set import EVERYTHING, NOTHING, StateSet
from sequence_planner.controller.alarms.consequences import Consequences
from sequence_planner.controller.alarms.kinds import CONTRADICTION, UNDECIDED_OUTPUTS, Cause
from sequence_planner.controller.recovery.safe_state import leaves
from sequence_planner.controller.views.station import QuestionView, UndecidedOutputView
from sequence_planner.core.clock import Timestamp
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.vocabulary import Production
from sequence_planner.language.evaluator import evaluate
from sequence_planner.language.types import Value
from sequence_planner.texts.message import Message, Sentence, message

# Where what the station believes does not fit what is measured, and what else could be true.
#
# Pure. It says nothing of measurements that never come without a fault, nor of beliefs that never are together whatever
# is measured: only of a belief that could be, a measurement that could be, and not both. An unknown variable may have
# any value.

MOST_HYPOTHESES = 64
_MOST_MEMBERS = 1000  # several can be one hypothesis, where values are unknown

Hypothesis = Mapping[str, Value]  # the estimates that have another value than is believed
Price = Callable[[str, Value], float]  # of a variable's value; infinite where it cannot have it


@dataclass(frozen=True)
class Contradictions:
    """`because` says which belief does not go together with which measurement; by one of `hypotheses` all fits."""

    because: tuple[Message, ...] = ()
    hypotheses: tuple[Hypothesis, ...] = ()


def contradictions(automaton: Automaton, known: NeverTogether, state: State) -> Contradictions:
    """Return what is wrong in `state` with the estimates, if anything is."""
    if known.fits is not None and (found := _of_all(automaton, known.fits, state)) is not None:
        return found
    return _of_pairs(automaton, known, state)


def questions(automaton: Automaton, found: Contradictions, state: State) -> list[QuestionView]:
    """Return what to look at; first what is wrong by every hypothesis, then the variable whose value leaves the fewest
    of them, whichever it turns out to be.
    """
    asked: list[tuple[bool, int, QuestionView]] = []
    for name in automaton.names(Kind.ESTIMATED):
        believed = state[name]
        if believed is None or not any(name in hypothesis for hypothesis in found.hypotheses):
            continue
        said = [hypothesis.get(name, believed) for hypothesis in found.hypotheses]
        possible = [value for value in automaton.types[name].domain if value in said]
        because = list(found.because)
        question = QuestionView(
            variable=name,
            believed=believed,
            so=message("offer.so", condition=sentences_of(automaton).tell_value(name, believed)),
            possible=possible,
            because=[*because],
            because_messages=because,
        )
        asked.append((believed in possible, sum(said.count(value) ** 2 for value in possible), question))
    return [question for *_, question in sorted(asked, key=lambda each: each[:2])]


def _of_all(automaton: Automaton, fits: StateSet, state: State) -> Contradictions | None:
    """By all variables at once. None where the measurements, or the estimates, alone are never so."""
    estimates = frozenset(automaton.names(Kind.ESTIMATED))

    def costs(held: frozenset[str], may_change: frozenset[str]) -> _Priced:
        """With the values of `held`, any of the others, and as few changes as possible of `may_change`."""

        def price(name: str, value: Value) -> float:
            now = state[name]
            if now is None or now == value:
                return 0
            return 1 if name in may_change else inf if name in held else 0

        return _Priced(fits, price)

    if _fits(fits, state):
        return Contradictions()
    names = frozenset(fits.names)
    believing = costs(names, estimates)
    if believing.least == inf or costs(estimates, frozenset()).least == inf:
        return None
    held = names
    for name in _last_first(automaton, fits.names):
        if costs(held - {name}, frozenset()).least == inf:
            held -= {name}
    members = islice(believing.members(), _MOST_MEMBERS)
    hypotheses = ({n: v for n, v in member.items() if n in estimates and v != state[n]} for member in members)
    return Contradictions((_because(automaton, state, held),), _different(hypotheses)[:MOST_HYPOTHESES])


def _fits(fits: StateSet, state: State) -> bool:
    """Return whether the set holds the state for some values that its unknown variables could have."""
    pending, seen = [fits.root], set[int]()
    while pending:
        reference = pending.pop()
        if reference == EVERYTHING:
            return True
        if reference == NOTHING or reference in seen:
            continue
        seen.add(reference)
        axis, children = fits.nodes[reference - 2]
        value = state[fits.names[axis]]
        pending.extend(c for c, v in zip(children, fits.domains[axis], strict=True) if value is None or v == value)
    return False


def _of_pairs(automaton: Automaton, known: NeverTogether, state: State) -> Contradictions:
    """By pairs: each estimate by itself, and only where it could have some other value."""
    because: list[Message] = []
    options: dict[str, list[Value]] = {}
    for name in automaton.names(Kind.ESTIMATED):
        excluded = {(value, other) for one, value, other, seen in known.pairs if one == name and state[other] == seen}
        against = sorted(other for value, other in excluded if value == state[name])
        possible = [v for v in automaton.types[name].domain if all(v != value for value, _ in excluded)]
        if against and possible:
            options[name] = possible
            because += [_because(automaton, state, (name, other)) for other in against]
    while prod(map(len, options.values())) > MOST_HYPOTHESES:
        options.popitem()  # one looks at this later, when the others are known
    combined = product(*options.values()) if options else ()
    return Contradictions(tuple(because), tuple(dict(zip(options, values, strict=True)) for values in combined))


def _last_first(automaton: Automaton, names: Iterable[str]) -> list[str]:
    """Outputs before what is measured before estimates: what is kept longest tells a person most."""
    order = (Kind.OUTPUT, Kind.MEASURED, Kind.ESTIMATED)
    return sorted(names, key=lambda name: order.index(automaton.variables[name].kind))


def _because(automaton: Automaton, state: State, names: Iterable[str]) -> Message:
    """That the belief in some of `names` does not go with what the others are measured to be."""
    told = set(names)
    believed: list[tuple[str, Value]] = []
    measured: list[tuple[str, Value]] = []
    for name in (each for each in automaton.variables if each in told):
        value = state[name]
        if value is not None:
            kind = automaton.variables[name].kind
            (believed if kind is Kind.ESTIMATED else measured).append((name, value))
    return message("belief.never", believed=_all_so(automaton, believed), measured=_all_so(automaton, measured))


def _all_so(automaton: Automaton, values: list[tuple[str, Value]]) -> Sentence:
    said = sentences_of(automaton)
    return said.tell_values(values, " and ".join(said.write_value(name, value) for name, value in values))


def _different(hypotheses: Iterable[Hypothesis]) -> tuple[Hypothesis, ...]:
    found: list[Hypothesis] = []
    for hypothesis in hypotheses:
        if hypothesis not in found:
            found.append(hypothesis)
    return tuple(found)


class _Priced:
    """The members of a set by what the values of their variables cost together."""

    def __init__(self, states: StateSet, price: Price) -> None:
        self._states = states
        self._prices = [
            [price(name, value) for value in domain] for name, domain in zip(states.names, states.domains, strict=True)
        ]
        # A variable that a way does not test has the value that costs nothing: there always is one that is free.
        self._costs: list[float] = [inf, 0]
        for axis, children in states.nodes:
            prices = self._prices[axis]
            self._costs.append(min(self._costs[c] + p for c, p in zip(children, prices, strict=True)))

    @property
    def least(self) -> float:
        """The cost of the cheapest; infinite if there are none."""
        return self._costs[self._states.root]

    def members(self) -> Iterator[dict[str, Value]]:
        """The cheapest, by what is said of them on the way."""

        def cheapest(reference: int) -> Iterator[dict[str, Value]]:
            if reference == NOTHING:
                return
            if reference == EVERYTHING:
                yield {}
                return
            axis, children = self._states.nodes[reference - 2]
            name, domain = self._states.names[axis], self._states.domains[axis]
            for value, child, cost in zip(domain, children, self._prices[axis], strict=True):
                if cost + self._costs[child] == self._costs[reference] < inf:
                    for rest in cheapest(child):
                        yield {name: value, **rest}

        return cheapest(self._states.root)


# Outputs that came back from the journal and would make their devices react as soon as they are published.
#
# While it was away the station does not know what has become of its devices, so an output that would move one as things
# are now is for a person to decide.


class RestoredOutputs:
    """Looks at `execution`."""

    def __init__(self, execution: Executor) -> None:
        self._execution = execution
        self._readers = _readers(execution.automaton)
        self._seen: tuple[State, object] | None = None
        self._views: dict[str, UndecidedOutputView] = {}

    def views(self) -> dict[str, UndecidedOutputView]:
        """The outputs on which a person must decide now, each with what its device would do.

        To force one for a while is no decision: what it will be afterwards is looked at.
        """
        state, conduct = self._execution.state, self._execution.conduct
        if self._seen is None or self._seen[0] is not state or self._seen[1] is not conduct:
            self._seen = state, conduct
            forced = {name: conduct.forces[name].real for name in conduct.forces.keys() & conduct.returned}
            real = {name: value for name, value in forced.items() if value is not None}
            self._views = dict(self._look(self._execution.corrected(real) if real else state, real, conduct.returned))
        return self._views

    def told(self, untold: Collection[str]) -> list[str]:
        """Those of them for which somebody is called.

        What rests only on resources whose silence is too young to be told may be over as soon as they are heard.
        """
        return [name for name in self.views() if not self._may_pass(name, untold)]

    def _may_pass(self, name: str, untold: Collection[str]) -> bool:
        """Return whether nothing reacts for certain, and what is unknown is of resources in `untold`."""
        automaton, state = self._execution.automaton, self._execution.state
        for effect in self._readers.get(name, ()):
            if _reaction(automaton, effect, state) is not None:
                read = read_variables(automaton, (effect.guard, *(each.value for each in effect.actions)))
                unknown = [each for each in read if state[each] is None]
                if not unknown or any(automaton.variables[each].resource not in untold for each in unknown):
                    return False
        return True

    def _look(
        self, state: State, real: Mapping[str, Value], returned: frozenset[str]
    ) -> Iterator[tuple[str, UndecidedOutputView]]:
        automaton = self._execution.automaton
        for name in sorted(returned):
            value = state[name]
            assert value is not None
            if reacts := self._reactions(name, state):
                others = (other for other in automaton.types[name].domain if other != value)
                quiet = [v for v in others if not self._reactions(name, self._execution.corrected({**real, name: v}))]
                yield (
                    name,
                    UndecidedOutputView(
                        value=value, reacts=[*reacts], reacts_messages=reacts, quiet=quiet, unsafe=self._unsafe(name)
                    ),
                )

    def _unsafe(self, name: str) -> list[Value]:
        """The values that would lead out of the safe states while all else is as it is."""
        execution = self._execution
        safe, state = execution.supervisor.safe, execution.state
        domain = execution.automaton.types[name].domain
        return [value for value in domain if leaves(safe, state, execution.corrected({name: value}))]

    def _reactions(self, name: str, state: State) -> list[Message]:
        found = (_reaction(self._execution.automaton, effect, state) for effect in self._readers.get(name, ()))
        return list(dict.fromkeys(text for text in found if text is not None))


def _readers(automaton: Automaton) -> Mapping[str, list[Effect]]:
    """By output the effects that read it; nobody counts on faults."""
    readers: dict[str, list[Effect]] = {}
    for effect in automaton.effects:
        conditions = (action.condition for action in effect.actions if action.condition is not None)
        read = read_variables(automaton, (effect.guard, *conditions, *(action.value for action in effect.actions)))
        for name in sorted(read & automaton.outputs) if not effect.fault else ():
            readers.setdefault(name, []).append(effect)
    return readers


def _reaction(automaton: Automaton, effect: Effect, state: State) -> Message | None:
    """Return what the effect would change; None where it certainly would change nothing."""
    guard = evaluate(effect.guard, state)
    if guard is False:
        return None
    changes: dict[str, Value | None] = {}
    for action in effect.actions:
        applies = True if action.condition is None else evaluate(action.condition, state)
        value, now = evaluate(action.value, state), state[target(action)]
        if applies is not False and (value is None or now is None or value != now):
            changes[target(action)] = value if applies else None
    if not changes:
        return None
    sentences = sentences_of(automaton)
    resource = sentences.call_part(effect.resource, automaton.resources.get(effect.resource, effect.resource))
    if guard is None:
        unknown = sorted(n for n in read_variables(automaton, (effect.guard,)) if state[n] is None)
        return message("reacts.may", resource=resource, variables=" and ".join(unknown))
    said = [
        message("reacts.changes", variable=n) if v is None else sentences.tell_value(n, v) for n, v in changes.items()
    ]
    return message("reacts.does", resource=resource, changes=said)


# What a person should look at: beliefs that do not fit what is measured, and outputs that nobody has decided on.

LOG = structlog.get_logger(__name__)

START_AFTER = 10.0  # seconds; a station that begins has other things to do
MOST_WORK = 60.0  # seconds of a processor to find out what is never together
SETTLED = 1.0  # seconds that a contradiction lasts before anybody is asked: messages of several devices come in turn


class ConsistencyMonitor:
    """Looks at `execution`. `close` ends the search for what is never together, if it was begun.

    `untold` are resources whose silence is too young to be told.
    """

    def __init__(
        self,
        execution: Executor,
        known: NeverTogether | None = None,
        untold: Callable[[], Collection[str]] = frozenset,
    ) -> None:
        self._execution = execution
        self._untold = untold
        self._consequences = Consequences(execution)
        self._outputs = RestoredOutputs(execution)
        self._known = known
        self._search: asyncio.Task[None] | None = None
        self._seen: tuple[State, frozenset[str], Production] | None = None
        self._found = Contradictions()
        self._since: float | None = None
        self.questions: Sequence[QuestionView] = ()

    def begin(self, after: float = START_AFTER) -> None:
        """Search for what is never together, in a while, unless it is known from an earlier run."""
        self._search = asyncio.get_running_loop().create_task(self._learn(after))

    def close(self) -> None:
        """Search no longer."""
        if self._search is not None:
            self._search.cancel()

    @property
    def undecided(self) -> dict[str, UndecidedOutputView]:
        """The outputs on which a person must decide."""
        return self._outputs.views()

    def view_part(self, moment: Timestamp) -> dict[str, object]:
        """Its part of the view."""
        return {"undecided": self.undecided, "questions": list(self.questions)}

    def causes(self, moment: Timestamp) -> Iterator[Cause]:
        """The causes of alarms that there are now."""
        if self.questions:
            said = sentences_of(self._execution.automaton)
            asked = [said.tell_value(each.variable, each.believed) for each in self.questions]
            texts = [message("contradiction.believed", condition=each) for each in asked]
            past = [message("contradiction.believed-past", condition=each) for each in asked]
            yield CONTRADICTION.cause(
                "",
                {
                    "first": texts[0],
                    "first_past": past[0],
                    "consequence": self._consequences.of_values({each.variable for each in self.questions}),
                },
                parts=texts,
                past_parts=past,
                about=frozenset(each.variable for each in self.questions),
            )
        if undecided := self.told(self._untold()):
            call = sentences_of(self._execution.automaton).call_variable
            yield UNDECIDED_OUTPUTS.cause("", {"outputs": [call(name) for name in sorted(undecided)]})

    def told(self, untold: Collection[str]) -> list[str]:
        """Those for which somebody is called, while the silence of resources in `untold` is too young to be told."""
        return self._outputs.told(untold)

    def impossible(self) -> frozenset[Pair]:
        """The values of estimates that never go together with a value of another variable, as far as is known."""
        return frozenset() if self._known is None else self._known.pairs

    def look(self, now: float | None = None) -> None:
        """See whether there is something to be asked. It takes no time unless something has changed."""
        now = time.monotonic() if now is None else now
        execution = self._execution
        seen = execution.state, frozenset(execution.conduct.forces), execution.production
        if self._known is not None and seen != self._seen:
            self._seen = seen
            self._found = self.contradictions(execution.state)
            self._since = (now if self._since is None else self._since) if self._found.hypotheses else None
        asked = self._since is not None and now - self._since >= SETTLED
        found = questions(execution.automaton, self._found, execution.state) if asked else ()
        # Who has looked is not asked again: then what is measured is what is wrong.
        self.questions = tuple(each for each in found if each.variable not in execution.conduct.answers)

    def contradictions(self, state: State) -> Contradictions:
        """Return what of the beliefs in `state` does not fit what is measured there."""
        if self._known is None:
            return Contradictions()
        return contradictions(self._execution.automaton, self._known, self._evidence(state))

    def _evidence(self, state: State) -> State:
        """Without what says nothing of the devices: what is forced, and outputs before they are published."""
        outputs = self._execution.automaton.outputs
        unpublished = outputs if self._execution.production is not Production.STARTED else frozenset[str]()
        unseen = unpublished | self._execution.conduct.forces.keys()
        return {name: None if name in unseen else value for name, value in state.items()}

    async def _learn(self, after: float) -> None:
        automaton = self._execution.automaton
        if not automaton.names(Kind.ESTIMATED):
            return
        of = await asyncio.to_thread(key, automaton)
        self._known = await asyncio.to_thread(read, of, NeverTogether)
        if self._known is None:
            await asyncio.sleep(after)
            self._known = await find_never_together(automaton, self._execution.supervisor, MOST_WORK)
            if self._known is not None:
                await asyncio.to_thread(write, of, self._known)
            pairs, exact = len(self.impossible()), self._known is not None and self._known.fits is not None
            LOG.info("what is never together", known=self._known is not None, pairs=pairs, exact=exact)
