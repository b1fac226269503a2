"""The HTML report in headless Chromium: it draws, a click selects a pair, and a drag turns the robot.

    test_report_in_browser.py PROGRAM SOURCE_FOLDER

Exit status 77, which ctest shows as skipped, where Chromium or its driver is missing.
"""
import base64
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

PROGRAM, SOURCE = sys.argv[1:3]
ROBOT = os.path.join(SOURCE, "data/hrp2_style/hrp2_style")


class Browser:
    """The few commands of WebDriver that this needs."""

    def __init__(self, folder):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.driver = subprocess.Popen(["chromedriver", f"--port={port}"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        self.base = f"http://127.0.0.1:{port}/session"
        arguments = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1400,1000", f"--user-data-dir={folder}/profile"]
        capabilities = {"alwaysMatch": {"goog:chromeOptions": {"args": arguments},
                                        "goog:loggingPrefs": {"browser": "ALL"}}}
        for _ in range(50):  # until the driver listens
            try:
                self.base += "/" + self.post("", {"capabilities": capabilities})["sessionId"]
                return
            except ConnectionError:
                time.sleep(0.2)
            except urllib.error.URLError:
                time.sleep(0.2)
        raise RuntimeError("chromedriver does not answer")

    def post(self, path, body):
        request = urllib.request.Request(self.base + path, json.dumps(body).encode(),
                                         {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=60) as reply:
            return json.load(reply)["value"]

    def script(self, text):
        return self.post("/execute/sync", {"script": text, "args": []})

    def drag(self, x, y, to_x, to_y):
        moves = [{"type": "pointerMove", "x": x, "y": y, "duration": 0}, {"type": "pointerDown", "button": 0},
                 {"type": "pointerMove", "x": to_x, "y": to_y, "duration": 50}, {"type": "pointerUp", "button": 0}]
        self.post("/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": moves}]})

    def close(self):
        request = urllib.request.Request(self.base, method="DELETE")
        try:
            urllib.request.urlopen(request, timeout=20)
        finally:
            self.driver.terminate()
            self.driver.wait()


def picture(browser):
    url = browser.script("return document.getElementById('view').toDataURL('image/png')")
    return base64.b64decode(url.split(",")[1])


def colours(browser):
    return browser.script("""
      const c = document.getElementById('view'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
      const seen = new Set();
      for (let i = 0; i < d.length; i += 4) seen.add(d[i] << 16 | d[i + 1] << 8 | d[i + 2]);
      return seen.size;""")


def main():
    if not (shutil.which("chromium") and shutil.which("chromedriver")):
        print("skipped: install chromium and chromium-driver to run this")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "report.html")
        subprocess.run([PROGRAM, ROBOT + ".urdf", "--srdf", ROBOT + ".srdf", "--samples", "10", "--pose", "zero",
                        "--format", "html", "--no-cache", "-o", page], check=True)
        browser = Browser(folder)
        try:
            browser.post("/url", {"url": "file://" + page})
            assert browser.script("return document.querySelectorAll('tbody tr').length") == 465
            assert colours(browser) > 50, "the view is blank"
            before = picture(browser)
            browser.script("document.querySelectorAll('tbody tr')[7].click()")
            assert browser.script("return document.body.dataset.selected") == "7"
            assert browser.script("return document.querySelector('tr.sel').dataset.pair") == "7"
            clicked = picture(browser)
            assert clicked != before, "the selected pair is not highlighted"
            browser.drag(200, 250, 300, 270)
            assert picture(browser) != clicked, "the view does not turn"
            browser.script("document.querySelectorAll('th')[2].click(); document.querySelectorAll('th')[2].click()")
            first = browser.script("return +document.querySelector('tbody tr').dataset.pair")
            assert first != 0, "the table does not sort"
            errors = [e for e in browser.post("/se/log", {"type": "browser"}) if e["level"] == "SEVERE"]
            assert not errors, errors
        finally:
            browser.close()
    print("the report draws, selects, turns and sorts")
    return 0


if __name__ == "__main__":
    sys.exit(main())
