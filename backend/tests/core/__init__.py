"""The core against its definition: hand-made examples, and laws over random models with slow, plain implementations."""
