"""What has happened to the running station, from the journal: looked back on, replayed, and branched from."""
