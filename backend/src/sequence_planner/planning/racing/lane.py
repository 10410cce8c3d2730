"""The process of a lane: some engines that take turns, warm from task to task."""

from __future__ import annotations

import contextlib
import os
import resource
from collections.abc import Callable, Iterator, Mapping
from multiprocessing.connection import Connection

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.immutable import Immutable
from sequence_planner.planning.budget import Budget
from sequence_planner.planning.engine import Task
from sequence_planner.planning.engines import Engines, Factory, Lane, Report
from sequence_planner.planning.racing.companion import stand_by


class LaneModel(Immutable):
    """What the process of a lane works with: `memory` is the most it may use for data, in bytes."""

    automaton: Automaton
    supervisor: Supervisor
    lane: Lane
    factories: Mapping[str, Factory]
    memory: int


def work(connection: Connection) -> None:
    """The life of the process."""
    stand_by(connection, _prepared)


def _prepared(model: LaneModel) -> Callable[[Task, Budget], Iterator[Report]]:
    stand_back(model.lane.niceness, model.memory)
    engines = Engines(model.automaton, model.supervisor, model.lane, model.factories)
    engines.prepare()
    return engines.work


def stand_back(niceness: int, memory: int) -> None:
    """Have this process be as nice as that to others, and have no more than so many bytes of data."""
    os.nice(niceness)
    with contextlib.suppress(ValueError, OSError):  # where the system knows no such limit, or has a lower one
        resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))
