"""Draws the picture of the page in the documentation: ``python -m benchmarks.screenshot``."""

import subprocess
import sys
from pathlib import Path

from benchmarks.live_device import hostkit, live_device, running
from benchmarks.live_page import CHROMIUM, address_of

PICTURE = Path(__file__).resolve().parents[1] / "docs" / "monitor.png"
RATE_HZ = 100.0
WATCHED_MS = 12_000


def main() -> int:
    """Watch an emulated device for a while and keep what the page shows."""
    from playwright.sync_api import sync_playwright

    with live_device(RATE_HZ) as device, sync_playwright() as playwright:
        command = hostkit("monitor", str(device.design_file), "--port", device.port)
        with running([*command, "--web", "--no-browser"], stderr=subprocess.PIPE) as child:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1280, "height": 800}, color_scheme="light")
            page.goto(address_of(child))
            page.wait_for_timeout(WATCHED_MS)
            page.screenshot(path=PICTURE)
            browser.close()
    print(f"{PICTURE}: {PICTURE.stat().st_size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
