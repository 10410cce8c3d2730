"""What a person may ask of a station that is not as it should be: corrections, decisions, ways back, and forces."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, StrictBool, StrictInt, StrictStr

from sequence_planner.control.command_base import CommandBase
from sequence_planner.journal.entry import LONGEST_REASON

GivenValue = StrictBool | StrictInt | StrictStr
GivenValues = Annotated[dict[str, GivenValue], Field(min_length=1, max_length=200)]
Why = Annotated[str, Field(min_length=1, max_length=LONGEST_REASON)]


class CorrectEstimates(CommandBase):
    """Estimated variables get other values, all at once; refused if the state is not at `revision` any more."""

    kind: Literal["correct-estimates"] = "correct-estimates"
    for_control: ClassVar[bool] = True
    reason: Why
    values: GivenValues
    revision: int

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class UndoCorrection(CommandBase):
    """The last correction, made on `revision`, is taken back, as long as its variables have the values that it gave."""

    kind: Literal["undo-correction"] = "undo-correction"
    for_control: ClassVar[bool] = True
    reason: Why
    revision: int


class ConfirmEstimates(CommandBase):
    """A person has seen that these estimated variables are as the station believes."""

    kind: Literal["confirm-estimates"] = "confirm-estimates"
    values: GivenValues  # as they were seen; refused if one is another by now
    reason: Why

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class DecideOutputs(CommandBase):
    """Outputs that came back from the journal, and would move devices, shall have these values."""

    kind: Literal["decide-outputs"] = "decide-outputs"
    for_control: ClassVar[bool] = True
    reason: Why
    values: GivenValues

    @property
    def subject(self) -> str:
        """The variables."""
        return ", ".join(sorted(self.values))


class TakeErrand(CommandBase):
    """Carry out a plan that was offered, and nothing else; refused if the state has moved since.

    `starts` and `corrections` repeat what the person was shown, as the second confirmation of it.
    """

    kind: Literal["take-errand"] = "take-errand"
    for_control: ClassVar[bool] = True
    reason: Why
    offer: str
    starts: list[str] = Field(max_length=1000)
    corrections: dict[str, GivenValue] = Field(default_factory=dict, max_length=200)

    @property
    def subject(self) -> str:
        """The offer."""
        return f"offer {self.offer}"


class TryAbility(CommandBase):
    """One run of an ability alone. `real_devices` confirms that devices may move which are not emulated ones."""

    kind: Literal["try-ability"] = "try-ability"
    for_control: ClassVar[bool] = True
    ability: str = Field(max_length=400)
    real_devices: bool = False

    @property
    def subject(self) -> str:
        """The ability."""
        return self.ability


class StopErrand(CommandBase):
    """What is carried out is started no further; what is only tried is called off."""

    kind: Literal["stop-errand"] = "stop-errand"

    @property
    def harmless(self) -> bool:
        """It only ends starts."""
        return True


class ForceVariable(CommandBase):
    """A measured variable or an output has this value, whatever its device or an ability says, for so many seconds."""

    kind: Literal["force-variable"] = "force-variable"
    for_control: ClassVar[bool] = True
    reason: Why
    name: str
    value: GivenValue
    seconds: float = Field(gt=0, le=3600)

    @property
    def subject(self) -> str:
        """The variable."""
        return self.name


class ReleaseForce(CommandBase):
    """A forced variable is as it comes again."""

    kind: Literal["release-force"] = "release-force"
    for_control: ClassVar[bool] = True
    name: str

    @property
    def subject(self) -> str:
        """The variable."""
        return self.name
