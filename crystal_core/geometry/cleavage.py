"""The shape that a blow leaves: planes of cleavage, where they enclose a body."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from crystal_core.errors import InputError
from crystal_core.geometry.habit import Form, check_indices, check_size, grown, scaled
from crystal_core.geometry.half_spaces import bounded_body, is_bounded
from crystal_core.geometry.lattice import Lattice
from crystal_core.geometry.point_groups import PointGroup
from crystal_core.geometry.solid import Hkl, Solid, hkl_label

__all__ = ["cleavage_closes", "cleavage_solid"]

Real = NDArray[np.float64]


def cleavage_closes(lattice: Lattice, group: PointGroup, cleavages: Sequence[Hkl]) -> bool:
    """Return whether the planes of cleavages enclose a body, as {104} of calcite does and {001} of mica does not."""
    faces = [face for hkl in cleavages for face in group.laue.equivalents(hkl)]
    return is_bounded(np.array([lattice.face_normal(face) for face in faces]))


def cleavage_solid(
    lattice: Lattice,
    group: PointGroup,
    cleavages: Sequence[Hkl],
    spacing_mm: float | Sequence[float],
    *,
    pointer: str = "",
) -> Solid:
    """Return the body that planes of cleavage enclose, in the crystal frame, its centroid at the origin.

    A crystal that cleaves leaves a face on either side: the planes are those of the Laue class.

    Parameters
    ----------
    lattice : Lattice
        Of the crystal.
    group : PointGroup
        Of the crystal, in the setting of the lattice.
    cleavages : sequence of (int, int, int)
        One plane of each cleavage.
    spacing_mm : float or sequence of float
        Distance between parallel faces: the same for all, or one for each pair, in the order in which the pairs first
        come among the faces of equal spacings.
    pointer : str
        Where the spacing stands in the input, for errors.

    Raises
    ------
    InputError
        At the pointer: the planes enclose no body. At ``/spacing_mm``: not a length, not as many as there are pairs, or
        one so large that its faces lie outside the others.
    """
    for hkl in cleavages:
        check_indices(hkl, pointer)
    told = " and ".join(f"{{{hkl_label(hkl)}}}" for hkl in cleavages)
    if not cleavages or not cleavage_closes(lattice, group, cleavages):
        raise InputError.at(pointer, f"the planes of cleavage {told} enclose no body: it comes off in plates or rods")
    solid = grown(lattice, group.laue, [Form(hkl, 1.0) for hkl in cleavages], pointer=pointer)
    body = solid.body
    pairs = [(face, int(other)) for face, other in enumerate(body.parallel_face) if face < other]
    if isinstance(spacing_mm, int | float):
        check_size(float(spacing_mm), f"{pointer}/spacing_mm")
        return scaled(solid, 0.5 * float(spacing_mm), np.zeros(3))
    if len(spacing_mm) != len(pairs):
        raise InputError.at(
            f"{pointer}/spacing_mm", f"{told} has {len(pairs)} pairs of parallel faces, not {len(spacing_mm)}"
        )
    offsets = body.offsets.copy()
    for number, (pair, spacing) in enumerate(zip(pairs, spacing_mm, strict=True)):
        check_size(spacing, f"{pointer}/spacing_mm/{number}")
        offsets[list(pair)] = 0.5 * spacing
    apart, kept = bounded_body(body.normals, offsets, np.zeros(3))
    for number, (face, _) in enumerate(pairs):
        if face not in kept:
            raise InputError.at(
                f"{pointer}/spacing_mm/{number}",
                f"at {spacing_mm[number]:g} mm the faces {solid.labels[face]} lie outside what the others enclose",
            )
    return Solid(apart, solid.labels, solid.hkl)
