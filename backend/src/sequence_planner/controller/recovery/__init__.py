"""Getting a station going again: corrections, proposals, forces, what contradicts itself, and why nothing starts."""
