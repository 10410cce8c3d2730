# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from typing import Any

from rclpy import _rclpy_pybind11
from rclpy.context import Context
from rclpy.qos import QoSProfile
from rclpy.task import Future

class Client:
    def __init__(
        self,
        context: Context,
        client_impl: _rclpy_pybind11.Client,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: Any,
    ) -> None: ...
    def call_async(self, request: Any) -> Future: ...
    def get_pending_request(self, sequence_number: int) -> Future: ...
    handle: _rclpy_pybind11.Client
    def remove_pending_request(self, future: Future) -> None: ...
    def service_is_ready(self) -> bool: ...
