"""Cylindrical coordinates (rho, phi, z) in a local frame, which extrude and drag share (Table 1)."""

import numpy as np

from shapewright.modeling.frames import Frames, Vectors
from shapewright.modeling.operations.operation import Quantities


def displacement(frames: Frames, quantities: Quantities) -> Vectors:
    """Return rho cos(phi) u + rho sin(phi) v + z n in model space, one vector for each target and instance."""
    angle_rad = np.radians(quantities["phi_deg"])
    rho = quantities["rho"]
    local = np.stack([rho * np.cos(angle_rad), rho * np.sin(angle_rad), quantities["z"]])
    return np.einsum("tijb,jb->tib", frames, local)
