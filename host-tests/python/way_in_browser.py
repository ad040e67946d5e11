"""The whole way on the page of `hitch serve`, in a headless Chromium: another first model, values of data sheets, a fit of the constants,
a calibration tuned and saved; the list of steps says where one is.

Called with the page's address, the browser, and a folder for pictures.
"""

import sys
import zipfile
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PHONE, assert_accessible, assert_fits, opened, story

STEPS = ["data", "model", "fit", "effects", "calibration", "loop", "tuning", "save"]


def step(page: Page, key: str):
    """A step of the list."""
    return page.locator(f"#way [data-step={key}]")


def first_model(page: Page) -> None:
    """The first model is exchanged and comes back; values of a data sheet make another; a wrong value is refused."""
    step(page, "model").click()
    page.locator("#first > summary").click()
    page.click("#first-dynamic")
    expect(page.locator("#first-name")).to_contain_text("dynamic")
    expect(step(page, "model")).to_contain_text("dynamic")
    expect(page.locator("#subtitle")).to_contain_text("dynamic")
    page.click("#first-back")
    expect(page.locator("#first-name")).to_contain_text("nominal")
    before = page.locator("#title").inner_text()
    page.locator("#sheet > summary").click()
    bore = page.locator("[data-name='cylinder.bore_mm']")
    bore.fill(str(float(bore.input_value()) * 1.05))
    page.locator("#sheet-form button").click()
    expect(page.locator("#first-name")).to_contain_text("data-sheet")
    assert page.locator("#title").inner_text() != before
    page.click("#first-back")
    expect(page.locator("#title")).to_have_text(before)
    tables(page)


def choose_table(page: Page, of: str, text: bytes) -> None:
    """Chooses a table for a valve."""
    with page.expect_file_chooser() as choosing:
        page.locator(f"#sheet-tables [data-of={of}]").press("Enter")
    choosing.value.set_files({"name": "curve.csv", "mimeType": "text/csv", "buffer": text})


def tables(page: Page) -> None:
    """A flow curve of a table becomes that of its valve."""
    before = page.locator("#title").inner_text()
    page.locator("#sheet > summary").click()
    choose_table(page, "lower", b"Strom [mA];Durchfluss [l/min]\n0;0\n1100;0\n3200;40,0\n")
    expect(page.locator("#first-status")).to_contain_text("3 points, opens at 1.10 A, 40.0 l/min at 3.20 A")
    expect(page.locator("[data-name='lower_valve.opens']")).to_have_value("1.100")
    expect(page.locator("#title")).not_to_have_text(before)
    page.click("#first-back")
    expect(page.locator("#title")).to_have_text(before)


def refused(page: Page) -> None:
    """A value that is no number is refused with the name of its constant, and a table without a current with its line."""
    page.wait_for_selector("#views[data-ready]")
    step(page, "model").click()
    page.locator("#first > summary").click()
    page.locator("#sheet > summary").click()
    page.locator("[data-name='cylinder.bore_mm']").fill("wide")
    page.locator("#sheet-form button").click()
    expect(page.locator("#first-fault")).to_contain_text("cylinder.bore_mm")
    choose_table(page, "lift", b"a,b\n1,2\n")
    expect(page.locator("#first-fault")).to_contain_text("curve.csv:1:")
    assert_accessible(page)


def fitted(page: Page, name: str) -> list[float]:
    """Declared and fitted value of a constant in the table."""
    row = page.locator("#constants-fitted tbody tr").filter(has=page.get_by_role("rowheader", name=name, exact=True))
    return [float(text) for text in row.locator("td").all_inner_texts()[:2]]


