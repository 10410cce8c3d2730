from uuid import UUID

from cyclonedds.core import Entity
from cyclonedds.domain import DomainParticipant
from cyclonedds.dynamic import TypeIdentifier
from cyclonedds.internal import SampleInfo
from cyclonedds.qos import Qos

class BuiltinTopic: ...

BuiltinTopicDcpsPublication: BuiltinTopic
BuiltinTopicDcpsSubscription: BuiltinTopic

# When an endpoint has gone (`sample_info`), only `key` is there.
class DcpsEndpoint:
    key: UUID
    participant_key: UUID
    topic_name: str
    type_name: str
    qos: Qos
    type_id: TypeIdentifier | None
    sample_info: SampleInfo

class BuiltinDataReader(Entity):
    def __init__(self, subscriber_or_participant: DomainParticipant, builtin_topic: BuiltinTopic) -> None: ...
    def take(self, n: int = 1, /) -> list[DcpsEndpoint]: ...
