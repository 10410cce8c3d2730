"""The meaning of scenarios: their names and conditions looked up in the automaton."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.automaton.automaton import Automaton, Kind
from sequence_planner.automaton.findings import Findings, without_arguments
from sequence_planner.core.immutable import Immutable
from sequence_planner.language.names.suggestions import suggestion
from sequence_planner.language.syntax import Expression, ExpressionError
from sequence_planner.language.types import Place, Value, contains
from sequence_planner.model.fields import main_text
from sequence_planner.model.loader import Station
from sequence_planner.model.paths import EditError
from sequence_planner.model.scenarios.documents import (
    EXPECTATIONS,
    PATIENCE,
    ScenarioDocument,
    ScenarioStepDocument,
    Setting,
)
from sequence_planner.model.source import Finding, SourceText
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.simulation.faults import FaultReader
from sequence_planner.texts.message import message
from sequence_planner.texts.names import in_words


class ScenarioCondition(Immutable):
    """A condition as it is written, where, and what it means."""

    text: str
    place: Place
    meaning: Expression


class ScenarioStep(Immutable):
    """One step: an act that happens, or with `within` what is to come about in so many seconds of simulated time.

    `done` and each of `starts` are the ground abilities that are meant.
    """

    place: Place
    fault: str | None = None
    sets: Mapping[str, Value] = {}
    done: frozenset[str] = frozenset()
    wait: float = 0.0
    holds: ScenarioCondition | None = None
    starts: tuple[tuple[str, frozenset[str]], ...] = ()
    completes: str | None = None
    within: float | None = None


class Scenario(Immutable):
    """A scenario that can be carried out."""

    name: str
    title: str
    place: Place
    given: Mapping[str, Value | None]
    people_wait: bool
    never: tuple[ScenarioCondition, ...]
    steps: tuple[ScenarioStep, ...]


def scenarios_of(
    automaton: Automaton, station: Station, pipelines: StationPipelines
) -> tuple[list[Scenario], list[Finding]]:
    """All scenarios of a station that can be carried out, and what is wrong with the others."""
    reader = _ScenarioReader(automaton, pipelines)
    found = [reader.scenario(name, document) for name, document in station.scenarios.items()]
    wrong = sorted({*station.unreadable_scenarios, *reader.findings.all})
    return [each for each in found if each is not None], wrong


def named_scenario(scenarios: Iterable[Scenario], name: str) -> Scenario:
    """Return the scenario of this name. Raises `EditError` where there is none that can be carried out."""
    known = {each.name: each for each in scenarios}
    if name not in known:
        raise EditError(message("scenario.no-scenario", name=name, hint=suggestion(name, known)))
    return known[name]


def unusable_scenarios_of(automaton: Automaton, station: Station, pipelines: StationPipelines) -> list[Finding]:
    """What is wrong with the scenarios of a station."""
    if not station.scenarios and not station.unreadable_scenarios:
        return []
    return scenarios_of(automaton, station, pipelines)[1]


class _ScenarioReader:
    def __init__(self, automaton: Automaton, pipelines: StationPipelines) -> None:
        self.findings = Findings()
        self._automaton = automaton
        self._fed = frozenset(pipelines.feeds)
        self._faults = FaultReader(automaton, pipelines, lambda resource: True)

    def scenario(self, name: SourceText, document: ScenarioDocument) -> Scenario | None:
        """Return the scenario, or None where something is wrong with it."""
        before = len(self.findings.all)
        never = document.never if isinstance(document.never, list) else [document.never]
        scenario = Scenario(
            str(name),
            main_text(document.title) or in_words(str(name)),
            name.place,
            {str(each): self._given(each, value) for each, value in document.given.items()},
            document.people == "wait",
            tuple(self._condition(each, name) for each in never if each is not None),
            tuple(self._step(each, name, document.people == "wait") for each in document.steps),
        )
        return scenario if len(self.findings.all) == before else None

    def _step(self, written: ScenarioStepDocument, name: SourceText, people_wait: bool) -> ScenarioStep:
        (kind,) = written.kinds
        starts = written.starts if isinstance(written.starts, list) else [written.starts]
        named = [each for each in starts if each is not None]
        if written.fault is not None:
            self._fault(written.fault)
        if written.done is not None and not people_wait:
            self.findings.add(written.done, message("wrong.people-act"))
        return ScenarioStep(
            written.written_at,
            None if written.fault is None else str(written.fault),
            {str(each): self._by_hand(each, value) for each, value in (written.sets or {}).items()},
            frozenset() if written.done is None else self._task(written.done),
            float(written.wait or 0),
            None if written.holds is None else self._condition(written.holds, name),
            tuple((str(each), self._abilities(each)) for each in named),
            None if written.completes is None else self._operation(written.completes),
            None if kind not in EXPECTATIONS else PATIENCE if written.within is None else float(written.within),
        )

    def _condition(self, written: SourceText | bool, name: SourceText) -> ScenarioCondition:
        text = written if isinstance(written, SourceText) else SourceText(str(written).lower(), name.place, "")
        try:
            meaning = self._automaton.read_condition(text)
        except ExpressionError as error:
            self.findings.add_within(text, error.span, error.message)
            meaning = self._automaton.read_condition("true")
        return ScenarioCondition(str(text), text.place, meaning)

    def _fault(self, text: SourceText) -> None:
        try:
            self._faults.read(text)
        except ExpressionError as error:
            self.findings.add_within(text, error.span, error.message)

    def _given(self, name: SourceText, written: Setting) -> Value | None:
        declared = self._automaton.variables.get(name)
        if declared is None:
            hint = suggestion(name, self._automaton.variables)
            self.findings.add(name, message("wrong.no-variable-given", name=str(name), hint=hint))
            return None
        if written is None:
            if declared.kind is not Kind.MEASURED:
                self.findings.add(name, message("wrong.always-known", name=str(name)))
            return None
        return self._value(name, written)

    def _by_hand(self, name: SourceText, written: Setting) -> Value:
        declared = self._automaton.variables.get(name)
        if declared is None:
            hint = suggestion(name, self._fed)
            self.findings.add(name, message("wrong.no-variable-given", name=str(name), hint=hint))
        elif str(name) not in self._fed:
            self.findings.add(name, message("wrong.not-by-device", name=str(name)))
        else:
            return self._value(name, written)
        return False

    def _value(self, name: SourceText, written: Setting) -> Value:
        type_ = self._automaton.variables[name].type
        value = str(written) if isinstance(written, str) else written
        if value is None or not contains(type_, value):
            hint = suggestion(str(value), map(str, type_.domain)) if isinstance(value, str) else ""
            shown = "null" if value is None else str(value).lower() if isinstance(value, bool) else str(value)
            said = message("wrong.value-given", value=shown, name=str(name), range=str(type_), hint=hint)
            self.findings.add(written if isinstance(written, SourceText) else name, said)
            return False
        return value

    def _abilities(self, text: SourceText) -> frozenset[str]:
        found = _meant(text, self._automaton.abilities)
        if not found and _meant(text, self._automaton.operations):
            self.findings.add(text, message("wrong.no-ability-named.operation", name=str(text)))
        elif not found:
            known = {*self._automaton.abilities, *map(without_arguments, self._automaton.abilities)}
            hint = suggestion(text, known)
            self.findings.add(text, message("wrong.no-ability-named", name=str(text), hint=hint))
        return found

    def _task(self, text: SourceText) -> frozenset[str]:
        found = self._abilities(text)
        if found and not any(self._automaton.abilities[each].human for each in found):
            self.findings.add(text, message("wrong.no-task", name=str(text)))
        return found

    def _operation(self, text: SourceText) -> str:
        if _meant(text, self._automaton.abilities):
            self.findings.add(text, message("wrong.no-operation-named.ability", name=str(text)))
        elif str(text) not in self._automaton.operations:
            hint = suggestion(text, self._automaton.operations)
            self.findings.add(text, message("wrong.no-operation-named", name=str(text), hint=hint))
        return str(text)


def _meant(text: str, names: Iterable[str]) -> frozenset[str]:
    """Return those that a name means: itself, or without arguments all instances."""
    return frozenset(each for each in names if text in (each, without_arguments(each)))
