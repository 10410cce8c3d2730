from typing import Any
from uuid import UUID

from cyclonedds.domain import DomainParticipant
from cyclonedds.qos import Qos
from cyclonedds.sub import DataReader

class DDSException(Exception):
    code: int
    msg: str

class Entity:
    @property
    def guid(self) -> UUID: ...
    def set_status_mask(self, mask: int) -> None: ...
    def get_qos(self) -> Qos: ...
    def set_qos(self, qos: Qos) -> None: ...
    def __del__(self) -> None: ...

class DDSStatus:
    OfferedDeadlineMissed: int
    RequestedDeadlineMissed: int
    OfferedIncompatibleQos: int
    RequestedIncompatibleQos: int
    LivelinessLost: int
    LivelinessChanged: int

class SampleState:
    Read: int
    NotRead: int
    Any: int

class ViewState:
    New: int
    Old: int
    Any: int

class InstanceState:
    Alive: int
    NotAliveDisposed: int
    NotAliveNoWriters: int
    Any: int

class ReadCondition(Entity):
    def __init__(self, reader: DataReader[Any], mask: int) -> None: ...

class GuardCondition(Entity):
    def __init__(self, domain_participant: DomainParticipant) -> None: ...
    def set(self, triggered: bool) -> None: ...
    def take(self) -> bool: ...

class WaitSet(Entity):
    def __init__(self, domain_participant: DomainParticipant) -> None: ...
    def attach(self, entity: Entity) -> None: ...
    def detach(self, entity: Entity) -> None: ...
    def wait(self, timeout: int) -> int: ...
