"""What the probe of an interface answers: the physics, the conventions of its numbers, each by itself."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import minerals_db
from crystal_core.errors import InputError, NotSupportedError
from crystal_core.materials import gyration, principal_indices
from service.probes.interface import INTERFACE, InterfaceAnswer
from service.probes.probe import encode
from tests.service.interface_questions import CALCITE, activated, any_question, turned

Complex = NDArray[np.complex128]

KINDS = list(itertools.product((1, 2, 3), (1, 2, 3)))
IDENTITY = np.eye(3).tolist()


def field(wave: dict[str, Any]) -> Complex:
    return np.array(wave["field"]) @ (1, 1j)


def magnetic(wave: dict[str, Any]) -> Complex:
    return np.cross(np.array(wave["k"]) + 1j * np.array(wave.get("k_imag", (0, 0, 0))), field(wave))


def of_kind(answer: dict[str, Any], kind: str) -> dict[str, dict[str, Any]]:
    return {wave["mode"]: wave for wave in answer["scattered"] if wave["kind"] == kind}


def answered(
    rng: np.random.Generator, source: int, target: int, count: int
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Return questions and answers; what no wave of `from` can bring in is left out."""
    found = []
    for _ in range(count):
        question = any_question(rng, source, target)
        (answer,) = INTERFACE.compute([INTERFACE.request.model_validate(question)])
        if isinstance(answer, dict):
            found.append((question, answer))
        else:
            assert source > 1
            assert str(answer) == "/tangential_k: no wave of `from` propagates with this tangential wave vector"
    return found


def test_the_textbook_question() -> None:
    answer = INTERFACE.ask(CALCITE)
    assert [wave["mode"] for wave in answer["incident"]] == ["s", "p"]
    assert [(wave["kind"], wave["mode"]) for wave in answer["scattered"]] == [
        ("transmitted", "ordinary"),
        ("transmitted", "extraordinary"),
        ("reflected", "s"),
        ("reflected", "p"),
    ]
    # Three independent programs agree on these; see tests/reference/test_golden_interface.py.
    into = of_kind(answer, "transmitted")
    np.testing.assert_allclose(into["ordinary"]["k"], (0.5, 0, 1.581230710554), atol=1e-11)
    np.testing.assert_allclose(into["ordinary"]["ray"], (0.301495417, 0, 0.953467626), atol=1e-9)
    np.testing.assert_allclose(into["extraordinary"]["k"], (0.5, 0, 1.529032971460), atol=1e-11)
    assert into["extraordinary"]["index"] == pytest.approx(1.608708123872, abs=1e-11)
    np.testing.assert_allclose(
        into["extraordinary"]["ray"], (0.241182822203, -0.069889615624, 0.967959858621), atol=1e-11
    )
    np.testing.assert_allclose(into["ordinary"]["power"], (0.477826885719, 0.458064137860), atol=1e-11)
    np.testing.assert_allclose(into["extraordinary"]["power"], (0.440721750006, 0.508099751736), atol=1e-11)
    back = of_kind(answer, "reflected")
    np.testing.assert_allclose(back["s"]["power"], (0.0811628663, 0.0000623979), atol=1e-9)
    np.testing.assert_allclose(back["p"]["power"], (0.000288497951, 0.0337737125), atol=1e-9)
    assert {wave["absorption_per_mm"] for wave in answer["scattered"]} == {0.0}


