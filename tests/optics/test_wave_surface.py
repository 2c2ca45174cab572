"""Index and ray surfaces as meshes: on Fresnel's equation, closed, nested, touching, each the other's reciprocal."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.optics.arrays import Real
from crystal_core.optics.directions import waves_along
from crystal_core.optics.indicatrix import optic_axes, permittivity
from crystal_core.optics.medium import Medium
from crystal_core.optics.wave_surface import SurfaceKind, WaveSurface, dual, wave_surface

AXES = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]

MEDIA = {
    "isotropic": Medium.isotropic(1.54),
    "positive uniaxial": Medium.uniaxial(1.5443, 1.5534, AXES[2]),
    "calcite": Medium.uniaxial(1.6584, 1.4864, AXES[2]),
    "aragonite": Medium.biaxial((1.5300, 1.6810, 1.6854), np.eye(3)),
    "in another order": Medium.biaxial((1.9, 1.5, 1.7), AXES),
    "the other handedness": Medium.biaxial((1.9, 1.5, 1.7), -AXES),
    "huge": Medium.biaxial((1.2, 2.0, 4.0), AXES),
    "nearly uniaxial": Medium.biaxial((1.5, 1.5 + 1e-12, 1.7), AXES),
    "lower two equal": Medium.biaxial((1.7, 1.5, 1.5), AXES),
    "upper two equal": Medium.biaxial((1.7, 1.5, 1.7), AXES),
    "all equal": Medium.biaxial((1.6, 1.6, 1.6), AXES),
}
BIAXIAL = [name for name in MEDIA if name not in {"isotropic", "positive uniaxial", "calcite"} and "equal" not in name]
UNIAXIAL = ["positive uniaxial", "calcite", "lower two equal", "upper two equal"]
KINDS: tuple[SurfaceKind, ...] = ("index", "ray")


def fresnel(tensor: Real, points: Real) -> Real:
    """Return k² k·ε·k − k·(tr ε − ε)ε·k + det ε over det ε, zero on the index surface of ε (on the ray one of ε⁻¹)."""
    cofactor = np.trace(tensor) * tensor - tensor @ tensor
    quartic = np.sum(points**2, axis=0) * np.einsum("in,ij,jn->n", points, tensor, points)
    det = np.linalg.det(tensor)
    return np.asarray((quartic - np.einsum("in,ij,jn->n", points, cofactor, points) + det) / det)


def tensor(medium: Medium, kind: SurfaceKind) -> Real:
    eps = permittivity(medium)
    return eps if kind == "index" else np.asarray(np.linalg.inv(eps))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", MEDIA)
def test_every_vertex_is_on_fresnels_surface(name: str, kind: SurfaceKind) -> None:
    surface = wave_surface(MEDIA[name], kind, 12)
    for sheet in (surface.outer, surface.inner):
        np.testing.assert_allclose(fresnel(tensor(MEDIA[name], kind), sheet.vertices), 0.0, atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("resolution", [2, 3, 20])
@pytest.mark.parametrize("name", MEDIA)
def test_the_sheets_are_closed_and_face_outward(name: str, resolution: int, kind: SurfaceKind) -> None:
    surface = wave_surface(MEDIA[name], kind, resolution)
    for sheet in (surface.outer, surface.inner):
        mesh = trimesh.Trimesh(sheet.vertices.T, sheet.triangles, process=False)
        assert mesh.is_watertight
        assert mesh.is_winding_consistent
        assert mesh.euler_number == 2  # one sphere, topologically
        assert len(np.unique(sheet.triangles)) == sheet.vertices.shape[1]
        assert mesh.body_count == 1
        # Seen from the origin every triangle shows its back, and together they cover each direction once.
        a, b, c = (sheet.vertices[:, corner] for corner in sheet.triangles.T)
        assert np.all(np.sum(a * np.cross(b, c, axis=0), axis=0) > 0)
        assert np.sum(solid_angles(a, b, c)) == pytest.approx(4 * np.pi, rel=1e-12)


def solid_angles(a: Real, b: Real, c: Real) -> Real:
    """Return the solid angle of each triangle at the origin (van Oosterom & Strackee 1983)."""
    la, lb, lc = (np.linalg.norm(v, axis=0) for v in (a, b, c))
    below = la * lb * lc + sum(np.sum(p * q, axis=0) * length for p, q, length in ((a, b, lc), (b, c, la), (c, a, lb)))
    return np.asarray(2 * np.arctan2(np.sum(a * np.cross(b, c, axis=0), axis=0), below))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", BIAXIAL)
def test_a_biaxial_surface_touches_itself_at_four_points(name: str, kind: SurfaceKind) -> None:
    medium = MEDIA[name]
    surface = wave_surface(medium, kind, 16)
    first, second = optic_axes(medium if kind == "index" else dual(medium))
    beta = np.sort(np.stack(medium.indices))[1]
    radius = beta if kind == "index" else 1 / beta
    expected = radius * np.stack((first, -first, second, -second), axis=1)
    np.testing.assert_allclose(surface.contact_points, expected, rtol=1e-15)
    assert_touching(surface, 4)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", UNIAXIAL)
def test_a_uniaxial_one_is_a_sphere_and_a_spheroid_that_touch_at_two(name: str, kind: SurfaceKind) -> None:
    medium = MEDIA[name]
    surface = wave_surface(medium, kind, 16)
    (axis,) = optic_axes(medium)
    n = np.sort(np.stack(medium.indices))
    ordinary = n[1] if len(n) == 3 else medium.indices[0]
    other = {"lower two equal": 1.7, "upper two equal": 1.5}.get(name, medium.indices[-1])
    outer_is_sphere = (other < ordinary) == (kind == "index")
    sphere, spheroid = (surface.outer, surface.inner) if outer_is_sphere else (surface.inner, surface.outer)
    radius, equator = (ordinary, other) if kind == "index" else (1 / ordinary, 1 / other)
    np.testing.assert_allclose(np.linalg.norm(sphere.vertices, axis=0), radius, rtol=1e-14)
    along = axis @ spheroid.vertices
    across = np.linalg.norm(np.cross(axis, spheroid.vertices.T), axis=1)
    np.testing.assert_allclose((along / radius) ** 2 + (across / equator) ** 2, 1.0, rtol=1e-14)
    np.testing.assert_allclose(np.abs(axis @ surface.contact_points), radius, rtol=1e-15)
    assert_touching(surface, 2)
    if len(n) == 2:
        assert (sphere.mode, spheroid.mode) == ("ordinary", "extraordinary")


def assert_touching(surface: WaveSurface, count: int) -> None:
    """The contact points are vertices of both sheets, to the bit; everywhere else the outer one is further out."""
    assert surface.contact_points.shape == (3, count)
    outer, inner = surface.outer.vertices, surface.inner.vertices
    shared = np.flatnonzero(np.all(outer == inner, axis=0))
    assert {tuple(p) for p in outer[:, shared].T} == {tuple(p) for p in surface.contact_points.T}
    gap = np.linalg.norm(outer, axis=0) / np.linalg.norm(inner, axis=0) - 1
    others = np.delete(np.arange(outer.shape[1]), shared)
    # The lines of a nearly uniaxial medium meet the optic axes at 1e-6 of a step: there the gap is only rounding.
    assert np.all(gap[others] >= -4e-16)
    assert np.count_nonzero(gap[others] > 1e-13) > 0.9 * gap.size
    # One set of triangles over one set of directions: then neither sheet can come through the other.
    assert np.array_equal(surface.outer.triangles, surface.inner.triangles)
    np.testing.assert_allclose(outer / np.linalg.norm(outer, axis=0), inner / np.linalg.norm(inner, axis=0), atol=1e-15)


@pytest.mark.parametrize("name", ["aragonite", "in another order", "huge"])
def test_the_funnel_at_a_contact_is_resolved(name: str) -> None:
    """Around each contact the gap grows linearly with the angle, by one factor: two cones, tip to tip."""
    medium = MEDIA[name]
    surface = wave_surface(medium, "index", 32)
    outer, inner = surface.outer.vertices, surface.inner.vertices
    a, b, g = np.sort(np.stack(medium.indices))
    slope = b**3 * np.sqrt((a**-2 - b**-2) * (b**-2 - g**-2))
    for contact in surface.contact_points.T:
        angle = np.linalg.norm(np.cross(outer.T, contact), axis=1) / np.linalg.norm(outer, axis=0) / b
        ahead = outer.T @ contact > 0
        near = ahead & (angle > 0) & (angle < 0.02)
        assert np.count_nonzero(near) >= 12
        gap = (np.linalg.norm(outer, axis=0) - np.linalg.norm(inner, axis=0))[near]
        np.testing.assert_allclose(gap / angle[near], slope, rtol=0.25)
        nearest = np.argsort(np.where(near, angle, np.inf))[:4]
        assert angle[nearest[0]] < 2e-3
        np.testing.assert_allclose(
            (np.linalg.norm(outer, axis=0) - np.linalg.norm(inner, axis=0))[nearest] / angle[nearest], slope, rtol=0.03
        )


@pytest.mark.parametrize("name", MEDIA)
def test_the_two_surfaces_are_polar_reciprocals(name: str) -> None:
    """The ray vector of a point k of the index surface lies on the ray surface, k·r = 1, and its normal there is k."""
    medium = MEDIA[name]
    surface = wave_surface(medium, "index", 10)
    lengths = np.linalg.norm(surface.outer.vertices, axis=0)
    s = surface.outer.vertices / lengths
    apart = np.ones(s.shape[1], bool)
    for contact in surface.contact_points.T:  # there the ray depends on the pair of waves
        apart &= np.linalg.norm(np.cross(s.T, contact / np.linalg.norm(contact)), axis=1) > 1e-3
    waves = waves_along(medium, s[:, apart])
    for wave in waves:
        r = wave.ray_vector()
        np.testing.assert_allclose(np.sum(r * wave.k, axis=0), 1.0, rtol=1e-14)
        np.testing.assert_allclose(fresnel(tensor(medium, "ray"), r), 0.0, atol=1e-12)
        back = waves_along(dual(medium), wave.ray)
        same = [np.abs(other.index / np.linalg.norm(r, axis=0) - 1) for other in back]
        np.testing.assert_allclose(np.minimum(*same), 0.0, atol=1e-13)
        # 1e-10: a ray near the rim of the flat circle around a contact passes close to a biradial.
        turned = [np.linalg.norm(np.cross(other.ray, s[:, apart], axis=0), axis=0) for other in back]
        if not medium.is_isotropic and name != "nearly uniaxial":
            np.testing.assert_allclose(np.minimum(*turned), 0.0, atol=1e-10)


def test_the_surfaces_bound_all_speeds() -> None:
    medium = MEDIA["aragonite"]
    alpha, beta, gamma = np.sort(np.stack(medium.indices))
    for kind, (low, middle, high) in (
        ("index", (alpha, beta, gamma)),
        ("ray", (1 / gamma, 1 / beta, 1 / alpha)),
    ):
        surface = wave_surface(medium, kind, 8)
        outer, inner = (np.linalg.norm(m.vertices, axis=0) for m in (surface.outer, surface.inner))
        assert (outer.min(), outer.max()) == (pytest.approx(middle, rel=1e-15), pytest.approx(high, rel=1e-15))
        assert (inner.min(), inner.max()) == (pytest.approx(low, rel=1e-15), pytest.approx(middle, rel=1e-15))
    assert (surface.outer.mode, surface.inner.mode) == ("fast", "slow")


def test_an_isotropic_surface_is_one_sphere_twice() -> None:
    for name in ("isotropic", "all equal"):
        surface = wave_surface(MEDIA[name], "index", 4)
        assert np.array_equal(surface.outer.vertices, surface.inner.vertices)
        assert surface.contact_points.shape == (3, 0)
        n = float(MEDIA[name].indices[0])
        np.testing.assert_allclose(np.linalg.norm(surface.outer.vertices, axis=0), n, rtol=1e-15)


def test_the_mesh_converges_to_the_volume_of_the_spheroid() -> None:
    axis = (0.0, 0.6, 0.8)
    volume = 4 / 3 * np.pi * 1.6**2 * 1.6 * (1.9 / 1.6) ** 2  # radius n_o along the axis, n_e across
    errors = []
    for resolution in (8, 16):
        sheet = wave_surface(Medium.uniaxial(1.6, 1.9, axis), "index", resolution).outer
        errors.append(1 - trimesh.Trimesh(sheet.vertices.T, sheet.triangles, process=False).volume / volume)
    assert 0 < errors[1] < 0.01
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)


@pytest.mark.parametrize(
    ("medium", "kind", "resolution", "pointer"),
    [
        (MEDIA["calcite"], "rays", 8, "/kind"),
        (MEDIA["calcite"], "index", 1, "/resolution"),
        (Medium.isotropic([1.5, 1.6]), "index", 8, ""),
        (Medium.uniaxial(1.5, 1.6, np.eye(3)), "index", 8, ""),
        (Medium.biaxial((1.5, 1.6, 1.7), np.eye(3)[:, :, None]), "index", 8, ""),
    ],
)
def test_wrong_input_is_named(medium: Medium, kind: SurfaceKind, resolution: int, pointer: str) -> None:
    with pytest.raises(InputError) as caught:
        wave_surface(medium, kind, resolution)
    assert [fault.pointer for fault in caught.value.faults] == [pointer]


def test_the_ray_surface_of_an_active_medium_is_refused_by_name() -> None:
    with pytest.raises(NotSupportedError, match="gyration"):
        wave_surface(MEDIA["calcite"].active(np.eye(3) * 1e-4), "ray")


def test_the_sheets_of_an_active_medium_stay_apart() -> None:
    """By G/n along the optic axes, where those of the inactive one touch; and they are its waves."""
    for name in ("calcite", "aragonite"):
        inactive = MEDIA[name]
        surface = wave_surface(inactive.active(1e-4 * np.eye(3)), "index")
        plain = wave_surface(inactive, "index")
        assert surface.contact_points.shape == (3, 0)
        assert (surface.outer.mode, surface.inner.mode) == ("slow", "fast")
        outer, inner = (np.linalg.norm(mesh.vertices, axis=0) for mesh in (surface.outer, surface.inner))
        gap = outer - inner
        mean = sum(float(n) for n in inactive.indices) / 3 if name == "aragonite" else float(inactive.indices[0])
        assert gap.min() == pytest.approx(1e-4 / mean, rel=0.03)
        np.testing.assert_array_equal(surface.outer.triangles, plain.outer.triangles)
        for mesh, wave in zip(
            (surface.outer, surface.inner),
            waves_along(inactive.active(1e-4 * np.eye(3)), surface.outer.vertices / outer),
            strict=True,
        ):
            np.testing.assert_allclose(mesh.vertices, wave.k, rtol=0, atol=1e-14)
        assert np.abs(surface.outer.vertices - plain.outer.vertices).max() < 5e-5


def test_without_gyration_along_the_axis_the_sheets_touch() -> None:
    """Only G along the axis parts them."""
    along = Medium.uniaxial(1.6584, 1.4864, (0, 0, 1)).active(np.diag((1e-4, 1e-4, 0.0)))
    assert wave_surface(along, "index").contact_points.shape == (3, 2)


@pytest.mark.parametrize("kind", KINDS)
def test_the_contacts_are_shared_to_the_bit_in_any_medium(kind: SurfaceKind) -> None:
    rng = np.random.default_rng(1)
    for turn in range(100):
        axes, n = np.linalg.qr(rng.normal(size=(3, 3)))[0], rng.uniform(1.3, 2.5, 3)
        medium = Medium.biaxial(n, axes) if turn % 2 else Medium.uniaxial(n[0], n[1], axes[0])
        surface = wave_surface(medium, kind, 2)
        for sheet in (surface.outer, surface.inner):
            vertices = {tuple(p) for p in sheet.vertices.T}
            assert all(tuple(p) in vertices for p in surface.contact_points.T)
