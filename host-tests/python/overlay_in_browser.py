"""Several runs over one another in the page of `hitch serve`, in a headless Chromium.

Called with the page's address, that of a page with 20 long runs, the browser, and a folder for pictures.
"""

import re
import sys
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PHONE, assert_accessible, assert_fits, opened, story

# What a user feels as at once, on a machine of one's own; measured and printed.
REDRAW_MS = 100
FRAME_MS = 1000 / 60

# Collects the times between frames.
FRAMES = """() => {
  window.framesEnd = false;
  window.frameTimes = [];
  let last = null;
  const next = (now) => {
    if (last !== null) window.frameTimes.push(now - last);
    last = now;
    if (!window.framesEnd) requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}"""

# Hues of the drawn lines, in steps of 10 deg, with the number of their pixels.
HUES = """() => {
  const canvas = document.getElementById("overlay-lines");
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  const hues = {};
  for (let at = 0; at < data.length; at += 4) {
    const [r, g, b, a] = data.slice(at, at + 4);
    const high = Math.max(r, g, b), low = Math.min(r, g, b);
    if (a < 250 || high - low < 60) continue;
    const raw = high === r ? (g - b) / (high - low) : high === g ? 2 + (b - r) / (high - low) : 4 + (r - g) / (high - low);
    const hue = Math.round((((raw * 60) + 360) % 360) / 10) % 36;
    hues[hue] = (hues[hue] ?? 0) + 1;
  }
  return hues;
}"""


def shown(page: Page, runs: int) -> None:
    """Waits until so many runs are drawn."""
    expect(page.locator("#overlay")).to_have_attribute("data-shown", str(runs))


def hues(page: Page) -> set:
    """The hues of the lines."""
    return {hue for hue, pixels in page.evaluate(HUES).items() if pixels > 50}


def overlay(page: Page, pictures: Path, view: str) -> None:
    """Ticks two runs, and takes one away."""
    page.wait_for_selector("#views[data-ready]")
    page.locator("#overlay summary").press("Enter")
    boxes = page.locator("#run input[type=checkbox]")
    boxes.nth(0).press("Space")
    shown(page, 1)
    one = hues(page)
    boxes.nth(1).press("Space")
    shown(page, 2)
    both = hues(page)
    assert one and one < both, (one, both)
    boxes.nth(0).press("Space")
    shown(page, 1)
    assert not hues(page) & one, "the legend switches a run off"
    page.click("#overlay-all")
    shown(page, boxes.count())
    expect(page.locator("#plot-view")).to_be_hidden()
    page.locator("#runs").screenshot(path=pictures / f"overlay_{view}.png")
    assert_fits(page)
    assert_accessible(page)
    # A cell shows one run again.
    page.locator("#cells td button").first.click()
    expect(page.locator("#overlay-view")).to_be_hidden()
    expect(page.locator("#run input[type=checkbox]:checked")).to_have_count(0)
    width = page.evaluate("document.querySelector('#plot .main-svg').clientWidth - document.getElementById('plot').clientWidth")
    assert abs(width) <= 1, f"the plot is {width} px wider than its place"


def zoom(page: Page) -> None:
    """Zooms in time, and back."""
    before = page.evaluate(HUES)
    box = page.locator("#overlay-plot .nsewdrag").first.bounding_box()
    y = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.3 * box["width"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], y, steps=5)
    page.mouse.up()
    page.wait_for_function("document.getElementById('overlay-plot').layout.xaxis.range[0] > 0")
    assert page.evaluate(HUES) != before, "the lines follow the axis"
    page.mouse.dblclick(box["x"] + 0.3 * box["width"], y)
    page.wait_for_function("document.getElementById('overlay-plot').layout.xaxis.range[0] === 0")


def cursor(page: Page, runs: int, pictures: Path) -> None:
    """Moves the pointer over the plot, and pans it; measures the frames meanwhile."""
    box = page.locator("#overlay-plot .nsewdrag").first.bounding_box()
    y = box["y"] + box["height"] / 2

    def sweep() -> None:
        for step in range(60):
            page.mouse.move(box["x"] + (0.2 + 0.01 * step) * box["width"], y)

    page.mouse.move(box["x"] + 0.2 * box["width"], y)
    frames(page, sweep, f"cursor over {runs} runs")
    label = page.locator("#overlay-cursor span")
    expect(label.first).to_have_text(re.compile(r"^[0-9.]+ s$"))
    assert " to " in label.nth(1).inner_text(), label.nth(1).inner_text()
    page.screenshot(path=pictures / "overlay_cursor.png")
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] - 200)
    expect(page.locator("#overlay-cursor")).to_be_hidden()
    page.locator("#overlay-plot .modebar-btn[data-val=pan]").click()
    page.mouse.move(box["x"] + 0.2 * box["width"], y)
    page.mouse.down()
    frames(page, sweep, f"panning {runs} runs")
    page.mouse.up()
    page.mouse.dblclick(box["x"] + 0.3 * box["width"], y)
    page.locator("#overlay-plot .modebar-btn[data-val=zoom]").click()


def frames(page: Page, act, what: str) -> None:
    """Prints the times between frames while something happens."""
    page.evaluate(FRAMES)
    act()
    times = sorted(page.evaluate("() => { window.framesEnd = true; return window.frameTimes; }"))
    middle, late = times[len(times) // 2], times[len(times) * 95 // 100]
    print(f"{what}: a frame every {middle:.1f} ms (95 %: {late:.1f} ms), wanted {FRAME_MS:.1f} ms")
    assert middle < 4 * FRAME_MS, "the machine may be busy, but not that much"


def measure(page: Page, pictures: Path) -> None:
    """Measures the redraw of many runs when one is switched."""
    page.wait_for_selector("#views[data-ready]")
    page.locator("#overlay summary").press("Enter")
    page.click("#overlay-all")
    boxes = page.locator("#run input[type=checkbox]")
    runs = boxes.count()
    shown(page, runs)
    zoom(page)
    cursor(page, runs, pictures)
    page.evaluate("performance.clearMeasures('overlay')")
    for _ in range(5):
        for expected in (runs - 1, runs):
            boxes.first.press("Space")
            shown(page, expected)
            page.wait_for_timeout(100)
    page.wait_for_timeout(300)
    times = page.evaluate("performance.getEntriesByName('overlay').map((entry) => entry.duration)")
    middle = sorted(times)[len(times) // 2]
    print(f"{runs} runs redrawn within {middle:.0f} ms (median of {len(times)}), wanted {REDRAW_MS} ms")


def main() -> None:
    address, long, name, folder = sys.argv[1:5]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
            overlay(opened(browser, address, options, faults), pictures, view)
        measure(opened(browser, long, DESKTOP, faults), pictures)
    print("the overlay went well")


if __name__ == "__main__":
    main()