@pytest.mark.parametrize(("source", "target"), KINDS)
def test_fields_join_at_the_face_and_energy_is_kept(source: int, target: int) -> None:
    rng = np.random.default_rng((source, target))
    single = evanescent = 0
    for question, answer in answered(rng, source, target, 120):
        normal = np.array(question["normal"])
        single += len(answer["incident"]) == 1
        for j, incident in enumerate(answer["incident"]):
            jump_e, jump_h = field(incident), magnetic(incident)
            for wave in answer["scattered"]:
                share = complex(*wave["amplitude"][j]) * (1 if wave["kind"] == "reflected" else -1)
                jump_e = jump_e + share * field(wave)
                jump_h = jump_h + share * magnetic(wave)
            assert np.abs(np.cross(normal, jump_e)).max() < 1e-11
            assert np.abs(np.cross(normal, jump_h)).max() < 1e-11
            assert sum(wave["power"][j] for wave in answer["scattered"]) == pytest.approx(1, abs=1e-12)
            flux = np.cross(field(incident), magnetic(incident).conj()).real @ normal
            for wave in answer["scattered"]:
                size = abs(complex(*wave["amplitude"][j])) ** 2
                out = abs(np.cross(field(wave), magnetic(wave).conj()).real @ normal)
                assert wave["power"][j] == pytest.approx(0 if wave["evanescent"] else size * out / flux, abs=1e-10)
        for wave in answer["scattered"]:
            evanescent += wave["evanescent"]
            out = 1 if wave["kind"] == "transmitted" else -1
            if wave["evanescent"]:
                assert np.array(wave["k_imag"]) @ normal * out > 0
                assert wave["power"] == [0.0] * len(answer["incident"])
                assert wave["ray"] is wave["index"] is wave["absorption_per_mm"] is None
            else:
                assert np.abs(wave["k_imag"]).max() < 1e-14
                assert np.array(wave["ray"]) @ normal * out >= 0
                assert wave["index"] == pytest.approx(np.linalg.norm(wave["k"]), abs=1e-14)
                flow = np.cross(field(wave), magnetic(wave).conj()).real
                np.testing.assert_allclose(wave["ray"], flow / np.linalg.norm(flow), atol=1e-11)
    assert evanescent > 5  # or the test has not seen what it is about
    assert (single > 5) == (source > 1)


@pytest.mark.parametrize(("source", "target"), KINDS)
def test_every_wave_obeys_the_wave_equation_of_its_medium(source: int, target: int) -> None:
    rng = np.random.default_rng((7, source, target))
    for question, answer in answered(rng, source, target, 40):
        for wave in answer["incident"] + answer["scattered"]:
            medium = question["to" if wave.get("kind") == "transmitted" else "from"]
            indices = medium["indices"]
            principal = {1: indices * 3, 2: [indices[0], *indices], 3: indices}[len(indices)]
            axes = np.array(medium.get("axes", IDENTITY))
            epsilon = axes.T @ np.diag(np.square(principal)) @ axes
            k = np.array(wave["k"]) + 1j * np.array(wave.get("k_imag", (0, 0, 0)))
            np.testing.assert_allclose(np.cross(k, magnetic(wave)), -epsilon @ field(wave), atol=1e-11)


@pytest.mark.parametrize(("source", "target"), KINDS)
def test_fields_have_the_phase_that_was_promised(source: int, target: int) -> None:
    rng = np.random.default_rng((3, source, target))
    for _, answer in answered(rng, source, target, 40):
        for wave in answer["incident"] + answer["scattered"]:
            e = field(wave)
            largest = e[np.argmax(np.abs(e))]
            assert largest.imag == 0
            assert largest.real > 0
            assert np.linalg.norm(e) == pytest.approx(1, abs=1e-14)


def test_s_is_across_the_plane_of_incidence() -> None:
    rng = np.random.default_rng(5)
    for question, answer in answered(rng, 1, 1, 50):
        across = np.cross(question["normal"], question["wave_normal"])
        for wave in answer["incident"] + answer["scattered"]:
            along = abs(field(wave) @ across) / np.linalg.norm(across)
            assert along == pytest.approx(1 if wave["mode"] == "s" else 0, abs=1e-12)


@pytest.mark.parametrize("source", [1, 2, 3])
def test_modes_are_named_by_their_medium(source: int) -> None:
    names = {1: {"s", "p"}, 2: {"ordinary", "extraordinary"}, 3: {"slow", "fast"}}
    rng = np.random.default_rng((9, source))
    for target in (1, 2, 3):
        for _, answer in answered(rng, source, target, 20):
            assert {wave["mode"] for wave in answer["incident"]} <= names[source]
            assert set(of_kind(answer, "reflected")) <= names[source]
            assert set(of_kind(answer, "transmitted")) <= names[target]


