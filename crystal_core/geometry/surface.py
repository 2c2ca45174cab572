"""Is a heap of triangles the surface of one body? What can be mended without a guess is; the rest is refused."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from crystal_core.errors import InputError

__all__ = ["COINCIDENT", "THINNEST", "Surface", "closed_surface", "paired_edges"]

Real = NDArray[np.float64]
Index = NDArray[np.intp]

COINCIDENT = 1e-6
"""Corners nearer than this are one, in units of the largest extent: what float32 or six digits may keep apart."""

THINNEST = 1e-4
"""A body thinner than this on average, in units of its largest extent, is none: its sides could not be told apart."""


@dataclass(frozen=True)
class Surface:
    """A closed, oriented surface of one piece.

    Parameters
    ----------
    vertices : Real
        Corners, shape (V, 3), all of them used.
    triangles : NDArray of int
        Corner indices, counter-clockwise from outside, shape (T, 3).
    notes : tuple of str
        What was mended, a sentence each.
    """

    vertices: Real
    triangles: Index
    notes: tuple[str, ...]


def closed_surface(vertices: Real, triangles: Index, *, pointer: str = "") -> Surface:
    """Return triangles as the surface of a body.

    Mended, each with a note: corners that fall together, triangles without area or that come twice, and triangles that
    are wound the wrong way round. Nothing is filled.

    Parameters
    ----------
    vertices : Real
        Shape (V, 3).
    triangles : NDArray of int
        Corner indices, shape (T, 3).
    pointer : str
        Where the mesh stands in the input.

    Raises
    ------
    InputError
        At the pointer: corners that are no numbers or all in one place, triangles of corners that there are not, no
        triangles; a hole; edges of more than two triangles; a surface with one side; several surfaces; no volume.
    """
    if not len(triangles) or not len(vertices):
        raise InputError.at(pointer, "the mesh has no triangles")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise InputError.at(pointer, f"a triangle names a corner that is not among the {len(vertices)} of the mesh")
    used, triangles = np.unique(triangles, return_inverse=True)
    vertices, triangles = vertices[used], triangles.reshape(-1, 3)
    wrong = ~(np.abs(vertices) < 1e30).all(axis=1)
    if wrong.any():
        raise InputError.at(
            pointer, f"the place of {_count(int(wrong.sum()), 'corner')} of the mesh is not three finite numbers"
        )
    middle, size = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)), float(np.ptp(vertices, axis=0).max())
    if not size > 1e-30:
        raise InputError.at(pointer, "all corners of the mesh lie in one place")
    notes: list[str] = []
    vertices, triangles = _merged((vertices - middle) / size, triangles, notes)
    triangles = _without_idle(triangles, notes)
    if not len(triangles):
        raise InputError.at(pointer, "no triangle of the mesh has an area")
    _refuse_open(vertices * size + middle, triangles, pointer)
    triangles = _wound(vertices, triangles, notes, pointer)
    used, triangles = np.unique(triangles, return_inverse=True)
    return Surface(vertices[used] * size + middle, triangles.reshape(-1, 3), tuple(notes))


def paired_edges(triangles: Index) -> tuple[Index, Index]:
    """Return the edges of a closed surface and what lies at them.

    Returns
    -------
    ends : NDArray of int
        The smaller and the larger corner of each edge, shape (E, 2).
    sides : NDArray of int
        Its two places among the directed edges, shape (E, 2): place p is edge p // T of triangle p % T, from its corner
        p // T to the next.
    """
    directed = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    ends, owner = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True)
    return ends, np.argsort(owner.reshape(-1), kind="stable").reshape(-1, 2)


def _merged(vertices: Real, triangles: Index, notes: list[str]) -> tuple[Real, Index]:
    """Return the mesh with corners that fall together made one."""
    # First by cells, which bounds how many neighbours a corner can have however many are heaped up.
    _, first, cell = np.unique(np.floor(vertices / COINCIDENT), axis=0, return_index=True, return_inverse=True)
    pairs = cKDTree(vertices[first]).query_pairs(COINCIDENT, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(first), len(first)))
    count, cluster = connected_components(links, directed=False)
    if count < len(vertices):
        notes.append(f"merged {_count(len(vertices), 'corner')} that fall together into {count}")
    _, chosen = np.unique(cluster, return_index=True)
    return vertices[first[chosen]], cluster[cell.reshape(-1)][triangles].astype(np.intp)


def _without_idle(triangles: Index, notes: list[str]) -> Index:
    """Return the triangles that have three corners, each once."""
    a, b, c = triangles.T
    real = (a != b) & (b != c) & (c != a)
    if not real.all():
        notes.append(f"left out {_count(int((~real).sum()), 'triangle')} without area")
    triangles = triangles[real]
    _, first = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)
    if len(first) < len(triangles):
        notes.append(f"left out {_count(len(triangles) - len(first), 'triangle')} that came twice")
    return triangles[np.sort(first)]


def _refuse_open(vertices: Real, triangles: Index, pointer: str) -> None:
    """Raise where an edge has not exactly two triangles."""
    directed = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    ends, uses = np.unique(np.sort(directed, axis=1), axis=0, return_counts=True)
    if (uses == 1).any():
        rim = ends[uses == 1]
        links = coo_array((np.ones(len(rim)), (rim[:, 0], rim[:, 1])), shape=(len(vertices), len(vertices)))
        _, piece = connected_components(links, directed=False)
        pieces = np.unique(piece[rim[:, 0]])
        place = vertices[np.unique(rim[piece[rim[:, 0]] == pieces[0]])].mean(axis=0)
        holes = "a hole" if len(pieces) == 1 else f"{len(pieces)} holes, the first"
        raise InputError.at(
            pointer,
            f"the mesh is open: {_count(len(rim), 'edge')} of one triangle only, around {holes} near {_told(place)}; "
            "holes are not filled",
        )
    if (uses > 2).any():
        place = vertices[ends[uses > 2][0]].mean(axis=0)
        raise InputError.at(
            pointer,
            f"more than two triangles meet at {_count(int((uses > 2).sum()), 'edge')}, the first near {_told(place)}: "
            "walls inside a body, or bodies that share an edge",
        )


def _wound(vertices: Real, triangles: Index, notes: list[str], pointer: str) -> Index:
    """Return the triangles of one surface, all counter-clockwise from outside."""
    count = len(triangles)
    _, sides = paired_edges(triangles)
    one, other = sides[:, 0] % count, sides[:, 1] % count
    ends = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    against = ends[sides[:, 0], 0] == ends[sides[:, 1], 0]  # both run the same way: one of them is wound wrongly
    # Every triangle twice, as it is and turned round; neighbours hang together in the sense that agrees.
    rows = np.concatenate((one, one + count))
    columns = np.concatenate((np.where(against, other + count, other), np.where(against, other, other + count)))
    links = coo_array((np.ones(len(rows)), (rows, columns)), shape=(2 * count, 2 * count))
    _, sense = connected_components(links, directed=False)
    if (sense[:count] == sense[count:]).any():
        raise InputError.at(pointer, "the mesh has no inside: its surface has one side only, as a Möbius strip has")
    pieces = len(np.unique(sense)) // 2
    if pieces > 1:
        raise InputError.at(pointer, f"the mesh holds {pieces} separate surfaces: give each body a file of its own")
    turned_round = sense[:count] != sense[0]
    volume, area = _volume_and_area(vertices, np.where(turned_round[:, None], triangles[:, ::-1], triangles))
    if abs(volume) <= 0.5 * THINNEST * area:
        raise InputError.at(pointer, "the mesh encloses no volume, or hardly any: it is flat")
    if volume < 0.0:
        turned_round = ~turned_round
    if turned_round.all():
        notes.append("turned the surface inside out: its triangles were wound clockwise")
    elif turned_round.any():
        notes.append(f"turned {_count(int(turned_round.sum()), 'triangle')} round, against the others' sense")
    return np.where(turned_round[:, None], triangles[:, ::-1], triangles)


def _volume_and_area(vertices: Real, triangles: Index) -> tuple[float, float]:
    a, b, c = (vertices[triangles[:, i]] for i in range(3))
    return float(np.sum(a * np.cross(b, c)) / 6.0), float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def _count(number: int, thing: str) -> str:
    return f"1 {thing}" if number == 1 else f"{number} {thing}s"


def _told(place: Real) -> str:
    return "({:.4g}, {:.4g}, {:.4g})".format(*(place + 0.0))
