"""Dispersion formulas as published, twice: as our data would have them, and as refractiveindex.info lists them.

The list of coefficients C1, C2, ... is the database's own (CC0); `squared_or_plain` puts it into the equations that its
documentation numbers 1 to 9, in 40 digits and without anything of ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mpmath
from pydantic import TypeAdapter

from minerals_db.dispersion import AnyDispersion, Dispersion

mp = mpmath.mp.clone()
mp.dps = 40

ADAPTER: TypeAdapter[Dispersion] = TypeAdapter(AnyDispersion)
KNOWN = {"source": "somebody", "status": "published"}


def curve(data: dict[str, Any], **changes: Any) -> Dispersion:
    """Return the curve of the data, which need not name a source."""
    return ADAPTER.validate_python(KNOWN | data | changes)


@dataclass(frozen=True)
class Published:
    """A curve; `formula` and `coefficients` are refractiveindex.info's, `data` ours."""

    name: str
    source: str
    formula: int
    coefficients: tuple[float, ...]
    data: dict[str, Any]

    def index(self, wavelength_nm: Any) -> Any:
        """Return the index in 40 digits at a wavelength of mpmath's, nm."""
        # Our curves take 1e-3, rounded, for the thousandth: that alone is 2e-20, far below what is compared.
        return _index(self.formula, [mp.mpf(c) for c in self.coefficients], wavelength_nm / 1000)

    def group_index(self, wavelength_nm: float) -> Any:
        """Return n − λ dn/dλ, the derivative by differences in 40 digits."""
        at = mp.mpf(wavelength_nm)
        return self.index(at) - at * mp.diff(self.index, at)


def _index(formula: int, c: list[Any], x: Any) -> Any:  # the equations of the documentation, in its own numbering
    pairs = list(zip(c[1::2], c[2::2], strict=False))
    if formula == 1:
        return mp.sqrt(1 + c[0] + sum(b * x**2 / (x**2 - r**2) for b, r in pairs))
    if formula == 2:
        return mp.sqrt(1 + c[0] + sum(b * x**2 / (x**2 - r) for b, r in pairs))
    if formula == 3:
        return mp.sqrt(c[0] + sum(a * x**p for a, p in pairs))
    if formula == 4:
        resonances = sum(c[i] * x ** c[i + 1] / (x**2 - c[i + 2] ** c[i + 3]) for i in (1, 5) if len(c) > i and c[i])
        return mp.sqrt(c[0] + resonances + sum(a * x**p for a, p in zip(c[9::2], c[10::2], strict=True)))
    if formula == 5:
        return c[0] + sum(a * x**p for a, p in pairs)
    if formula == 6:
        return 1 + c[0] + sum(b / (r - x**-2) for b, r in pairs)
    if formula == 7:
        pole = 1 / (x**2 - mp.mpf("0.028"))
        return c[0] + c[1] * pole + c[2] * pole**2 + sum(a * x ** (2 * i) for i, a in enumerate(c[3:], start=1))
    if formula == 8:
        ratio = c[0] + c[1] * x**2 / (x**2 - c[2]) + c[3] * x**2
        return mp.sqrt((1 + 2 * ratio) / (1 - ratio))
    assert formula == 9
    return mp.sqrt(c[0] + c[1] / (x**2 - c[2]) + c[3] * (x - c[4]) / ((x - c[4]) ** 2 + c[5]))


def _sellmeier_2(name: str, source: str, shortest_nm: float, *coefficients: float) -> Published:
    terms = [
        {"strength": strength, "resonance_um2": resonance}
        for strength, resonance in zip(coefficients[1::2], coefficients[2::2], strict=True)
    ]
    data = {"model": "sellmeier-2", "offset": coefficients[0], "terms": terms, "range_nm": [shortest_nm, 2500]}
    return Published(name, source, 2, coefficients, data)


SCHOTT = "SCHOTT Zemax catalog 2017-01-20b"
GLASSES = (
    _sellmeier_2("N-BK7", SCHOTT, 300, 0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653),
    _sellmeier_2("F2", SCHOTT, 320, 0, 1.34533359, 0.00997743871, 0.209073176, 0.0470450767, 0.937357162, 111.886764),
    _sellmeier_2("SF6", SCHOTT, 365, 0, 1.72448482, 0.0134871947, 0.390104889, 0.0569318095, 1.04572858, 118.557185),
    _sellmeier_2("SF10", SCHOTT, 380, 0, 1.61625977, 0.0127534559, 0.259229334, 0.0581983954, 1.07762317, 116.60768),
    _sellmeier_2("SF11", SCHOTT, 390, 0, 1.73848403, 0.0136068604, 0.311168974, 0.0615960463, 1.17490871, 121.922711),
    _sellmeier_2("N-SF11", SCHOTT, 370, 0, 1.73759695, 0.013188707, 0.313747346, 0.0623068142, 1.89878101, 155.23629),
    _sellmeier_2(
        "N-LASF9", SCHOTT, 365, 0, 2.00029547, 0.0121426017, 0.298926886, 0.0538736236, 1.80691843, 156.530829
    ),
)

