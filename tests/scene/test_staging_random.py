"""Whatever can be written down is staged or refused with a pointer; nothing else happens."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from crystal_core.errors import InputError, NotSupportedError
from crystal_core.scene import drawable, parse_scene, stage_scene
from tests.scene.strategies import Mapping, scenes

SLOW = settings(max_examples=80, deadline=None, suppress_health_check=list(HealthCheck))
FULL = settings(max_examples=1000, deadline=None, suppress_health_check=list(HealthCheck))


def check(mapping: Mapping) -> None:
    mapping = mapping | {"motion": None}
    scene = parse_scene(mapping, paths=True)
    try:
        staged = stage_scene(scene)
    except InputError as error:
        assert all(fault.message for fault in error.faults)
        assert all(
            fault.pointer.startswith(("/bodies/", "/surfaces/", "/lights/", "/camera", "/sheets/"))
            for fault in error.faults
        )
        return
    except NotSupportedError:
        return
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
    try:
        drawable(staged)
    except NotSupportedError as error:
        assert str(error).startswith("/")


@SLOW
@given(scenes())
def test_a_random_scene_is_staged_or_refused(mapping: Mapping) -> None:
    check(mapping)


@pytest.mark.full
@FULL
@given(scenes())
def test_many_random_scenes(mapping: Mapping) -> None:
    check(mapping)
