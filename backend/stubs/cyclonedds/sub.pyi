from typing import Generic, TypeVar

from cyclonedds.core import Entity
from cyclonedds.domain import DomainParticipant
from cyclonedds.internal import InvalidSample
from cyclonedds.qos import Qos
from cyclonedds.topic import Topic

_S = TypeVar("_S")

class DataReader(Entity, Generic[_S]):
    def __init__(
        self, subscriber_or_participant: DomainParticipant, topic: Topic[_S], qos: Qos | None = None
    ) -> None: ...
    def take(self, n: int = 1, /) -> list[_S | InvalidSample]: ...
