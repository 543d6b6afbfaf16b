"""What the tests of the page of `alhazen view` have in common: the program, Chromium, and images."""

import os
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

SKIPPED = 77
ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
except ImportError:
    # The first Python of the path is not always that of the system, for which packages are installed.
    system = "/usr/bin/python3"
    if Path(system).exists() and os.path.realpath(sys.executable) != os.path.realpath(system):
        os.execv(system, [system, *sys.argv])
    print("browser: selenium is missing: install python3-selenium")
    sys.exit(SKIPPED)

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
if not CHROMIUM or not DRIVER:
    print("browser: chromium or chromedriver is missing: install chromium and chromium-driver")
    sys.exit(SKIPPED)


def wait_for(condition, what, seconds=60):
    """The first value of `condition()` that is true."""
    end = time.monotonic() + seconds
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"not within {seconds} s: {what}")
        time.sleep(0.05)


class Program:
    """`alhazen view`, or another command that prints the address of a page."""

    def __init__(self, alhazen, *arguments):
        environment = {**os.environ, "ALHAZEN_TUNED": ""}
        self.process = subprocess.Popen([alhazen, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, env=environment)
        self.url = ""
        for line in self.process.stdout:
            if found := re.search(r"http://\S+", line):
                self.url = found.group()
                return
        raise AssertionError(f"the program printed no address: {self.process.stderr.read()}")

    def is_running(self):
        return self.process.poll() is None

    def stop(self):
        """Ends it as a user does. Returns what it wrote to stderr."""
        if self.is_running():
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.communicate(timeout=30)[1]
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.communicate()
            raise


class Browser:
    """A headless Chromium, with WebGL2 in software."""

    def __init__(self, width=1000, height=700, *arguments):
        options = webdriver.ChromeOptions()
        options.binary_location = CHROMIUM
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle", "--hide-scrollbars",
                         "--use-angle=swiftshader", "--enable-unsafe-swiftshader", f"--window-size={width},{height}", *arguments):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        self.driver.set_script_timeout(120)
        self.resize(width, height)

    def resize(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, expression, what, seconds=60):
        return wait_for(lambda: self.run(f"return {expression}"), what, seconds)

    def open(self, url):
        self.driver.get(url)

    def wait_until_final(self, layer="color", kind=None, seconds=120):
        """Waits until the layer has all its samples, and no change is on its way."""
        kind_matches = f" && image.header.type === '{kind}'" if kind else ""
        self.wait(f"""(() => {{
            const image = alhazen.app.picture.images.get('{layer}'), {{ samples, samples_total }} = alhazen.app.status;
            return image && image.step === 1 && alhazen.app.picture.isDrawn && samples >= samples_total &&
              (image.header.final || image.header.samples >= samples_total){kind_matches};
        }})()""", f"all samples of {layer}", seconds)

    def pixels(self):
        """Red, green, blue and alpha of what the display shows now, as bytes."""
        return bytes(self.run("""
            const shown = alhazen.byId('picture'), canvas = document.createElement('canvas');
            [canvas.width, canvas.height] = [160, 120];
            const context = canvas.getContext('2d', { willReadFrequently: true });
            context.drawImage(shown, 0, 0, canvas.width, canvas.height);
            return [...context.getImageData(0, 0, canvas.width, canvas.height).data];"""))

    def bits(self, layer):
        """The layer's values as the page has them: for each channel the bits of its floats, rows from the top down."""
        return self.run("""
            const image = alhazen.app.picture.images.get(arguments[0]), words = new Uint32Array(image.data.buffer);
            return image.channels.map((_, c) => [...words].filter((_, i) => i % image.channels.length === c));""", layer)

    def sent(self):
        """How many messages of each type the page has sent."""
        return self.run("return { ...alhazen.app.connection.sent }")

    def drag(self, dx, dy, steps=12):
        surface = self.driver.find_element("id", "surface")
        actions = ActionChains(self.driver, duration=20).move_to_element(surface).click_and_hold()
        for _ in range(steps):
            actions.move_by_offset(round(dx / steps), round(dy / steps))
        actions.release().perform()

    def click(self, x=0, y=0):
        """Clicks the picture, so far from its middle."""
        surface = self.driver.find_element("id", "surface")
        ActionChains(self.driver).move_to_element_with_offset(surface, x, y).click().perform()

    def double_click(self, x, y):
        surface = self.driver.find_element("id", "surface")
        ActionChains(self.driver).move_to_element_with_offset(surface, x, y).double_click().perform()

    def press(self, *keys):
        ActionChains(self.driver).send_keys(*keys).perform()

    def complaints(self):
        """What the browser's console has of warnings and errors."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]

    def kill(self):
        """Ends the browser, and all that it started, without a chance to say goodbye."""
        children = {}
        for status in Path("/proc").glob("[0-9]*/stat"):
            try:
                text = status.read_text()
            except OSError:
                continue  # it has ended meanwhile
            children.setdefault(int(text.rpartition(")")[2].split()[1]), []).append(int(status.parent.name))
        found = [self.driver.service.process.pid]
        for pid in found:
            found += children.get(pid, [])
        for pid in found[1:]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.driver.service.process.kill()
        self.driver.service.process.wait()

    def close(self):
        self.driver.quit()


def read_exr(path):
    """The channels of an image with floats and without compression: bits of the values by name, rows from the top down."""
    data = Path(path).read_bytes()
    magic, version = struct.unpack_from("<II", data)
    assert magic == 20000630 and version & 0x1e00 == 0, "not a plain image of scan lines"
    at, header = 8, {}

    def text():
        nonlocal at
        end = data.index(b"\0", at)
        at, value = end + 1, data[at:end].decode()
        return value

    while name := text():
        text()
        size = struct.unpack_from("<I", data, at)[0]
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    assert header["compression"] == b"\0", "the image is compressed"
    x0, y0, x1, y1 = struct.unpack("<iiii", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names, channels = [], header["channels"]
    while channels[0]:
        end = channels.index(b"\0")
        assert struct.unpack_from("<i", channels, end + 1)[0] == 2, "a channel is not of floats"
        names.append(channels[:end].decode())
        channels = channels[end + 17:]
    values = {name: [] for name in names}
    for y in range(height):
        line = struct.unpack_from("<Q", data, at + 8 * y)[0] + 8
        for i, name in enumerate(names):
            values[name] += struct.unpack_from(f"<{width}I", data, line + 4 * i * width)
    return values
