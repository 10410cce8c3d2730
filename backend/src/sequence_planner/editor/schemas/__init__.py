"""The things that pages are told of a draft."""
