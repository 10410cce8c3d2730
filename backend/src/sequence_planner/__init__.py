"""Sequence Planner: model and control collaborative, intelligent automation stations on ROS 2."""
