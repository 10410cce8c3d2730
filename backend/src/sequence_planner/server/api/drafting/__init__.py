"""Routes by which something new comes to the draft: topics of the network, and stations from outlines."""
