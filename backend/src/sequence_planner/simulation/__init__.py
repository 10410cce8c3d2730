"""Simulated devices: a process that speaks ROS 2 as the station's devices would, driven by the model's effects.

Nothing but messages connects it to the controller: it hears commands and reports states. `devices` is the behaviour
over time, free of clock and network; `service` puts it on the network.
"""
