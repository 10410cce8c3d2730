"""Document schema of `tests/*.yaml`: scenarios by which a station is tested in simulated time."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from pydantic import Field, ModelWrapValidatorHandler, PrivateAttr, model_validator

from sequence_planner.language.types import Place
from sequence_planner.model.fields import DocumentPart, Given, Predicate, Words
from sequence_planner.model.source import SourceText
from sequence_planner.texts.message import message

LONGEST: Final = 3600.0
"""Seconds of simulated time that one step may take."""
PATIENCE: Final = 60.0
"""Seconds in which something is to come about where nothing else is said."""

Seconds = Annotated[float | int, Field(ge=0, le=LONGEST)]
Setting = bool | int | SourceText | None
# What happens, and what is then to be so; one of them is what a step is about.
ACTS: Final = ("fault", "set", "done", "wait")
EXPECTATIONS: Final = ("holds", "starts", "completes")


class ScenarioStepDocument(DocumentPart):
    """One step of a scenario: exactly one thing that happens, or that is to come about."""

    fault: Given[SourceText] = None
    """A fault that a device has from now on, such as `robot silent for 5 s`; `clear` ends all of them, `clear robot`
    those of one.
    """
    sets: Given[Annotated[dict[SourceText, Setting], Field(min_length=1)]] = Field(default=None, alias="set")
    """Measured variables that are brought to values by hand, each with its value."""
    done: Given[SourceText] = None
    """An ability whose task a person has done."""
    wait: Given[Seconds] = None
    """Seconds that pass."""
    holds: Given[Predicate] = None
    """A condition that is to hold, now or `within` some seconds."""
    starts: Given[SourceText | Annotated[list[SourceText], Field(min_length=1)]] = None
    """An ability that is to start, or several one after the other; others may start in between. Without arguments it is
    any of its instances.
    """
    completes: Given[SourceText] = None
    """An operation that is to be completed."""
    within: Given[Seconds] = None
    """Seconds in which it is to come about; without it 60, and 0 is at once."""

    _place: Place = PrivateAttr(default=Place("", 1, 1))

    @model_validator(mode="wrap")
    @classmethod
    def _about_one(
        cls, written: object, handler: ModelWrapValidatorHandler[ScenarioStepDocument]
    ) -> ScenarioStepDocument:
        """About exactly one thing; its place is that of its first key."""
        step = handler(written)
        about = step.kinds
        if len(about) != 1:
            raise ValueError(message("form.scenario-step", kinds=", ".join((*ACTS, *EXPECTATIONS))))
        if step.within is not None and about[0] in ACTS:
            raise ValueError(message("form.within", kinds=", ".join(EXPECTATIONS)))
        if isinstance(written, dict) and isinstance(key := next(iter(written)), SourceText):
            step._place = key.place
        return step

    @property
    def written_at(self) -> Place:
        """Where it is written."""
        return self._place

    @property
    def kinds(self) -> list[str]:
        """The keys that say what it is about."""
        names = {"set": "sets"}
        return [each for each in (*ACTS, *EXPECTATIONS) if getattr(self, names.get(each, each)) is not None]


class ScenarioDocument(DocumentPart):
    """A scenario: from where the station begins, what happens, what is then to come about, and what must never be."""

    title: Given[Words] = None
    """For people; without it the name in plain words."""
    given: dict[SourceText, Setting] = Field(default_factory=dict)
    """Values that variables have at the beginning, `null` for one that is not known; all others have those of the
    initial state.
    """
    people: Literal["act", "wait"] = "act"
    """Whether people do their tasks by themselves, or only where a step says `done`."""
    never: Given[Predicate | Annotated[list[Predicate], Field(min_length=1)]] = None
    """A condition that must not hold at any moment of it, or several."""
    steps: Annotated[list[ScenarioStepDocument], Field(min_length=1)]
    """What happens and what is to come about, one after the other."""
