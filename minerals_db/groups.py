"""Names of the families of minerals: what people call them, and what a search finds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

__all__ = ["GROUPS", "GroupNames"]


@dataclass(frozen=True, slots=True)
class GroupNames:
    """What people call a family."""

    en: str
    ru: str


GROUPS: Mapping[str, GroupNames] = MappingProxyType(
    {
        key: GroupNames(en, ru)
        for key, en, ru in (
            ("aluminosilicate", "Aluminosilicate polymorphs", "Полиморфы силиката алюминия"),
            ("amphibole", "Amphiboles", "Амфиболы"),
            ("andalusite", "Andalusite group", "Группа андалузита"),
            ("apatite", "Apatite group", "Группа апатита"),
            ("aragonite", "Aragonite group", "Группа арагонита"),
            ("barite", "Barite group", "Группа барита"),
            ("beryl", "Beryl group", "Группа берилла"),
            ("calcite", "Calcite group", "Группа кальцита"),
            ("carbonate", "Carbonates", "Карбонаты"),
            ("chrysoberyl", "Chrysoberyl group", "Группа хризоберилла"),
            ("corundum", "Corundum group", "Группа корунда"),
            ("diamond", "Diamond", "Алмаз"),
            ("dolomite", "Dolomite group", "Группа доломита"),
            ("epidote", "Epidote group", "Группа эпидота"),
            ("feldspar", "Feldspars", "Полевые шпаты"),
            ("feldspathoid", "Feldspathoids", "Фельдшпатоиды"),
            ("garnet", "Garnets", "Гранаты"),
            ("glass", "Glasses", "Стёкла"),
            ("halide", "Halides", "Галогениды"),
            ("humite", "Humite group", "Группа гумита"),
            ("laser-crystal", "Laser crystals", "Лазерные кристаллы"),
            ("mica", "Micas", "Слюды"),
            ("molybdate", "Molybdates", "Молибдаты"),
            ("monazite", "Monazite group", "Группа монацита"),
            ("olivine", "Olivines", "Оливины"),
            ("optical-glass", "Optical glasses", "Оптические стёкла"),
            ("oxide", "Oxides", "Оксиды"),
            ("perovskite", "Perovskite group", "Группа перовскита"),
            ("pyroxene", "Pyroxenes", "Пироксены"),
            ("quartz", "Quartz and its varieties", "Кварц и его разновидности"),
            ("rutile", "Rutile group", "Группа рутила"),
            ("scapolite", "Scapolites", "Скаполиты"),
            ("scheelite", "Scheelite group", "Группа шеелита"),
            ("sodalite", "Sodalite group", "Группа содалита"),
            ("sphalerite", "Sphalerite group", "Группа сфалерита"),
            ("spinel", "Spinels", "Шпинели"),
            ("sulphate", "Sulphates", "Сульфаты"),
            ("sulphide", "Sulphides", "Сульфиды"),
            ("titanite", "Titanite group", "Группа титанита"),
            ("topaz", "Topaz group", "Группа топаза"),
            ("tourmaline", "Tourmalines", "Турмалины"),
            ("wulfenite", "Wulfenite group", "Группа вульфенита"),
            ("zeolite", "Zeolites", "Цеолиты"),
            ("zircon", "Zircon group", "Группа циркона"),
        )
    }
)
"""Every family of the built-in minerals by its key, and those that a user's own minerals are likely to belong to."""
