"""From [fracture].device to the engine whose sub-steps are made there."""

from __future__ import annotations

from importlib.util import find_spec

from cosim.errors import InputError
from lattice.explicit.engine import ExplicitEngine


def explicit_engine(device: str) -> type[ExplicitEngine]:
    """The explicit engine on a device. InputError where it, or what it needs, is missing."""
    if device == "cpu":
        return ExplicitEngine
    if find_spec("numba_cuda") is None:
        raise InputError("fracture.device = cuda needs numba-cuda: pip install 'brash-ice[gpu]', or use cpu")
    from numba import cuda  # only where it is asked for: it starts a driver

    if not cuda.is_available():
        raise InputError("fracture.device = cuda: no card of NVIDIA with its driver is found here; use cpu")
    from lattice.cuda.engine import CardEngine

    return CardEngine
