"""The past of the running station, from the journal: looked back on, replayed, and branched from."""
