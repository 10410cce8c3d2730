"""Recordings of ROS 2 traffic: read with the pipelines of a draft, for the states that the station was in."""
