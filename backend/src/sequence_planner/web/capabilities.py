"""What the station can do for a MES: its work masters, its equipment and its people, and how many orders it holds."""

from __future__ import annotations

from fastapi import Request
from pydantic import BaseModel

from sequence_planner.control.work_master_view import WorkMasterView
from sequence_planner.identity.roles import Role, Scope
from sequence_planner.mes import orders
from sequence_planner.mes.orders import MOST_OPEN
from sequence_planner.web.access import allowed
from sequence_planner.web.interface import interface
from sequence_planner.web.job_orders import desk_of
from sequence_planner.web.problems import ProblemFound
from sequence_planner.web.request_parts import Identity, LiveView

router = interface("/capabilities", tags=["job orders"], dependencies=[allowed(Role.VIEWER, scope=Scope.ORDERS_READ)])


class EquipmentAnswer(BaseModel):
    """A resource, whether all its topics speak and it is in service."""

    title: str
    online: bool
    in_service: bool
    abilities: list[str]


class HeldAnswer(BaseModel):
    """How many orders that are not over the station holds at most, and holds now."""

    most: int
    now: int


class CapabilitiesAnswer(BaseModel):
    """What may be ordered, and what it is made with.

    `personnel` are the resources whose abilities people carry out, `equipment` all others. Only while `by_order` the
    station works on orders: it is for people there to let it.
    """

    station: str
    title: str
    by_order: bool
    work_masters: dict[str, WorkMasterView]
    equipment: dict[str, EquipmentAnswer]
    personnel: dict[str, EquipmentAnswer]
    job_orders: HeldAnswer


@router.get("")
async def capabilities(request: Request, identity: Identity, view: LiveView) -> CapabilitiesAnswer:
    """What may be ordered, and what it is made with."""
    masters = await desk_of(request).work_masters()
    if masters is None:
        detail = "The station is being prepared, so it is not known yet what it can do. Try again in a moment."
        raise ProblemFound(503, "preparing", "The station is being prepared", detail)
    out = {(each.of, each.name) for each in view.out_of_service}
    human = {each.resource for each in view.abilities.values() if each.human}
    able: dict[str, list[str]] = {name: [] for name in view.resources}
    for name, ability in view.abilities.items():
        able.setdefault(ability.resource, []).append(name)
    resources = {
        name: EquipmentAnswer(
            title=each.title,
            online=each.online,
            in_service=("resource", name) not in out,
            abilities=able[name],
        )
        for name, each in view.resources.items()
    }
    return CapabilitiesAnswer(
        station=view.station.name,
        title=view.station.title,
        by_order=view.by_order,
        work_masters=masters.work_masters,
        equipment={name: each for name, each in resources.items() if name not in human},
        personnel={name: each for name, each in resources.items() if name in human},
        job_orders=HeldAnswer(most=MOST_OPEN, now=await identity.read(orders.count_open)),
    )
