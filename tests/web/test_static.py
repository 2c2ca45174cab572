"""What can be said of the page's files without a browser."""

from __future__ import annotations

import hashlib
import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

WEB = Path(__file__).parents[2] / "web"
OWN = [path for path in sorted(WEB.rglob("*")) if path.is_file() and "vendor" not in path.parts]
LANGUAGES = ("en", "ru")


def sources(*kinds: str) -> list[Path]:
    found = [path for path in OWN if path.suffix in kinds]
    assert found
    return found


def words(language: str) -> dict[str, str]:
    pairs = json.loads((WEB / "i18n" / f"{language}.json").read_text(encoding="utf-8"), object_pairs_hook=list)
    assert len(dict(pairs)) == len(pairs), "a key stands twice"
    return dict(pairs)


def test_vendored_files_are_what_their_record_says() -> None:
    record = (WEB / "vendor" / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([^`]+)` \|.*`(LICENSE[^`]+)`.*\| `([0-9a-f]{64})` \|$", record, re.MULTILINE)
    assert {name for name, _, _ in rows} == {path.name for path in (WEB / "vendor").glob("*.js")}
    for name, licence, digest in rows:
        assert hashlib.sha256((WEB / "vendor" / name).read_bytes()).hexdigest() == digest, name
        assert (WEB / "vendor" / licence).stat().st_size > 500


def test_both_languages_have_the_same_phrases_with_the_same_places() -> None:
    english, russian = words("en"), words("ru")
    assert list(english) == list(russian)
    for key in english:
        assert english[key].strip(), key
        assert russian[key].strip(), key
        assert sorted(re.findall(r"\{\w+\}", english[key])) == sorted(re.findall(r"\{\w+\}", russian[key])), key


def test_russian_is_russian() -> None:
    for key, phrase in words("ru").items():
        assert re.search("[А-Яа-яЁё]", phrase), key


def test_every_phrase_is_used_and_every_phrase_used_is_there() -> None:
    known = set(words("en"))
    code = "\n".join(path.read_text(encoding="utf-8") for path in sources(".js"))
    # Keys stand in the code whole ("stage.play"), or as the beginning of a template (`unit.${name}`), or as the
    # prefix given to a helper (phrase("system", …)).
    named = {key for key in re.findall(r'"([a-z]+(?:\.[a-z]+)+)"', code) if not key.endswith(".js")}
    prefixes = {p + "." for p in re.findall(r'#phrase\("([a-z]+)"', code)}
    prefixes |= set(re.findall(r"`([a-z]+\.(?:[a-z_]+\.)*)\$\{", code))
    storage = {"isogyre.language"}
    plain = set(re.findall(r'say\("([^"]+)"', code))
    assert plain - known == set()
    assert named - storage - known == set()
    unused = {key for key in known - named - plain if not any(key.startswith(prefix) for prefix in prefixes)}
    assert unused == set()


def test_nothing_is_loaded_from_elsewhere() -> None:
    for path in sources(".html", ".css", ".js", ".json", ".svg"):
        text = path.read_text(encoding="utf-8").replace('xmlns="http://www.w3.org/2000/svg"', "")
        assert not re.search(r"(?:https?:|wss?:)?//[\w-]+\.\w", re.sub(r"^\s*//.*$", "", text, flags=re.MULTILINE)), (
            path
        )
        assert "@import" not in text, path


def test_nothing_needs_a_looser_content_security_policy() -> None:
    for path in sources(".html", ".js"):
        text = path.read_text(encoding="utf-8")
        for pattern in (r"\sstyle=", r"\son\w+=\"", r"\beval\(", r"new Function\b", r"javascript:", r"\bunsafe\w*\b"):
            assert not re.search(pattern, text), (path.name, pattern)


class Links(HTMLParser):
    """Collects what a page loads and whether anything stands inline."""

    def __init__(self) -> None:
        super().__init__()
        self.files: list[str] = []
        self.inline: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        of = dict(attrs)
        if tag == "style" or (tag == "script" and not of.get("src")):
            self.inline.append(tag)
        self.files += [value for key in ("src", "href") if (value := of.get(key))]


def test_what_the_page_names_is_there() -> None:
    links = Links()
    links.feed((WEB / "index.html").read_text(encoding="utf-8"))
    assert links.inline == []
    assert len(links.files) > 3
    for name in links.files:
        assert not name.startswith("/"), "the page may be mounted anywhere"
        assert (WEB / name).is_file(), name
    styles = {f"css/{path.name}" for path in sources(".css")}
    assert styles <= set(links.files)


@pytest.mark.parametrize("path", sources(".js"), ids=lambda path: path.name)
def test_module_imports_what_exists(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    for names, target in re.findall(r'^import (?:\{([^}]*)\} from )?"([^"]+)";$', text, re.MULTILINE):
        module = (path.parent / target).resolve()
        assert module.is_file(), target
        exported = module.read_text(encoding="utf-8")
        for name in filter(None, (part.strip() for part in names.split(","))):
            pattern = rf"export (?:async )?(?:function|class|const) {name}\b|export\s*\{{[^}}]*\b{name}\b"
            assert re.search(pattern, exported), f"{target} exports no {name}"
            assert len(re.findall(rf"\b{re.escape(name)}\b", text)) > 1, f"{name} is imported and not used"
    assert text.count("\n") < 400


def test_no_module_is_left_over() -> None:
    seen: set[Path] = set()
    waiting = [WEB / "js" / "main.js"]
    while waiting:
        path = waiting.pop().resolve()
        if path in seen or "vendor" in path.parts:
            continue
        seen.add(path)
        waiting += [
            path.parent / name for name in re.findall(r'^import .*?"([^"]+)";$', path.read_text(), re.MULTILINE)
        ]
    assert seen == {path.resolve() for path in sources(".js")}
