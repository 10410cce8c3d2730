"""The station's side of ROS 2: message types, their bytes, and the transports that carry them.

Above the port (`transport`) everything is a dictionary of plain values; below it everything is bytes:

    messages   which messages, services and actions there are, dictionary <-> CDR bytes, type hashes
    found_types  types that somebody on the network describes
    transport  the port: advertise, publish, subscribe, call, serve, graph, close; bytes only
    quality    qualities of service, and what is said when they are not agreed on or not kept
    actions    goals, feedback, status and results, over any transport; action_server for emulated devices
    cyclone    DDS from PyPI, for machines without a ROS installation
    rclpy_transport  ROS 2's own client library, where it is installed
    memory     the same contract inside one process, for tests
    rosbridge  nodes of ROS 1, through a rosbridge server
    routing    one transport over two: topics of ROS 1 and all others
    choice     which of them a station runs on
    ament      a colcon package of the station's messages, which rclpy needs
"""
