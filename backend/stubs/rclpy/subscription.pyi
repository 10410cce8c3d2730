# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from collections.abc import Callable
from typing import Any

from rclpy import _rclpy_pybind11
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile

class Subscription:
    def __init__(
        self,
        subscription_impl: _rclpy_pybind11.Subscription,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        callback_group: Any,
        qos_profile: QoSProfile,
        raw: bool,
        event_callbacks: SubscriptionEventCallbacks,
    ) -> None: ...
    handle: _rclpy_pybind11.Subscription
