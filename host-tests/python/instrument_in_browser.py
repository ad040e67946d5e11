"""The page of `hitch serve` as an instrument, in a headless Chromium: the plots stay in view, runs are searched and sorted, signals are
chosen, a cursor reads all rows, and everything follows a parameter while it is moved.

Called with the page's address, the browser, and a folder for pictures.
"""

import json
import sys
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import PATIENCE_MS, PHONE, assert_accessible, assert_fits, opened, story

WINDOWS = {"small": {"width": 1400, "height": 760}, "large": {"width": 1920, "height": 1080}}

# Parts of the names of runs that are broken over two lines; parts end at separators.
BROKEN = r"""() => [...document.querySelectorAll('#run .name')].flatMap((name) =>
  [...name.childNodes].filter((node) => node.nodeType === Node.TEXT_NODE && node.length).filter((node) => {
    const range = document.createRange();
    range.selectNodeContents(node);
    return new Set([...range.getClientRects()].map((one) => Math.round(one.top))).size > 1;
  }).map((node) => node.data))"""

# Lines of the plot, its place, and the ends of the axes of the residuals.
DRAWN = """() => {
  const plot = document.getElementById('plot');
  const axes = Object.entries(plot.layout).filter(([name, axis]) => name.startsWith('yaxis') && axis.title.text === 'σ');
  return { lines: [...document.querySelectorAll('#plot .scatterlayer .trace')].filter((trace) => trace.querySelector('path.js-line')).length, top: plot.getBoundingClientRect().top,
    axes: axes.map(([name, axis]) => [name, ...axis.range]),
    titles: plot.layout.annotations.map((one) => one.text),
    residuals: plot.data.filter((line) => line.legendgroup === 'residual').map((line) => line.y) };
}"""


def assert_in_view(page: Page) -> None:
    """The page does not scroll, and the plots are inside the window with all of their height."""
    window = page.viewport_size
    heights = page.evaluate("[document.documentElement.scrollHeight, document.body.scrollHeight]")
    assert max(heights) <= window["height"], heights
    box = page.locator("#plot .main-svg").first.bounding_box()
    assert box["y"] >= 0 and box["y"] + box["height"] <= window["height"], box
    scrolled = page.evaluate("(() => { const at = document.getElementById('plot-view'); return at.scrollHeight - at.clientHeight; })()")
    assert scrolled <= 1, f"the plots have to be scrolled by {scrolled} px"


def tabs(page: Page, pictures: Path, window: str) -> None:
    """The plots stay beside each tab of the column; the tabs are reached by keys."""
    page.locator("#tab-map").focus()
    for tab in ("map", "missing", "model", "controller"):
        expect(page.locator(f"#{tab}")).to_be_visible()
        assert_in_view(page)
        page.screenshot(path=pictures / f"instrument_{window}_{tab}.png")
        page.keyboard.press("ArrowRight")
    expect(page.locator("#loop")).to_be_visible()
    expect(page.locator("#tab-loop")).to_be_focused()
    page.keyboard.press("Home")
    expect(page.locator("#map")).to_be_visible()


def runs(page: Page) -> None:
    """Sorted by error, searched, and chosen by keys."""
    shown = page.locator("#run .run:visible")
    errors = [float(text.split()[0]) for text in page.locator("#run .error").all_inner_texts()]
    assert errors == sorted(errors, reverse=True), errors
    every = shown.count()
    page.fill("#run-search", "LOWER 250")
    expect(shown).to_have_count(1)
    expect(shown).to_contain_text("lower_2.2A_250kg")
    page.fill("#run-search", "nothing like this")
    expect(shown).to_have_count(0)
    expect(page.locator("#run-none")).to_be_visible()
    page.fill("#run-search", "")
    expect(shown).to_have_count(every)
    page.select_option("#run-order", "file")
    names = page.locator("#run .name").all_inner_texts()
    assert names[0].startswith("duty_050kg"), names
    shown.first.locator("label").click()
    expect(page.locator("#runs-title")).to_contain_text("duty_050kg")
    page.keyboard.press("ArrowDown")
    expect(page.locator("#runs-title")).to_contain_text("duty_150kg")
    page.select_option("#run-order", "error")
    assert not page.evaluate(BROKEN), page.evaluate(BROKEN)
    height = page.locator("#run").bounding_box()["height"]
    assert height < 0.45 * page.viewport_size["height"], height


