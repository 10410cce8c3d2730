"""The guard and action language: one grammar, one syntax tree, used wherever a condition or an update is written.

Text becomes a tree (`parser`), names become variables and values of known type (`resolution`), and a resolved tree is
evaluated over three truth values (`evaluation`) or printed back in canonical form (`printing`).
"""
