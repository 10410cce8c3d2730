"""The golden journals: short runs of both stations, each with the model that it was recorded with, and their replay.

A journal is a file of the lines that `journal export` writes, compressed; its models lie beside it under the first
digits of their digests. `make golden-journals` records all of them anew.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Final

from sequence_planner.automaton.automaton import Automaton
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.execution.record.codec import BEGUN, SNAPSHOT
from sequence_planner.execution.record.replay import Player
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise

GOLDEN: Final = Path(__file__).parent
JOURNALS: Final = GOLDEN / "journals"
MODELS: Final = JOURNALS / "models"
MOST_BYTES: Final = 40_000  # of a journal
MOST_BYTES_OF_ALL: Final = 600_000  # with the models
_DIGITS: Final = 12  # of the digest of a model, in the name of its file
_LONG_AGO: Final = (1980, 1, 1, 0, 0, 0)  # so that the same files make the same archive


def names() -> list[str]:
    """The golden journals."""
    return sorted(file.name.removesuffix(".jsonl.gz") for file in JOURNALS.glob("*.jsonl.gz"))


def records(name: str) -> list[RunRecord]:
    """The records of a journal. AssertionError where they are not as they were written."""
    found, before = list[RunRecord](), ""
    for line in gzip.decompress((JOURNALS / f"{name}.jsonl.gz").read_bytes()).decode().splitlines():
        record = RunRecord.parse(line)
        assert record is not None, line[:80]
        before = hashlib.sha256((before + record.text()).encode()).hexdigest()
        assert record.hash == before, f"record {record.number} of {name} is not as it was written"
        found.append(record)
    return found


def write(name: str, run: list[RunRecord]) -> None:
    """Keep a journal."""
    text = "".join(f'{record.text()},"hash":"{record.hash}"}}\n' for record in run)
    (JOURNALS / f"{name}.jsonl.gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))


def keep(digest: str, folder: Path) -> None:
    """Keep a model."""
    with zipfile.ZipFile(_file(digest), "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            archive.writestr(zipfile.ZipInfo(str(file.relative_to(folder)), _LONG_AGO), file.read_bytes(), 8)


@contextmanager
def model(digest: str) -> Iterator[Path]:
    """The folder of a model that was kept."""
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(_file(digest)) as archive:
            archive.extractall(folder)
        yield Path(folder)


def model_of(record: RunRecord) -> str | None:
    """The digest of the model that is named by a record that says everything; None for all others."""
    return json.loads(record.content)["model"] if record.kind in (BEGUN, SNAPSHOT) else None


def replayed(run: list[RunRecord]) -> str | None:
    """The first difference between what was recorded and what comes of it when all is done again, None without one.

    Each life is played with the model that it had.
    """
    player, digest = None, None
    for record in run:
        named = model_of(record)
        if named not in (None, digest):
            player, digest = Player(*_prepared(str(named))), named
        assert player is not None, "the first record says everything"
        if (difference := player.play(record)) is not None:
            return difference
    return None


@cache
def _prepared(digest: str) -> tuple[Automaton, Supervisor]:
    with model(digest) as folder:
        automaton = prepare_station(folder).automaton
    return automaton, synthesise(automaton)


def _file(digest: str) -> Path:
    return MODELS / f"{digest[:_DIGITS]}.zip"
