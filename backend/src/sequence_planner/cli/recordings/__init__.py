"""Commands on recordings of ROS 2 traffic."""
