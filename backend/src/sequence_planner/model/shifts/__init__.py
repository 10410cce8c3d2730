"""The shifts of a station, as `shifts.yaml` has them."""
