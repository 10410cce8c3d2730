"""Answers that are kept, so that a request which is repeated with its `Idempotency-Key` has its effect once.

What is refused changes nothing and is not kept: repeated, it is decided anew.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Final

from pydantic import BaseModel
from sqlalchemy import Connection, delete, insert, select

from sequence_planner.mes.order import OrderRefused
from sequence_planner.mes.tables import JOB_ANSWERS
from sequence_planner.texts.message import message

KEPT: Final = 7 * 86400.0  # seconds


@dataclass(frozen=True)
class KeptAnswer:
    """An answer: its status, its `ETag` and its body."""

    status: int
    tag: str
    content: str


def digest(path: str, body: BaseModel) -> str:
    """Return what tells one request from another: where it was sent to, and what it says in whatever order."""
    said = json.dumps([path, body.model_dump(mode="json")], sort_keys=True)
    return hashlib.sha256(said.encode()).hexdigest()


def recall(connection: Connection, bearer: str, key: str, digest: str) -> KeptAnswer | None:
    """Return what was answered before to the bearer's request with this key; None if there was none.

    Raises `OrderRefused` (`idempotency-key-reused`, 422) when that was another request.
    """
    mine = (JOB_ANSWERS.c.bearer == bearer) & (JOB_ANSWERS.c.key == key)
    row = connection.execute(select(JOB_ANSWERS).where(mine)).first()
    if row is None:
        return None
    if row.digest != digest:
        raise OrderRefused("idempotency-key-reused", message("refused.idempotency-key-reused.other"), 422)
    return KeptAnswer(row.status, row.tag, row.content)


def store_answer(connection: Connection, bearer: str, key: str, digest: str, answer: KeptAnswer, now: float) -> None:
    """Keep an answer in the transaction of its effect; those that are too old go."""
    connection.execute(delete(JOB_ANSWERS).where(JOB_ANSWERS.c.time <= now - KEPT))
    row = {"bearer": bearer, "key": key, "digest": digest, "time": now, **vars(answer)}
    connection.execute(insert(JOB_ANSWERS), row)
