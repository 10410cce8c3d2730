"""A process that is killed while it writes what happens, at points drawn by seed, while another process reads."""

from __future__ import annotations

import random
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from os import kill
from signal import SIGKILL

from journal.happened import content
from sequence_planner.db.database import Database
from sequence_planner.journal import run_journal
from sequence_planner.journal.hash_chain import START, broken_at
from support.examples import rounds

SEED = 8
POINTS = rounds(40, 10)

# One process imports the program, and one after the other of its children writes: it would be slow to begin otherwise.
WRITE_UNTIL_KILLED = """
import asyncio, os, sys, time
from journal.happened import content
from sequence_planner.journal.writer import RunWriter
from sequence_planner.db.database import Database

async def write():
    writer = RunWriter(Database.open(sys.argv[1]), lambda: print("durable", writer.durable, flush=True))
    writer.start()
    print("child", os.getpid(), flush=True)
    number = writer.durable
    while True:
        number += 1
        assert writer.write("ticked", float(number), content(number)) == number
        if number % 3 == 0:
            await asyncio.sleep(0.001)

for line in sys.stdin:
    if os.fork() == 0:
        asyncio.run(write())
    os.wait()
    print("killed", flush=True)
"""


@dataclass
class _Reader:
    """Reads what is written behind what it has read before, and keeps that."""

    database: Database
    records: list[run_journal.RunRecord] = field(default_factory=list)

    def look(self) -> None:
        with self.database.reading() as connection:
            while page := run_journal.after(connection, len(self.records), 1000):
                self.records += page


@contextmanager
def _reading(reader: _Reader) -> Iterator[None]:
    ended = threading.Event()

    def read() -> None:
        while not ended.wait(0.003):
            reader.look()

    thread = threading.Thread(target=read)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def test_no_acknowledged_record_is_lost_and_what_was_read_stays(database: Database, database_url: str) -> None:
    draw = random.Random(SEED)
    reader = _Reader(database)
    acknowledged = 0
    with subprocess.Popen(
        [sys.executable, "-c", WRITE_UNTIL_KILLED, database_url],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={"PYTHONPATH": ":".join(sys.path)},
    ) as program:
        assert program.stdin is not None
        assert program.stdout is not None
        with _reading(reader):
            for _ in range(POINTS):
                program.stdin.write("go\n")
                program.stdin.flush()
                child = int(program.stdout.readline().removeprefix("child "))
                for _ in range(draw.randint(0, 8)):
                    acknowledged = int(program.stdout.readline().removeprefix("durable "))
                time.sleep(draw.uniform(0, 0.02))
                kill(child, SIGKILL)
                while (said := program.stdout.readline()) != "killed\n":
                    acknowledged = max(acknowledged, int(said.removeprefix("durable ")))
                with database.reading() as connection:
                    end = run_journal.end(connection)
                    assert end is not None
                    assert end.number >= acknowledged
        program.stdin.close()
    assert acknowledged > 20 * POINTS
    reader.look()
    with database.reading() as connection:
        assert run_journal.broken_at(connection) is None
        assert broken_at(reader.records, START, run_journal.end(connection)) is None
    assert [record.content for record in reader.records] == [content(each + 1) for each in range(len(reader.records))]
