"""Two models compared in the page of `hitch serve`, in a headless Chromium: a model file, then an earlier step.

Called with the page's address, a model file, a broken one, the browser, and a folder for pictures.
"""

import sys
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PHONE, assert_accessible, assert_fits, opened, story


def choose(page: Page, model: Path) -> None:
    """Chooses a model file by the keyboard."""
    with page.expect_file_chooser() as choosing:
        page.locator("#second-file").press("Enter")
    choosing.value.set_files(model)


def groups(page: Page) -> list:
    """The lines of the plot, by their groups of the legend."""
    return page.evaluate("document.getElementById('plot').data.map((line) => line.legendgroup)")


def compare_file(page: Page, model: Path, pictures: Path, view: str) -> None:
    """A model file beside the present model, in map and plot."""
    page.wait_for_selector("#views[data-ready]")
    choose(page, model)
    expect(page.locator("#second-view")).to_be_visible()
    expect(page.locator("#second option:checked")).to_have_text(model.name)
    expect(page.locator("#second-text")).to_contain_text(f"from {model.name} to present model")
    cells = page.locator("#cells td button")
    worse = [text for text in cells.all_inner_texts() if text.startswith("▲")]
    assert worse, "the initial model is worse than the fitted one"
    page.click("#second-swap")
    expect(page.locator("#second-text")).to_contain_text(f"from present model to {model.name}")
    better = page.locator("#cells td button", has_text="▼")
    sizes = [float(text.split()[1]) for text in better.all_inner_texts()]
    better.nth(sizes.index(max(sizes))).click()
    expect(page.locator("#place")).to_contain_text("Largest change for")
    lines = groups(page)
    assert lines.count("second") == lines.count("simulated") + lines.count("residual"), lines
    assert "first" not in lines, lines
    page.wait_for_timeout(300)
    page.screenshot(path=pictures / f"second_{view}.png")
    page.locator("#map").screenshot(path=pictures / f"second_map_{view}.png")
    assert_fits(page)
    assert_accessible(page)


def own_maps(page: Page) -> None:
    """The map shows each model, and their change."""
    text = page.locator("#cells").inner_text
    shown = set()
    for name in ("present", "second", "change"):
        page.click(f"#second-shown-{name}")
        expect(page.locator(f"#second-shown-{name}")).to_be_focused()
        shown.add(text())
    assert len(shown) == 3, shown


def compare_step(page: Page) -> None:
    """An earlier step; it is that of before when the model is changed, until the comparison is closed."""
    page.select_option("#second", "0")
    expect(page.locator("#second-text")).to_have_text("Both are the same model.")
    page.click("#tab-missing")
    page.click("#rank")
    page.wait_for_selector("#ranking .effect")
    expect(page.locator("#job")).to_be_hidden()
    page.locator("#ranking .effect button.add").first.click()
    page.wait_for_selector("#effects .effect")
    page.click("#tab-map")
    expect(page.locator("#second option:checked")).to_contain_text("step 0")
    expect(page.locator("#second-channels tbody tr").last.locator("td").last).to_contain_text("▼")
    page.click("#second-close")
    expect(page.locator("#second-view")).to_be_hidden()
    expect(page.locator("#second")).to_be_focused()
    page.wait_for_function("!document.getElementById('plot').data.some((line) => line.legendgroup === 'second')")


def refused(page: Page, broken: Path, pictures: Path) -> None:
    """A broken model file: the fault has its line."""
    page.wait_for_selector("#views[data-ready]")
    choose(page, broken)
    lines = broken.read_text(encoding="utf-8").splitlines()
    line = 1 + next(index for index, text in enumerate(lines) if "oops" in text)
    expect(page.locator("#second-fault")).to_contain_text(f"{broken.name}:{line}:")
    expect(page.locator("#job")).to_be_hidden()
    page.locator("#map").screenshot(path=pictures / "second_fault.png")
    assert_accessible(page)


def main() -> None:
    address, model, broken, name, folder = sys.argv[1:6]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"phone": PHONE, "dark": DARK, "desktop": DESKTOP}.items():
            page = opened(browser, address, options, faults)
            compare_file(page, Path(model), pictures, view)
        page.emulate_media(media="print")
        page.screenshot(path=pictures / "second_print.png", full_page=True)
        page.emulate_media(media="screen")
        own_maps(page)
        compare_step(page)
        # A refused request is a message of the console.
        refused(opened(browser, address, DESKTOP, []), Path(broken), pictures)
    print("the comparison went well")


if __name__ == "__main__":
    main()
