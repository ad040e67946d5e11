"""Reports of `hitch explain`, `loop` and `model fit` in a headless Chromium: the worst cell, zoom, print, and no scripts.

Called with the files of the reports, the browser, and a folder for pictures.
"""

import sys
import time
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PATIENCE_MS, PHONE, assert_accessible, assert_fits, opened, story

# Whether the element is laid out and not in a folded part.
VISIBLE = "(selector) => [...document.querySelectorAll(selector)].map((one) => one.checkVisibility())"


def loads_nothing(browser, address: str, options: dict, faults: list) -> Page:
    """The page, which may request nothing but itself."""
    page = opened(browser, address, options, faults)
    loaded = page.evaluate("performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert not loaded, loaded
    return page


def until(page: Page, condition: str) -> None:
    """Waits for a condition. The page forbids the evaluation of text, which `wait_for_function` needs."""
    end = time.monotonic() + PATIENCE_MS / 1000
    while not page.evaluate(condition):
        assert time.monotonic() < end, condition
        page.wait_for_timeout(50)


def show_worst_cell(page: Page) -> str:
    """Presses the worst cell of the error map; the id of the run that it leads to."""
    cells = page.locator("#cells td button")
    errors = [float(text) for text in cells.all_inner_texts()]
    cells.nth(errors.index(max(errors))).click()
    run = page.locator("details.run", has=page.locator("output", has_text="Worst for"))
    expect(run).to_have_count(1)
    expect(run).to_have_attribute("open", "")
    name = run.get_attribute("id")
    until(page, f"document.querySelector('#{name} .plot').layout?.shapes.some((one) => one.yref === 'paper')")
    expect(run).to_be_in_viewport()
    mark = page.evaluate(f"document.querySelector('#{name} .plot').layout.shapes.find((one) => one.yref === 'paper')")
    low, high = shown_range(page, name)
    assert low <= mark["x0"] < mark["x1"] <= high and high - low < 6, (low, high, mark)
    lines = page.evaluate(f"[...new Set(document.querySelector('#{name} .plot').data.map((line) => line.legendgroup))]")
    assert {"measured", "first", "simulated", "residual", "lift", "lower"} == set(lines), lines
    return name


def shown_range(page: Page, name: str) -> list:
    """The time axis of a run's plot, which all its channels share."""
    plot = page.evaluate(
        f"(({{data, _fullLayout}}) => [new Set(data.map((line) => line.xaxis ?? 'x')).size, _fullLayout.xaxis.range])"
        f"(document.querySelector('#{name} .plot'))"
    )
    assert plot[0] == 1, "the channels have one time axis"
    return plot[1]


def zoom(page: Page, name: str) -> None:
    """Drags over one channel: the time axis of all changes; the button shows the whole run again."""
    before = shown_range(page, name)
    grids = f"[...document.querySelectorAll('#{name} .plot .xgrid')].map((line) => line.getAttribute('transform') ?? line.getAttribute('d'))"
    places = page.evaluate(grids)
    box = page.locator(f"#{name} .plot .nsewdrag").nth(2).bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.3 * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.5 * box["width"], middle, steps=5)
    page.mouse.up()
    until(page, f"document.querySelector('#{name} .plot')._fullLayout.xaxis.range[0] > {before[0]}")
    after = shown_range(page, name)
    width = before[1] - before[0]
    assert abs(after[0] - before[0] - 0.3 * width) < 0.05 * width, (before, after)
    assert abs(after[1] - before[0] - 0.5 * width) < 0.05 * width, (before, after)
    assert page.evaluate(grids) != places, "the grids of all channels are redrawn"
    page.locator(f"#{name} button", has_text="Whole run").click()
    until(page, f"document.querySelector('#{name} .plot')._fullLayout.xaxis.range[0] === 0")


def toggle(page: Page, name: str) -> None:
    """An entry of the legend hides its lines in all channels."""
    page.locator(f"#{name} .legendtoggle").nth(1).click()
    until(
        page,
        f"document.querySelector('#{name} .plot')._fullData.filter((line) => line.legendgroup === 'first')"
        ".every((line) => line.visible === 'legendonly')",
    )


