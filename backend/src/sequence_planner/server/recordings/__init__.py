"""Recordings of ROS 2 traffic that engineers bring to the server."""
