"""What records of the run's journal say of jobs, in the form in which orders need it. `docs/journal.md` says how they
are written.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from sequence_planner.control.happenings import Corrected, ServiceChanged
from sequence_planner.control.vocabulary import JobState
from sequence_planner.history.codec import BEGUN, KINDS, SNAPSHOT, TICKED, kind_of
from sequence_planner.history.line import ALARM
from sequence_planner.journal.run_journal import RunRecord

CORRECTED: Final = kind_of(Corrected)
_SERVICE: Final = kind_of(ServiceChanged)
REPLANNED: Final = "replanned"
GIVEN_UP: Final = "given-up"


@dataclass(frozen=True)
class ReadJob:
    """A job as a record says it is; times are in seconds since the epoch."""

    id: str
    work_master: str
    title: str
    state: JobState
    taken: float
    ended: float | None
    started: Mapping[str, float]
    completed: Mapping[str, float]


@dataclass(frozen=True)
class ReadRecord:
    """A record: `whole` ones say everything of the station, all others what is new.

    `jobs` are those that have changed, None where one is not kept any more; `runs` are the starts that a whole record
    remembers, by ability and when it was started, each with its end.
    """

    number: int
    time: float
    kind: str
    whole: bool
    values: Mapping[str, Any]
    jobs: Mapping[str, ReadJob | None]
    started: tuple[str, ...]
    ended: tuple[str, ...]
    called_off: tuple[str, ...]
    runs: Mapping[tuple[str, float], float | None]
    correction: Mapping[str, Any] | None
    deviations: tuple[tuple[str, Mapping[str, Any]], ...]


def read(record: RunRecord) -> ReadRecord:
    """What a record says."""
    content = json.loads(record.content)
    whole = record.kind in (BEGUN, SNAPSHOT)
    told = content if record.kind == TICKED else {}  # a note, such as that of an alarm, has names of its own
    return ReadRecord(
        number=record.number,
        time=record.time,
        kind=record.kind,
        whole=whole,
        values=_values(content, whole) if whole or record.kind in KINDS else {},
        jobs=_jobs(content) if whole or record.kind in KINDS else {},
        started=tuple(told.get("started", ())),
        ended=tuple(told.get("ended", ())),
        called_off=tuple(told.get("called_off", ())),
        runs=_runs(content) if whole else {},
        correction=content["what"] if record.kind == CORRECTED else None,
        deviations=() if whole else tuple(_deviations(record.kind, content)),
    )


def _values(content: Mapping[str, Any], whole: bool) -> dict[str, Any]:
    if whole:
        return {**content["values"], **content.get("senses", {}).get("measured", {})}
    return {**content.get("all", {}), **content.get("measured", {}), **content.get("changes", {})}


def _jobs(content: Mapping[str, Any]) -> dict[str, ReadJob | None]:
    return {name: None if each is None else _job(each) for name, each in content.get("jobs", {}).items()}


def _job(document: Mapping[str, Any]) -> ReadJob:
    ended = document.get("ended")
    return ReadJob(
        id=document["id"],
        work_master=document["work_master"],
        title=document["title"],
        state=JobState(document.get("state", JobState.WAITING.value)),
        taken=document["taken"]["epoch"],
        ended=None if ended is None else ended["epoch"],
        started={name: at["epoch"] for name, at in document.get("started", {}).items()},
        completed={name: at["epoch"] for name, at in document.get("completed", {}).items()},
    )


def _runs(content: Mapping[str, Any]) -> dict[tuple[str, float], float | None]:
    past = content.get("memory", {}).get("order.past", ())
    return {
        (each["ability"], each["started"]["epoch"]): each["ended"]["epoch"] if each.get("ended") else None
        for each in past
        if each.get("started")
    }


def _deviations(kind: str, content: Mapping[str, Any]) -> list[tuple[str, Mapping[str, Any]]]:
    """What did not go as planned."""
    found: list[tuple[str, Mapping[str, Any]]] = []
    if kind == ALARM:
        found.append((kind, content))
    if kind == _SERVICE:
        found.append((kind, {name: value for name, value in content["what"].items() if name != "now"}))
    if kind == TICKED and (given_up := content.get("given_up")):
        found.append((GIVEN_UP, {"abilities": given_up}))
    if kind in KINDS and (plan := content.get("plan", {})).get("replaced"):
        found.append((REPLANNED, {"reason": plan["reason"]}))
    return found
