"""The PANORAMA descriptor and distance (Papadakis et al. 2010; section 3.3, layer 1, of the paper).

Our reading, where the papers leave a choice:

- An object is turned into its principal axes twice: of its surface (CPCA, exact integrals over the triangles)
  and of its normals (NPCA). Each alignment gives three cylinders through the area-weighted centroid with radius
  R = 3 * mean distance of the surface, height 2R, 64 heights x 128 directions. Rays leave the axis outward and
  the farthest hit within R counts. They are rasterised: a row of rays cuts a triangle in a segment, which is
  intersected exactly. SDM is the hit's distance / R, NDM is ``|cos(ray, normal)| ** 4``, so winding is
  irrelevant.
- Principal axes have no sign. Frames are kept right-handed, which leaves the four frames that half turns about
  the axes make of each other. Such a half turn shifts a map by half a turn, or turns it by 180 degrees. Samples
  are taken at the middle of pixels, so both are exact permutations of them. Fourier magnitudes do not change
  under either, nor do statistics of Haar sub-bands when skewness counts by its absolute value; Coiflets are not
  symmetric, so their statistics are the mean over a map and the map turned by 180 degrees. The descriptor is
  the same in all four frames. A mirror image is another object.
- Principal axes of equal strength (a square plate, a ball) have no order either. Nothing is done about that: the
  descriptor then depends on the pose, though most such objects look the same about the axes concerned (a square
  table under a little noise moves by 0.3, one of 1 x 0.9 by 0.2). Settling ties by fourth moments was tried;
  where strong enough to help, it ranked real meshes worse (0.66 instead of 0.74).
- Fourier: |DFT| for 0..8 periods around and -4..4 along the axis, divided by their sum. On 242 real meshes of
  ten classes this window ranks as well as one four times as large (mean average precision 0.74 both).
- Wavelets: Haar and Coiflet (``coif1``), periodic, 6 levels, 19 sub-bands: mean absolute value, standard
  deviation, absolute skewness.
- Distance: per axis, the Manhattan distance of the Fourier parts (at most 4 for two maps, so divided by 4) plus
  the *mean* Canberra term of the wavelet parts, ``|a - b| / (|a| + |b| + 0.1)``; the weighted sum over the axes;
  the smaller of the two alignments. It lies in [0, 2]. Without the softening 0.1, sub-bands that are rounding
  noise count as much as the shape does: the same ranking drops from 0.74 to 0.72 (at 0.001).
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Float, Float32, Int

from shapewright.errors import MeshError

VERSION = 1
"""Raise it with every change of a descriptor's numbers or of their distance; a test compares both with known numbers.

