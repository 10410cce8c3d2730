"""Answers about the state space of a draft, in a process that keeps the model and the states that it has reached."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from sequence_planner.automaton.automaton import Automaton, State
from sequence_planner.controller.views.part import Value as ShownValue
from sequence_planner.editor.processes import encoded
from sequence_planner.editor.schemas.state_space import Extent, StateSpaceQuestion, StateSpaceView
from sequence_planner.editor.schemas.what_if import transferred
from sequence_planner.editor.state_space.choice import about_guards, ranked, suggested
from sequence_planner.editor.state_space.preparing import SafeStates, with_safe_states
from sequence_planner.editor.state_space.quotient import MOST_NODES, Quotient
from sequence_planner.editor.state_space.reached import Reached, reached_states
from sequence_planner.editor.state_space.telling import StateSpaceTelling
from sequence_planner.editor.stepping.stepper import Stepper
from sequence_planner.editor.stepping.telling import StepTelling
from sequence_planner.editor.usable import KeptDraft, UnusableModelError, read_condition
from sequence_planner.language.syntax import Expression
from sequence_planner.model.paths import EditError
from sequence_planner.texts.message import message

Asked = tuple[int, Path | None, Mapping[str, ShownValue | None], StateSpaceQuestion]
SpaceQuestion = tuple[Mapping[str, str | None], str, Asked]


class StateSpaceService:
    """Answers about a draft that it keeps in `folder`."""

    def __init__(self, folder: Path) -> None:
        self._draft = KeptDraft(folder, with_safe_states)
        self._of: SafeStates | None = None
        self._telling: StateSpaceTelling | None = None
        self._known: dict[Extent, Reached] = {}

    def space_view(self, question: SpaceQuestion) -> StateSpaceView:
        """Return the state space as it is asked for. Raises `EditError` for what is not in the model."""
        changed, _, (number, stages, present, asked) = question
        meant = self._draft.meant(changed, stages)
        if isinstance(meant, UnusableModelError):
            return StateSpaceView(number=number, obstacle=meant.why, most=MOST_NODES)
        if self._telling is None or self._of is not meant:
            self._of, self._known = meant, {}
            self._telling = StateSpaceTelling(StepTelling(Stepper(meant.automaton, meant.supervisor)))
        if asked.variables is not None:  # each once
            asked = asked.model_copy(update={"variables": list(dict.fromkeys(asked.variables))})
        _check(meant.automaton, asked)
        return self._told(meant, self._telling, number, transferred(meant.automaton, present), asked)

    def _told(
        self, meant: SafeStates, telling: StateSpaceTelling, number: int, state: State, asked: StateSpaceQuestion
    ) -> StateSpaceView:
        automaton = meant.automaton
        space = self._reached(meant, state, asked.variables or (), asked.extent)
        if space is None:
            return StateSpaceView(number=number, obstacle=message("space.too-many"), most=MOST_NODES)
        chosen = asked.variables
        if chosen is None:
            wanted = dict.fromkeys((*about_guards(automaton, meant.supervisor, asked.cut), *ranked(automaton)))
            known = [name for name in wanted if name in space.plant.diagrams.bits]
            chosen = list(suggested(Quotient(space, ()), known))
        quotient = Quotient(space, chosen)
        count = quotient.number_of_nodes()
        nodes = [] if count > MOST_NODES else quotient.folded_nodes(state, asked.cut)
        arrows, left_out = telling.tell_arrows(quotient, nodes)
        path, verdict = (
            telling.planned(state, _until(automaton, asked), quotient, nodes) if asked.plan else (None, None)
        )
        return StateSpaceView(
            number=number,
            obstacle=None,
            unsupervised=meant.why,
            variables=telling.folding_variables(automaton.variables),
            chosen=telling.tell_chosen(quotient, nodes),
            extent=space.extent,
            whole=space.has_all_variables,
            exact=space.exact,
            states=quotient.states,
            count=len(nodes) or count,
            most=MOST_NODES,
            nodes=telling.tell_nodes(nodes),
            arrows=arrows,
            arrows_left_out=left_out,
            path=path,
            verdict=verdict,
        )

    def _reached(self, meant: SafeStates, state: State, chosen: Sequence[str], extent: Extent) -> Reached | None:
        """Return what is reached from the initial states, or also from the state where it is none of these: known from
        before, or found now.
        """
        space = self._known.get(extent)
        if space is None or not set(chosen) <= space.plant.diagrams.bits.keys():
            space = reached_states(meant.automaton, meant.supervisor.safe, chosen, extent)
            if space is None:
                return None
            self._known[extent] = self._known[space.extent] = space
        begun = space.beginning(state)
        if begun is not None:
            return begun
        return reached_states(meant.automaton, meant.supervisor.safe, chosen, extent, state)


def _check(automaton: Automaton, asked: StateSpaceQuestion) -> None:
    """Raises `EditError` where what is asked about is not in the model."""
    if asked.variables is not None and not asked.variables:
        raise EditError(message("space.none-chosen"))
    for name in asked.variables or ():
        if name not in automaton.variables:
            raise EditError(message("step.no-variable", name=name))
    for name in asked.cut:
        if name not in automaton.abilities:
            raise EditError(message("step.no-ability", name=name))


def _until(automaton: Automaton, asked: StateSpaceQuestion) -> Expression | None:
    return None if asked.until is None else read_condition(automaton, asked.until)


def answering(folder: Path) -> Callable[[SpaceQuestion, object], object]:
    """Return what answers questions, in an empty folder; a process's life."""
    service = StateSpaceService(folder)
    return lambda question, _: encoded(service.space_view(question))