BACD11 = Published(
    "HOYA BACD11",
    "HOYA Zemax catalog 2017-04-01",
    3,
    (2.4095163, -0.0091904415, 2, 0.012939968, -2, 0.0002346143, -4, -1.1130589e-05, -6, 1.0131863e-06, -8),
    {
        "model": "polynomial",
        "constant": 2.4095163,
        "powers": [
            {"coefficient": -0.0091904415, "power": 2},
            {"coefficient": 0.012939968, "power": -2},
            {"coefficient": 0.0002346143, "power": -4},
            {"coefficient": -1.1130589e-05, "power": -6},
            {"coefficient": 1.0131863e-06, "power": -8},
        ],
        "range_nm": [365.01, 1013.98],
    },
)

FUSED_SILICA = Published(
    "fused silica",
    "I. H. Malitson, J. Opt. Soc. Am. 55, 1205 (1965)",
    1,
    (0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161),
    {
        "model": "sellmeier-1",
        "terms": [
            {"strength": 0.6961663, "resonance_um": 0.0684043},
            {"strength": 0.4079426, "resonance_um": 0.1162414},
            {"strength": 0.8974794, "resonance_um": 9.896161},
        ],
        "range_nm": [210, 6700],
    },
)

STANDARD_AIR = Published(
    "standard air",
    "P. E. Ciddor, Appl. Opt. 35, 1566 (1996)",
    6,
    (0, 0.05792105, 238.0185, 0.00167917, 57.362),
    {
        "model": "gas",
        "terms": [
            {"strength_per_um2": 0.05792105, "resonance_per_um2": 238.0185},
            {"strength_per_um2": 0.00167917, "resonance_per_um2": 57.362},
        ],
        "range_nm": [230, 1690],
    },
)

