"""The live picture of a station: drawn by hand in `mimic.yaml`, or made from the model."""
