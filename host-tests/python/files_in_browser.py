"""Files opened in the page of `hitch serve`, in a headless Chromium: a log of another logger is assigned and opened.

Called with the page's address, a log, a broken log, a log with a voltage, two files of one recording, the browser, and a folder for
pictures.
"""

import sys
from pathlib import Path

from playwright.sync_api import Page, expect

from browser_view import DARK, DESKTOP, PHONE, assert_accessible, assert_fits, opened, story

# Drops a file on the page, as a user does from a folder.
DROP = """([name, text]) => {
  const data = new DataTransfer();
  data.items.add(new File([text], name));
  for (const kind of ["dragover", "drop"])
    document.body.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
}"""


def open_log(page: Page, log: Path, pictures: Path, view: str) -> None:
    """Chooses a log, edits its assignment, and opens it."""
    page.wait_for_selector("#views[data-ready]")
    with page.expect_file_chooser() as choosing:
        page.locator("#files-choose").press("Enter")
    choosing.value.set_files(log)
    expect(page.locator("#files-form")).to_be_visible()
    column = page.get_by_label("Column for lowering current")
    expect(column).to_have_value("Ventil Senken Strom")
    unit = page.get_by_label("Unit of lowering current")
    expect(unit).to_have_value("mA")
    page.get_by_label("Column for flow").select_option("")
    page.locator("#files").screenshot(path=pictures / f"files_{view}.png")
    assert_fits(page)
    assert_accessible(page)
    page.click("#files-open")
    expect(page.locator("#title")).to_contain_text(log.stem)
    expect(page.locator("#files-form")).to_be_hidden()
    expect(page.locator("#run .run")).to_have_count(1)
    heads = page.locator("#cells thead th").all_inner_texts()
    assert "rocker angle" in heads and "flow" not in heads, heads
    page.wait_for_timeout(300)
    page.screenshot(path=pictures / f"files_opened_{view}.png")
    assert_fits(page)
    assert_accessible(page)


def refused(page: Page, broken: Path, pictures: Path) -> None:
    """Drops a broken log, and mends its assignment; the campaign stays."""
    page.wait_for_selector("#views[data-ready]")
    page.evaluate(DROP, [broken.name, broken.read_text(encoding="utf-8")])
    expect(page.locator("#files-form")).to_be_visible()
    page.click("#files-open")
    expect(page.locator("#files-fault")).to_contain_text("the load at the hitch is missing")
    page.get_by_label(f"Load of {broken.name}, kg").fill("150")
    page.click("#files-open")
    expect(page.locator("#files-fault")).to_contain_text(f"{broken.name}:2:18")
    page.locator("#files").screenshot(path=pictures / "files_fault.png")
    assert_accessible(page)
    page.click("#files-discard")
    expect(page.locator("#files-form")).to_be_hidden()
    expect(page.locator("#title")).to_contain_text("demonstration")


def points(page: Page, log: Path, pictures: Path) -> None:
    """A voltage is left out with its reason, and assigned by two known points of its sensor."""
    page.wait_for_selector("#views[data-ready]")
    with page.expect_file_chooser() as choosing:
        page.locator("#files-choose").press("Enter")
    choosing.value.set_files(log)
    expect(page.locator(".left-out")).to_contain_text('"Zylinderdruck": it is in V')
    page.get_by_label("Column for cylinder pressure").select_option("Zylinderdruck")
    expect(page.get_by_label("Unit of cylinder pressure")).to_have_value("raw:V")
    group = page.get_by_role("group", name="Two known points of cylinder pressure")
    for field, value in zip(group.locator("input").all(), ("0.5", "0", "4.5", "250")):
        field.fill(value)
    page.locator("#files").screenshot(path=pictures / "files_points.png")
    assert_fits(page)
    assert_accessible(page)
    page.click("#files-open")
    expect(page.locator("#title")).to_contain_text(log.stem)
    heads = page.locator("#cells thead th").all_inner_texts()
    assert "cylinder pressure" in heads, heads


def notes(page: Page, parts: list[Path], pictures: Path) -> None:
    """What is assumed and left out is shown before files are opened, and which are joined and cut behind it."""
    page.wait_for_selector("#views[data-ready]")
    with page.expect_file_chooser() as choosing:
        page.locator("#files-choose").press("Enter")
    choosing.value.set_files(parts)
    # Of the first of two files, whose columns are the same.
    said = page.locator(".left-out").first
    expect(said).to_contain_text('"Zylinderdruck": it is in V')
    expect(said).to_contain_text('"Luftfeuchte": its name is none of a signal of a run')
    assumed = page.locator("td.reason").filter(has_text="the log states no unit")
    expect(assumed.first).to_be_visible()
    page.locator("#files").screenshot(path=pictures / "files_assumed.png")
    assert_accessible(page)
    page.click("#files-open")
    expect(page.locator("#title")).to_contain_text("150kg")
    status = page.locator("#files-status .note")
    expect(status).to_have_count(2)
    expect(status.nth(0)).to_have_text(f"{parts[1].name} continues {parts[0].name}: they are joined.")
    expect(status.nth(1)).to_contain_text("it is in motion at 0.00 s: the run begins at the next rest, at ")
    page.locator("#files-status").screenshot(path=pictures / "files_joined.png")
    expect(page.locator("#run .run")).to_have_count(1)
    assert_fits(page)
    assert_accessible(page)


def main() -> None:
    address, log, broken, volts, first, second, name, folder = sys.argv[1:9]
    with story(name, folder) as (browser, pictures, faults):
        for view, options in {"desktop": DESKTOP, "phone": PHONE, "dark": DARK}.items():
            open_log(opened(browser, address, options, faults), Path(log), pictures, view)
        points(opened(browser, address, DESKTOP, faults), Path(volts), pictures)
        notes(opened(browser, address, DESKTOP, faults), [Path(first), Path(second)], pictures)
        # A refused request is a message of the console.
        refused(opened(browser, address, DESKTOP, []), Path(broken), pictures)
    print("the files went well")


if __name__ == "__main__":
    main()
