"""Frames: tiles that cover, bits that repeat, angles, and a manifest that repeats the geometry."""

import json
import random

import numpy as np
import pytest

import minerals_db
from crystal_core.sequence import (
    FrameRecord,
    RenderRequest,
    assemble,
    frame_angle_deg,
    manifest,
    parse_request,
    render_tile,
    tile_grid,
)


def _request(**more: object) -> RenderRequest:
    return parse_request(
        {"demonstration": "rotating-calcite", "size": [150, 70], "quality": "draft", "frames": 8, **more}
    )


@pytest.mark.parametrize("quality", ["draft", "standard", "fine"])
@pytest.mark.parametrize("size", [(16, 16), (150, 70), (513, 64)])
def test_tiles_cover_the_frame_once(quality: str, size: tuple[int, int]) -> None:
    counted = np.zeros(size[::-1], int)
    for tile in tile_grid(_request(size=size, quality=quality)):
        counted[tile.y0 : tile.y1, tile.x0 : tile.x1] += 1
    assert (counted == 1).all()


def test_frames_do_not_depend_on_the_order_of_the_tiles() -> None:
    request = _request()
    order = list(range(len(tile_grid(request))))
    results = [render_tile(request, 3, tile) for tile in order]
    random.Random(0).shuffle(order)
    again = [render_tile(request, 3, tile) for tile in order]
    first, second = assemble(request, results), assemble(request, again)
    np.testing.assert_array_equal(first.linear, second.linear)
    assert first.error_estimate == second.error_estimate
    with pytest.raises(ValueError, match="make no frame"):
        assemble(request, results[1:])


def test_angles() -> None:
    request = _request(frames=12, parameters={"first_angle_deg": 10.0})
    assert [frame_angle_deg(request, i) for i in (0, 1, 11)] == [10.0, 40.0, 340.0]


def test_a_frame_at_an_angle_is_the_frame_of_a_sequence() -> None:
    """One frame asked for by its angle shows what the sequence shows there."""
    turning = _request(frames=4)
    alone = _request(frames=1, parameters={"first_angle_deg": 90.0})
    pictures = [
        assemble(request, [render_tile(request, frame, i) for i in range(len(tile_grid(request)))]).linear
        for request, frame in ((turning, 1), (alone, 0))
    ]
    # The same scene with other random numbers: they differ by noise, nowhere by structure.
    assert np.sqrt(np.mean((pictures[0] - pictures[1]) ** 2)) < 0.06


def test_manifest_repeats_the_geometry() -> None:
    request = _request(parameters={"marks": [[1.0, -2.0]], "analyser_deg": 30.0})
    record = FrameRecord(1, 45.0, "frame-0001.png", "0" * 64, 0.5, 0.01, 0.125)
    told = manifest(request, [record], complete=False)
    assert json.loads(json.dumps(told)) == told
    scene = told["scene"]
    assert scene["half_size_mm"] == [10.0, 10.0]
    assert (scene["z0_mm"], scene["z1_mm"]) == pytest.approx((0.02, 12.02))
    assert scene["page_z_mm"] == 0.0
    assert scene["marks_mm"] == [[1.0, -2.0]]
    axis = np.array(scene["optic_axis"])
    assert np.rad2deg(np.arccos(axis[2])) == pytest.approx(44.64)
    calcite = minerals_db.mineral("calcite")
    assert scene["n_o"] == float(calcite.dispersion["o"].index(589.3))
    assert scene["n_e"] == float(calcite.dispersion["e"].index(589.3))
    assert told["frames"] == [
        {
            "index": 1,
            "angle_deg": 45.0,
            "file": "frame-0001.png",
            "sha256": "0" * 64,
            "seconds": 0.5,
            "error_estimate": 0.01,
            "clipped_fraction": 0.125,
        }
    ]
    assert told["error_estimate"] == 0.01
    assert told["reproducible"] is True
    assert told["complete"] is False
    camera = told["camera"]
    assert np.linalg.norm(np.subtract(camera["eye_mm"], camera["target_mm"])) == pytest.approx(170.0)


def test_cleavage_rhombohedron() -> None:
    """Its axis comes from the cell; the manifest gives its faces instead of half sizes."""
    request = _request(parameters={"cut": "cleavage", "axis_tilt_deg": 10.0})
    scene = manifest(request, [], complete=False)["scene"]
    assert "half_size_mm" not in scene
    assert np.rad2deg(np.arccos(scene["optic_axis"][2])) == pytest.approx(44.64, abs=0.01)
    assert len(scene["faces"]) == 6
    assert min(v[2] for v in scene["vertices_mm"]) == pytest.approx(0.02)