@pytest.mark.parametrize("absorbing", [False, True])
def test_an_answer_does_not_depend_on_the_others(absorbing: bool) -> None:
    rng = np.random.default_rng(11)
    questions = [any_question(rng, *KINDS[n % 9], absorbing=absorbing) for n in range(400)]
    requests = [INTERFACE.request.model_validate(question) for question in questions]
    together = INTERFACE.compute(requests)
    for request, answer in zip(requests, together, strict=True):
        (alone,) = INTERFACE.compute([request])
        if isinstance(answer, dict):
            assert isinstance(alone, dict)
            assert encode(alone) == encode(answer)
        else:
            assert str(alone) == str(answer)
    assert sum(isinstance(answer, InputError) for answer in together) > 5


@pytest.mark.parametrize(("source", "target"), KINDS)
@pytest.mark.parametrize("active", [("from",), ("to",), ("from", "to")])
def test_active_media_join_too(source: int, target: int, active: tuple[str, ...]) -> None:
    rng = np.random.default_rng((17, source, target, len(active)))
    answers = 0
    for _ in range(40):
        question = any_question(rng, source, target)
        question |= {side: activated(rng, question[side]) for side in active}
        (answer,) = INTERFACE.compute([INTERFACE.request.model_validate(question)])
        if not isinstance(answer, dict):
            continue
        answers += 1

        def h(wave: dict[str, Any], side: str) -> Complex:
            medium = question[side]  # noqa: B023
            if "gyration" not in medium:
                return magnetic(wave)
            axes, indices = np.array(medium["axes"]), medium["indices"]
            g = axes.T @ np.diag(medium["gyration"]) @ axes
            kappa = (0.5 * np.trace(g) * np.eye(3) - g) / (np.mean(indices) if len(indices) == 3 else indices[0])
            return magnetic(wave) + 1j * kappa @ field(wave)

        normal = np.array(question["normal"])
        for j, incident in enumerate(answer["incident"]):
            jump_e, jump_h = field(incident), h(incident, "from")
            for wave in answer["scattered"]:
                reflected = wave["kind"] == "reflected"
                share = complex(*wave["amplitude"][j]) * (1 if reflected else -1)
                jump_e = jump_e + share * field(wave)
                jump_h = jump_h + share * h(wave, "from" if reflected else "to")
            assert np.abs(np.cross(normal, jump_e)).max() < 1e-10
            assert np.abs(np.cross(normal, jump_h)).max() < 1e-10
            assert sum(wave["power"][j] for wave in answer["scattered"]) == pytest.approx(1, abs=1e-12)
        for wave in answer["scattered"]:
            if ("to" if wave["kind"] == "transmitted" else "from") in active:
                assert wave["mode"] in {"slow", "fast"}
    assert answers > 20


def test_quartz_turns_light_along_its_axis_to_the_right_or_left() -> None:
    entry = minerals_db.mineral("quartz")
    quartz = {
        "indices": [index[0] for index in principal_indices(entry, np.array([589.3]))],
        "axes": IDENTITY,
        "gyration": gyration(entry, np.array([589.3]))[..., 0].tolist(),
    }
    answer = INTERFACE.ask({**CALCITE, "wave_normal": [0, 0, 1], "to": quartz})
    into = of_kind(answer, "transmitted")
    # ρ = π (n_slow − n_fast)/λ: 21.7°/mm at the D line, in every textbook.
    turn = 180 * (into["slow"]["index"] - into["fast"]["index"]) / 589.3e-6
    assert turn == pytest.approx(21.7, abs=0.1)
    for wave in into.values():
        x, y, z = field(wave)
        assert abs(z) < 1e-12
        assert abs(x) == pytest.approx(abs(y), abs=1e-6)
        assert abs(np.cos(np.angle(x / y))) < 1e-6
    # Dextro quartz: clockwise to whoever faces the source, so the fast wave is the clockwise one, (1, -i).
    assert (field(into["fast"])[1] / field(into["fast"])[0]).imag == pytest.approx(-1, abs=1e-6)


def test_a_named_mineral_has_linear_modes_at_a_face() -> None:
    answer = INTERFACE.ask({**CALCITE, "to": {"mineral": "quartz"}})
    into = of_kind(answer, "transmitted")
    assert set(into) == {"ordinary", "extraordinary"}
    assert into["ordinary"]["index"] == pytest.approx(1.5442, abs=1e-4)
    assert all(component[1] == 0 for wave in into.values() for component in wave["field"])


