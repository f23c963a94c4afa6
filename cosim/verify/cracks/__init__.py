"""Cases of `cosim verify` on cracks that close: thrust, friction, softening, and sheets that stand on them."""