What was stored under another version is then refused or computed again (``distances/descriptor_files.py``).
"""
AXIS_WEIGHTS = (0.51, 0.31, 0.18)
"""Weights of the first, second and third principal axis."""
RADIUS_FACTOR = 3.0
"""R in mean distances of the surface to the centroid."""
NORMAL_POWER = 4.0
"""n of ``|cos(ray, normal)| ** n``."""
CANBERRA_SOFTENING = 0.1
"""What is added to the denominator of each Canberra term."""
DESCRIPTOR_SIZE = 2292
"""Numbers of a descriptor: 2 alignments x 3 axes x 2 maps x (77 Fourier + 114 wavelet features)."""


@dataclass(frozen=True, eq=False)
class PanoramaDescriptor:
    """The descriptor of one object: a flat vector, alignments outermost, then axes, Fourier before wavelets."""

    values: Float32[np.ndarray, " D"]

    def __post_init__(self) -> None:
        if self.values.shape != (DESCRIPTOR_SIZE,):
            raise MeshError(f"expected {DESCRIPTOR_SIZE} numbers, got shape {self.values.shape}", where="descriptor")

    def to_array(self) -> Float32[np.ndarray, " D"]:
        """The flat vector, (DESCRIPTOR_SIZE,) float32."""
        return self.values

    @classmethod
    def from_array(cls, values: Float[np.ndarray, " D"]) -> "PanoramaDescriptor":
        """Take a flat vector, e.g. a row of a bank.

        Raises:
            MeshError: not DESCRIPTOR_SIZE numbers.
        """
        return cls(np.asarray(values, dtype=np.float32))


@dataclass(frozen=True, eq=False)
class PanoramaBatch:
    """The descriptors of N objects."""

    values: Float32[np.ndarray, "N D"]

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, index: int) -> PanoramaDescriptor:
        return PanoramaDescriptor(self.values[index])

    def to_array(self) -> Float32[np.ndarray, "N D"]:
        """The flat vectors as rows, (N, DESCRIPTOR_SIZE) float32: what a bank stores."""
        return self.values


def panorama_descriptor(vertices: Float[np.ndarray, "V 3"], triangles: Int[np.ndarray, "F 3"]) -> PanoramaDescriptor:
    """Describe one object; see :func:`panorama_descriptors`."""
    return panorama_descriptors(vertices[None], triangles)[0]


def panorama_descriptors(
    vertices: Float[np.ndarray, "N V 3"],
    triangles: Int[np.ndarray, "F 3"],
    *,
    radius_factor: float = RADIUS_FACTOR,
    normal_power: float = NORMAL_POWER,
) -> PanoramaBatch:
    """Describe N objects that share their triangles, on all threads numba may use.

    An object gets the same numbers alone and in a batch. Position, size and winding do not matter; rotation does
    not as far as the module's text says.

    Args:
        vertices: positions, in any unit.
        triangles: vertex indices.
        radius_factor: R in mean distances of the surface to the centroid.
        normal_power: exponent of the normals' deviation map.

    Raises:
        MeshError: no triangles, an index out of range, NaN or infinity, a surface without area.
    """
    from shapewright.distances import panorama_kernel as kernel

    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    triangles = np.ascontiguousarray(triangles, dtype=np.int64)
    count = len(vertices)
    if len(triangles) == 0:
        raise MeshError("there are no triangles to describe", where="triangles")
    if triangles.min() < 0 or triangles.max() >= vertices.shape[1]:
        raise MeshError(f"an index is not one of {vertices.shape[1]} vertices", where="triangles")
    finite = np.isfinite(vertices).all(axis=(1, 2))
    if not finite.all():
        raise MeshError("a coordinate is NaN or infinite", where=f"vertices[{int(np.argmin(finite))}]")
    centroids = np.zeros((count, 3))
    mean_distances = np.zeros(count)
    covariances = np.zeros((count, 2, 3, 3))
    kernel.pose_moments(vertices, triangles, centroids, mean_distances, covariances)
    if not (mean_distances > 0).all():
        flat = int(np.argmin(mean_distances > 0))
        raise MeshError("the surface has no area", where=f"vertices[{flat}]")
    values = np.empty((count, 2, 3, kernel.AXIS_SIZE), dtype=np.float32)
    kernel.describe(
        vertices,
        triangles,
        centroids,
        radius_factor * mean_distances,
        _principal_frames(covariances),
        float(normal_power),
        *_wavelet_filters(),
        values,
    )
    return PanoramaBatch(values.reshape(count, DESCRIPTOR_SIZE))


def panorama_distance(
    a: PanoramaDescriptor, b: PanoramaDescriptor, *, axis_weights: tuple[float, float, float] = AXIS_WEIGHTS
) -> float:
    """Distance of two objects, in [0, 2]; 0 for an object and itself, symmetric."""
    return float(panorama_distances(a, b.values[None], axis_weights=axis_weights)[0])


def panorama_distances(
    query: PanoramaDescriptor,
    bank: Float[np.ndarray, "N D"] | PanoramaBatch,
    *,
    axis_weights: tuple[float, float, float] = AXIS_WEIGHTS,
    softening: float = CANBERRA_SOFTENING,
) -> Float[np.ndarray, " N"]:
    """Distances of one object to each row of a bank, which may be memory-mapped: one scan.

    Raises:
        MeshError: the rows are no descriptors.
    """
    from shapewright.distances import panorama_kernel as kernel

    rows = np.asarray(bank.values if isinstance(bank, PanoramaBatch) else bank, dtype=np.float32)
    if rows.ndim != 2 or rows.shape[1] != DESCRIPTOR_SIZE:
        raise MeshError(f"expected rows of {DESCRIPTOR_SIZE} numbers, got shape {rows.shape}", where="bank")
    out = np.empty(len(rows))
    kernel.distances(
        np.ascontiguousarray(query.values).reshape(2, 3, kernel.AXIS_SIZE),
        np.ascontiguousarray(rows).reshape(len(rows), 2, 3, kernel.AXIS_SIZE),
        np.array(axis_weights, dtype=np.float64),
        float(softening),
        out,
    )
    return out


def _principal_frames(covariances: Float[np.ndarray, "N 2 3 3"]) -> Float[np.ndarray, "N 2 3 3"]:
    """Right-handed principal axes as rows, the strongest first."""
    _, vectors = np.linalg.eigh(covariances)
    frames = np.ascontiguousarray(vectors[..., ::-1].swapaxes(-1, -2))
    frames[..., 2, :] = np.cross(frames[..., 0, :], frames[..., 1, :])
    return frames


@lru_cache(maxsize=1)
def _wavelet_filters() -> tuple[Any, Any, Any]:
    """Low- and high-pass filters (2, L) float32 of Haar and Coiflet, and their lengths."""
    import pywt

    wavelets = [pywt.Wavelet("haar"), pywt.Wavelet("coif1")]
    lengths = np.array([wavelet.dec_len for wavelet in wavelets], dtype=np.int64)
    low_passes = np.zeros((2, lengths.max()), dtype=np.float32)
    high_passes = np.zeros((2, lengths.max()), dtype=np.float32)
    for index, wavelet in enumerate(wavelets):
        low_passes[index, : lengths[index]] = wavelet.dec_lo
        high_passes[index, : lengths[index]] = wavelet.dec_hi
    return low_passes, high_passes, lengths
