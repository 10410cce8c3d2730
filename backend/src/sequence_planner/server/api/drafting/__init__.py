"""Routes by which something comes to the draft: topics of the network, stations from outlines, what is said of it."""
