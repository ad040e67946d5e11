"""The proposed next experiment on the page of `hitch serve`, in a headless Chromium: the pictures of its runs, and its currents.

Called with the page's address, the browser, and a folder for pictures.
"""

import csv
import io
import sys
import tomllib
import zipfile
from pathlib import Path

from playwright.sync_api import Locator, Page, expect

from browser_view import DARK, DESKTOP, PHONE, assert_accessible, assert_fits, opened, story


def currents(page: Page, place: Locator) -> list[list[list[float]]]:
    """Times and currents of each run in the saved archive; its campaign names all of them."""
    with page.expect_download() as saving:
        place.get_by_role("button", name="Save currents").click()
    with zipfile.ZipFile(saving.value.path()) as archive:
        campaign = tomllib.loads(archive.read("campaign.toml").decode())
        files = [run["file"] for run in campaign["run"]]
        names = sorted(["campaign.toml", *(f"currents/{file}" for file in files)])
        assert sorted(archive.namelist()) == names, archive.namelist()
        logs = [list(csv.reader(io.StringIO(archive.read(f"currents/{file}").decode()))) for file in files]
    for log in logs:
        assert log[0] == ["time_s", "lift_current_a", "lower_current_a"], log[0]
    return [[[float(cell) for cell in row] for row in log[1:]] for log in logs]


def pictures_of(page: Page, place: Locator) -> list[dict[str, list]]:
    """The drawn lines of each run, by name."""
    assert place.locator(".expected *").count() == 0, "nothing is simulated before it is asked for"
    place.locator(".next-experiment > summary").click()
    expect(place.locator(".expected[data-ready]")).to_be_visible()
    plots = place.locator(".expected [role=img]")
    return plots.evaluate_all(
        "plots => plots.map(plot => ({ lines: plot.data.map(({ name, x, y, yaxis }) => [name, yaxis, Array.from(x), Array.from(y)]) }))")


def shown(page: Page, place: Locator) -> None:
    """Each run has the currents of the files, and each channel as both models expect it."""
    runs = currents(page, place)
    plots = pictures_of(page, place)
    assert len(plots) == len(runs) > 0, f"{len(plots)} plots of {len(runs)} runs"
    names = set()
    for plot, run in zip(plots, runs):
        lines = plot["lines"]
        for name, column in (("lift current", 1), ("lowering current", 2)):
            drawn = next(y for line, _, _, y in lines if line == name)
            assert abs(max(drawn) - max(row[column] for row in run)) < 1e-3, name
        axes = [axis for name, axis, _, _ in lines if "current" not in name]
        assert axes and all(axes.count(axis) == 2 for axis in axes), axes
        names |= {name for name, _, _, _ in lines if "current" not in name}
    assert names == {"model A", "model B"}, names
    expect(place.locator(".expected li").nth(0)).to_contain_text("model A: ")
    # Somewhere the models differ, or the experiment would not be proposed.
    apart = [max(abs(a - b) for a, b in zip(one[3], other[3])) for plot in plots
             for one, other in zip(plot["lines"][2::2], plot["lines"][3::2])]
    assert max(apart) > 0.5, apart


def main() -> None:
    address, name, folder = sys.argv[1:4]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
            page = opened(browser, address, options, faults)
            page.wait_for_selector("#views[data-ready]")
            page.click("#tab-missing")
            page.click("#rank")
            place = page.locator("#ranking")
            expect(place).to_contain_text("Experiment that separates them")
            shown(page, place)
            page.screenshot(path=pictures / f"next_{view}.png")
            if view == "phone":
                place.locator(".expected").screenshot(path=pictures / f"next_runs_{view}.png")
            assert_fits(page)
            assert_accessible(page)
            # What is open stays open when something else is shown.
            place.locator("button.sign").first.click()
            expect(place.locator("button.sign").first).to_have_attribute("aria-pressed", "true")
            expect(place.locator(".expected[data-ready]")).to_be_visible()
    print("the next experiment went well")


if __name__ == "__main__":
    main()
