from cyclonedds.core import Entity
from cyclonedds.qos import Qos

class Domain(Entity):
    def __init__(self, domain_id: int, config: str | None = None) -> None: ...

class DomainParticipant(Entity):
    def __init__(self, domain_id: int = ..., qos: Qos | None = None) -> None: ...
