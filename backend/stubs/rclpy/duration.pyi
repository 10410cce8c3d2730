# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
class Duration:
    def __init__(self, *, seconds: int | float = ..., nanoseconds: int = ...) -> None: ...
    nanoseconds: int
