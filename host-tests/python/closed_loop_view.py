"""The closed loop of a page in a browser: how it is driven by clicking, with a server and without one."""

import re
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import assert_accessible, assert_fits


def about(angle_deg: int) -> re.Pattern:
    """Matches an angle within half a degree."""
    return re.compile(rf"^({angle_deg - 1}\.[5-9]|{angle_deg}\.[0-4])")


def both_in(page: Page, state: str) -> None:
    """Waits until both hitches are in a state."""
    for hitch in range(2):
        expect(page.locator(f"#loop-state-{hitch}")).to_have_text(state)


def assert_charts(page: Page) -> None:
    """The strip charts follow the simulation, and nothing covers them."""
    drawn = page.evaluate(
        "[...document.querySelectorAll('#loop-chart .scatterlayer path.js-line')].map((path) => path.getBBox().width)"
    )
    axis = page.evaluate("document.querySelector('#loop-chart .gridlayer').getBBox().width")
    assert max(drawn) > 0.1 * axis, (drawn, axis)
    page.locator("#loop-chart").scroll_into_view_if_needed()
    box = page.locator("#loop-chart .nsewdrag").first.bounding_box()
    top = "([x, y]) => Boolean(document.elementFromPoint(x, y)?.closest('#loop-chart'))"
    assert page.evaluate(top, [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2]), box


def assert_in_real_time(page: Page) -> None:
    """The simulation is not faster than real time, even after a pause that is ended at once."""
    for _ in range(2):
        page.evaluate("document.getElementById('loop-start').click()")
    clocks = "[document.getElementById('loop-chart').data[0].x.at(-1), performance.now() / 1000]"
    page.wait_for_timeout(300)
    before = page.evaluate(clocks)
    page.wait_for_timeout(2000)
    simulated_s, passed_s = (after - at for at, after in zip(before, page.evaluate(clocks)))
    assert 0 < simulated_s < 1.2 * passed_s, f"{simulated_s:.2f} s were simulated in {passed_s:.2f} s"


def drive(page: Page, pictures: Path, name: str, view: str) -> None:
    """Drives the closed loop: the hitch follows the lever, and a broken sensor is a fault."""
    page.wait_for_selector("#loop[data-ready]")
    expect(page.locator("#valve-map .main-svg").first).to_be_visible()
    expect(page.locator("#loop-chart")).to_be_hidden()
    page.click("#loop-start")
    expect(page.locator("#loop-start")).to_have_text("Pause")
    lever = page.locator("#loop-lever")
    lever.fill("110")
    for hitch in range(2):
        expect(page.locator(f"#loop-angle-{hitch}")).to_have_text(about(110))
        expect(page.locator(f"#loop-error-{hitch}")).to_contain_text("0.")
    both_in(page, "holding")
    page.locator("#loop-raise").focus()
    page.keyboard.down("Space")
    # On a busy machine the hitch may be at its end stop before the key is released.
    expect(page.locator("#loop-angle-1")).to_have_text(re.compile("^1(1[2-9]|2|3)"))
    page.keyboard.up("Space")
    both_in(page, "locked")
    # The lever picks the hitch up.
    lever.press("End")
    page.wait_for_timeout(150)
    for lever_deg in ("100", "60"):
        lever.fill(lever_deg)
        page.wait_for_timeout(150)
    expect(page.locator("#loop-angle-1")).to_have_text(about(60))
    page.locator("#loop").screenshot(path=pictures / f"{name}_{view}.png")
    assert_charts(page)
    lever.fill("120")
    page.wait_for_timeout(300)
    page.select_option("#loop-kind", "frozen")
    expect(page.locator("#loop-state-1")).to_contain_text("fault: ")
    expect(page.locator("#loop-events")).to_contain_text("Cause: ")
    page.locator("#loop").screenshot(path=pictures / f"{name}_fault_{view}.png")
    assert_accessible(page)
    assert_fits(page)
    page.select_option("#loop-kind", "none")
    both_in(page, "locked")
    assert_in_real_time(page)
    page.click("#loop-start")
    expect(page.locator("#loop-start")).to_have_text("Start")
    with page.expect_download() as saving:
        page.click("#save-calibration")
    text = Path(saving.value.path()).read_text(encoding="utf-8")
    assert "[lower]" in text, text[-400:]
    times = page.evaluate("performance.getEntriesByName('strip chart').map((entry) => entry.duration)")
    print(f"{name}, {view}: strip charts drawn within {sorted(times)[len(times) // 2]:.0f} ms (median of {len(times)})")
