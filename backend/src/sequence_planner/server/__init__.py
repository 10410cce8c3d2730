"""The server: REST, the WebSocket stream, the page. It knows the station only through `StationView`."""
