#!/usr/bin/env python3
"""Tests of the page of `alhazen view` in Chromium.

usage: tests/browser/view_test.py ALHAZEN [TEST...]

Exits with 77 where Chromium or selenium is missing.
"""

import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from view_fixture import SCENES, Browser, Program, read_exr, wait_for

ALHAZEN = str(Path(sys.argv.pop(1)).resolve()) if len(sys.argv) > 1 else ""
CORNELL = [SCENES / "cornell.pbrt", "--size", "120x80", "--spp", "8"]


class PageTest(unittest.TestCase):
    """One program and one browser for all tests of a class; each begins at the camera of the file."""

    @classmethod
    def setUpClass(cls):
        cls.program = Program(ALHAZEN, "view", *CORNELL)
        cls.addClassCleanup(cls.program.stop)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.browser.open(self.program.url)
        self.browser.wait("alhazen.app.camera.camera !== null", "a camera")
        self.browser.run("alhazen.app.resetCamera()")
        self.browser.wait_until_final()

    def tearDown(self):
        self.assertEqual(self.browser.complaints(), [])

    def change_and_wait(self, change):
        """Runs what changes the view, and waits until a later view has all its samples."""
        view = self.browser.run("return alhazen.app.picture.image.header.view")
        change()
        self.browser.wait(f"alhazen.app.picture.image.header.view > {view}", "another view")
        self.browser.wait_until_final()

    def render(self, command, *options):
        """Runs a command that the page made, with other options at its end. Returns the folder with what it wrote."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        words = shlex.split(command)
        self.assertEqual(words[:2], ["alhazen", "render"])
        words[words.index("-o"):words.index("-o") + 2] = []
        words[2] = str(CORNELL[0])
        subprocess.run([ALHAZEN, *words[1:], "-q", *options], cwd=folder.name, check=True, timeout=120)
        return Path(folder.name)


class CornellPage(PageTest):
    def test_shows_a_picture_that_is_not_black(self):
        self.assertIn("cornell.pbrt", self.browser.driver.title)
        pixels = self.browser.pixels()
        bright = sum(max(pixels[i:i + 3]) > 40 for i in range(0, len(pixels), 4))
        self.assertGreater(bright, len(pixels) / 4 * 0.2)
        self.assertEqual(self.browser.run("return alhazen.app.picture.display.name"), "WebGL2")

    def test_needs_nothing_from_elsewhere(self):
        names = self.browser.run("return performance.getEntriesByType('resource').map((entry) => entry.name)")
        self.assertEqual([name for name in names if not name.startswith((self.program.url, "data:"))], [])

    def test_dragging_shows_another_picture(self):
        before = self.browser.pixels()
        self.change_and_wait(lambda: self.browser.drag(120, 36))
        self.assertNotEqual(self.browser.pixels(), before)
        self.assertFalse(self.browser.run("return alhazen.app.camera.isMoving"))
        self.assertGreater(self.browser.run("return alhazen.app.meter.milliseconds"), 0)

    def test_what_is_dragged_follows_the_pointer(self):
        """A point of the scene between the camera and its target is seen further right after a drag to the right."""
        moved = self.browser.run("""
            const { camera } = alhazen.app, { subtract, scale, add, dot, cross, normalize } = alhazen.vec;
            const point = add(camera.camera.target, scale(camera.forward, -0.3 * camera.distance));
            const seen = () => { const d = subtract(point, camera.camera.position);
              return [dot(d, camera.right) / dot(d, camera.forward), dot(d, camera.upward) / dot(d, camera.forward)]; };
            const first = seen();
            camera.orbit(0.2, 0);
            const right = seen();
            camera.orbit(-0.2, 0);
            camera.orbit(0, 0.2);
            const down = seen();
            return [right[0] - first[0], down[1] - first[1]];""")
        self.assertGreater(moved[0], 0.01)
        self.assertLess(moved[1], -0.01)

    def test_undo_takes_back_a_whole_drag(self):
        first = self.browser.run("return alhazen.app.camera.camera")
        self.change_and_wait(lambda: self.browser.drag(96, 24))
        second = self.browser.run("return alhazen.app.camera.camera")
        self.assertNotEqual(first, second)
        self.change_and_wait(lambda: self.browser.run("alhazen.app.camera.undo()"))
        self.assertEqual(self.browser.run("return alhazen.app.camera.camera"), first)
        self.change_and_wait(lambda: self.browser.run("alhazen.app.camera.redo()"))
        self.assertEqual(self.browser.run("return alhazen.app.camera.camera"), second)

    def test_display_settings_send_nothing(self):
        sent, before = self.browser.sent(), self.browser.pixels()
        self.browser.run("alhazen.byId('surface').focus()")
        self.browser.press("eeee")
        wait_for(lambda: sum(self.browser.pixels()) > sum(before), "a brighter picture")
        brighter = self.browser.pixels()
        for key in "txjh":
            self.browser.press(key)
        self.browser.run("alhazen.app.viewport.zoomTo(8); alhazen.app.picture.set({ channel: 'luminance' })")
        wait_for(lambda: self.browser.pixels() != brighter, "another display")
        self.assertEqual(self.browser.sent(), sent)

    def test_exact_values_have_the_bits_of_a_render(self):
        self.change_and_wait(lambda: self.browser.drag(60, -24))
        layers = {"color": ["R", "G", "B"], "albedo": ["albedo.R", "albedo.G", "albedo.B"],
                  "normal": ["normal.X", "normal.Y", "normal.Z"], "depth": ["depth.Z"]}
        self.browser.run("alhazen.app.setExact(true); alhazen.app.chooseLayer('color')")
        command = self.browser.run("alhazen.app.output.copyCommand(); return alhazen.lastCopied")
        folder = self.render(command, "-o", "exact.exr", "--aov", "albedo,normal,depth", "--exr-type", "float",
                             "--exr-compression", "none", "--denoise", "none")
        expected = read_exr(folder / "exact.exr")
        for layer, channels in layers.items():
            self.browser.run("alhazen.app.chooseLayer(arguments[0])", layer)
            self.browser.wait(f"alhazen.app.picture.images.get('{layer}') !== undefined", layer)
            self.browser.wait_until_final(layer, "float")
            for channel, bits in zip(channels, self.browser.bits(layer), strict=True):
                different = sum(a != b for a, b in zip(bits, expected[channel], strict=True))
                self.assertEqual(different, 0, f"{different} of {len(bits)} values of {channel} differ")

    def test_tone_maps_are_those_of_the_program(self):
        self.browser.run("alhazen.app.setExact(true); alhazen.app.picture.set({ exposure: 0.7 })")
        self.browser.wait_until_final("color", "float")
        for tone_map in self.browser.run("return alhazen.colour.toneMaps"):
            self.browser.run("alhazen.app.picture.set({ toneMap: arguments[0] })", tone_map)
            folder = self.render(self.browser.run("return alhazen.app.output.command()"), "-o", "tone.png", "--denoise",
                                 "none")
            worst = self.browser.driver.execute_async_script("""
                const done = arguments[arguments.length - 1];
                const pixels = async (blob) => {
                  const bitmap = await createImageBitmap(blob, { colorSpaceConversion: 'none' });
                  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), context = canvas.getContext('2d');
                  context.drawImage(bitmap, 0, 0);
                  return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
                };
                const file = new Blob([new Uint8Array(arguments[0])], { type: 'image/png' });
                Promise.all([alhazen.app.picture.png().then(pixels), pixels(file)]).then(([shown, written]) =>
                  done(shown.length === written.length ? Math.max(...shown.map((value, i) => Math.abs(value - written[i]))) : 256));
                """, list((folder / "tone.png").read_bytes()))
            self.assertLessEqual(worst, 1, tone_map)

    def test_saves_an_image(self):
        sizes = self.browser.driver.execute_async_script("""
            const done = arguments[arguments.length - 1];
            Promise.all(['save.exr', 'save.png?exposure=1&tone_map=agx'].map((name) =>
              fetch(name).then((answer) => answer.arrayBuffer()))).then((all) =>
                done(all.map((each) => [...new Uint8Array(each, 0, 4)])));""")
        self.assertEqual(sizes, [[0x76, 0x2f, 0x31, 0x01], [0x89, 0x50, 0x4e, 0x47]])

    def test_a_click_names_what_is_there(self):
        self.browser.click()
        self.browser.wait("!document.querySelector('#section-object .facts').hidden", "what was clicked")
        text = self.browser.run("return alhazen.byId('section-object').innerText")
        self.assertRegex(text, r"cornell\.pbrt:\d+")

    def test_a_double_click_focuses_there(self):
        target = self.browser.run("return alhazen.app.camera.camera.target")
        self.browser.double_click(30, 40)
        self.browser.wait(f"JSON.stringify(alhazen.app.camera.camera.target) !== JSON.stringify({target})", "another target")
        focus, distance = self.browser.run("return [alhazen.app.camera.camera.focus, alhazen.app.camera.distance]")
        self.assertAlmostEqual(focus, distance, delta=1e-6 * distance)

    def test_flying(self):
        before = self.browser.run("return alhazen.app.camera.camera.position")
        self.browser.run("alhazen.app.input.setMode('fly')")
        self.browser.driver.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": "keyDown", "code": "KeyW", "key": "w"})
        self.browser.wait(f"JSON.stringify(alhazen.app.camera.camera.position) !== JSON.stringify({before})", "a move")
        self.browser.driver.execute_cdp_cmd("Input.dispatchKeyEvent", {"type": "keyUp", "code": "KeyW", "key": "w"})
        self.browser.wait("!alhazen.app.camera.isMoving", "the end of the move")

    def test_copies_the_camera_for_pbrt(self):
        text = self.browser.run("alhazen.app.output.copyPbrt(); return alhazen.lastCopied")
        self.assertRegex(text, r'LookAt( *[-\d.e]+){3}\s( *[-\d.e]+){3}\s( *[-\d.e]+){3}\nCamera "perspective" "float fov" \d')

    def test_keys_are_listed_and_the_list_closes(self):
        self.browser.run("alhazen.byId('surface').focus()")
        self.browser.press("?")
        self.browser.wait("alhazen.byId('help').open", "the list of keys")
        self.browser.press("\ue00c")  # Escape
        self.browser.wait("!alhazen.byId('help').open", "the page again")

    def test_every_control_has_a_name(self):
        nameless = self.browser.run("""
            return [...document.querySelectorAll('button, input, select, [role=slider], [tabindex="0"]')].filter((each) =>
              !each.getAttribute('aria-label') && !each.textContent.trim() && !(each.labels && each.labels.length) &&
              !each.closest('[hidden]')).map((each) => each.outerHTML);""")
        self.assertEqual(nameless, [])

    def test_narrow_pages_show_the_whole_picture_above_the_panels(self):
        self.addCleanup(self.browser.resize, 1000, 700)
        self.browser.resize(390, 844)
        self.browser.wait("innerWidth === 390", "the size")
        stage, panels, scrolled = self.browser.run("""
            const box = (id) => alhazen.byId(id).getBoundingClientRect();
            return [box('stage').toJSON(), box('panels').toJSON(), document.documentElement.scrollWidth];""")
        self.assertLessEqual(scrolled, 390)
        self.assertGreaterEqual(stage["height"], 0.35 * 844)
        self.assertLessEqual(stage["bottom"], panels["top"])

    def test_another_size(self):
        self.addCleanup(self.change_and_wait, lambda: self.browser.run("alhazen.app.chooseSize('120x80')"))
        self.change_and_wait(lambda: self.browser.run("alhazen.app.chooseSize('60x40')"))
        self.assertEqual(self.browser.run("const { header } = alhazen.app.picture.image; return [header.width, header.height]"),
                         [60, 40])

    def test_viewers_come_and_go(self):
        driver = self.browser.driver
        first = driver.current_window_handle
        for _ in range(6):
            driver.switch_to.new_window("tab")
            self.browser.open(self.program.url)
            self.browser.wait_until_final()
        self.assertEqual(self.browser.wait("alhazen.app.status.viewers === 7 && 7", "seven viewers"), 7)
        for handle in driver.window_handles:
            if handle != first:
                driver.switch_to.window(handle)
                driver.close()
        driver.switch_to.window(first)
        self.browser.wait("alhazen.app.status.viewers === 1", "the others to be gone")


class EditedPage(PageTest):
    def test_a_change_of_a_material_is_seen_and_told(self):
        self.browser.click(0, 60)
        slider = "document.querySelector('#section-object .stack input')"
        self.browser.wait(slider, "fields of the material")
        before = self.browser.pixels()
        self.change_and_wait(lambda: self.browser.run(f"""
            const control = {slider};
            control.value = control.type === 'color' ? '#2040ff' : (Number(control.min) + Number(control.max)) / 2 + 0.1;
            control.dispatchEvent(new Event('input'));"""))
        self.assertNotEqual(self.browser.pixels(), before)
        self.browser.wait("document.querySelectorAll('#section-object .changes li').length === 1", "the change in the list")


class OtherPages(unittest.TestCase):
    def start(self, *arguments):
        program = Program(ALHAZEN, "view", *arguments)
        self.addCleanup(program.stop)
        return program

    def browse(self, *arguments):
        browser = Browser(1000, 700, *arguments)
        self.addCleanup(browser.close)
        return browser

    def test_a_scene_that_fails_shows_its_error(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "broken.pbrt"
            scene.write_text('WorldBegin\nShape "sphere" "float radius" [ -1 ]\n')
            program, browser = self.start(scene), self.browse()
            browser.open(program.url)
            browser.wait("!alhazen.byId('failure').hidden", "the error")
            self.assertRegex(browser.run("return alhazen.byId('failure-text').textContent"), r"broken\.pbrt:2:\d+: ")
            self.assertTrue(program.is_running())

    def test_without_webgl_a_canvas_shows_the_picture(self):
        program, browser = self.start(*CORNELL), self.browse("--disable-3d-apis")
        browser.open(program.url)
        browser.wait_until_final()
        self.assertEqual(browser.run("return alhazen.app.picture.display.name"), "2D canvas")
        pixels = browser.pixels()
        self.assertGreater(sum(max(pixels[i:i + 3]) > 40 for i in range(0, len(pixels), 4)), len(pixels) / 4 * 0.2)

    def test_a_killed_browser_leaves_the_program_running(self):
        program = self.start(*CORNELL)
        killed = Browser()
        killed.open(program.url)
        killed.wait("alhazen.app.picture.image !== null", "a picture")
        killed.kill()
        browser = self.browse()
        browser.open(program.url)
        browser.wait_until_final()
        browser.wait("alhazen.app.status.viewers === 1", "the killed one to be gone")
        self.assertTrue(program.is_running())

    def test_a_program_that_ends_is_missed(self):
        program, browser = self.start(*CORNELL), self.browse()
        browser.open(program.url)
        browser.wait_until_final()
        shown = browser.pixels()
        program.stop()
        browser.wait("document.querySelector('.notice') !== null && document.querySelector('.notice').textContent", "a notice")
        self.assertEqual(browser.pixels(), shown)


if __name__ == "__main__":
    unittest.main(verbosity=2)