def constants(page: Page, pictures: Path, view: str) -> None:
    """The constants are fitted but for the one that is held; one is in a range, in whose middle the fit starts."""
    step(page, "fit").click()
    page.locator("#constants-view > summary").click()
    page.locator("#constants-view details > summary").click()
    page.get_by_label("cylinder.bore_mm is exact", exact=True).check()
    expect(page.get_by_label("Tolerance or range of cylinder.bore_mm")).to_be_disabled()

    within = page.get_by_label("Tolerance or range of lower_valve.current_a")
    row = page.get_by_role("group", name="lower_valve.current_a")
    expect(row.locator(".declared")).to_have_text("0.9990 A")
    fault = row.get_by_role("alert")
    for text, what in {"about": "neither a tolerance", "9..8": "not two rising values", "0": "above zero"}.items():
        within.fill(text)
        within.press("Tab")
        expect(fault).to_contain_text(what)
    page.click("#constants-fit")
    expect(page.locator("#job")).to_be_hidden()
    expect(page.locator("#constants-fitted table")).to_have_count(0)
    page.get_by_label("Tolerance or range of lift_valve.flow_lpm").fill("12 %")
    page.get_by_label("Tolerance or range of pump.theoretical_flow_lpm").fill("0..1")
    page.get_by_label("Tolerance or range of pump.theoretical_flow_lpm").press("Tab")
    expect(page.get_by_role("group", name="pump.theoretical_flow_lpm").get_by_role("alert")).to_contain_text("above zero")
    page.screenshot(path=pictures / f"way_known_{view}.png")
    assert_accessible(page)
    page.get_by_label("Tolerance or range of pump.theoretical_flow_lpm").fill("")
    within.fill("1,1 .. 1.3")
    within.press("Tab")
    expect(fault).to_be_empty()

    page.click("#constants-fit")
    expect(page.locator("#constants-fitted table")).to_be_visible()
    expect(step(page, "fit")).to_contain_text("→")
    names = page.locator("#constants-fitted tbody th").all_inner_texts()
    assert names and "cylinder.bore_mm" not in names, names
    # The demonstration hides a shift of 0.2 A, which is beyond the usual tolerance.
    start_a, found_a = fitted(page, "lower_valve.threshold_a")
    assert abs(start_a - 1.2) < 1e-9 and abs(found_a - 1.2) < 0.01, f"from {start_a} A to {found_a} A"
    expect(page.locator("#constants-fitted")).not_to_contain_text("At the limit")
    expect(within).to_have_value("1,1 .. 1.3")
    page.screenshot(path=pictures / f"way_constants_{view}.png")


def calibration(page: Page, pictures: Path, view: str) -> None:
    """A tuned calibration says of each limit whether it is met; everything is saved in one archive."""
    step(page, "tuning").click()
    page.fill("#tune-trials", "10")
    page.click("#tune")
    verdicts = page.locator("#tuned tr.met, #tuned tr.missed")
    expect(verdicts.first).to_be_visible()
    for row in verdicts.all():
        expect(row).to_contain_text("limit met" if row.get_attribute("class") == "met" else "limit not met")
    expect(step(page, "tuning")).to_contain_text("limits met")
    page.screenshot(path=pictures / f"way_tuned_{view}.png")
    expect(step(page, "save")).to_contain_text("not saved")
    with page.expect_download() as saving:
        page.click("#save-all")
    names = sorted(zipfile.ZipFile(saving.value.path()).namelist())
    assert names == ["calibration.toml", "model.toml", "report.html", "tuned.toml"], names
    expect(step(page, "save").locator("small")).to_have_text("saved")
    for button, name in (("#save-report", "report.html"), ("#save-controller", "calibration.toml")):
        with page.expect_download() as saving:
            page.click(button)
        assert saving.value.suggested_filename == name


def main() -> None:
    address, name, folder = sys.argv[1:4]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
            page = opened(browser, address, options, faults)
            page.wait_for_selector("#views[data-ready]")
            assert [one.get_attribute("data-step") for one in page.locator("#way button").all()] == STEPS
            if view == "desktop":
                first_model(page)
                constants(page, pictures, view)
                calibration(page, pictures, view)
            for tab in ("model", "controller"):
                page.click(f"#tab-{tab}")
                closed = page.locator(f"#{tab} details:not([open]) > summary")
                while closed.count():
                    closed.first.click()
                page.screenshot(path=pictures / f"way_{tab}_{view}.png")
                if tab == "model":
                    page.locator("#known").screenshot(path=pictures / f"way_known_list_{view}.png")
                assert_fits(page)
                assert_accessible(page)
        # A refused request is a message of the console.
        refused(opened(browser, address, DESKTOP, []))
    print("the way went well")


if __name__ == "__main__":
    main()
