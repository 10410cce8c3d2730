"""The transports that carry messages, and which of them a station runs on (`choice`).

`cyclonedds` is DDS from PyPI, for machines without a ROS installation; `rclpy` is ROS 2's own client library, where
it is installed; `rosbridge` reaches nodes of ROS 1 through a rosbridge server (`routing` joins it with another);
`memory` keeps the same contract inside one process, for tests.
"""
