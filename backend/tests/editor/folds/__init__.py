"""What a station could say shorter."""
