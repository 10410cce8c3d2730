"""Importing this prepares the standard types: for a process that others are forked from, which all use them."""

from __future__ import annotations

from sequence_planner.ros.standard_types import standard_store

standard_store()
