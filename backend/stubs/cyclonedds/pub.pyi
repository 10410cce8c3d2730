from typing import Generic, TypeVar

from cyclonedds.core import Entity
from cyclonedds.domain import DomainParticipant
from cyclonedds.qos import Qos
from cyclonedds.topic import Topic

_S = TypeVar("_S")

class DataWriter(Entity, Generic[_S]):
    def __init__(
        self, publisher_or_participant: DomainParticipant, topic: Topic[_S], qos: Qos | None = None
    ) -> None: ...
    def write(self, sample: _S, timestamp: int | None = None) -> None: ...
