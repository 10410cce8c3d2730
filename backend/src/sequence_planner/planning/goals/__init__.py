"""Goals, and the formulas that runs must keep to until they are reached."""
