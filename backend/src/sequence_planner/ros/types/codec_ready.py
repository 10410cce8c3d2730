"""Importing this imports what bytes of messages take: for a process that others are forked from, which have some."""

from __future__ import annotations

from sequence_planner.ros.types.standard_types import standard_store

standard_store()
