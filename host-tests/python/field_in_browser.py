"""The work on a field in the closed loop of `hitch serve`, in a headless Chromium: draft control in varying loam, a soft patch, another
soil, and what the drawing shows.

Called with the page's address, the browser, and a folder for pictures.
"""

import re
import sys
import time
from statistics import fmean

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PATIENCE_MS, PHONE, assert_accessible, assert_fits, opened, story

# Set point of the draft, kN, and how far the mean over the seconds of the chart may be from it.
SET_KN, OFF_KN = 18.2, 1.0

# Time for the entry into the soil, and of the work that is judged, s.
ENTRY_S, WORK_S = 15, 20


def row(page: Page, title: str) -> list[float]:
    """The samples of the second hitch in the row of the strip chart with that title."""
    return page.evaluate(
        """(title) => {
          const chart = document.getElementById("loop-chart");
          const index = chart.layout.annotations.findIndex((one) => one.text === title);
          const axis = index === 0 ? "y" : `y${index + 1}`;
          return [...chart.data.filter((line) => line.yaxis === axis).at(-1).y];
        }""",
        title,
    )


def simulated_s(page: Page) -> float:
    """The time of the last sample."""
    return page.evaluate("document.getElementById('loop-chart').data.at(-1).x.at(-1) ?? 0")


def pass_time(page: Page, seconds: float) -> None:
    """Waits until the simulation has gone on."""
    until_s, patience_s = simulated_s(page) + seconds, time.monotonic() + PATIENCE_MS / 1000
    while simulated_s(page) < until_s:
        assert time.monotonic() < patience_s, "the simulation stands still"
        page.wait_for_timeout(200)


def last_s(values: list[float], seconds: float) -> list[float]:
    """The last samples of a row, which are 10 ms apart."""
    return values[-int(seconds * 100) :]


def to_field(page: Page) -> None:
    """Opens the closed loop and puts a plough behind the hitch, with the keyboard."""
    page.wait_for_selector("#views[data-ready]")
    page.click("#tab-loop")
    page.wait_for_selector("#loop[data-ready]")
    expect(page.locator("#field-view")).to_be_hidden()
    page.locator("#field-on").focus()
    page.keyboard.press("ArrowDown")
    expect(page.locator("#field-controls")).to_be_visible()
    expect(page.locator("#loop-lever-value")).to_have_text("125.0 deg")
    page.click("#loop-start")
    expect(page.locator("#field-reason")).to_have_text("the lever")


def works_by_draft(page: Page) -> float:
    """Draft control in varying loam settles near its set point; the mean depth, cm."""
    page.select_option("#field-function", "draft")
    expect(page.locator("#field-reason")).to_have_text("the lever, until the implement works in the ground")
    expect(page.locator("#loop-depth-1")).to_have_text("above ground")
    page.click("#field-down")
    pass_time(page, ENTRY_S + WORK_S)
    draft_kn = fmean(last_s(row(page, "draft and set point"), WORK_S))
    depth_cm = fmean(last_s(row(page, "working depth"), WORK_S))
    print(f"mean draft {draft_kn:.2f} kN at a set point of {SET_KN} kN, mean depth {depth_cm:.1f} cm")
    assert abs(draft_kn - SET_KN) < OFF_KN, draft_kn
    expect(page.locator("#field-reason")).to_have_text("the draft")
    expect(page.locator("#field-work")).to_have_text("in work")
    return depth_cm


def soft_patch(page: Page, depth_cm: float) -> None:
    """On a soft patch the slip raises the implement."""
    page.locator("#field-patch").press("Enter")
    expect(page.locator("#field-view .soft").first).to_be_attached()
    expect(page.locator("#field-reason")).to_have_text("the slip, which is above its limit")
    # 20 m at 6.5 km/h are 11 s.
    pass_time(page, 8)
    shallow_cm = fmean(last_s(row(page, "working depth"), 4))
    slip = max(last_s(row(page, "slip and limit"), 8))
    print(f"on the soft patch: slip up to {slip:.1f} %, depth {shallow_cm:.1f} cm instead of {depth_cm:.1f} cm")
    assert shallow_cm < depth_cm - 2, (shallow_cm, depth_cm)


def sand(page: Page) -> None:
    """Another soil comes from the front and is named."""
    page.select_option("#field-soil", "coarse")
    expect(page.locator("#field-view text").filter(has_text="sand")).to_be_attached()
    expect(page.locator("#field-view .coarse").first).to_be_attached()


def assert_drawn(page: Page) -> None:
    """Arrows with their values, the tractor above the ground, the shares below its surface."""
    expect(page.locator("#field-view .draft text")).to_have_text(re.compile(r"^draft \d+\.\d kN$"))
    expect(page.locator("#field-view .vertical text")).to_have_text(re.compile(r"^vertical .?\d+\.\d kN$"))
    lowest, surface, arrow = page.evaluate(
        """() => ["#field-view .plough", "#field-view .surface", "#field-view .draft line"]
          .map((one) => document.querySelector(one).getBoundingClientRect())
          .map((box) => [box.left, box.bottom, box.width])"""
    )
    assert lowest[1] > surface[1] + 5, (lowest, surface)
    assert arrow[2] > 10, arrow


def main() -> None:
    address, name, folder = sys.argv[1:4]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
            page = opened(browser, address, options, faults)
            began_s = time.monotonic()
            to_field(page)
            if view == "desktop":
                depth_cm = works_by_draft(page)
                assert_drawn(page)
                page.screenshot(path=pictures / "field_work.png")
                soft_patch(page, depth_cm)
                page.screenshot(path=pictures / "field_patch.png")
                sand(page)
                print(f"{simulated_s(page):.0f} s of the field passed in {time.monotonic() - began_s:.0f} s")
            else:
                page.select_option("#field-ground", "rough")
                page.select_option("#field-function", "draft")
                page.click("#field-down")
                pass_time(page, 8)
                assert_drawn(page)
            page.locator("#field-view").scroll_into_view_if_needed()
            page.screenshot(path=pictures / f"field_{view}.png")
            page.locator("#loop").screenshot(path=pictures / f"field_loop_{view}.png")
            assert_accessible(page)
            assert_fits(page)
            page.click("#loop-start")
            page.select_option("#field-on", "load")
            expect(page.locator("#field-view")).to_be_hidden()
            page.context.close()
    print("the field was worked")


if __name__ == "__main__":
    main()