def test_absorption_is_that_along_the_ray() -> None:
    question = {**CALCITE, "wave_normal": [0, 0, 1]}
    # The optic axis across the normal: each wave vibrates along a principal direction.
    question["to"] = {"indices": [1.6584, 1.4864], "axes": IDENTITY, "absorption_per_mm": [1, 2, 4]}
    question["normal"] = question["wave_normal"] = [1, 0, 0]
    into = of_kind(INTERFACE.ask(question), "transmitted")
    assert into["ordinary"]["absorption_per_mm"] == pytest.approx(2)  # vibrates along y
    assert into["extraordinary"]["absorption_per_mm"] == pytest.approx(4)
    question["to"]["absorption_axes"] = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    into = of_kind(INTERFACE.ask(question), "transmitted")
    assert into["ordinary"]["absorption_per_mm"] == pytest.approx(4)
    assert into["extraordinary"]["absorption_per_mm"] == pytest.approx(1)
    question["to"] = {"indices": [1.5], "absorption_per_mm": [3, 3, 3]}
    answer = INTERFACE.ask(question)
    assert [wave["absorption_per_mm"] for wave in answer["scattered"]] == [3.0, 3.0, 0.0, 0.0]


def test_a_mineral_is_its_indices_turned() -> None:
    rotation = turned(np.random.default_rng(1))
    for mineral in ("calcite", "fluorite", "aragonite"):
        indices = [float(n) for n in principal_indices(minerals_db.mineral(mineral), 500.0)]
        inline = {"indices": indices, "axes": rotation.T.tolist()}
        named = {"mineral": mineral, "rotation": rotation.tolist()}
        by_name, by_index = (INTERFACE.ask({**CALCITE, "wavelength_nm": 500.0, "to": to}) for to in (named, inline))
        for one, other in zip(by_name["scattered"], by_index["scattered"], strict=True):
            for key in ("k", "ray", "power", "field", "amplitude"):
                np.testing.assert_allclose(one[key], other[key], atol=1e-12)


def test_grazing_normal_and_critical_incidence() -> None:
    glass = {"indices": [1.33]}
    for source, target in ((glass, {"indices": [1.0]}), ({"indices": [1.0]}, CALCITE["to"])):
        for azimuth in np.linspace(0, 7, 30):
            sideways = np.array([np.cos(azimuth), np.sin(azimuth), 0])
            for steepness in (1.0, 1e-5, 1e-12, 1e-15, 1e-300, (1 - 1 / 1.33**2) ** 0.5):
                wave_normal = (sideways * (1 - steepness**2) ** 0.5 + [0, 0, steepness]).tolist()
                answer = INTERFACE.ask({**CALCITE, "from": source, "to": target, "wave_normal": wave_normal})
                assert len(answer["incident"]) == 2
                for j in (0, 1):
                    assert sum(wave["power"][j] for wave in answer["scattered"]) == pytest.approx(1, abs=1e-9)


def test_equal_media_in_contact_are_no_face() -> None:
    calcite = CALCITE["to"]
    question = {**CALCITE, "from": calcite, "to": calcite, "tangential_k": [0.4, 0.1, 0.0]}
    del question["wave_normal"]
    answer = INTERFACE.ask(question)
    into = of_kind(answer, "transmitted")
    np.testing.assert_allclose([into["ordinary"]["power"], into["extraordinary"]["power"]], np.eye(2), atol=1e-14)


def test_an_answer_is_as_the_description_says() -> None:
    rng = np.random.default_rng(13)
    for source, target in KINDS:
        for _, answer in answered(rng, source, target, 5):
            model = InterfaceAnswer.model_validate(answer, strict=False)
            assert set(answer) == {"incident", "scattered"}
            assert all(set(wave) == {"mode", "k", "ray", "index", "field"} for wave in answer["incident"])
            assert model.model_dump(mode="json") == answer


def test_what_the_optics_cannot_do_is_told_by_them(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuses(*_: object) -> None:
        raise NotSupportedError("no light today")

    monkeypatch.setattr("service.probes.scattering.scatter", refuses)
    with pytest.raises(NotSupportedError, match="no light today"):
        INTERFACE.ask(CALCITE)
