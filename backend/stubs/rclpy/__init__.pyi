# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

def init(
    *,
    args: list[str] | None = ...,
    context: Context | None = ...,
    domain_id: int | None = ...,
    signal_handler_options: SignalHandlerOptions | None = ...,
) -> None: ...
