"""A command given to the one feature that it is for, as the controller hands it on."""

from __future__ import annotations

from sequence_planner.controller.commands.bus import handlers
from sequence_planner.controller.commands.command import Command
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.data_models import DataModel


def carry_out(feature: object, command: Command, moment: Timestamp) -> DataModel | None:
    made: DataModel | None = handlers((feature,))[type(command)](command, moment)
    return made
