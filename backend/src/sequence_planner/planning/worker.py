"""The planner in a process of its own: requests in, answers out, over a pipe. It can be killed at any time."""

from __future__ import annotations

import signal
import traceback
from enum import Enum, auto
from multiprocessing.connection import Connection

from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.lifeline import end_without_parent
from sequence_planner.planning.plan import Answer, Request, WayBackRequest
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.way_back import WaysBack


class Ready(Enum):
    """The first word of a planner's process: from now on it answers."""

    READY = auto()


# What comes from the process; a text says why there is no answer.
Word = Ready | Answer | str


def work(connection: Connection) -> None:
    """Hear of an automaton and its supervisor, then answer each request, until the other end is closed.

    Where there is no answer, the text of an error says why. After an error that nobody thought of, the process ends:
    what it has learnt could be wrong.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever started this process ends it
    end_without_parent()
    try:
        model: tuple[Automaton, Supervisor] = connection.recv()
        automaton, supervisor = model
        planner, ways = Planner(automaton, supervisor), WaysBack(automaton, supervisor.safe)
        connection.send(Ready.READY)
        while True:
            request: Request = connection.recv()
            try:
                word: Word = ways.answer(request) if isinstance(request, WayBackRequest) else planner.answer(request)
            except PlannerError as error:
                word = str(error)
            except Exception as error:
                traceback.print_exc()
                connection.send(f"the planner failed ({type(error).__name__}: {error})")
                return
            connection.send(word)
    except (EOFError, ConnectionError):
        return  # whoever asked is gone
