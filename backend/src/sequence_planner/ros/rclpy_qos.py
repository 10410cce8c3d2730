"""Qualities of service as rclpy has them, and what it says about them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Literal

from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_policy_name_from_kind,
)

from sequence_planner.ros.quality import QualityOfService

if TYPE_CHECKING:
    from rclpy.event_handler import (
        QoSLivelinessChangedInfo,
        QoSLivelinessLostInfo,
        QoSOfferedDeadlineMissedInfo,
        QoSOfferedIncompatibleQoSInfo,
        QoSRequestedDeadlineMissedInfo,
        QoSRequestedIncompatibleQoSInfo,
    )

#: Tells of an event: its kind, how often it has happened, and what it is in words.
Tell = Callable[[Literal["incompatible", "deadline", "liveliness"], int, str], None]

#: Nanoseconds that mean "never": rmw's infinite duration.
_INFINITE = 2**63 - 1


def profile(qos: QualityOfService) -> QoSProfile:
    """Return the profile of a publisher or subscription."""
    made = QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=qos.depth,
        reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE,
    )
    if qos.deadline is not None:
        made.deadline = Duration(seconds=qos.deadline)
    if qos.liveliness is not None:
        made.liveliness = LivelinessPolicy.AUTOMATIC
        made.liveliness_lease_duration = Duration(seconds=qos.liveliness)
    return made


def seconds(duration: Duration) -> float | None:
    """Return a duration of a profile in s; None when it is infinite or not given."""
    return duration.nanoseconds / 1e9 if 0 < duration.nanoseconds < _INFINITE else None


def publisher_events(qos: QualityOfService, tell: Tell) -> PublisherEventCallbacks:
    """Return the callbacks of a publisher; a middleware is asked for no more of them than `qos` needs."""

    def incompatible(info: QoSOfferedIncompatibleQoSInfo) -> None:
        tell("incompatible", info.total_count, qos_policy_name_from_kind(info.last_policy_kind).lower())

    def missed(info: QoSOfferedDeadlineMissedInfo) -> None:
        tell("deadline", info.total_count, f"no sample published within its deadline of {qos.deadline or 0:g} s")

    def lost(info: QoSLivelinessLostInfo) -> None:
        detail = f"this publisher has not shown for {qos.liveliness or 0:g} s that it is alive"
        tell("liveliness", info.total_count, detail)

    return PublisherEventCallbacks(
        incompatible_qos=incompatible,
        deadline=missed if qos.deadline is not None else None,
        liveliness=lost if qos.liveliness is not None else None,
        use_default_callbacks=False,
    )


def subscription_events(qos: QualityOfService, tell: Tell) -> SubscriptionEventCallbacks:
    """Return the callbacks of a subscription, as `publisher_events` does."""

    def incompatible(info: QoSRequestedIncompatibleQoSInfo) -> None:
        tell("incompatible", info.total_count, qos_policy_name_from_kind(info.last_policy_kind).lower())

    def missed(info: QoSRequestedDeadlineMissedInfo) -> None:
        tell("deadline", info.total_count, f"no sample received within its deadline of {qos.deadline or 0:g} s")

    def changed(info: QoSLivelinessChangedInfo) -> None:
        if info.not_alive_count_change > 0:
            detail = f"a publisher has not shown for {qos.liveliness or 0:g} s that it is alive"
            tell("liveliness", info.not_alive_count, detail)

    return SubscriptionEventCallbacks(
        incompatible_qos=incompatible,
        deadline=missed if qos.deadline is not None else None,
        liveliness=changed if qos.liveliness is not None else None,
        use_default_callbacks=False,
    )
