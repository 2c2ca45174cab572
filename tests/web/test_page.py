"""The page in real Chromium, before the real service."""

from __future__ import annotations

import json
import re
import statistics
import urllib.request
from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Route, expect

from tests.web.visitor import TINY, Visitor

pytestmark = pytest.mark.browser


def fetch(address: str) -> tuple[str, bytes]:
    with urllib.request.urlopen(address, timeout=30) as answer:
        return answer.headers["content-type"], answer.read()


@pytest.fixture
def dragged(chromium: Browser, service: str) -> Iterator[Any]:
    """Give a function that opens visitors of other kinds."""
    opened: list[Visitor] = []

    def another(**kind: Any) -> Visitor:
        opened.append(Visitor(chromium, service, **{"locale": "en-GB", **kind}))
        return opened[-1]

    yield another
    for visitor in opened:
        visitor.leave()
        visitor.close()


def test_first_look_comes_by_itself_and_turns(visitor: Visitor) -> None:
    visitor.open({})
    visitor.page.locator('.frame[data-state="exact"] canvas').wait_for()
    (request,) = visitor.asked[:1]
    assert request["demonstration"] == "rotating-calcite"
    assert (request["frames"], request["size"], request["quality"]) == (36, [384, 384], "draft")
    assert request["parameters"]["mineral"] == "calcite"
    visitor.until(lambda: visitor.angle > 0)  # it turns while the frames come
    expect(visitor.page.get_by_role("button", name="Pause", exact=True)).to_be_visible()
    job = visitor.job()
    visitor.page.goto(visitor.address + "favicon.svg")  # nobody looks any more, and nobody had asked
    visitor.until(lambda: json.loads(fetch(job)[1])["status"] == "dismissed")


