"""The names by which parts of a scene speak of others: each must stand for something that can do what is asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from crystal_core.scene.motions import Move, Shift, TurnMotion
from crystal_core.scene.parts import Location

if TYPE_CHECKING:
    from crystal_core.scene.document import SceneDocument

__all__ = ["reference_faults"]

Faults = Iterator[tuple[Location, str]]


def reference_faults(scene: SceneDocument) -> Faults:
    """Yield the names in bodies and motions that stand for nothing, or for something unfit."""
    yield from _resting_faults(scene)
    for key in ("inside", "joined_to"):
        for name, body in scene.bodies.items():
            other = getattr(body, key)
            if other is not None and other not in scene.bodies:
                yield ("bodies", name, key), _unknown(other, "body", list(scene.bodies))
    yield from _circles(scene)
    yield from _motion_faults(scene)


def _resting_faults(scene: SceneDocument) -> Faults:
    for name, body in scene.bodies.items():
        under = body.rests_on
        if under is None:
            continue
        place = ("bodies", name, "rests_on")
        surface = scene.surfaces.get(under)
        if surface is not None:
            if any(abs(c) > 1e-9 for c in surface.facing[:2]):
                yield place, f"{under} is not horizontal: give position_mm"
        elif under not in scene.bodies:
            yield place, _unknown(under, "surface or body", [*scene.surfaces, *scene.bodies])


def _circles(scene: SceneDocument) -> Faults:
    """Yield the bodies whose place depends on itself."""
    for name, body in scene.bodies.items():
        seen, at = {name}, body.depends_on
        while at is not None and at in scene.bodies and at not in seen:
            seen.add(at)
            at = scene.bodies[at].depends_on
        if at == name:
            key = next(key for key in ("rests_on", "inside", "joined_to") if getattr(body, key) is not None)
            yield ("bodies", name, key), f"goes in a circle back to {name}"


def _motion_faults(scene: SceneDocument) -> Faults:
    if scene.motion is None:
        return
    taken: dict[tuple[str, str], int] = {}
    for number, move in enumerate(scene.motion.moves):
        place: Location = ("motion", "moves", number, move.kind)
        check: Callable[[SceneDocument, Move, Location], Faults] = _CHECKS[move.kind]
        yield from check(scene, move, place)
        subject = _subject(move)
        if (move.kind, subject) in taken:
            yield place, f"the same is said by /motion/moves/{taken[move.kind, subject]}"
        taken.setdefault((move.kind, subject), number)


def _subject(move: Move) -> str:
    part = getattr(move, move.kind)
    return str(getattr(part, "what", getattr(part, "of", "")))


def _turn_faults(scene: SceneDocument, move: Move, place: Location) -> Faults:
    turn = move.turn
    assert isinstance(turn, TurnMotion)
    if turn.what in scene.sheets:
        if turn.about is not None:
            yield (*place, "about"), "does not go with a sheet: it turns about its normal"
    elif turn.what in scene.lights:
        light = scene.lights[turn.what]
        if light.kind in {"point", "sky"}:
            yield (*place, "what"), f"{turn.what} shines alike in all directions: turning it changes nothing"
        elif turn.about is None:
            yield (*place, "about"), "required for a light"
    elif turn.what not in scene.bodies:
        known = [*scene.bodies, *scene.sheets, *scene.lights]
        yield (*place, "what"), _unknown(turn.what, "body, sheet or light", known)


def _shift_faults(scene: SceneDocument, move: Move, place: Location) -> Faults:
    shift = move.shift
    assert isinstance(shift, Shift)
    what = (*place, "what")
    if shift.what in scene.bodies:
        if scene.bodies[shift.what].rests_on is not None:
            yield what, f"{shift.what} rests on {scene.bodies[shift.what].rests_on}: give its position_mm instead"
    elif shift.what in scene.lights:
        if scene.lights[shift.what].sky is not None:
            yield what, "the sky stands nowhere"
    elif shift.what not in scene.surfaces and shift.what not in scene.sheets:
        known = [*scene.bodies, *scene.surfaces, *scene.sheets, *scene.lights]
        yield what, _unknown(shift.what, "body, surface, sheet or light", known)


def _stage_faults(scene: SceneDocument, move: Move, place: Location) -> Faults:
    assert move.stage is not None
    if not scene.bodies and all(sheet.plate is None for sheet in scene.sheets.values()):
        yield place, "there is no body and no plate on the stage"


def _analyser_faults(scene: SceneDocument, move: Move, place: Location) -> Faults:
    assert move.analyser is not None
    if scene.camera.analyser_deg is None:
        yield place, "the camera has no analyser: give /camera/analyser_deg"


def _wavelength_faults(scene: SceneDocument, move: Move, place: Location) -> Faults:
    assert move.wavelength is not None
    name = move.wavelength.of
    if name not in scene.lights:
        yield (*place, "of"), _unknown(name, "light", list(scene.lights))
        return
    spectrum = scene.lights[name].spectrum
    if isinstance(spectrum, str) or spectrum.lines is None or len(spectrum.lines) != 1:
        yield (*place, "of"), f"{name} must have a spectrum of one line"


_CHECKS: dict[str, Callable[[SceneDocument, Move, Location], Faults]] = {
    "turn": _turn_faults,
    "shift": _shift_faults,
    "stage": _stage_faults,
    "analyser": _analyser_faults,
    "wavelength": _wavelength_faults,
}


def _unknown(name: str, what: str, known: list[str]) -> str:
    return f"no {what} {name!r}; " + (f"there are {', '.join(known)}" if known else "there is none")
