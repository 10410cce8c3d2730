# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
class TypeHash:
    def __init__(self, version: int = ..., value: bytes = ...) -> None: ...
    value: bytes
    version: int
