"""Expressions over records: the language of conditions, with real numbers, texts, products, quotients and list items.

    expression = disjunction ["implies" expression]
    disjunction = conjunction {"or" conjunction}
    conjunction = negation {"and" negation}
    negation = "not" negation | relation
    relation = sum [("==" | "!=" | "<" | "<=" | ">" | ">=") sum | "in" "{" sum {"," sum} "}"]
    sum = product {("+" | "-") product}
    product = factor {("*" | "/") factor}
    factor = "-" factor | "true" | "false" | number | "'" text "'" | field {"[" sum "]"} | "(" expression ")"
    field = word {"." word | "[" digits "]" | "[" word {"," word} "]"}

A model's guards stay without all this: they range over finite domains. Here names are fields of a record, or values of
the enumeration beside which they stand. What is unknown stays unknown, as in guards (Kleene).
"""
