"""The minerals' optical constants against figures from sources other than those of their coefficients.

Figures "from memory" are standard values of textbooks that were not looked up again. Minerals whose curve is made from
such a figure (`one-term`) cannot be compared with it, and varieties have the curves of their species.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

import minerals_db

THERE = {entry: minerals_db.mineral(entry) for entry in minerals_db.minerals()}
D, F, C, E = 589.3, 486.1, 656.3, 546.1
HELIUM_D = 587.56

# mineral, axis, nm, index, tolerance, where the index comes from
FIGURES = [
    # Our coefficients: Ghosh 1999, whose fit runs 3e-4 under Martens for the e ray.
    ("calcite", "o", D, 1.65835, 5e-5, "F. F. Martens, Ann. Phys. 6, 603 (1901); from memory"),
    ("calcite", "e", D, 1.48640, 3e-4, "F. F. Martens, Ann. Phys. 6, 603 (1901); from memory"),
    ("calcite", "o", D, 1.658, 5e-4, "Handbook of Mineralogy (2001-2005)"),
    ("calcite", "e", D, 1.486, 5e-4, "Handbook of Mineralogy (2001-2005)"),
    ("adp", "o", D, 1.5246, 8e-4, "classical value of crystals of ammonium dihydrogen phosphate; from memory"),
    ("adp", "e", D, 1.4792, 8e-4, "classical value of crystals of ammonium dihydrogen phosphate; from memory"),
    # Our coefficients: Ghosh 1999.
    ("quartz", "o", D, 1.54424, 5e-5, "classical textbook value; from memory"),
    ("quartz", "e", D, 1.55335, 6e-5, "classical textbook value; from memory"),
    ("quartz", "o", F, 1.54968, 5e-5, "T. Radhakrishnan, Proc. Indian Acad. Sci. 31, 22 (1951), his formula"),
    ("quartz", "e", F, 1.55897, 5e-5, "T. Radhakrishnan, Proc. Indian Acad. Sci. 31, 22 (1951), his formula"),
    ("quartz", "o", C, 1.54189, 6e-5, "T. Radhakrishnan, Proc. Indian Acad. Sci. 31, 22 (1951), his formula"),
    ("quartz", "e", C, 1.55093, 8e-5, "T. Radhakrishnan, Proc. Indian Acad. Sci. 31, 22 (1951), his formula"),
    # Our coefficients: Malitson and Dodge 1972 (synthetic).
    ("corundum", "o", D, 1.768, 5e-4, "gemmological constant of sapphire (Schumann, Gemstones of the World)"),
    ("corundum", "e", D, 1.760, 5e-4, "gemmological constant of sapphire (Schumann, Gemstones of the World)"),
    # Our coefficients: Peter 1923.
    ("diamond", "n", D, 2.4175, 5e-4, "Handbook of Mineralogy: 2.4175 to 2.4178; from memory"),
    # Our coefficients: Malitson 1963.
    ("fluorite", "n", D, 1.43385, 6e-5, "classical textbook value; from memory"),
    ("fluorite", "n", F, 1.43705, 5e-5, "M. Daimon, A. Masumura, Appl. Opt. 41, 5275 (2002), 20 °C"),
    ("fluorite", "n", E, 1.43497, 5e-5, "M. Daimon, A. Masumura, Appl. Opt. 41, 5275 (2002), 20 °C"),
    ("fluorite", "n", C, 1.43249, 5e-5, "M. Daimon, A. Masumura, Appl. Opt. 41, 5275 (2002), 20 °C"),
    # Our coefficients: Li 1976.
    ("halite", "n", D, 1.5443, 3e-4, "classical textbook value; from memory"),
    ("halite", "n", F, 1.5541, 1.2e-3, "B. Powell in A. Beer, Einleitung in die höhere Optik (1853), p. 255"),
    ("halite", "n", C, 1.5415, 1.2e-3, "B. Powell in A. Beer, Einleitung in die höhere Optik (1853), p. 255"),
    # Our coefficients: Li 1976.
    ("sylvite", "n", D, 1.4903, 5e-5, "Handbook of Mineralogy (2001-2005)"),
    # Our coefficients: Dodge 1984 (synthetic).
    ("sellaite", "o", D, 1.378, 5e-4, "Handbook of Mineralogy (2001-2005)"),
    ("sellaite", "e", D, 1.390, 5e-4, "Handbook of Mineralogy (2001-2005)"),
    # Our table: a natural gem (Karnke); theirs: synthetic.
    (
        "spinel",
        "n",
        430.8,
        1.73149,
        3e-4,
        "W. J. Tropf, M. E. Thomas in Palik, Handbook of Optical Constants II (1991)",
    ),
    ("spinel", "n", F, 1.72440, 3e-4, "W. J. Tropf, M. E. Thomas in Palik, Handbook of Optical Constants II (1991)"),
    ("spinel", "n", E, 1.71903, 3e-4, "W. J. Tropf, M. E. Thomas in Palik, Handbook of Optical Constants II (1991)"),
    ("spinel", "n", D, 1.71610, 3e-4, "W. J. Tropf, M. E. Thomas in Palik, Handbook of Optical Constants II (1991)"),
    ("spinel", "n", C, 1.71260, 3e-4, "W. J. Tropf, M. E. Thomas in Palik, Handbook of Optical Constants II (1991)"),
    # Our coefficients: Devore 1951.
    ("rutile", "o", 500.0, 2.7058, 9e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    ("rutile", "o", 600.0, 2.6034, 3e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    ("rutile", "o", 700.0, 2.5514, 3e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    ("rutile", "e", 600.0, 2.8900, 9e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    ("rutile", "e", 700.0, 2.8255, 9e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    # Our coefficients: Uchida 1971.
    ("paratellurite", "o", E, 2.2931, 1e-3, "Elent-A, basic properties of TeO2"),
    ("paratellurite", "o", 632.8, 2.2597, 1e-3, "Elent-A, basic properties of TeO2"),
    ("paratellurite", "e", E, 2.4520, 1e-3, "Elent-A, basic properties of TeO2"),
    ("paratellurite", "e", 632.8, 2.4119, 1e-3, "Elent-A, basic properties of TeO2"),
    # Our coefficients: Debenham 1984.
    ("sphalerite", "n", 500.0, 2.4208, 4e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    ("sphalerite", "n", 600.0, 2.3640, 2e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    ("sphalerite", "n", 700.0, 2.3333, 2e-3, "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)"),
    # Our tables: Rudberg 1828-31.
    ("aragonite", "c", D, 1.5295, 1e-3, "mindat.org, Aragonite"),
    ("aragonite", "a", D, 1.6810, 1e-3, "mindat.org, Aragonite"),
    ("aragonite", "b", D, 1.6855, 1e-3, "mindat.org, Aragonite"),
    # Our coefficients: synthetic alexandrite, pure but for chromium; theirs: natural, with iron, which raises indices.
    ("chrysoberyl", "c", D, 1.745, 6e-3, "Wikipedia, Chrysoberyl, after handbooks"),
    ("chrysoberyl", "a", D, 1.748, 6e-3, "Wikipedia, Chrysoberyl, after handbooks"),
    ("chrysoberyl", "b", D, 1.754, 6e-3, "Wikipedia, Chrysoberyl, after handbooks"),
    # Our coefficients: Stephens and Malitson 1952 (synthetic).
    ("periclase", "n", D, 1.736, 2e-3, "Handbook of Mineralogy: 1.735 to 1.745; from memory"),
    # Our coefficients: Li 1976.
    ("villiaumite", "n", D, 1.327, 3e-3, "Handbook of Mineralogy; from memory"),
    # Our coefficients: Malitson 1964 (synthetic).
    ("frankdicksonite", "n", D, 1.475, 1e-3, "Handbook of Mineralogy; from memory"),
    # Our coefficients: Tilton, Plyler and Stephens 1950 (synthetic).
    ("chlorargyrite", "n", D, 2.071, 6e-3, "Handbook of Mineralogy; from memory"),
    # Our coefficients: Feldman and Horowitz 1969 (synthetic); theirs: natural, soft and oxidized.
    ("nantokite", "n", D, 1.93, 5e-2, "Handbook of Mineralogy; from memory"),
    # Our coefficients: Bond 1965, of synthetic crystals; theirs: gems and minerals.
    ("tausonite", "n", D, 2.41, 3e-3, "gemmological constant of strontium titanate; from memory"),
    ("scheelite", "o", D, 1.920, 2e-3, "Handbook of Mineralogy: 1.918 to 1.921; from memory"),
    ("scheelite", "e", D, 1.936, 2e-3, "Handbook of Mineralogy: 1.934 to 1.937; from memory"),
    ("powellite", "o", D, 1.974, 2.5e-2, "Handbook of Mineralogy, with tungsten; from memory"),
    ("powellite", "e", D, 1.984, 2.5e-2, "Handbook of Mineralogy, with tungsten; from memory"),
    ("wulfenite", "o", D, 2.405, 6e-3, "Handbook of Mineralogy; from memory"),
    ("wulfenite", "e", D, 2.283, 8e-3, "Handbook of Mineralogy; from memory"),
    ("zincite", "o", D, 2.013, 1.2e-2, "Handbook of Mineralogy, with manganese; from memory"),
    ("zincite", "e", D, 2.029, 1.2e-2, "Handbook of Mineralogy, with manganese; from memory"),
    # Our coefficients: those of synthetic crystals.
    ("greenockite", "o", D, 2.506, 3e-2, "Handbook of Mineralogy; from memory"),
    ("greenockite", "e", D, 2.529, 3e-2, "Handbook of Mineralogy; from memory"),
    ("moissanite", "o", D, 2.648, 2e-3, "gemmological constant of synthetic moissanite; from memory"),
    ("moissanite", "e", D, 2.691, 3e-3, "gemmological constant of synthetic moissanite; from memory"),
    ("bromellite", "o", D, 1.719, 2e-3, "Handbook of Mineralogy; from memory"),
    ("bromellite", "e", D, 1.733, 2e-3, "Handbook of Mineralogy; from memory"),
    ("berlinite", "o", D, 1.524, 2e-3, "Handbook of Mineralogy; from memory"),
    ("berlinite", "e", D, 1.533, 2e-3, "Handbook of Mineralogy; from memory"),
    ("lithium-niobate", "o", 632.8, 2.286, 4e-3, "makers of the crystal; from memory"),
    ("lithium-niobate", "e", 632.8, 2.203, 4e-3, "makers of the crystal; from memory"),
    ("yag", "n", D, 1.833, 1e-3, "gemmological constant; from memory"),
    ("cubic-zirconia", "n", D, 2.165, 1.5e-2, "gemmological constant: 2.15 to 2.18; from memory"),
    # Our coefficients: Malitson 1965. Makers have their own melts.
    ("fused-silica", "n", HELIUM_D, 1.45846, 3e-5, "Heraeus, data sheet of Suprasil; from memory"),
    ("fused-silica", "n", F, 1.46313, 3e-5, "Heraeus, data sheet of Suprasil; from memory"),
    ("fused-silica", "n", C, 1.45637, 3e-5, "Heraeus, data sheet of Suprasil; from memory"),
    # Our table: one pane; theirs: the mean of several.
    ("soda-lime-glass", "n", D, 1.5233, 3e-3, "M. Rubin, Sol. Energy Mater. 12, 275 (1985), his formula; from memory"),
    # Our coefficients: those of the maker, who states n_d beside them.
    ("glass-n-bk7", "n", HELIUM_D, 1.51680, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
    ("glass-f2", "n", HELIUM_D, 1.62004, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
    ("glass-sf6", "n", HELIUM_D, 1.80518, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
    ("glass-sf10", "n", HELIUM_D, 1.72825, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
    ("glass-sf11", "n", HELIUM_D, 1.78472, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
    ("glass-n-sf11", "n", HELIUM_D, 1.78472, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
    ("glass-n-lasf9", "n", HELIUM_D, 1.85025, 5.5e-6, "SCHOTT Zemax catalog 2017-01-20b"),
]


@pytest.mark.parametrize(
    ("mineral", "axis", "nm", "index", "tolerance", "source"), [row for row in FIGURES if row[0] in THERE]
)
def test_index(mineral: str, axis: str, nm: float, index: float, tolerance: float, source: str) -> None:
    found = float(minerals_db.mineral(mineral).dispersion[axis].index(nm))
    assert found == pytest.approx(index, abs=tolerance), source


# birefringence at the D line between two axes, and its tolerance, from a source other than our coefficients'
BIREFRINGENCE = [
    ("calcite", "eo", -0.17195, 3e-4, "Martens 1901; from memory"),
    ("quartz", "eo", 0.00911, 3e-5, "classical textbook value; from memory"),
    ("corundum", "eo", -0.008, 5e-4, "gemmological constant of sapphire (Schumann, Gemstones of the World)"),
    ("sellaite", "eo", 0.012, 5e-4, "Handbook of Mineralogy"),
    ("fluorapatite", "eo", -0.003, 1.5e-3, "The Gemology Project, Apatite: 0.003"),
    ("rutile", "eo", 0.292, 5e-3, "Handbook of Mineralogy: 2.605 to 2.613, 2.899 to 2.901"),
    ("paratellurite", "eo", 0.1557, 5e-4, "Elent-A at 589.3 nm: 2.2738, 2.4295"),
    ("aragonite", "bc", 0.156, 5e-4, "mindat.org, Aragonite: 1.5295, 1.6855"),
    ("topaz", "ca", 0.0095, 1.5e-3, "Mineralogía óptica, Topacio: 0.008 to 0.011"),
    ("chrysoberyl", "bc", 0.009, 1.5e-3, "Wikipedia, Chrysoberyl, after handbooks: 1.745, 1.754"),
]


@pytest.mark.parametrize(("mineral", "axes", "birefringence", "tolerance", "source"), BIREFRINGENCE)
def test_birefringence(mineral: str, axes: str, birefringence: float, tolerance: float, source: str) -> None:
    dispersion = minerals_db.mineral(mineral).dispersion
    found = float(dispersion[axes[0]].index(D) - dispersion[axes[1]].index(D))
    assert found == pytest.approx(birefringence, abs=tolerance), source


def test_fluorapatite_lies_where_apatites_do() -> None:
    # The Gemology Project, Apatite: 1.63 to 1.64.
    for curve in minerals_db.mineral("fluorapatite").dispersion.values():
        assert 1.63 < float(curve.index(D)) < 1.64


def test_topaz_lies_where_topazes_do() -> None:
    # Mineralogía óptica, Topacio.
    ranges = {"a": (1.606, 1.634), "b": (1.609, 1.637), "c": (1.616, 1.644)}
    for axis, (least, most) in ranges.items():
        assert least < float(minerals_db.mineral("topaz").dispersion[axis].index(D)) < most


# n_F - n_C from a source other than our coefficients', relative tolerance
DISPERSION = [
    ("fluorite", "n", 0.00456, 0.01, "Daimon and Masumura 2002"),
    ("quartz", "o", 0.00779, 0.01, "Radhakrishnan 1951"),
    ("quartz", "e", 0.00804, 0.01, "Radhakrishnan 1951"),
    ("spinel", "n", 0.01180, 0.02, "Tropf and Thomas 1991"),
    ("halite", "n", 0.01274, 0.02, "Baden Powell, in Beer 1853"),
    # Gem books give B-G; over C-F it is 0.58 of that.
    ("topaz", "b", 0.58 * 0.014, 0.1, "Schumann, Gemstones of the World, B-G 0.014"),
    ("diamond", "n", 0.58 * 0.044, 0.05, "Schumann, Gemstones of the World, B-G 0.044"),
]


@pytest.mark.parametrize(("mineral", "axis", "dispersion", "tolerance", "source"), DISPERSION)
def test_dispersion(mineral: str, axis: str, dispersion: float, tolerance: float, source: str) -> None:
    n_f, n_c = minerals_db.mineral(mineral).dispersion[axis].index([F, C])
    assert n_f - n_c == pytest.approx(dispersion, rel=tolerance), source


CONFINED = {"cinnabar", "proustite"}
"""Their formulas begin beyond the D line, at which handbooks give the indices."""


def test_every_published_curve_is_compared_with_another_source() -> None:
    compared = {row[0] for rows in (FIGURES, BIREFRINGENCE) for row in rows} | CONFINED
    others = yaml.safe_load((Path(__file__).parent / "published_values.yaml").read_text(encoding="utf-8"))
    compared |= {row["mineral"] for part in ("values", "disagreements") for row in others[part]}
    published = {
        entry
        for entry, mineral in THERE.items()
        if mineral.variety_of is None and any(curve.model != "one-term" for curve in mineral.dispersion.values())
    }
    assert sorted(published - compared) == []


OPAQUE = {"hematite"}
"""κ near 1 in the blue: dispersion is anomalous inside an absorption band."""


@pytest.mark.parametrize("mineral", sorted(THERE.keys() - OPAQUE))
def test_dispersion_is_normal_in_the_visible(mineral: str) -> None:
    # Transparent minerals: n falls with the wavelength. Kramers-Kronig allows nothing else away from absorption. So the
    # group index is above the index.
    for curve in THERE[mineral].dispersion.values():
        shortest, longest = max(380.0, curve.range_nm[0]), min(780.0, curve.range_nm[1])
        wavelengths = np.linspace(shortest, longest, 2001)
        assert np.all(np.diff(curve.index(wavelengths)) < 0.0)
        assert np.all(curve.group_index(wavelengths[1:-1]) > curve.index(wavelengths[1:-1]))


FIRST_NM = {
    "chlorargyrite": 578.0,
    "cinnabar": 620.0,
    "greenockite": 512.0,
    "proustite": 630.0,
    "bromellite": 440.0,
    "moissanite": 435.8,
    "orpiment": 500.0,
    "powellite": 450.0,
    "scheelite": 450.0,
    "wulfenite": 440.0,
    "yttrium-vanadate": 480.0,
    "zincite": 450.0,
}
"""Where the measurements of coloured minerals, and of some others, begin, nm."""


@pytest.mark.parametrize("mineral", THERE)
def test_most_of_the_visible_is_covered(mineral: str) -> None:
    for curve in THERE[mineral].dispersion.values():
        if curve.model == "one-term":
            continue  # a guide within the range that its entry states, by what the mineral lets through
        # To 686.7 nm, Fraunhofer's B, where the old tables end: beyond it lies 1/2000 of the luminance of daylight.
        assert curve.covers(FIRST_NM.get(THERE[mineral].variety_of or mineral, 430.0), 686.7)
