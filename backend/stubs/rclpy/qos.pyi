from enum import IntEnum

from rclpy.duration import Duration

class HistoryPolicy(IntEnum):
    KEEP_LAST = 1

class ReliabilityPolicy(IntEnum):
    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2

class DurabilityPolicy(IntEnum):
    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2

class LivelinessPolicy(IntEnum):
    AUTOMATIC = 1

def qos_policy_name_from_kind(policy_kind: int) -> str: ...

class QoSProfile:
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    deadline: Duration
    liveliness: LivelinessPolicy
    liveliness_lease_duration: Duration
    def __init__(
        self,
        *,
        history: HistoryPolicy,
        depth: int,
        reliability: ReliabilityPolicy,
        durability: DurabilityPolicy,
    ) -> None: ...
