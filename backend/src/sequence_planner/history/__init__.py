"""What has happened to the running station, from the journal: restored, replayed, looked back on, and branched from."""
