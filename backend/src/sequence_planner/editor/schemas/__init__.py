"""What pages are told of a draft."""
