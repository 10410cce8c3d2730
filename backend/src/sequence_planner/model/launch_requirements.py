"""The way a station is run, as far as a model has to fit that."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class StartNeeds:
    """The needs of a start: whether its devices are to be emulated, and whether there is a rosbridge server for topics
    of ROS 1.
    """

    emulated: bool = False
    rosbridge: bool = True
