"""Things that a station keeps in its database, and for how long: all else goes to its archive, by itself and bit by
bit.
"""
