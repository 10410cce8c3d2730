"""The model that an engineer writes: a station is a folder of YAML documents and `.msg` files.

`yaml` reads and edits YAML, and `source` remembers where each word stands; `documents` says what a document may
hold, `loader` brings a folder together, and `json_schema` tells editors of it all. What the documents mean is the
business of `automaton`.
"""
