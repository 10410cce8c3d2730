"""What engineers do while they commission a station: forces, and breakpoints."""

from sequence_planner.controller.features.commissioning.breakpoints import Breakpoints
from sequence_planner.controller.features.commissioning.forces import Forces

__all__ = ["Breakpoints", "Forces"]
