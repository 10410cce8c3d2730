from typing import Generic, TypeVar

from cyclonedds.core import Entity
from cyclonedds.domain import DomainParticipant
from cyclonedds.qos import Qos

_S = TypeVar("_S")

class Topic(Entity, Generic[_S]):
    def __init__(
        self, domain_participant: DomainParticipant, topic_name: str, data_type: type[_S], qos: Qos | None = None
    ) -> None: ...