def prints(page: Page, pictures: Path, view: str) -> None:
    """In print, pictures and tables of all runs are visible, on white, and no plot is."""
    page.evaluate(
        "addEventListener('beforeprint', () => { window.unfolded = [...document.querySelectorAll('details')].every((one) => one.open); })"
    )
    folded = page.locator("details:not([open])").count()
    assert folded > 0
    page.pdf(path=pictures / f"report_{view}.pdf")
    assert page.evaluate("window.unfolded"), "everything is unfolded for printing"
    assert page.locator("details:not([open])").count() == folded, "and folded again"
    page.emulate_media(media="print")
    for selector in ["details.run .static figure", "table:not(#cells table)"]:
        visible = page.evaluate(VISIBLE, selector)
        assert visible and all(visible), (selector, visible)
    assert not any(page.evaluate(VISIBLE, ".plot, #map"))
    colours = page.evaluate("(({backgroundColor, color}) => [backgroundColor, color])(getComputedStyle(document.body))")
    assert colours == ["rgb(255, 255, 255)", "rgb(27, 31, 36)"], colours
    page.screenshot(path=pictures / f"report_{view}_print.png", full_page=True)
    page.emulate_media(media="screen")


def without_scripts(browser, address: str, pictures: Path) -> None:
    """Without scripts, the unfolded runs have pictures, and the errors are tables."""
    page = opened(browser, address, {**DESKTOP, "java_script_enabled": False}, [])
    expect(page.locator("details.run[open] .static svg[role=img]").first).to_be_visible()
    expect(page.locator(".replaced table").first).to_be_visible()
    expect(page.locator("#map")).to_be_hidden()
    page.screenshot(path=pictures / "report_no_scripts.png", full_page=True)


def explanation(browser, address: str, pictures: Path, faults: list) -> None:
    """The report of `hitch explain` in all views."""
    for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
        page = loads_nothing(browser, address, options, faults)
        expect(page.locator("#cells")).to_be_visible()
        page.screenshot(path=pictures / f"report_{view}.png", full_page=True)
        assert_fits(page)
        assert_accessible(page)
        name = show_worst_cell(page)
        page.wait_for_timeout(300)
        page.screenshot(path=pictures / f"report_{view}_worst.png")
        assert_fits(page)
        assert_accessible(page)
        if view == "desktop":
            zoom(page, name)
            toggle(page, name)
        prints(page, pictures, view)


def closed_loop(browser, address: str, pictures: Path, faults: list) -> None:
    """The report of `hitch loop`: moves become plots as they come into view."""
    for view, options in {"desktop": DESKTOP, "phone": PHONE}.items():
        page = loads_nothing(browser, address, options, faults)
        page.get_by_role("heading", name="Every move", exact=True).scroll_into_view_if_needed()
        expect(page.locator(".plotted.drawn .plot").first).to_be_visible()
        page.wait_for_timeout(500)
        page.screenshot(path=pictures / f"report_loop_{view}.png")
        assert_fits(page)
        assert_accessible(page)


def base_fit(browser, address: str, pictures: Path, faults: list) -> None:
    """The report of `hitch model fit`: a plot for each valve with declared and fitted curve, and a bar for each interval."""
    for view, options in {"desktop": DESKTOP, "phone": PHONE}.items():
        page = loads_nothing(browser, address, options, faults)
        for valve in ["Lift valve", "Lowering valve"]:
            plot = page.get_by_role("img", name=f"{valve}: declared and fitted flow over the current")
            plot.scroll_into_view_if_needed()
            expect(plot).to_be_visible()
            expect(plot.locator("path.js-line")).not_to_have_count(0)
            names = plot.evaluate("({data}) => data.map((line) => line.name)")
            assert names[:2] == ["declared", "fitted"] and len(names) > 2, names
            page.wait_for_timeout(300)
            page.screenshot(path=pictures / f"report_fit_{valve.split()[0].lower()}_{view}.png")
        page.get_by_role("heading", name="Constants", exact=True).scroll_into_view_if_needed()
        page.screenshot(path=pictures / f"report_fit_{view}.png", full_page=True)
        assert_fits(page)
        assert_accessible(page)


def main() -> None:
    explained, loop, fitted, name, folder = sys.argv[1:6]
    with story(name, folder) as (browser, pictures, faults):
        address = Path(explained).as_uri()
        explanation(browser, address, pictures, faults)
        closed_loop(browser, Path(loop).as_uri(), pictures, faults)
        base_fit(browser, Path(fitted).as_uri(), pictures, faults)
        without_scripts(browser, address, pictures)
    print("the reports went well")


if __name__ == "__main__":
    main()
