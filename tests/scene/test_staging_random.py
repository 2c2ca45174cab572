"""Whatever can be written down is staged or refused with a pointer; nothing else happens."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from crystal_core.errors import Fault, InputError, NotSupportedError
from crystal_core.scene import StagedDocument, drawable, parse_scene, stage_scene
from tests.scene.strategies import Mapping, scenes

SLOW = settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
FULL = settings(max_examples=1000, deadline=None, suppress_health_check=list(HealthCheck))

PLACES = ("/bodies/", "/surfaces/", "/lights/", "/camera", "/sheets/")


def outcome(mapping: Mapping) -> StagedDocument | tuple[Fault, ...] | None:
    """Return the staged scene, its faults, or None where something is not supported."""
    try:
        return stage_scene(parse_scene(mapping | {"motion": None}, paths=True))
    except InputError as error:
        return error.faults
    except NotSupportedError:
        return None


def check(mapping: Mapping) -> bool:
    """Check one scene; tell whether it was staged."""
    staged = outcome(mapping)
    if not isinstance(staged, StagedDocument):
        assert all(fault.message and fault.pointer.startswith(PLACES) for fault in staged or ())
        return False
    for body in staged.bodies:
        medium = staged.media[body.medium]
        assert np.allclose(medium.rotation @ medium.rotation.T, np.eye(3), atol=1e-9)
        assert np.linalg.det(medium.rotation) > 0
        assert medium.at([450.0, 650.0]).indices[0].shape == (2,)
        assert len(body.outside) == len(body.solid.labels) == len(body.neighbour)
        assert np.isfinite(body.solid.body.vertices).all()
    view = staged.camera
    frame = np.stack((view.right, view.up, -view.forward))
    assert np.allclose(frame @ frame.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame) > 0
    refused = ""
    try:
        drawable(staged)
    except NotSupportedError as error:
        refused = str(error)
    assert not refused or refused.startswith("/")
    return True


@SLOW
@given(scenes())
def test_a_random_scene_is_staged_or_refused(mapping: Mapping) -> None:
    check(mapping)


@pytest.mark.full
@FULL
@given(scenes())
def test_many_random_scenes(mapping: Mapping) -> None:
    check(mapping)


def test_many_of_them_are_staged() -> None:
    seen: list[bool] = []

    @settings(max_examples=100, deadline=None, database=None, derandomize=True, suppress_health_check=list(HealthCheck))
    @given(scenes())
    def collect(mapping: Mapping) -> None:
        seen.append(check(mapping))

    collect()
    assert 0.05 < sum(seen) / len(seen) < 1.0
