"""Planning by satisfiability: the unrolled tick as clauses, and searches in it."""
