"""From documents to the automaton: names resolved, parameters replaced by values, types checked.

`declarations` has what there is, `meaning` what a text means where it stands; `abilities`, `specifications` and
`operations` make the parts of the automaton, which `station` puts together.
"""
