# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from collections.abc import Callable
from typing import Any

from rclpy import _rclpy_pybind11
from rclpy.qos import QoSProfile

class Service:
    def __init__(
        self,
        service_impl: _rclpy_pybind11.Service,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        callback_group: Any,
        qos_profile: QoSProfile,
    ) -> None: ...
    handle: _rclpy_pybind11.Service
    def send_response(self, response: Any, header: Any) -> None: ...