def signals(page: Page) -> None:
    """Signals are left out and shown again; one channel stays."""
    groups = "document.getElementById('plot').data.map((line) => line.legendgroup)"
    buttons = page.locator("#signals button")
    every = page.evaluate(groups)
    page.get_by_role("button", name="currents", exact=True).click()
    page.wait_for_function(f"!{groups}.includes('lift')")
    page.get_by_role("button", name="residuals", exact=True).click()
    page.wait_for_function(f"!{groups}.includes('residual')")
    for index in range(4):
        buttons.nth(index).click()
    expect(page.locator("#signals [aria-pressed=true]")).to_have_count(1)
    page.wait_for_function(f"{groups}.filter((group) => group === 'measured').length === 1")
    assert_in_view(page)
    left_out = page.locator("#signals [aria-pressed=false]")
    while left_out.count():
        left_out.first.press("Enter")
    page.wait_for_function(f"{groups}.length === {len(every)}")


def cursor(page: Page, pictures: Path) -> None:
    """The cursor reads every row, by keys and by the pointer; the fixed one gives differences."""
    rows = len(page.evaluate("document.getElementById('plot').layout.annotations"))
    page.locator("#plot").focus()
    page.keyboard.press("Home")
    labels = page.locator("#plot-cursor span")
    expect(labels).to_have_count(rows + 1)
    expect(page.locator("#place")).to_contain_text(" s: ")
    page.keyboard.press("Enter")
    for _ in range(5):
        page.keyboard.press("Shift+ArrowRight")
    expect(labels.first).to_contain_text("Δ")
    expect(labels.nth(1)).to_contain_text("Δ")
    page.screenshot(path=pictures / "instrument_cursor.png")
    page.keyboard.press("+")
    span = "(() => { const [from, to] = document.getElementById('plot').layout.xaxis.range; return to - from; })()"
    before = page.evaluate(span)
    page.keyboard.press("+")
    page.wait_for_function(f"{span} < {0.6 * before}")
    page.keyboard.press("0")
    page.wait_for_function(f"{span} > {before}")
    page.keyboard.press("Escape")
    expect(page.locator("#plot-cursor")).to_be_hidden()
    box = page.locator("#plot .nsewdrag").first.bounding_box()
    page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 5)
    expect(labels).to_have_count(rows + 1)
    page.mouse.move(5, 5)


