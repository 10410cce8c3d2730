"""What a person should look at: beliefs that do not fit what is measured, and outputs that nobody has decided on."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Collection, Sequence

import structlog

from sequence_planner.analysis.never_together import NeverTogether, Pair
from sequence_planner.analysis.never_together_process import find_never_together
from sequence_planner.analysis.remembering import cache, remember, remembered
from sequence_planner.automaton.structure import Kind, State
from sequence_planner.control.contradictions import Contradictions, contradictions, questions
from sequence_planner.control.execution import Execution
from sequence_planner.control.restart_view import QuestionView, UndecidedOutputView
from sequence_planner.control.undecided import Undecided
from sequence_planner.control.vocabulary import Production

LOG = structlog.get_logger(__name__)

START_AFTER = 10.0  # seconds; a station that begins has other things to do
MOST_WORK = 60.0  # seconds of a processor to find out what is never together
SETTLED = 1.0  # seconds that a contradiction lasts before anybody is asked: messages of several devices come in turn


class Doubting:
    """Looks at `execution`. `close` ends the search for what is never together, if it was begun."""

    def __init__(self, execution: Execution, known: NeverTogether | None = None) -> None:
        self._execution = execution
        self._outputs = Undecided(execution)
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
        """What of the beliefs in `state` does not fit what is measured there."""
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
        where = cache()
        if where is not None:
            self._known = await asyncio.to_thread(remembered, where, automaton, NeverTogether)
        if self._known is None:
            await asyncio.sleep(after)
            self._known = await find_never_together(automaton, self._execution.supervisor, MOST_WORK)
            if where is not None and self._known is not None:
                await asyncio.to_thread(remember, where, automaton, self._known)
            pairs, exact = len(self.impossible()), self._known is not None and self._known.fits is not None
            LOG.info("what is never together", known=self._known is not None, pairs=pairs, exact=exact)
