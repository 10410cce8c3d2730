"""What an engineer writes: a station is a folder of YAML documents and `.msg` files.

`source` reads YAML and remembers where each word stands, `documents` says what a document may hold, `loading` brings a
folder together. What the documents mean is the business of `sequence_planner.automaton`.
"""
