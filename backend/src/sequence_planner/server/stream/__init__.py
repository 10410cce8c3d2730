"""The WebSockets: the station as it changes, for pages and watches."""