def test_it_renders(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    assert visitor.asked[0]["frames"] == 4
    assert visitor.asked[0]["size"] == [32, 32]
    values = visitor.pixels()
    assert len(values) == 32 * 32 * 4
    assert set(values[3::4]) == {255}
    assert statistics.pstdev(values[1::4]) > 5, "a page of digits under a crystal is not of one grey"
    expect(visitor.words).to_contain_text("4 of 4 frames")
    expect(visitor.page.locator(".estimate")).to_contain_text("error about")
    expect(visitor.page.get_by_role("img")).to_have_attribute(
        "aria-label", "Rotating calcite. Mineral: Calcite. Stage at 0°."
    )


def test_every_mineral_is_offered(visitor: Visitor) -> None:
    visitor.open()
    choice = visitor.page.get_by_label("Mineral", exact=True)
    total = json.loads(fetch(visitor.address + "v1/minerals?limit=1")[1])["total"]
    assert total > 100  # more than a page of the list
    expect(choice.locator("option")).to_have_count(total)
    for name in ("Diamond", "Quartz", "Topaz"):  # of each optical class
        expect(choice.locator("option", has_text=re.compile(f"^{name}$"))).to_have_count(1)


def test_render_button_asks_for_what_the_form_says(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    visitor.page.get_by_label("Mineral", exact=True).select_option("quartz")
    visitor.page.get_by_label("Frames in a turn").fill("2")
    visitor.page.get_by_role("button", name="Render", exact=True).click()
    visitor.until(lambda: len(visitor.asked) == 2)
    visitor.wait_done()
    first, second = visitor.asked
    assert second == {**first, "frames": 2, "parameters": {**first["parameters"], "mineral": "quartz"}}
    expect(visitor.words).to_contain_text("2 of 2 frames")
    expect(visitor.page.locator(".facts")).to_contain_text("SiO₂ · trigonal · uniaxial positive")
    expect(visitor.page.locator(".caption")).to_contain_text("Quartz at 589 nm: nₒ = 1.544, nₑ = 1.553")


def test_files_can_be_taken_home(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    links = visitor.page.locator(".downloads a")
    expect(links).to_have_count(3)
    kinds = [fetch(links.nth(i).evaluate("a => a.href")) for i in range(3)]
    assert [kind for kind, _ in kinds] == ["image/png", "image/webp", "application/json"]
    manifest = json.loads(kinds[2][1])
    assert manifest["complete"] is True
    assert len(manifest["frames"]) == 4


def test_slider_and_keys_stand_at_frames(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    slider = visitor.page.get_by_role("slider", name="Stage angle")
    slider.focus()
    for key, angle in [("End", 270), ("ArrowLeft", 180), ("Home", 0), ("ArrowRight", 90), ("ArrowRight", 180)]:
        visitor.page.keyboard.press(key)
        visitor.wait_angle(angle)
        expect(slider).to_have_attribute("aria-valuetext", f"{angle}°")
    visitor.run("document.activeElement.blur()")
    visitor.page.keyboard.press("ArrowLeft")  # the page's own keys, with no control in focus
    visitor.wait_angle(90)
    box = slider.bounding_box()
    assert box is not None
    visitor.page.mouse.click(box["x"] + box["width"] - 2, box["y"] + box["height"] / 2)
    visitor.wait_angle(270)
    expect(visitor.page.get_by_role("textbox", name="Stage angle", exact=True)).to_have_value("270")
    assert len(visitor.asked) == 1, "frames that are there are not asked for again"


def test_dragging_the_picture_turns_the_stage(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    box = visitor.canvas.bounding_box()
    assert box is not None
    x, y, r = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2, box["width"] / 3
    visitor.page.mouse.move(x + r, y)
    visitor.page.mouse.down()
    visitor.page.mouse.move(x + 0.7 * r, y - 0.7 * r)
    visitor.page.mouse.move(x, y - r)  # a quarter turn counter-clockwise, as one sees it
    visitor.page.mouse.up()
    visitor.wait_angle(90)


def test_any_angle_can_be_had_exactly(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    field = visitor.page.get_by_role("textbox", name="Stage angle", exact=True)
    field.fill("33.25")
    field.press("Enter")
    visitor.wait_angle(33.25)
    first, still = visitor.asked
    assert still == {**first, "frames": 1, "parameters": {**first["parameters"], "first_angle_deg": 33.25}}
    at_angle = visitor.pixels()
    visitor.page.get_by_role("slider", name="Stage angle").press("Home")
    visitor.wait_angle(0)
    assert visitor.pixels() != at_angle
    field.fill("-326.75")  # the same position, from the other side, and kept
    field.press("Enter")
    visitor.wait_angle(33.25)
    assert visitor.pixels() == at_angle
    assert len(visitor.asked) == 2
    field.fill("north")
    field.press("Enter")
    expect(field).to_have_value("33.25")


def test_space_plays_and_pauses(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    visitor.page.get_by_label("One turn in").select_option("3")
    visitor.run("document.activeElement.blur()")
    visitor.page.keyboard.press("Space")
    seen: set[float] = set()

    def round_the_turn() -> bool:
        seen.add(visitor.angle)
        return seen == {0, 90, 180, 270}

    visitor.until(round_the_turn)
    visitor.page.keyboard.press("Space")
    expect(visitor.page.get_by_role("button", name="Play", exact=True)).to_be_visible()
    stopped = visitor.angle
    visitor.page.wait_for_timeout(1000)  # longer than a frame at this pace
    assert visitor.angle == stopped
    visitor.page.get_by_role("button", name="Play", exact=True).click()
    visitor.until(lambda: visitor.angle != stopped)


def test_no_motion_where_motion_is_unwelcome(dragged: Any) -> None:
    visitor = dragged(motion="reduce").open(TINY)
    visitor.wait_done()
    visitor.wait_angle(0)
    expect(visitor.page.get_by_role("button", name="Play", exact=True)).to_be_visible()
    turning = dragged().open(TINY)
    turning.wait_done()
    turning.until(lambda: turning.angle > 0)


def test_language_changes_without_reload_and_is_kept(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    visitor.run("window.marked = true")
    visitor.page.get_by_role("button", name="Русский").click()
    expect(visitor.page.get_by_role("button", name="Построить")).to_be_visible()
    expect(visitor.page.get_by_label("Минерал", exact=True).locator("option:checked")).to_have_text("Кальцит")
    expect(visitor.page.locator(".caption")).to_contain_text("двупреломление")
    expect(visitor.page.locator(".caption")).to_contain_text("nₒ = 1,658")
    expect(visitor.words).to_contain_text("Готово")
    expect(visitor.page).to_have_title("Isogyre: что делает свет внутри кристалла")
    assert visitor.run("document.documentElement.lang") == "ru"
    assert visitor.run("window.marked") is True
    assert len(visitor.asked) == 1
    visitor.page.reload()
    expect(visitor.page.get_by_role("button", name="Построить")).to_be_visible()
    assert visitor.run("window.marked") is None


def test_language_of_the_browser_comes_first(dragged: Any) -> None:
    visitor = dragged(locale="ru-RU").open()
    expect(visitor.page.get_by_role("button", name="Построить")).to_be_visible()
    visitor.wait_done()


def test_problem_stands_at_its_control(visitor: Visitor) -> None:
    visitor.expected.append("422")
    visitor.open()
    visitor.wait_done()
    tilt = visitor.page.locator("#field-axis_tilt_deg")
    tilt.fill("999")
    visitor.page.get_by_label("Frames in a turn").fill("0")
    visitor.page.get_by_role("button", name="Render", exact=True).click()
    expect(visitor.page.get_by_role("alert")).to_contain_text("This cannot be rendered.")
    expect(tilt).to_have_attribute("aria-invalid", "true")
    expect(tilt).to_be_focused()
    fault = visitor.page.locator(f"#{tilt.get_attribute('aria-describedby')}")
    expect(fault).to_be_visible()
    assert len(fault.inner_text().strip()) > 5
    expect(visitor.page.locator("#field-frames")).to_have_attribute("aria-invalid", "true")
    expect(visitor.page.get_by_label("Mineral", exact=True)).not_to_have_attribute("aria-invalid", "true")
    visitor.wait_angle(0)  # the picture that was there stays
    visitor.page.get_by_role("button", name="Русский").click()
    expect(visitor.page.get_by_role("alert")).to_contain_text("Это построить нельзя.")
    expect(fault).to_contain_text("допустимо от 0 до")
    tilt.fill("45,5")  # a decimal comma is a decimal comma
    visitor.page.locator("#field-frames").fill("1")
    visitor.page.get_by_role("button", name="Построить").click()
    expect(visitor.page.get_by_role("alert")).to_be_hidden()
    expect(tilt).not_to_have_attribute("aria-invalid", "true")
    assert visitor.asked[-1]["parameters"]["axis_tilt_deg"] == 45.5


def test_problem_of_a_link_is_told(visitor: Visitor) -> None:
    visitor.expected.append("422")
    visitor.open({**TINY, "wizardry": "9"})
    alert = visitor.page.get_by_role("alert")
    expect(alert).to_contain_text("This cannot be rendered.")
    expect(alert).to_contain_text("wizardry")  # no control of the page is about it
    visitor.open({**TINY, "mineral": "kryptonite"})  # the same page, told another address
    expect(alert).to_contain_text("What to mend is marked.")
    expect(visitor.page.get_by_label("Mineral", exact=True)).to_have_attribute("aria-invalid", "true")


def test_a_service_that_is_away_is_told_and_tried_again(visitor: Visitor) -> None:
    visitor.expected.append("ERR_CONNECTION_REFUSED")
    visitor.open()
    visitor.wait_done()
    away = [True]

    def refuse(route: Route) -> None:
        if away[0]:
            route.abort("connectionrefused")
        else:
            route.fallback()

    visitor.page.route("**/v1/renders", refuse)
    render = visitor.page.get_by_role("button", name="Render", exact=True)
    render.click()
    expect(visitor.page.get_by_role("alert")).to_contain_text("The service does not answer.")
    away[0] = False
    render.click()
    expect(visitor.page.get_by_role("alert")).to_be_hidden()
    visitor.wait_done()


def test_a_page_that_found_no_service_begins_again(visitor: Visitor) -> None:
    visitor.expected.append("ERR_CONNECTION_REFUSED")
    visitor.page.route("**/v1/demonstrations", lambda route: route.abort("connectionrefused"), times=1)
    visitor.open()
    expect(visitor.page.get_by_role("alert")).to_contain_text("The service does not answer.")
    visitor.page.get_by_role("button", name="Render", exact=True).click()
    visitor.wait_done()
    expect(visitor.page.get_by_role("alert")).to_be_hidden()


def test_frames_come_even_where_the_stream_breaks(visitor: Visitor) -> None:
    visitor.expected.append("ERR_FAILED")
    broken: list[str] = []

    def cut(route: Route) -> None:
        broken.append(route.request.url)
        route.abort()

    visitor.page.route("**/events", cut)
    visitor.open({**TINY, "seed": "7", "angle": "0"})
    visitor.wait_done()
    expect(visitor.words).to_contain_text("4 of 4 frames")
    assert broken


def test_analyser_renders_anew_when_it_is_let_go(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    bare = visitor.pixels()
    visitor.page.get_by_role("switch", name="Analyser").click()
    visitor.until(lambda: len(visitor.asked) == 2)
    visitor.wait_done()
    visitor.wait_angle(0)
    visitor.until(lambda: visitor.pixels() != bare)
    dial = visitor.page.locator(".analyser isogyre-dial").bounding_box()
    assert dial is not None
    x, y, r = dial["x"] + dial["width"] / 2, dial["y"] + dial["height"] / 2, dial["width"] / 3
    visitor.page.mouse.move(x + r, y)
    visitor.page.mouse.down()
    visitor.page.mouse.move(x + 0.7 * r, y - 0.7 * r)
    expect(visitor.page.get_by_role("textbox", name="Angle of the analyser")).to_have_value("45")
    visitor.page.mouse.move(x, y - r)
    assert len(visitor.asked) == 2, "not while it is being turned"
    visitor.page.mouse.up()
    visitor.until(lambda: len(visitor.asked) == 3)
    expect(visitor.page.locator(".caption")).to_contain_text("along 90°")
    visitor.page.get_by_role("switch", name="Analyser").click()
    visitor.until(lambda: len(visitor.asked) == 4)
    assert [r["parameters"]["analyser_deg"] for r in visitor.asked] == [None, 0, 90, None]
    assert len({json.dumps({**r, "parameters": {**r["parameters"], "analyser_deg": 0}}) for r in visitor.asked}) == 1
    visitor.wait_done()


def test_cancel_dismisses_the_render(visitor: Visitor) -> None:
    visitor.open({"quality": "fine", "size": "512x512", "frames": "360", "angle": "0"})
    visitor.page.locator('.words[data-status="running"]').wait_for()
    job = visitor.job()
    visitor.page.get_by_role("button", name="Cancel").click()
    visitor.wait_done("dismissed")
    visitor.until(lambda: json.loads(fetch(job)[1])["status"] == "dismissed")
    expect(visitor.page.get_by_role("button", name="Cancel")).to_be_disabled()


def test_a_link_reproduces_the_view(visitor: Visitor, dragged: Any) -> None:
    visitor.open({**TINY, "mineral": "rutile", "size_mm": "[20, 20, 9.5]", "analyser_deg": "30", "angle": "90"})
    visitor.wait_done()
    visitor.wait_angle(90)
    visitor.page.get_by_label("Frames in a turn").fill("8")
    visitor.page.get_by_role("button", name="Render", exact=True).click()
    visitor.until(lambda: len(visitor.asked) >= 2)
    visitor.wait_done()
    visitor.page.get_by_role("slider", name="Stage angle").press("ArrowRight")
    visitor.wait_angle(135)
    visitor.until(lambda: "angle=135" in visitor.page.url and "frames=8" in visitor.page.url)
    other = dragged()
    other.page.goto(visitor.page.url)
    other.wait_angle(135)
    whole = [request for request in visitor.asked if request["frames"] == 8]
    assert [request for request in other.asked if request["frames"] == 8] == whole
    assert other.pixels() == visitor.pixels()
    other.page.goto(other.page.url.replace("angle=135", "angle=270"))  # the same page, told another address
    other.wait_angle(270)


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("locale", ["en-GB", "ru-RU"])
def test_fits_its_window_and_names_its_controls(dragged: Any, width: int, locale: str) -> None:
    visitor = dragged(width=width, locale=locale).open()
    visitor.wait_done()
    for summary in visitor.page.locator("summary").all():
        summary.click()
    assert visitor.run("document.documentElement.scrollWidth") <= width
    wide = (
        "[...document.querySelectorAll('isogyre-app *')].filter(e => e.getBoundingClientRect().right > innerWidth + 1)"
    )
    assert visitor.run(f"{wide}.map(e => e.outerHTML.slice(0, 80))") == []
    session = visitor.context.new_cdp_session(visitor.page)
    nodes = session.send("Accessibility.getFullAXTree")["nodes"]
    roles = {"button", "slider", "textbox", "combobox", "switch", "checkbox", "link", "img", "progressbar"}
    controls = [n for n in nodes if not n["ignored"] and n["role"]["value"].lower() in roles]
    assert len(controls) > 20
    assert [n for n in controls if not n.get("name", {}).get("value", "").strip()] == []


def test_progress_is_told_to_those_who_listen(visitor: Visitor) -> None:
    visitor.open()
    visitor.wait_done()
    status = visitor.page.locator('[role="status"]')
    expect(status).to_have_attribute("aria-live", "polite")
    expect(status).to_contain_text("Done: 4 of 4 frames")
