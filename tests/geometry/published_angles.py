"""Angles between faces as mineralogists measured and printed them, on the axes of our cells.

Where a source prints the angle inside the crystal, its supplement stands: angles are those between the normals. Faces
are named on the structural cell; the remark says what the source calls them where that differs.
"""

from __future__ import annotations

__all__ = ["HEDDLE", "PHILLIPS", "PUBLISHED", "RECALLED", "SPENCER", "STAUROLITE", "degrees"]

Angle = tuple[str, tuple[int, int, int], tuple[int, int, int], float, str]


def degrees(whole: int, minutes: float) -> float:
    return whole + minutes / 60.0


HEDDLE = "M. F. Heddle, Mineralogy, Encyclopædia Britannica, 9th ed., vol. 16 (1883)"
SPENCER = "L. J. Spencer, Encyclopædia Britannica, 11th ed."
PHILLIPS = "W. Phillips, Trans. Geol. Soc. London, 1st series, vol. 4 (1817), by reflecting goniometer"
STAUROLITE = "E. Wülfing, F. Hörner, Sitzungsber. Heidelberger Akad. Wiss., Math.-nat. Kl. A (1915), 10, p. 9"

PUBLISHED: tuple[Angle, ...] = (
    ("albite", (0, 0, 1), (0, 1, 0), degrees(86, 24), f"{SPENCER}, vol. 1, p. 512: the cleavages P and M"),
    ("anatase", (1, 0, 1), (1, 0, -1), 180.0 - degrees(136, 36), f"{HEDDLE}, p. 387: P {{111}}, basal edge"),
    ("andalusite", (1, 1, 0), (1, -1, 0), degrees(89, 12), f"{SPENCER}, vol. 1: prism-angle"),
    ("barite", (2, 1, 0), (2, -1, 0), degrees(78, 23), f"{SPENCER}, vol. 3: m on m, {{110}}"),
    (
        "beryl",
        (0, 0, 1),
        (1, 0, 2),
        degrees(29, 57),
        "Beiträge zur Kenntnis des brasilianischen Berylls, p. 141: p on c, from 29°54' to 29°58'; p is P {10-11}",
    ),
    ("beryl", (0, 0, 1), (1, 1, 2), degrees(44, 56), "the same: s on c, from 44°54' to 44°57'; s is 2P2 {11-21}"),
    ("calcite", (1, 0, 4), (-1, 1, 4), degrees(74, 55), f"{SPENCER}, vol. 3, p. 457 (Barytocalcite): the cleavages"),
    ("cassiterite", (1, 1, 1), (1, 1, -1), 180.0 - degrees(87, 7), f"{HEDDLE}, p. 387: P, basal edge"),
    ("cassiterite", (1, 0, 1), (1, 0, -1), 180.0 - degrees(67, 50), f"{HEDDLE}, p. 387: P∞, basal edge"),
    (
        "chrysoberyl",
        (1, 1, 0),
        (-1, 1, 0),
        degrees(60, 26),
        "W. L. Bragg, G. B. Brown, Proc. R. Soc. London A 110 (1926) 34: (011) on (0-11)",
    ),
    ("orthoclase", (0, 0, 1), (0, 1, 0), 90.0, f"{SPENCER}: the cleavages c and b"),
    ("quartz", (1, 0, 1), (0, 1, 1), 180.0 - degrees(133, 44), f"{HEDDLE}, p. 389: P, polar edge"),
    ("quartz", (1, 0, 1), (1, 0, -1), 180.0 - degrees(103, 34), f"{HEDDLE}, p. 389: P, middle edge"),
    ("rhodochrosite", (1, 0, 4), (-1, 1, 4), 180.0 - degrees(106, 56), f"{HEDDLE}, p. 398: R"),
    ("smithsonite", (1, 0, 4), (-1, 1, 4), 180.0 - degrees(107, 40), f"{HEDDLE}, p. 398: R"),
    ("staurolite", (1, 1, 0), (1, -1, 0), degrees(50, 40), f"{STAUROLITE}: m on m"),
    ("staurolite", (1, 1, 0), (0, 1, 0), degrees(64, 40), f"{STAUROLITE}: m on b"),
    ("staurolite", (1, 1, 0), (2, 0, 1), degrees(42, 3.4), f"{STAUROLITE}: m on r, {{101}}"),
    ("vesuvianite", (1, 0, 1), (1, 0, -1), 180.0 - degrees(74, 27), f"{HEDDLE}, p. 410: P {{111}}, basal edge"),
    ("zircon", (1, 0, 1), (-1, 0, 1), degrees(84, 20), f"{PHILLIPS}: P on P, {{111}}"),
)
"""Read in the sources named."""

RECALLED: tuple[Angle, ...] = (
    ("aragonite", (1, 1, 0), (1, -1, 0), degrees(63, 48), "m on m"),
    ("calcite", (0, 0, 1), (0, 1, 8), degrees(26, 15), "c on e"),
    ("cerussite", (1, 1, 0), (1, -1, 0), degrees(62, 46), "m on m"),
    ("corundum", (0, 0, 1), (0, 1, 2), degrees(57, 34), "c on r"),
    ("dolomite", (1, 0, 4), (-1, 1, 4), degrees(73, 45), "r on r'"),
    ("epidote", (1, 0, 0), (0, 0, 1), degrees(64, 36), "a on c"),
    ("fluorapatite", (0, 0, 1), (1, 0, 1), degrees(40, 18), "c on x"),
    ("fluorite", (1, 1, 1), (1, 1, -1), degrees(70, 32), "octahedron"),
    ("quartz", (1, 0, 0), (1, 0, 1), degrees(38, 13), "m on r"),
    ("rutile", (0, 0, 1), (1, 0, 1), degrees(32, 47), "c on e"),
    ("rutile", (0, 0, 1), (1, 1, 1), degrees(42, 20), "c on s"),
    ("siderite", (1, 0, 4), (-1, 1, 4), degrees(73, 0), "r on r'"),
    ("topaz", (1, 1, 0), (1, -1, 0), degrees(55, 43), "m on m'''"),
)
"""Standard values of mineralogical textbooks, recalled and not checked against a page."""
