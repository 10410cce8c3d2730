from enum import IntEnum

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

class QoSProfile:
    reliability: ReliabilityPolicy
    durability: DurabilityPolicy
    def __init__(
        self,
        *,
        history: HistoryPolicy,
        depth: int,
        reliability: ReliabilityPolicy,
        durability: DurabilityPolicy,
    ) -> None: ...
