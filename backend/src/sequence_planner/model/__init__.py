"""What an engineer writes: a station is a folder of YAML documents and `.msg` files.

`composing` and `reading` read YAML, and `source` remembers where each word stands; `documents` says what a document may
hold, `loading` brings a folder together, `editing` changes an entry and nothing else, and `schemas` tells editors of it
all. What the documents mean is the business of `sequence_planner.automaton`.
"""
