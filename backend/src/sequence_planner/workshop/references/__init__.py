"""What the names of a draft mean, and where they are used: for renaming and deleting a part of a model."""

from sequence_planner.workshop.references.finding import Usage, Usages, dependants, usages
from sequence_planner.workshop.references.parts import KINDS, Part, parse_part
from sequence_planner.workshop.references.renaming import renamed

__all__ = ["KINDS", "Part", "Usage", "Usages", "dependants", "parse_part", "renamed", "usages"]
