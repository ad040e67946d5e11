"""Pages in a headless Chromium: windows, and what holds for every page."""

import shutil
from contextlib import contextmanager
from pathlib import Path

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect, sync_playwright

DESKTOP = {"viewport": {"width": 1440, "height": 900}}
PHONE = {"viewport": {"width": 390, "height": 844}, "device_scale_factor": 2, "has_touch": True, "is_mobile": True}
DARK = {**DESKTOP, "color_scheme": "dark"}

# Computations may share the machine with others.
PATIENCE_MS = 180_000

# The last requests of a page; one under way is not among them.
REQUESTS = """() => performance.getEntriesByType("resource").filter((one) => one.name.includes("/api/")).slice(-20)
  .map((one) => `${one.startTime.toFixed(0)} ${one.duration.toFixed(0)} ${one.responseStatus} ${one.name.split("/api/")[1]}`)"""


def launched(playwright, name: str):
    """The browser with that name."""
    program = shutil.which(name)
    assert program, f"no {name} is installed"
    return playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])


@contextmanager
def story(name: str, folder: str):
    """The browser with that name, the folder for pictures, and a list of faults, which has to stay empty."""
    pictures = Path(folder)
    pictures.mkdir(parents=True, exist_ok=True)
    faults: list = []
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        browser = launched(playwright, name)
        try:
            yield browser, pictures, faults
        except BaseException:
            tell(browser, pictures, faults)
            raise
        assert not faults, faults
        browser.close()


def tell(browser, pictures: Path, faults: list) -> None:
    """Prints what the pages of a story that failed asked their server last, and takes their pictures."""
    for number, page in enumerate(page for context in browser.contexts for page in context.pages):
        page.screenshot(path=pictures / f"failed_{number}.png")
        requests = page.evaluate(REQUESTS)
        print(f"page {number}, its last requests (start, duration in ms, state):", *requests, sep="\n  ", flush=True)
    print("faults:", faults, flush=True)


def opened(browser, address: str, options: dict, faults: list) -> Page:
    """A page whose console messages count as faults."""
    page = browser.new_context(**options).new_page()
    page.set_default_timeout(PATIENCE_MS)
    page.on("pageerror", lambda error: faults.append(f"error: {error}"))
    page.on("console", lambda said: faults.append(f"console: {said.type}: {said.text}"))
    page.goto(address)
    return page


def assert_fits(page: Page) -> None:
    """Nothing is wider than the window."""
    width = page.evaluate("document.documentElement.scrollWidth")
    assert width <= page.viewport_size["width"], f"the page is {width} px wide"


def assert_accessible(page: Page) -> None:
    """The accessibility check finds nothing."""
    found = Axe().run(page).response["violations"]
    assert not found, [(rule["id"], rule["help"], rule["nodes"][0]["html"]) for rule in found]
