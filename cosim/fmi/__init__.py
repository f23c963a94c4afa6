"""FMI, the interface by which programs couple simulations: the ice for others, and a structure of others for the ice.

Needs the extra ``fmi`` (fmpy, pythonfmu, pythonfmu3), which is imported in this room alone and only when it is used.
"""
