"""The guard and action language: one grammar, one syntax tree, used wherever a condition or an update is written.

Text becomes a tree (`parser`), names become variables and values of known type (`resolver`), and a resolved tree is
evaluated over three truth values (`evaluator`) or printed back in canonical form (`printer`). `ltl` has the
formulas that runs must keep to.
"""
