# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks
from rclpy.qos import QoSProfile

class Publisher:
    def __init__(
        self,
        publisher_impl: Any,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks,
        callback_group: Any,
    ) -> None: ...
    def publish(self, msg: Any | bytes) -> None: ...
