"""Types of messages, services and actions: defined in files, derived, found on the network, and as bytes.

`interfaces` writes a colcon package of the station's messages, which rclpy needs.
"""
