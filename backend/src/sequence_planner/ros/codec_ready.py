"""Importing this imports what bytes of messages take: for a process that others are forked from, which have some."""

from __future__ import annotations

import numpy  # noqa: F401 - what only reads a model has no use for it, see `values`

from sequence_planner.ros.standard_types import standard_store

standard_store()
