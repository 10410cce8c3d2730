"""The orders in the database: storing, changing and reading them.

Each change is one transaction: the order, the record of who did it, and the event that tells of it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from datetime import UTC, datetime
from typing import Final

from pydantic import JsonValue
from sqlalchemy import Connection, func, insert, select, update

from sequence_planner.auth.tokens import new_id
from sequence_planner.core.actor import Actor
from sequence_planner.journal.audit import append as append_record
from sequence_planner.journal.entry import Entry
from sequence_planner.mes import events, responses
from sequence_planner.mes.events import EventKind
from sequence_planner.mes.order import (
    AT_ONCE,
    BEFORE_START,
    OVER,
    WISHES,
    JobOrder,
    OrderCommand,
    OrderContent,
    OrderRefused,
    OrderState,
    Wish,
)
from sequence_planner.mes.tables import JOB_BEGIN, JOB_ORDERS, JOB_ORDERS_GONE
from sequence_planner.texts.message import Argument, message

MOST_OPEN: Final = 10_000  # orders that are not over
_LOOKED_BACK: Final = 1000  # orders among which those that were cancelled are looked for
_MOST_NAMED: Final = 500  # in one question to the database

_NUMBERS: Final = (JOB_ORDERS.c.number, JOB_BEGIN.c.orders)  # whichever is highest was given last
_SHOWN = JOB_ORDERS.c.removed.is_(None)
# The states one by one, as the index has them: what is over is left out without being looked at.
_OPEN = JOB_ORDERS.c.state.in_([str(each) for each in OrderState if each not in OVER]) & _SHOWN
_NO_WISH: Final = {"wish": None, "wished_by": None, "wished_because": None}
_GRANTED: Final = {
    Wish.PAUSE: (OrderState.INTERRUPTED, EventKind.INTERRUPTED),
    Wish.RESUME: (OrderState.RUNNING, EventKind.RUNNING),
}
_GIVEN_UP: Final[dict[Wish | None, tuple[OrderState, EventKind]]] = {
    Wish.ABORT: (OrderState.ABORTED, EventKind.ABORTED),
    Wish.STOP: (OrderState.ENDED, EventKind.ENDED),
}
_EVENTS: Final = {
    OrderCommand.START: EventKind.ALLOWED,
    OrderCommand.REVOKE_START: EventKind.REVOKED,
    OrderCommand.ABORT: EventKind.ABORTED,
    OrderCommand.CANCEL: EventKind.CANCELLED,
    OrderCommand.CLEAR: EventKind.CLEARED,
}


def store(
    connection: Connection, content: OrderContent, by: Actor, now: float, *, id: str | None = None, start: bool
) -> JobOrder:
    """A new order, which is allowed to start at once with `start`; without an `id` it is given one.

    Raises `OrderRefused`: `job-order-exists` (409) for an id that was used before, `too-many-job-orders` (409).
    """
    if id is not None and (find(connection, id) is not None or _gone(connection, id) is not None):
        raise OrderRefused("job-order-exists", message("refused.job-order-exists.id", id=id))
    if count_open(connection) >= MOST_OPEN:
        raise OrderRefused("too-many-job-orders", message("refused.too-many-job-orders.most", most=MOST_OPEN))
    number = max(connection.execute(select(func.max(each))).scalar_one() or 0 for each in _NUMBERS)
    state = OrderState.ALLOWED_TO_START if start else OrderState.NOT_ALLOWED_TO_START
    id = id or new_id()
    row = {
        **content.model_dump(),
        "number": number + 1,
        "id": id,
        "state": state.value,
        "revision": 1,
        "stored": now,
        "stored_by": by.name,
        "changed": now,
    }
    connection.execute(insert(JOB_ORDERS), row)
    told = {**content.model_dump(mode="json"), "state": state.value}
    _record(connection, by, "job-order-stored", id, now, told)
    events.append(connection, EventKind.STORED, id, now, told)
    return get(connection, id)


def change(
    connection: Connection, id: str, revision: int | None, content: OrderContent, by: Actor, now: float
) -> JobOrder:
    """Let an order be of another content, before the station works on it; None is whatever revision it has.

    Raises `OrderRefused`: `no-job-order` (404), `job-order-changed` (412) when by now it has another revision,
    `job-order-started` (409).
    """
    order = get(connection, id)
    if revision is not None and order.revision != revision:
        raise OrderRefused(
            "job-order-changed", message("refused.job-order-changed.revision", revision=order.revision), 412
        )
    if order.state not in BEFORE_START or order.handed_over is not None:
        state = order.state.value
        raise OrderRefused(
            "job-order-started", message("refused.job-order-started.state", state=message(f"order-state.{state}"))
        )
    told = content.model_dump(mode="json")
    changed = _set(connection, order, now, content.model_dump())
    _record(connection, by, "job-order-updated", id, now, told)
    events.append(connection, EventKind.UPDATED, id, now, {**told, "state": order.state.value})
    return changed


def command(
    connection: Connection, id: str, given: OrderCommand, by: Actor, reason: str | None, now: float
) -> JobOrder:
    """Do what is asked of an order; what the station has to do is noted as its wish.

    Raises `OrderRefused`: `no-job-order` (404), and `command-not-allowed` (409) with those that are.
    """
    order = get(connection, id)
    if given not in order.allowed:
        able = [message(f"order-command.{each}") for each in order.allowed or ("none",)]
        said: dict[str, Argument] = {"state": message(f"order-state.{order.state}"), "allowed": able}
        if order.wish is None:
            detail = message("refused.command-not-allowed.allows", **said)
        else:
            detail = message("refused.command-not-allowed.allows-wish", wish=message(f"wish.{order.wish}"), **said)
        raise OrderRefused("command-not-allowed", detail, allowed=order.allowed)
    _record(connection, by, f"job-order-{_dashed(given)}", id, now, {"state": order.state.value}, reason)
    if order.is_at_station:
        wished = {"wish": WISHES[given].value, "wished_by": by.model_dump_json(), "wished_because": reason}
        return _set(connection, order, now, wished)
    if given in (OrderCommand.CANCEL, OrderCommand.CLEAR):
        why = {"wished_because": reason} if given is OrderCommand.CANCEL else {}
        changed = _set(connection, order, now, {"removed": now, **why})
        responses.remove(connection, id, now)
    else:
        state = AT_ONCE[given]
        changed = _set(connection, order, now, {"state": state.value, "ended": now if state in OVER else None})
    told: dict[str, JsonValue] = {"state": changed.state.value, "by": by.name, "reason": reason}
    if changed.is_over and not order.is_over:
        told["response"] = responses.write(connection, responses.nothing_made(changed, reason), now)
    events.append(connection, _EVENTS[given], id, now, told)
    return changed


def hand_over(connection: Connection, order: JobOrder, now: float) -> JobOrder | None:
    """Note that the station is about to be given an order; None if by now that may not start any more."""
    current = find(connection, order.id)
    if current is None or current.state is not OrderState.ALLOWED_TO_START or current.removed is not None:
        return None
    return current if current.handed_over is not None else _set(connection, current, now, {"handed_over": now})


def take_back(connection: Connection, order: JobOrder, now: float) -> JobOrder | None:
    """The station has no job of an order: that waits again, or is over if that was wished for meanwhile."""
    current = find(connection, order.id)
    if current is None or not current.is_at_station:
        return None
    if (found := _GIVEN_UP.get(current.wish)) is None:
        waits = current.state is OrderState.ALLOWED_TO_START
        return _set(connection, current, now, {"handed_over": None}) if waits else None
    state, kind = found
    over = {**_NO_WISH, "handed_over": None, "state": state.value, "ended": now}
    changed = _set(connection, current, now, over)
    made = responses.nothing_made(changed, current.wished_because)
    told: dict[str, JsonValue] = {
        "state": state.value,
        "reason": current.wished_because,
        "response": responses.write(connection, made, now),
    }
    if current.began is not None:
        told["outcome"] = made.outcome.value
    events.append(connection, kind, current.id, now, told)
    return changed


def granted(connection: Connection, order: JobOrder, now: float) -> JobOrder | None:
    """The station has paused or resumed an order, as was wished for; None if by now that is wished for no more."""
    current = find(connection, order.id)
    if current is None or current.is_over or current.wish is None or current.wish is not order.wish:
        return None
    state, kind = _GRANTED[current.wish]
    # Why it is paused is asked for as long as it is.
    because = current.wished_because if state is OrderState.INTERRUPTED else None
    changed = _set(connection, current, now, {**_NO_WISH, "wished_because": because, "state": state.value})
    told: dict[str, JsonValue] = {"state": state.value, "reason": current.wished_because}
    events.append(connection, kind, order.id, now, told)
    return changed


def refused(connection: Connection, order: JobOrder, now: float) -> None:
    """The station does not do what was wished for."""
    current = find(connection, order.id)
    if current is not None and not current.is_over and current.wish is order.wish:
        _set(connection, current, now, _NO_WISH)


def become(
    connection: Connection, order: JobOrder, state: OrderState, now: float, values: Mapping[str, object]
) -> JobOrder:
    """Note what has become of an order, without an event."""
    return _set(connection, order, now, {"state": state.value, **values})


def get(connection: Connection, id: str) -> JobOrder:
    """The order with this id. Raises `OrderRefused` (`no-job-order`, 404; `job-order-gone`, 410)."""
    order = find(connection, id)
    if order is None:
        require_kept(connection, id)
    if order is None or order.removed is not None:
        raise OrderRefused("no-job-order", message("refused.no-job-order.id"), 404)
    return order


def require_kept(connection: Connection, id: str) -> None:
    """Raises `OrderRefused` (`job-order-gone`, 410) for an order that was over long ago."""
    if (ended := _gone(connection, id)) is not None:
        raise OrderRefused(
            "job-order-gone",
            message("refused.job-order-gone.ended", time=f"{datetime.fromtimestamp(ended, UTC):%Y-%m-%d %H:%M:%S UTC}"),
            410,
        )


def page(connection: Connection, state: OrderState | None, after: int, limit: int) -> list[JobOrder]:
    """Up to `limit` orders with numbers above `after`, as they were stored; only those in a state, if one is named."""
    chosen = select(JOB_ORDERS).where(_SHOWN, JOB_ORDERS.c.number > after).order_by(JOB_ORDERS.c.number).limit(limit)
    if state is not None:
        chosen = chosen.where(JOB_ORDERS.c.state == state.value)
    return [JobOrder.from_row(row) for row in connection.execute(chosen).mappings()]


def cancelled(connection: Connection, limit: int) -> list[JobOrder]:
    """Up to `limit` orders that were cancelled, those first that were stored last; of the last ones that are kept."""
    newest = connection.execute(select(func.max(JOB_ORDERS.c.number))).scalar_one() or 0
    before_start = JOB_ORDERS.c.state.in_([str(each) for each in BEFORE_START])
    chosen = select(JOB_ORDERS).where(JOB_ORDERS.c.number > newest - _LOOKED_BACK, ~_SHOWN, before_start)
    ordered = chosen.order_by(JOB_ORDERS.c.number.desc()).limit(limit)
    return [JobOrder.from_row(row) for row in connection.execute(ordered).mappings()]


def open_orders(connection: Connection, known: Sequence[JobOrder] = ()) -> list[JobOrder]:
    """All orders that are not over, as they were stored. Of those `known` only what has changed since is read."""
    revisions = select(JOB_ORDERS.c.number, JOB_ORDERS.c.revision).where(_OPEN).order_by(JOB_ORDERS.c.number)
    numbers: dict[int, int] = {row.number: row.revision for row in connection.execute(revisions)}
    found = {each.number: each for each in known if numbers.get(each.number) == each.revision}
    changed = [number for number in numbers if number not in found]
    for start in range(0, len(changed), _MOST_NAMED):
        named = JOB_ORDERS.c.number.in_(changed[start : start + _MOST_NAMED])
        chosen = select(JOB_ORDERS).where(_OPEN, named)
        found |= {row["number"]: JobOrder.from_row(row) for row in connection.execute(chosen).mappings()}
    return [found[number] for number in numbers if number in found]


def those_over(connection: Connection, ids: Collection[str]) -> set[str]:
    """Of these orders, those that are over, or were cancelled: the station is to do nothing more for them."""
    over = JOB_ORDERS.c.state.in_([str(each) for each in OVER]) | JOB_ORDERS.c.removed.is_not(None)
    return set(connection.execute(select(JOB_ORDERS.c.id).where(JOB_ORDERS.c.id.in_(ids), over)).scalars())


def count_open(connection: Connection) -> int:
    """Count the orders that are not over."""
    found: int = connection.execute(select(func.count()).select_from(JOB_ORDERS).where(_OPEN)).scalar_one()
    return found


def find(connection: Connection, id: str) -> JobOrder | None:
    """The order with this id, be it removed or not; None if there never was one."""
    row = connection.execute(select(JOB_ORDERS).where(JOB_ORDERS.c.id == id)).mappings().first()
    return None if row is None else JobOrder.from_row(row)


def due_times(connection: Connection, ids: Collection[str]) -> list[float]:
    """Return when those of these orders were due that are to be done by some time, be they removed or not."""
    known = select(JOB_ORDERS.c.due).where(JOB_ORDERS.c.id.in_(ids), JOB_ORDERS.c.due.is_not(None))
    return [*connection.execute(known).scalars()]


def _gone(connection: Connection, id: str) -> float | None:
    """Return when an order was over that is kept no more; None where there is none of this id."""
    return connection.execute(select(JOB_ORDERS_GONE.c.ended).where(JOB_ORDERS_GONE.c.id == id)).scalar_one_or_none()


def _set(connection: Connection, order: JobOrder, now: float, values: Mapping[str, object]) -> JobOrder:
    changed = {**values, "revision": order.revision + 1, "changed": now}
    connection.execute(update(JOB_ORDERS).where(JOB_ORDERS.c.id == order.id).values(changed))
    found = find(connection, order.id)
    assert found is not None
    return found


def _dashed(given: OrderCommand) -> str:
    return "".join(f"-{letter.lower()}" if letter.isupper() else letter for letter in given.value).lstrip("-")


def _record(
    connection: Connection,
    by: Actor,
    action: str,
    id: str,
    now: float,
    details: Mapping[str, JsonValue],
    reason: str | None = None,
) -> None:
    entry = Entry(actor=by, action=action, subject=f"job order {id}", details=dict(details), reason=reason)
    append_record(connection, entry, now)
