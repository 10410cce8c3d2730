"""The station's side of ROS 2: message types, their bytes, and the transports that carry them.

Above the port (`transport`) everything is a dictionary of plain values; below it everything is bytes:

    messages   which message types there are, dictionary <-> CDR bytes, type hashes
    transport  the port: advertise, publish, subscribe, graph, close; bytes only
    cyclone    DDS from PyPI, for machines without a ROS installation
    rclpy_transport  ROS 2's own client library, where it is installed
    memory     the same contract inside one process, for tests
    choice     which of them a station runs on
    ament      a colcon package of the station's messages, which rclpy needs
"""