def drawn(page: Page, trials: list | None = None) -> dict:
    """What the plot shows once each of these requests for a trial, if any, is drawn and the drawing does not change any more."""
    before = None
    for _ in range(PATIENCE_MS // 200):
        page.wait_for_timeout(200)
        now = page.evaluate(DRAWN)
        measured = page.evaluate("['redraw', 'all runs'].map((name) => performance.getEntriesByName(name).length)")
        # As text: a missing value is not equal to itself.
        if json.dumps(now) == json.dumps(before) and (trials is None or sum(measured) == len(trials)):
            return now
        before = now
    raise AssertionError(f"the drawing does not come to rest: {trials and len(trials)} trials, {measured} drawn")


def drag(page: Page, pictures: Path) -> None:
    """A parameter moved by pointer and keys on a run of a flow bench: headings, list and heading of the page have the errors of the drawn trial."""
    page.click("#tab-missing")
    page.click("#rank")
    page.wait_for_selector("#ranking .effect .sign")
    page.locator("#ranking .effect button.add").first.click()
    page.wait_for_selector("#effects .effect")
    expect(page.locator("#job")).to_be_hidden()
    page.locator("#run label", has_text="flow_lower_005bar").click()
    expect(page.locator("#runs-title")).to_contain_text("flow_lower_005bar")
    trials = []
    page.on("request", lambda request: trials.append(request) if "/api/preview" in request.url else None)
    before = drawn(page)
    answers = {}

    def heard(response) -> None:
        for path in ("preview", "preview/all"):
            if response.url.endswith(f"api/{path}"):
                answers.setdefault(path, []).append(response)

    page.on("response", heard)
    slider = page.locator("#effects input[type=range]").first
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    thumb_px, y_px = 16, box["y"] + box["height"] / 2
    at_px = box["x"] + thumb_px / 2 + int(slider.input_value()) / 1000 * (box["width"] - thumb_px)
    page.mouse.move(at_px, y_px)
    page.mouse.down()
    for step in range(20):
        page.mouse.move(at_px + step * 0.008 * box["width"], y_px)
        page.wait_for_timeout(30)
    page.wait_for_function("performance.getEntriesByName('all runs').length > 2")
    during = drawn(page, trials)
    page.screenshot(path=pictures / "instrument_dragged.png")
    # The button is still down: the step has not been made.
    expect(page.locator("#steps li")).to_have_count(2)
    assert during["lines"] == before["lines"], (during["lines"], before["lines"])
    assert during["top"] == before["top"], (during["top"], before["top"])
    run, every = (answers[path][-1].json() for path in ("preview", "preview/all"))
    errors = [f"{one['error']:.2f} σ" for one in run["channels"]]
    titles = [title for title in during["titles"] if "error" in title]
    assert all(any(title.endswith(f"error {error}") for title in titles) for error in errors), (titles, errors)
    assert f"error {every['error']:.2f} σ" in page.locator("#title").inner_text()
    listed = sorted(page.locator("#run .error").all_inner_texts())
    assert listed == sorted(f"{error:.2f} σ" for error in every["runs"]), (listed, every["runs"])
    for (name, low, high), values in zip(during["axes"], during["residuals"]):
        seen = [value for value in values if value is not None]
        assert low <= min(seen) and max(seen) <= high, (name, low, high, min(seen), max(seen))
    for (name, low, high), (_, was_low, was_high) in zip(during["axes"], before["axes"]):
        assert low <= was_low and was_high <= high, f"{name} shrinks while a parameter is moved"
    page.mouse.up()
    expect(page.locator("#steps li")).to_have_count(3)
    expect(page.locator("#job")).to_be_hidden()
    slider.focus()
    for _ in range(10):
        page.keyboard.press("ArrowLeft")
    # Slow keys make several steps.
    expect(page.locator("#steps li").nth(3)).to_be_attached()
    expect(page.locator("#job")).to_be_hidden()
    after = drawn(page)
    for key in ("lines", "top"):
        assert after[key] == before[key], (key, after[key], before[key])
    times = page.evaluate("performance.getEntriesByName('all runs').map((entry) => entry.duration)")
    print(f"errors of all runs within {sorted(times)[len(times) // 2]:.0f} ms (median of {len(times)})")


def main() -> None:
    address, name, folder = sys.argv[1:4]
    with story(name, folder) as (browser, pictures, faults):
        for window, size in WINDOWS.items():
            page = opened(browser, address, {"viewport": size}, faults)
            page.wait_for_selector("#views[data-ready]")
            tabs(page, pictures, window)
            runs(page)
            signals(page)
            cursor(page, pictures)
            assert_accessible(page)
            drag(page, pictures)
            assert_in_view(page)
            assert_accessible(page)
        page = opened(browser, address, PHONE, faults)
        page.wait_for_selector("#views[data-ready]")
        for tab in ("missing", "model", "loop", "map"):
            page.click(f"#tab-{tab}")
            assert_fits(page)
        boxes = [page.locator(part).bounding_box() for part in ("#map", "#choice", "#runs")]
        assert all(above["y"] + above["height"] <= below["y"] for above, below in zip(boxes, boxes[1:])), boxes
        assert not page.evaluate(BROKEN), page.evaluate(BROKEN)
        assert_accessible(page)
    print("the instrument went well")


if __name__ == "__main__":
    main()
