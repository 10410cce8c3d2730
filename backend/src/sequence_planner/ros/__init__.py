"""The station's side of ROS 2: message types, their bytes, and the transports that carry them.

Above the port (`transport`) everything is a dictionary of plain values; below it everything is bytes:

    types       which messages, services and actions there are, dictionary <-> CDR bytes, type hashes
    transport   the port: advertise, publish, subscribe, call, serve, graph, close; bytes only
    transports  who carries them: Cyclone DDS, rclpy, rosbridge, and memory for tests
    qos         qualities of service, and what is said when they are not agreed on or not kept
    actions     goals, feedback, status and results, over any transport
"""
