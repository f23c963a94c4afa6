"""What holds between the keys of a scenario: one function for each rule, in tables.

A rule takes the whole model and yields what is wrong, each with the key to change. Rules read the model alone, so that
`cosim.scenario.faults` can tell which keys a fault rests on.
"""
