from collections.abc import Callable

class QoSOfferedDeadlineMissedInfo:
    total_count: int

class QoSRequestedDeadlineMissedInfo:
    total_count: int

class QoSLivelinessLostInfo:
    total_count: int

class QoSLivelinessChangedInfo:
    not_alive_count: int
    not_alive_count_change: int

class QoSOfferedIncompatibleQoSInfo:
    total_count: int
    last_policy_kind: int

class QoSRequestedIncompatibleQoSInfo:
    total_count: int
    last_policy_kind: int

class PublisherEventCallbacks:
    def __init__(
        self,
        *,
        deadline: Callable[[QoSOfferedDeadlineMissedInfo], None] | None = None,
        incompatible_qos: Callable[[QoSOfferedIncompatibleQoSInfo], None] | None = None,
        liveliness: Callable[[QoSLivelinessLostInfo], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None: ...

class SubscriptionEventCallbacks:
    def __init__(
        self,
        *,
        deadline: Callable[[QoSRequestedDeadlineMissedInfo], None] | None = None,
        incompatible_qos: Callable[[QoSRequestedIncompatibleQoSInfo], None] | None = None,
        liveliness: Callable[[QoSLivelinessChangedInfo], None] | None = None,
        use_default_callbacks: bool = True,
    ) -> None: ...
