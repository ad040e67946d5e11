"""An ECU on its bus in the page of `hitch serve --can`, in a headless Chromium.

Called with the page's address, a file whose creation ends the ECU, the browser, and a folder for pictures.
"""

import re
import sys
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PHONE, assert_accessible, assert_fits, opened, story

CONTROLS = ["loop-lever", "loop-raise", "loop-lower", "loop-stop", "loop-quick", "loop-load", "loop-oil", "loop-sensor", "loop-restart"]


def angle_deg(page: Page) -> float:
    """The shown angle."""
    expect(page.locator("#loop-angle-1")).to_have_text(re.compile(r"\d deg"))
    return float(page.locator("#loop-angle-1").inner_text().split()[0])


def watch(page: Page, pictures: Path, view: str) -> None:
    """The page shows a hitch that moves, and offers no control of it."""
    page.wait_for_selector("#views[data-ready]")
    page.click("#tab-loop")
    expect(page.locator("#loop-bus")).to_contain_text("listen-only mode")
    expect(page.locator("#loop-start")).to_have_text("Pause")
    for control in CONTROLS:
        expect(page.locator(f"#{control}")).to_be_hidden()
    before_deg = angle_deg(page)
    moved = "(before) => Math.abs(parseFloat(document.getElementById('loop-angle-1').textContent) - before) > 5"
    page.wait_for_function(moved, arg=before_deg)
    lines = "document.getElementById('loop-chart').data.map((line) => [line.name, line.y.filter((one) => one !== null).length])"
    drawn = page.evaluate(lines)
    assert len(drawn) == 5 and all(name == "ECU on the bus" and count > 10 for name, count in drawn), drawn
    assert_fits(page)
    assert_accessible(page)
    page.locator("#loop").screenshot(path=pictures / f"bus_{view}.png")


def main() -> None:
    """The story."""
    address, end, name, folder = sys.argv[1:5]
    with story(name, folder) as (browser, pictures, faults):
        pages = {}
        for view, options in [("phone", PHONE), ("dark", DARK), ("desktop", DESKTOP)]:
            pages[view] = opened(browser, address, options, faults)
            watch(pages[view], pictures, view)
        Path(end).touch()
        page = pages["desktop"]
        expect(page.locator("#loop-bus")).to_contain_text("is lost")
        expect(page.locator("#loop-state-1")).to_have_text("not heard")
        expect(page.locator("#loop-angle-1")).to_have_text("–")
        expect(page.locator("#loop-events p").first).to_contain_text("is lost")
        assert_accessible(page)
        page.locator("#loop").screenshot(path=pictures / "bus_lost.png")
    print("the bus was watched")


main()
