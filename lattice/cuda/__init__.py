"""Sub-steps of the explicit engine on a graphics card of NVIDIA, by numba-cuda: an option, the extra ``gpu``.

Nothing of it is imported unless it is asked for.
"""
