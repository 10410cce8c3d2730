# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from collections.abc import Callable
from typing import Any

class PublisherEventCallbacks:
    def __init__(
        self,
        *,
        deadline: Callable[[Any], None] | None = ...,
        liveliness: Callable[[Any], None] | None = ...,
        incompatible_qos: Callable[[Any], None] | None = ...,
        incompatible_type: Callable[[Any], None] | None = ...,
        matched: Callable[[Any], None] | None = ...,
        use_default_callbacks: bool = ...,
    ) -> None: ...

class SubscriptionEventCallbacks:
    def __init__(
        self,
        *,
        deadline: Callable[[Any], None] | None = ...,
        incompatible_qos: Callable[[Any], None] | None = ...,
        liveliness: Callable[[Any], None] | None = ...,
        message_lost: Callable[[Any], None] | None = ...,
        incompatible_type: Callable[[Any], None] | None = ...,
        matched: Callable[[Any], None] | None = ...,
        use_default_callbacks: bool = ...,
    ) -> None: ...

class QoSLivelinessChangedInfo:
    alive_count: int
    alive_count_change: int
    not_alive_count: int
    not_alive_count_change: int

class QoSLivelinessLostInfo:
    total_count: int
    total_count_change: int

class QoSOfferedDeadlineMissedInfo:
    total_count: int
    total_count_change: int

class QoSOfferedIncompatibleQoSInfo:
    last_policy_kind: int
    total_count: int
    total_count_change: int

class QoSRequestedDeadlineMissedInfo:
    total_count: int
    total_count_change: int

class QoSRequestedIncompatibleQoSInfo:
    last_policy_kind: int
    total_count: int
    total_count_change: int
