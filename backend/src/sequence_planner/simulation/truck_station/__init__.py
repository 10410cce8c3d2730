"""The truck engine station as it would stand in a hall: a physical truth, and a process for each of its nodes.

Nothing here knows the model of the station, its automaton or its pipelines: the nodes share with the controller
only messages and topics. `world` is what is true (free of clock and network), `nodes` keeps it in a process of its
own, and `drivers` are the computers at the devices, which speak ROS 2 and set and read `signals` of the world. A
server, since nodes are killed and restarted one by one while the world goes on; and a judge must see all of it.
"""
