"""The page that has controller and plant inside, in a headless Chromium without network: the closed loop is driven by clicking.

Called with the page's address, the browser, and a folder for pictures.
"""

import sys
import time
from statistics import median

from playwright.sync_api import Page

from browser_view import DARK, DESKTOP, PATIENCE_MS, PHONE, assert_accessible, story
from closed_loop_view import drive

# Simulated time, s, that is compared with the clock, and the least pace on a machine with other work too.
PACED_S = 5
SLOWEST = 0.5

# The transmission at 90 degrees is 4.3, the piston 45.4 cm2: 100 kg are 9.3 bar.
BAR_PER_100_KG = 9.3


def opened(browser, address: str, options: dict, faults: list) -> Page:
    """The page without a network; console messages and requests beyond the file count as faults."""
    page = browser.new_context(**options, offline=True).new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.on("pageerror", lambda error: faults.append(f"error: {error}"))
    page.on("console", lambda said: faults.append(f"console: {said.type}: {said.text}"))
    foreign = lambda request: request.url != address and not request.url.startswith("data:")
    page.on("request", lambda request: foreign(request) and faults.append(f"request: {request.url[:200]}"))
    began_s = time.monotonic()
    page.goto(address)
    page.wait_for_selector("#loop[data-ready]")
    print(f"described {1000 * (time.monotonic() - began_s):.0f} ms after the opening of the file")
    return page


def last(page: Page, key: str) -> float:
    """The last value of the second hitch in a row of the strip chart; of its time with the key `x`."""
    row = {"x": "y", "cylinder": "y4"}[key]
    lines = f"document.getElementById('loop-chart').data.filter((line) => (line.yaxis ?? 'y') === '{row}')"
    return page.evaluate(f"{lines}.at(-1).{'x' if key == 'x' else 'y'}.at(-1)")


def conditions(page: Page) -> None:
    """A load acts during the run, which keeps up with the clock, in cold oil as well."""
    page.locator("#loop-lever").fill("90")
    page.click("#loop-restart")
    page.click("#loop-start")
    page.wait_for_timeout(3000)
    light_bar = last(page, "cylinder")
    page.locator("#loop-load").fill("250")
    page.wait_for_timeout(4000)
    heavier_bar = last(page, "cylinder") - light_bar
    print(f"100 kg more are {heavier_bar:.2f} bar, expected {BAR_PER_100_KG}")
    assert abs(heavier_bar - BAR_PER_100_KG) < 1, heavier_bar
    page.locator("#loop-oil").fill("5")
    began_s, from_s = time.monotonic(), last(page, "x")
    page.wait_for_timeout(1000 * PACED_S)
    pace = (last(page, "x") - from_s) / (time.monotonic() - began_s)
    times = page.evaluate("performance.getEntriesByName('loop/step').map((entry) => entry.duration)")
    print(f"pace {pace:.2f} of real time; the module needs {median(times):.1f} ms for a step of the page (median of {len(times)})")
    assert pace > SLOWEST, pace
    page.click("#loop-start")


def main() -> None:
    address, name, folder = sys.argv[1:4]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
            page = opened(browser, address, options, faults)
            page.wait_for_timeout(300)
            page.screenshot(path=pictures / f"try_page_{view}.png")
            assert_accessible(page)
            drive(page, pictures, "try_page_loop", view)
            if view == "desktop":
                conditions(page)
    print("the page was tried")


if __name__ == "__main__":
    main()
