# The part of rclpy 7 (ROS 2 Jazzy) that `sequence_planner.ros.rclpy_transport` uses.
from collections.abc import Sequence

from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> None: ...