PUBLISHED = (
    FUSED_SILICA,
    Published(
        "sylvite",
        "H. H. Li, J. Phys. Chem. Ref. Data 5, 329 (1976)",
        1,
        (0.26486, 0.30523, 0.1, 0.4162, 0.131, 0.1887, 0.162, 2.62, 70.42),
        {
            "model": "sellmeier-1",
            "offset": 0.26486,
            "terms": [
                {"strength": 0.30523, "resonance_um": 0.1},
                {"strength": 0.4162, "resonance_um": 0.131},
                {"strength": 0.1887, "resonance_um": 0.162},
                {"strength": 2.62, "resonance_um": 70.42},
            ],
            "range_nm": [180, 35000],
        },
    ),
    Published(
        "calcite o",
        "G. Ghosh, Opt. Commun. 163, 95 (1999)",
        2,
        (0.73358749, 0.96464345, 0.0194325203, 1.82831454, 120.0),
        {
            "model": "sellmeier-2",
            "offset": 0.73358749,
            "terms": [
                {"strength": 0.96464345, "resonance_um2": 0.0194325203},
                {"strength": 1.82831454, "resonance_um2": 120},
            ],
            "range_nm": [204, 2172],
        },
    ),
    *GLASSES,
    BACD11,
    Published(
        "zincite o",
        "W. L. Bond, J. Appl. Phys. 36, 1674 (1965)",
        4,
        (2.81418, 0.87968, 2.0, 0.3042, 2.0, 0.0, 0.0, 0.0, 1.0, -0.00711, 2.0),
        {
            "model": "resonances-and-powers",
            "constant": 2.81418,
            "resonances": [{"strength": 0.87968, "power": 2, "resonance_um": 0.3042}],
            "powers": [{"coefficient": -0.00711, "power": 2}],
            "range_nm": [450, 4000],
        },
    ),
    Published(
        "KH2PO4 o",
        "F. Zernike, J. Opt. Soc. Am. 54, 1215 (1964)",
        4,
        (2.259276, 13.00522, 2.0, 400.0, 1.0, 0.01008956, 0.0, 0.0129426, 1.0),
        {
            "model": "resonances-and-powers",
            "constant": 2.259276,
            "resonances": [
                {"strength": 13.00522, "power": 2, "resonance_um2": 400.0},
                {"strength": 0.01008956, "power": 0, "resonance_um2": 0.0129426},
            ],
            "range_nm": [213.8, 1529],
        },
    ),
    Published(
        "sphalerite",
        "M. Debenham, Appl. Opt. 23, 2238 (1984)",
        4,
        (8.393, 0.14383, 0.0, 0.2421, 2.0, 4430.99, 0.0, 36.71, 2.0),
        {
            "model": "resonances-and-powers",
            "constant": 8.393,
            "resonances": [
                {"strength": 0.14383, "power": 0, "resonance_um": 0.2421},
                {"strength": 4430.99, "power": 0, "resonance_um": 36.71},
            ],
            "range_nm": [405, 13000],
        },
    ),
    Published(
        "nantokite",
        "A. Feldman, D. Horowitz, J. Opt. Soc. Am. 59, 1406 (1969)",
        4,
        (3.58, 0.03162, 2.0, 0.1642, 1.0, 0.0, 0.0, 0.0, 1.0, 0.09288, -2.0),
        {
            "model": "resonances-and-powers",
            "constant": 3.58,
            "resonances": [{"strength": 0.03162, "power": 2, "resonance_um2": 0.1642}],
            "powers": [{"coefficient": 0.09288, "power": -2}],
            "range_nm": [430, 2500],
        },
    ),
    Published(
        "LiB3O5 beta",  # its λ² never meets the pole, which is negative
        "F. Hanson, D. Dick, Opt. Lett. 16, 205 (1991)",
        4,
        (2.525, 0.017123, 0.0, -0.0060517, 1.0, 0.0, 0.0, 0.0, 1.0, -0.0087838, 2.0),
        {
            "model": "resonances-and-powers",
            "constant": 2.525,
            "resonances": [{"strength": 0.017123, "power": 0, "resonance_um2": -0.0060517}],
            "powers": [{"coefficient": -0.0087838, "power": 2}],
            "range_nm": [289.4, 1064],
        },
    ),
    Published(
        "chlorargyrite",
        "L. W. Tilton, E. K. Plyler, R. E. Stephens, J. Opt. Soc. Am. 40, 540 (1950)",
        4,
        (4.00804, 0.079086, 0.0, 0.04584, 1.0, 0.0, 0.0, 0.0, 1.0, -0.00085111, 2.0, -1.9762e-07, 4.0),
        {
            "model": "resonances-and-powers",
            "constant": 4.00804,
            "resonances": [{"strength": 0.079086, "power": 0, "resonance_um2": 0.04584}],
            "powers": [{"coefficient": -0.00085111, "power": 2}, {"coefficient": -1.9762e-07, "power": 4}],
            "range_nm": [578, 20600],
        },
    ),
    Published(
        "ethanol",
        "J. Rheims, J. Köser, T. Wriedt, Meas. Sci. Technol. 8, 601 (1997)",
        5,
        (1.35265, 0.00306, -2, 0.00002, -4),
        {
            "model": "cauchy",
            "constant": 1.35265,
            "powers": [{"coefficient": 0.00306, "power": -2}, {"coefficient": 0.00002, "power": -4}],
            "range_nm": [476.5, 830],
        },
    ),
    STANDARD_AIR,
    Published(
        "silicon",
        "D. F. Edwards, E. Ochoa, Appl. Opt. 19, 4130 (1980)",
        7,
        (3.41983, 0.159906, -0.123109, 1.26878e-6, -1.95104e-9),
        {
            "model": "herzberger",
            "constant": 3.41983,
            "resonance": {"first_order_um2": 0.159906, "second_order_um4": -0.123109},
            "powers": [{"coefficient": 1.26878e-6, "power": 2}, {"coefficient": -1.95104e-9, "power": 4}],
            "range_nm": [2437.3, 25000],
        },
    ),
    Published(
        "bromargyrite",
        "H. Schröter, Z. Phys. 67, 24 (1931)",
        8,
        (0.452505, 0.09939, 0.070537, -0.000150),
        {
            "model": "retro",
            "constant": 0.452505,
            "resonance": {"strength": 0.09939, "resonance_um2": 0.070537},
            "powers": [{"coefficient": -0.000150, "power": 2}],
            "range_nm": [495, 670],
        },
    ),
    Published(
        "urea e",
        "M. J. Rosker, K. Cheng, C. L. Tang, IEEE J. Quantum Electron. 21, 1600 (1985)",
        9,
        (2.51527, 0.0240, 0.0300, 0.020, 1.52, 0.8771),
        {
            "model": "exotic",
            "constant": 2.51527,
            "resonance": {"strength": 0.0240, "power": 0, "resonance_um2": 0.0300},
            "line": {"strength_um": 0.020, "centre_um": 1.52, "width_um2": 0.8771},
            "range_nm": [300, 1060],
        },
    ),
    Published(
        "made up, with powers that are no whole numbers",
        "chosen for this test",
        3,
        (2.3, 0.011, -1.5, -0.004, 1.0, 0.003, -3.0),
        {
            "model": "polynomial",
            "constant": 2.3,
            "powers": [
                {"coefficient": 0.011, "power": -1.5},
                {"coefficient": -0.004, "power": 1},
                {"coefficient": 0.003, "power": -3},
            ],
            "range_nm": [300, 2000],
        },
    ),
)
