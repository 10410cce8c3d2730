"""The server as its users meet it: over real sockets, with a real link to a controller."""
