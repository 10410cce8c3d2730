"""From a topic that somebody has on the network to an entry in a station's model, in one step.

`network` finds the topic and its type, `definitions` writes a type found on the wire as a `.msg` file, `proposals` has
the stages for what is no variable by itself, `attachment` makes the change of the model, and tries it on a copy first.
"""
