"""What a person may do about an alarm, after ISA-18.2. None of it changes the alarm's cause."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from sequence_planner.control.command_base import CommandBase
from sequence_planner.journal.entry import LONGEST_REASON

LONGEST_SHELVING = 8 * 3600.0  # seconds


class AlarmCommand(CommandBase):
    """`alarm` is its key in the view."""

    alarm: str = Field(min_length=1, max_length=400)

    @property
    def subject(self) -> str:
        """The alarm."""
        return f"alarm {self.alarm}"


class AcknowledgeAlarm(AlarmCommand):
    """A person has seen the alarm that has been there `since`; refused for one that came later."""

    kind: Literal["acknowledge-alarm"] = "acknowledge-alarm"
    since: float


class ShelveAlarm(AlarmCommand):
    """A person does not want to be told of it for so many seconds."""

    kind: Literal["shelve-alarm"] = "shelve-alarm"
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)
    seconds: float = Field(gt=0, le=LONGEST_SHELVING)


class UnshelveAlarm(AlarmCommand):
    """It is told again."""

    kind: Literal["unshelve-alarm"] = "unshelve-alarm"


class SuppressAlarm(AlarmCommand):
    """An engineer takes the alarm out of service, until it is put back."""

    kind: Literal["suppress-alarm"] = "suppress-alarm"
    reason: str = Field(min_length=1, max_length=LONGEST_REASON)


class RestoreAlarm(AlarmCommand):
    """An alarm that is out of service is told again."""

    kind: Literal["restore-alarm"] = "restore-alarm"
