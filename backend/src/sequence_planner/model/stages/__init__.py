"""The stages, one module for each family: their descriptions, their courses and how they are made from documents.

`expression` has expressions over records: the language of conditions, with real numbers, texts, products, quotients
and list items.

    expression = disjunction ["implies" expression]
    disjunction = conjunction {"or" conjunction}
    conjunction = negation {"and" negation}
    negation = "not" negation | relation
    relation = sum [("==" | "!=" | "<" | "<=" | ">" | ">=") sum | "in" "{" sum {"," sum} "}"]
    sum = product {("+" | "-") product}
    product = factor {("*" | "/") factor}
    factor = "-" factor | "true" | "false" | number | "'" text "'" | field {"[" sum "]"} | "(" expression ")"
    field = word {"." word | "[" digits "]" | "[" word {"," word} "]"}

A model's guards stay without all this: they range over finite domains. Here names are fields of a record, or values
of the enumeration beside which they stand. What is unknown stays unknown, as in guards (Kleene).

`python` has a station's own stages: Python functions in files of its folder `stages`, each in a process of its own.
The process gets one request at a time and can be killed: a function that hangs, crashes or fails costs the values
that it gives, and nothing else. The controller's thread never waits for it, nor do its ticks.
"""
