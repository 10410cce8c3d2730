# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
class SignalHandlerOptions:
    ALL: SignalHandlerOptions
    NO: SignalHandlerOptions
    SIGINT: SignalHandlerOptions
    SIGTERM: SignalHandlerOptions
