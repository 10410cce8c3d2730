"""Features of a running station: each has the state that its commands are about, and carries them out."""
