"""The HTML report in headless Chromium, by clicking: it draws, turns, searches, filters, sorts, isolates a pair, and loads nothing.

    test_report_in_browser.py URDF_COLLISION_REPORT SOURCE_FOLDER [TEST ...]

Needs the Debian packages chromium, chromium-driver and python3-selenium (tools/install_packages).
"""
import base64
import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select, WebDriverWait

from small_robot import joint, link

PROGRAM, SOURCE = sys.argv[1:3]
ROBOT = os.path.join(SOURCE, "data/hrp2_style/hrp2_style")
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars", "--window-size=1400,900",
         "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
UGLY = """a<b>&"'</script>\u00fc\u65e5"""  # a link's name that must stay text

# Colours of the two links and of the others, as the software renderer shades them.
COUNT_PIXELS = """
  const done = arguments[0], from = scene.canvas, to = document.createElement('canvas');
  scene.draw();
  to.width = from.width; to.height = from.height;
  const g = to.getContext('2d');
  g.drawImage(from, 0, 0);
  const d = g.getImageData(0, 0, to.width, to.height).data, count = {first: 0, second: 0, link: 0, witness: 0};
  for (let i = 0; i < d.length; i += 4) {
    if (d[i + 3] < 250) continue;
    const r = d[i], gr = d[i + 1], b = d[i + 2];
    if (r > 150 && gr < 60 && b < 60) ++count.witness;
    else if (r > 1.5 * b && r > gr + 20) ++count.first;
    else if (b > 1.5 * r) ++count.second;
    else ++count.link;
  }
  done(count);"""

TURN = """
  const done = arguments[0], frames = 30, first = scene.frames, start = performance.now();
  const turn = () => {
    scene.renderer.getContext().readPixels(0, 0, 1, 1, 6408, 5121, new Uint8Array(4));  // waits until the last one is drawn
    const drawn = scene.frames - first;
    if (drawn >= frames) return done([drawn, (performance.now() - start) / 1000]);
    scene.look(0.2 * drawn, 0.3);
    requestAnimationFrame(turn);
  };
  turn();"""


def processor_seconds(root):
    """Processor time of a process and all its descendants so far."""
    parent, used = {}, {}
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{pid}/stat", encoding="utf-8") as file:
                fields = file.read().rpartition(")")[2].split()
        except OSError:  # the process has just ended
            continue
        parent[int(pid)], used[int(pid)] = int(fields[1]), int(fields[11]) + int(fields[12])
    ours = {root}
    for _ in range(20):  # deeper than a browser's processes are nested
        ours |= {pid for pid, above in parent.items() if above in ours}
    return sum(used.get(pid, 0) for pid in ours) / os.sysconf("SC_CLK_TCK")


def xml(text):
    for char, code in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;"), ("'", "&apos;")):
        text = text.replace(char, code)
    return text


def primitives(count):
    """A chain of `count` links, each a sphere, a box, a cylinder or a mesh-free pair of shapes; the first has an ugly name."""
    shapes = ['<sphere radius="0.05"/>', '<box size="0.06 0.1 0.08"/>', '<cylinder radius="0.04" length="0.12"/>',
              '<capsule radius="0.03" length="0.1"/>']
    names = [xml(UGLY)] + [f"link{i}" for i in range(1, count)]
    links = "".join(link(name, shapes[i % 4]) for i, name in enumerate(names))
    joints = "".join(joint(f"joint{i}", names[i - 1], names[i], origin="0.2 0 0.02", axis="0 1 0", limits=(-2, 2)) for i in range(1, count))
    return '<robot name="primitives">' + links + joints + "</robot>"


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for flag in FLAGS + [f"--user-data-dir={cls.folder.name}/profile"]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        cls.browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        cls.browser.set_script_timeout(60)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.folder.cleanup()

    def open(self, urdf, *arguments, view=""):
        """Writes the report's page and opens it; the exit status must be that of a report."""
        page = self.path("report.html")
        done = subprocess.run([PROGRAM, urdf, "--samples", "10", "--format", "html", "-o", page, *arguments],
                              capture_output=True, text=True, env={**os.environ, "XDG_CACHE_HOME": self.path("cache")})
        self.assertIn(done.returncode, (1, 3) if "--skip-invalid" in arguments else (0, 1), done.stderr)
        self.show(view)
        return os.path.getsize(page)

    def show(self, view=""):
        self.browser.get("about:blank")
        self.browser.get(f"file://{self.path('report.html')}{view}")
        self.await_script("return document.body.dataset.ready === 'yes'")

    def reopen(self, change):
        """Opens the page again with other data."""
        with open(self.path("report.html"), encoding="utf-8") as file:
            before, block, after = re.split('(?<=id="packed-report">)([^<]*)', file.read())
        data = json.loads(gzip.decompress(base64.b64decode(block)))
        change(data)
        with open(self.path("report.html"), "w", encoding="utf-8") as file:
            file.write(before + base64.b64encode(gzip.compress(json.dumps(data).encode())).decode() + after)
        self.show()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def humanoid(self, *arguments, view="", shown=True):
        """Opens the humanoid's page; without `shown` it is only there, for reopen()."""
        if arguments or not os.path.exists(self.path("humanoid.html")):
            self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf", "--pose", "zero", *arguments, view=view)
            if not arguments:  # most tests ask for this page: made once
                shutil.copy(self.path("report.html"), self.path("humanoid.html"))
        else:
            shutil.copy(self.path("humanoid.html"), self.path("report.html"))
            if shown:
                self.show(view)
        return os.path.getsize(self.path("report.html"))

    def put(self, name, text):
        path = self.path(name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def script(self, text):
        return self.browser.execute_script(text)

    def click(self, selector):
        self.browser.find_element(By.CSS_SELECTOR, selector).click()

    def rows(self):
        """The table's rows as shown, each a list of its cells' texts."""
        return self.script("return [...document.querySelectorAll('#table tbody tr')].map(r => [...r.cells].map(c => c.textContent))")

    def states(self):
        """Both names of each row, and the state that is shown when the pair is selected."""
        return self.script("""return [...document.querySelectorAll('#table tbody tr')].map(row => {
          row.click(); return [row.cells[0].textContent, row.cells[1].textContent, document.querySelector('.tag').textContent]; })""")

    def window(self, width):
        """From now on the page is so wide; tearDown ends it."""
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})

    def await_script(self, text):
        WebDriverWait(self.browser, 60, poll_frequency=0.05).until(lambda b: b.execute_script(text))

    def detail(self):
        return self.browser.find_element(By.ID, "detail").text

    def pixels(self):
        return self.browser.execute_async_script(COUNT_PIXELS)

    def frame_rate(self, what, size):
        """Frames per second that a single processor would draw, so that other work of the machine does not count."""
        before = processor_seconds(self.browser.service.process.pid)
        frames, seconds = self.browser.execute_async_script(TURN)
        rate = frames / (processor_seconds(self.browser.service.process.pid) - before)
        print(f"\n{what}: page of {size / 1e6:.2f} MB, {frames / seconds:.0f} frames/s, {rate:.0f} for each processor that is "
              "all its own", file=sys.stderr)
        return rate

    def assert_turns_smoothly(self, what, size, calls, triangles):
        """Counts the work of a frame. Its time depends on the machine; the limit of 5 only detects a page that hardly moves."""
        rate = self.frame_rate(what, size)
        drawn = self.script("const work = scene.renderer.info.render; return [work.calls, work.triangles];")
        print(f"{what}: {drawn[0]} draw calls and {drawn[1]} triangles a frame", file=sys.stderr)
        self.assertTrue(0 < drawn[0] <= calls and 0 < drawn[1] <= triangles, drawn)
        self.assertGreater(rate, 5)

    def tearDown(self):
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        bad = [e for e in self.browser.get_log("browser") if e["level"] == "SEVERE"]
        self.assertEqual(bad, [])
        sent = [json.loads(e["message"])["message"] for e in self.browser.get_log("performance")]
        asked = [m["params"] for m in sent if m["method"] == "Network.requestWillBeSent"]
        ours = [p for p in asked if p["documentURL"].startswith("file://")]  # not the browser's own pages
        self.assertTrue(ours)
        self.assertEqual([p["request"]["url"] for p in ours if p["request"]["url"].split("#")[0] != p["documentURL"].split("#")[0]], [])

    def test_search_filters_and_sorting_change_the_rows(self):
        self.humanoid()
        self.assertEqual(len(self.rows()), 465)
        self.browser.find_element(By.ID, "search").send_keys("rarm_link6")
        found = self.rows()
        self.assertEqual(len(found), 30)
        self.assertTrue(all("RARM_LINK6" in row[:2] for row in found))
        self.assertEqual(self.browser.find_element(By.ID, "count").text, "30 of 465 pairs")
        self.click("#clear")
        Select(self.browser.find_element(By.ID, "link")).select_by_value("BODY")
        self.assertTrue(all("BODY" in row[:2] for row in self.rows()))
        self.click("#clear")
        Select(self.browser.find_element(By.ID, "reason")).select_by_value("adjacent")
        self.assertTrue(all("adjacent" in row for row in self.rows()))
        self.assertEqual(len(self.rows()), 30)
        self.click("#clear")
        Select(self.browser.find_element(By.ID, "state")).select_by_value("checked")
        self.assertEqual(len(self.rows()), 130)
        for way in (1, -1):
            self.click("#table th[data-key=distance]")
            shown = [float(row[2]) for row in self.rows()]
            self.assertEqual(shown, sorted(shown, reverse=way < 0))
        self.browser.find_element(By.ID, "search").send_keys("nobody")
        self.assertEqual(self.rows(), [])
        self.assertIn("No pair passes", self.browser.find_element(By.ID, "nothing").text)

    def test_a_click_isolates_the_two_links_and_draws_their_segment(self):
        self.humanoid()
        whole = self.pixels()
        self.assertGreater(whole["link"], 5000)
        self.click("#table tbody tr:nth-child(8)")
        self.assertEqual(self.script("return document.body.dataset.selected"), "7")
        alone = self.pixels()
        self.assertLess(alone["link"], whole["link"] / 20, "the other links still stand there")
        for part in ("first", "second"):
            self.assertGreater(alone[part], 1000)
        self.assertGreater(alone["witness"], 20)
        names = self.rows()[7][:2]
        detail = self.browser.find_element(By.ID, "detail").text
        self.assertTrue(all(name in detail for name in names), detail)
        shown = self.script("return scene.report.bodies.filter((b, i) => scene.side(b) >= 0).map(b => b.owner)")
        self.assertEqual(sorted(shown), sorted(names))
        self.click("#show button[data-value=pair]")
        visible = self.script("return scene.bodies.filter(m => m.visible).length")
        self.assertEqual(visible, 2)
        self.click("#show button[data-value=all]")
        self.assertGreater(self.pixels()["link"], 5000)

    def test_nearer_bodies_hide_farther_ones(self):
        # Two balls, one behind the other: the one in front hides the other completely.
        links = link("near", '<sphere radius="0.2"/>') + link("middle") + link("far", '<sphere radius="0.1"/>')
        urdf = self.put("balls.urdf", '<robot name="balls">' + links + "".join(
            joint(c, p, c, "prismatic", "-0.3 0 0", limits=(-0.1, 0.1)) for p, c in (("near", "middle"), ("middle", "far"))) + "</robot>")
        self.open(urdf, view="#yaw=0&pitch=0")
        seen = {part: n for part, n in self.pixels().items() if part in ("first", "second")}
        first = self.script("return scene.pair.link1")
        near, far = ("first", "second") if first == "near" else ("second", "first")
        self.assertGreater(seen[near], 5000)
        self.assertEqual(seen[far], 0)
        self.script("scene.look(Math.PI, 0)")
        turned = self.pixels()
        self.assertGreater(turned[far], 1000)

    def test_links_are_drawn_where_their_joints_put_them(self):
        kinds = ["revolute", "prismatic", "continuous", "planar", "floating", "fixed", "revolute"]
        urdf = '<robot name="joints">' + "".join(
            f'<link name="l{i}"><collision><origin xyz="0.1 -0.05 0.2"/><geometry><sphere radius="0.03"/></geometry></collision></link>'
            for i in range(8)) + "".join(
                f'<joint name="j{i}" type="{kind}"><parent link="l{i}"/><child link="l{i + 1}"/><origin xyz="0.3 0.1 {0.1 * i}" rpy="0.4 {0.2 * i} -1"/>'
                f'<axis xyz="{0.3 * i - 1} 0.5 {0.7 - i % 2}"/><limit lower="-2" upper="2" effort="1" velocity="1"/>' +
                ('<mimic joint="j1" multiplier="-1.5" offset="0.25"/>' if i == 6 else "") + "</joint>"
                for i, kind in enumerate(kinds)) + "</robot>"
        coordinates = ["j0", "j1", "j2", "j3/x", "j3/y", "j3/angle", "j4/x", "j4/y", "j4/z", "j4/rx", "j4/ry", "j4/rz"]
        far = {name: 0.3 + 0.1 * i for i, name in enumerate(coordinates)} | {"j4/x": 5000.0}  # the other poses must be as exact as without it
        self.open(self.put("joints.urdf", urdf), "--pose", self.put("pose.json", json.dumps(far)), "--primitives", "flat")
        off = self.script("""
          const at = name => new THREE.Vector3().setFromMatrixPosition(scene.bodies[scene.report.bodies.findIndex(b => b.owner === name)].matrix);
          return scene.report.pairs.flatMap(p => [['link1', 'point1'], ['link2', 'point2']].map(
            ([link, point]) => Math.abs(at(p[link]).distanceTo(new THREE.Vector3(...p[point])) - 0.03)));""")
        self.assertEqual(len(off), 2 * 28)
        self.assertLess(max(off), 2e-4)  # eight digits of 5000 m
        self.assertLess(sorted(off)[2 * 10 - 1], 1e-6)  # the ten pairs of the five links before it

    def test_a_drag_turns_the_robot(self):
        self.humanoid()
        before = self.script("return scene.camera.position.toArray()")
        canvas = self.browser.find_element(By.ID, "view")
        ActionChains(self.browser).move_to_element(canvas).click_and_hold().move_by_offset(90, 20).release().perform()
        self.assertNotEqual(self.script("return scene.camera.position.toArray()"), before)

    def test_the_heat_map_has_a_legend_and_selects(self):
        self.humanoid()
        legend = self.browser.find_element(By.ID, "legend").text
        for words in ("in collision", "mm and more apart", "not checked"):
            self.assertIn(words, legend)
        heat = self.browser.find_element(By.ID, "heat")
        self.script("document.getElementById('heat').scrollIntoView()")
        at = self.script("const h = document.getElementById('heat').getBoundingClientRect(); return h.width - 8 - h.width / 2")
        ActionChains(self.browser).move_to_element_with_offset(heat, int(at), int(at) - 30).click().perform()
        chosen = int(self.script("return document.body.dataset.selected"))
        pair = self.script(f"return [scene.report.pairs[{chosen}].link1, scene.report.pairs[{chosen}].link2]")
        self.assertIn("LARM_LINK6", pair)

    def test_any_name_stays_text_is_shortened_where_it_is_like_others_and_warnings_are_shown(self):
        self.open(self.put("names.urdf", primitives(4)), "--pose", self.put("pose.json", "{}"), "--primitives", "flat")
        self.assertIn(UGLY, [name for row in self.rows() for name in row[:2]])
        self.assertIn("no smooth body", self.browser.find_element(By.ID, "warnings").text)
        self.assertEqual(self.script("return document.querySelectorAll('#table b, #detail script').length"), 0)
        self.assertEqual(self.script("""
          const shorten = shortener(['left_arm_segment_1_of_the_hand', 'left_arm_segment_22_of_the_hand']);
          const most = length => shorten('left_arm_segment_22_of_the_hand', text => text.length <= length);
          return [40, 20, 10, 4].map(most);"""), ["left_arm_segment_22_of_the_hand", "…ment_22_of_the_hand", "…22_of_th…", "…22…"])
        # All four are drawn. A box has the fewest corners: eight with three normals each.
        self.assertEqual(self.script("return Math.min(...scene.bodies.map(m => m.geometry.attributes.position.count))"), 24)
        self.assertEqual(self.script("return scene.bodies.length"), 4)

    def test_a_link_may_have_the_name_of_something_of_the_language(self):
        self.open(self.put("names.urdf", primitives(4).replace("link1", "constructor")), "--primitives", "flat")
        choices = self.script("return [...document.getElementById('link').options].map(o => o.textContent)")
        self.assertEqual(choices, ["Any link", UGLY, "constructor", "link2", "link3"])

    def test_shapes_left_out_have_a_place_of_their_own_that_is_in_sight(self):
        urdf = self.put("broken.urdf", primitives(4).replace('<box size="0.06 0.1 0.08"/>', '<sphere radius="0"/>'))
        self.open(urdf, "--skip-invalid")
        place = self.browser.find_element(By.ID, "skipped")
        self.assertTrue(place.is_displayed())
        self.assertLess(place.rect["y"] + place.rect["height"], 900)  # without scrolling
        self.assertIn("Left out and not checked: 1 shape", place.text)
        self.assertIn("link1", place.text)
        self.assertNotIn("link1", self.script("return document.getElementById('warnings').textContent"))
        figures = self.browser.find_element(By.ID, "figures").text
        self.assertIn("left out", figures)
        self.assertEqual(self.script("return document.querySelectorAll('.figure.good').length"), 0)
        self.humanoid()
        self.assertFalse(self.browser.find_element(By.ID, "skipped").is_displayed())

    def test_obstacles_are_drawn_and_have_rows(self):
        scene = self.put("scene.urdf", '<robot name="scene"><link name="wall"><collision><origin xyz="0.6 0 0"/><geometry>'
                         '<box size="0.1 1 1"/></geometry></collision></link></robot>')
        self.humanoid("--obstacles", scene)
        self.browser.find_element(By.ID, "search").send_keys("wall")
        self.assertEqual(len(self.rows()), 30)
        self.click("#table tbody tr")
        self.assertEqual(self.script("return scene.report.bodies.filter(b => b.obstacle && scene.side(b) === 1).length"), 1)

    def test_an_obstacle_with_the_name_of_a_link_has_cells_of_its_own(self):
        scene = self.put("scene.urdf", '<robot name="scene"><link name="HEAD_LINK1"><collision><origin xyz="0.6 0 0"/><geometry>'
                         '<box size="0.1 1 1"/></geometry></collision></link></robot>')
        self.humanoid("--obstacles", scene)
        self.assertEqual(self.script("return new HeatMap(scene.report, () => {}).at.size"), 2 * self.script("return scene.report.pairs.length"))
        self.assertIn("HEAD_LINK1 (obstacle)", self.script("return new HeatMap(scene.report, () => {}).names"))

    def test_only_a_trajectory_that_is_free_is_shown_as_good(self):
        way = self.put("way.csv", "RARM_JOINT0\n0\n0.1\n")
        for margin, verdict, good in (("0", "proven free", 2), ("0.9", "CONTACT", 0)):
            self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf", "--trajectory", way, "--margin", margin)
            self.assertIn(verdict, self.browser.find_element(By.ID, "subtitle").text)
            self.assertIn("others where it begins", self.browser.find_element(By.ID, "subtitle").text)
            self.assertRegex(self.browser.find_element(By.ID, "detail").text, r"Closest at way point\n\d")
            self.assertEqual(self.script("return document.querySelectorAll('.figure.good').length"), good)
            self.assertEqual("within 900 mm" in self.browser.find_element(By.ID, "figures").text, not good)
            # The chart is away from the window's edge, and none of its text is cut off.
            self.assertTrue(self.script("""
              const box = document.getElementById('trajectory'), edge = box.getBoundingClientRect();
              return edge.left > 5 && [...box.querySelectorAll('text')].map(t => t.getBoundingClientRect()).every(
                at => at.left >= edge.left && at.right <= edge.right);"""))
        self.reopen(lambda data: data["trajectory"].update(verdict="NOT DECIDED") or data["summary"].update(colliding=0))
        self.assertEqual(self.script("return document.querySelectorAll('.figure.good').length"), 0)

    def test_a_pair_that_is_not_decided_is_not_called_clear(self):
        # A ball rolls on a floor, with a distance of 0 up to rounding. A box above it stays clear.
        shape = '<link name="{}"><collision><origin xyz="0 0 {}"/><geometry>{}</geometry></collision></link>'
        urdf = self.put("cart.urdf", '<robot name="cart"><link name="rail"/>' + shape.format("foot", 0.1, '<sphere radius="0.1"/>')
                        + shape.format("arm", 0.5, '<box size="0.1 0.1 0.2"/>') + joint("x", "rail", "foot", "prismatic")
                        + joint("y", "foot", "arm", "prismatic", axis="0 1 0") + "</robot>")
        floor = self.put("floor.urdf", '<robot name="ground">' + shape.format("floor", -0.05, '<box size="4 4 0.1"/>') + "</robot>")
        way = self.put("way.csv", "time,x,y\n0,-0.5,0\n1,0.5,0\n2,0.5,0.4\n")
        self.open(urdf, "--obstacles", floor, "--trajectory", way)
        self.assertIn("not decided\ntrajectory", self.browser.find_element(By.ID, "figures").text)
        self.assertIn("NOT DECIDED for foot - floor from the start on", self.browser.find_element(By.ID, "subtitle").text)
        chart = self.script("return [...document.querySelectorAll('#trajectory text')].map(t => t.textContent)")
        for words in ("not decided from here", "time [s]", "least distance [mm]"):
            self.assertIn(words, chart)
        self.assertTrue(any(re.fullmatch(r"closest: 0 mm at \d\.\d{3} s", text) for text in chart), chart)
        states = self.states()
        self.assertEqual([state for state in states if "floor" in state], [["foot", "floor", "not decided"], ["arm", "floor", "clear"]])
        # A contact of another pair ends the proof, so nothing more is known of the ball.
        wall = shape.format("wall", 0.6, '<box size="2 1 0.1"/>')
        both = self.put("both.urdf", '<robot name="ground">' + shape.format("floor", -0.05, '<box size="4 4 0.1"/>') + wall
                        + '<joint name="w" type="fixed"><parent link="floor"/><child link="wall"/></joint></robot>')
        self.open(urdf, "--obstacles", both, "--trajectory", way)
        self.assertIn("contact\ntrajectory", self.browser.find_element(By.ID, "figures").text)
        states = self.states()
        self.assertIn(["arm", "wall", "in collision"], states)
        self.assertIn(["foot", "floor", "not decided"], states)

    def test_the_page_of_a_posture_shows_what_its_task_asks_for(self):
        ball = '<link name="{}"><inertial><mass value="1"/></inertial><collision><geometry><sphere radius="0.05"/></geometry></collision></link>'
        urdf = self.put("two.urdf", '<robot name="two">' + ball.format("base") + ball.format("m") + ball.format("hand")
                        + joint("a", "base", "m", "prismatic", "0.5 0 0", "0 0 1") + joint("b", "m", "hand", "prismatic", "0.5 0 0", "0 0 1") + "</robot>")
        task = self.put("task.json", '{"base": "fixed", "placements": [{"name": "high", "link": "hand", "target": {"position": [1.01, 0, 0.5]}},'
                                     '{"link": "m", "target": {"position": [0.5, 0, 0.2]}, "free": ["rx", "ry", "rz"]}]}')
        find_posture = os.path.join(os.path.dirname(PROGRAM), "find_posture")
        done = subprocess.run([find_posture, urdf, task, "--no-cache", "--format", "html", "-o", self.path("report.html")], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1, done.stderr)  # the target is 1 cm outside the reach of the joints
        self.show()
        rows = self.script("return [...document.querySelectorAll('#tasktable tbody tr')].map(r => [...r.children].map(c => c.textContent))")
        self.assertEqual(rows, [["high", "10.000", "0.0000"], ["m", "0.000", "free"]])
        self.assertIn("target", self.browser.find_element(By.ID, "marks").text)
        self.assertEqual(self.script("return scene.marks.children.length"), 2 + 2 + 2)  # axes of one target, dots of both
        pixels = self.script("""
          scene.draw();
          const from = scene.canvas, to = document.createElement('canvas');
          to.width = from.width; to.height = from.height;
          const g = to.getContext('2d');
          g.drawImage(from, 0, 0);
          const d = g.getImageData(0, 0, to.width, to.height).data;
          let count = 0;
          for (let i = 0; i < d.length; i += 4) count += d[i] > 130 && d[i + 1] < 90 && d[i + 2] > 120;
          return count;""")
        self.assertGreater(pixels, 20)  # of the targets' colour
        self.assertIn("high x: violated by 10.000 mm", self.browser.find_element(By.ID, "violated").text)
        self.assertNotIn("Least in samples", self.detail())
        # The link between base and hand is adjacent to both, so no pair has it.
        self.script("[...document.querySelectorAll('#linktable tbody tr')].find(row => row.cells[0].title === 'm').click()")
        self.assertEqual(self.browser.find_element(By.ID, "count").text, "0 of 1 pair")
        self.assertIn("No pair passes", self.browser.find_element(By.ID, "nothing").text)
        self.click("#clear")
        self.click("#show [data-value=pair]")
        self.assertFalse(self.script("return scene.marks.visible"))
        self.window(390)
        self.show()
        self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), 390)
        self.open(urdf)
        self.assertFalse(self.browser.find_element(By.ID, "task").is_displayed())

    def test_within_a_margin_is_not_called_a_collision(self):
        self.humanoid("--margin", "0.9")
        self.assertEqual(self.browser.find_element(By.CSS_SELECTOR, ".tag").text, "within 900 mm")
        self.assertIn("within 900 mm", self.browser.find_element(By.ID, "legend").text)
        self.assertNotIn("in collision", self.script("return document.body.innerText + document.getElementById('state').textContent"))

    def test_a_posture_is_copied_without_a_clipboard_too(self):
        self.humanoid()
        self.script("Object.defineProperty(navigator, 'clipboard', { value: undefined })")
        self.script("""
          const button = document.querySelector('.tags button'), later = window.setTimeout;
          window.setTimeout = (done, wait) => later(done, wait / 10);
          window.told = [];
          new MutationObserver(() => told.push(button.textContent)).observe(button, { childList: true });""")
        self.click(".tags button")
        self.await_script("return told.length >= 2")
        self.assertEqual(self.script("return told"), ["Copied", "Copy posture"])

    def test_a_pair_that_overlaps_by_less_than_a_negative_margin_allows_is_not_in_collision(self):
        self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf", "--margin", "-0.5")
        self.assertEqual(self.script("return document.querySelectorAll('.figure.bad').length"), 0)
        self.assertEqual(self.script("return scene.report.pairs.filter(p => p.checked && p.distance < 0).length > 0"), True)
        # No cell has a colour between those of collisions.
        self.assertTrue(self.script("const map = new HeatMap(scene.report, () => {}); map.draw(); "
                                    "return map.pairs.filter(p => p.checked).every(p => "
                                    "map.colour(p) === scaleColour(Math.max(0, Math.min(1, p.distance / map.far))))"))
        self.assertIn("overlap", [row[3] for row in self.rows()])

    def test_an_address_opens_its_view_later_too_and_the_first_pair_if_there_is_no_such_pair(self):
        self.humanoid(view="#pair=9999&show=pair")
        self.assertEqual(self.script("return document.body.dataset.selected"), "0")
        self.assertEqual(self.script("return scene.bodies.filter(m => m.visible).length"), 2)
        self.script("location.hash = '#pair=7'")
        self.await_script("return document.body.dataset.selected === '7'")
        self.assertEqual(self.script("return scene.bodies.filter(m => m.visible).length"), 31)
        self.script("location.hash = '#pair=8&show=pair'")
        self.await_script("return document.body.dataset.selected === '8'")
        self.assertEqual(self.script("return scene.bodies.filter(m => m.visible).length"), 2)

    def test_a_page_without_pairs_opens(self):
        # The tools refuse an empty report, but a page whose data has no pairs must still open.
        self.humanoid(shown=False)
        self.reopen(lambda data: data["pairs"].clear())
        self.assertIn("no pairs", self.browser.find_element(By.ID, "nothing").text)
        self.assertGreater(self.pixels()["link"], 5000)

    def test_names_stay_readable_on_a_phone_and_other_columns_give_way(self):
        self.window(390)
        self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf")  # everything collides: all columns
        self.await_script("return document.querySelector('#table td').hidden === false")
        names = {name for row in self.rows() for name in row[:2]}
        self.assertTrue(all(len(name) >= 9 or name == "BODY" for name in names), names)
        shown = self.script("return [...document.querySelectorAll('#table th')].filter(h => h.offsetWidth).map(h => h.dataset.key)")
        self.assertEqual(shown[:3], ["link1", "link2", "distance"])
        self.assertNotIn("cover", shown)
        self.assertTrue(self.script("const box = document.getElementById('tablebox'); return box.scrollWidth <= box.clientWidth"))
        self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), 390)
        self.window(1400)
        self.await_script("return document.querySelector('#table th[data-key=cover]').offsetWidth > 0")

    def test_hulls_that_overlap_are_said_to_and_come_first(self):
        self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf")
        self.click("#table th[data-key=hull_distance]")
        hulls = [row[3] for row in self.rows()]
        count = hulls.count("overlap")
        self.assertGreater(count, 10)
        self.assertEqual(set(hulls[:count]), {"overlap"})
        self.assertNotIn("–", hulls)
        self.assertIn("overlap", self.script("return document.querySelector('#table th[data-key=hull_distance]').title"))

    def test_long_names_of_links_differ_and_a_click_shows_their_pairs(self):
        self.humanoid(shown=False)
        self.reopen(lambda data: [link.update(name=f"mobile_manipulator_robot_with_two_arms_{link['name']}") for link in data["links"]])
        names = self.script("return [...document.querySelectorAll('#linktable tbody tr')].map(({ cells: [name] }) => "
                            "[name.textContent, name.title, name.scrollWidth <= name.clientWidth])")
        self.assertEqual(len({short for short, *_ in names}), len(names))
        self.assertTrue(all(title.startswith("mobile_manipulator_robot_with_two_arms_") and fits for _, title, fits in names), names)
        self.script("document.querySelector('#linktable tbody tr').click()")
        self.assertEqual(self.browser.find_element(By.ID, "count").text, "30 of 465 pairs")
        numbers = "return [...document.querySelectorAll('#linktable tbody tr')].map(r => Number(r.cells[r.cells.length - 1].textContent))"
        for way in (-1, 1):
            self.script("document.querySelector('#linktable th[data-key=vertices]').click()")
            self.assertEqual(self.script(numbers), sorted(self.script(numbers), reverse=way < 0))

    def test_a_trajectory_opens_at_its_first_contact(self):
        # The arm goes on into the body for half a second.
        way = self.put("way.csv", "time,RARM_JOINT1,RARM_JOINT3\n0,-0.2,-0.3\n1,0.4,-0.3\n2,-0.2,-0.3\n")
        self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf", "--trajectory", way)
        contact = self.script("return scene.report.trajectory.contact")
        self.assertAlmostEqual(contact["distance"], 0, delta=1e-5)
        self.assertIn("First contact at\n" + contact["time_text"], self.detail())
        self.assertNotIn("meshes meet", self.detail())  # which they do later only
        posture = lambda: self.script("return scene.pair.posture")
        self.assertEqual(posture(), contact["posture"])
        tags = self.script("return [...document.querySelectorAll('#table td[data-tag]')].map(c => [c.dataset.tag, c.parentElement.rowIndex])")
        self.assertEqual(tags, [["first contact", 1]])
        self.click(".moments button:last-child")
        self.assertEqual(posture(), self.script("return scene.report.pairs[0].posture"))
        self.assertNotIn("First contact at", self.detail())
        self.assertIn("meshes meet", self.detail())
        # The chart tells what is under the mouse, and a click puts the robot there.
        self.script("document.getElementById('trajectory').scrollIntoView()")
        chart = self.browser.find_element(By.CSS_SELECTOR, "#trajectory svg")
        ActionChains(self.browser).move_to_element(chart).perform()
        told = self.browser.find_element(By.ID, "instant").text
        self.assertRegex(told, r"^\d\.\d{3} s: -?\d+\.\d{3} mm, \w+ – \w+$")
        chart.click()
        self.assertIn("Shown at\n" + told.split(":")[0], self.detail())
        self.assertEqual(posture(), self.script(f"const c = scene.report.trajectory.chart; return c.posture[c.time_text.indexOf('{told.split(':')[0]}')]"))
        self.assertFalse(self.script("scene.draw(); return scene.witness.visible"))  # it is known where the two are closest only
        instants = self.browser.find_element(By.ID, "instants").text
        self.assertRegex(instants, r"First contact: \d\.\d{3} s, .* \w+ – \w+\nClosest: \d\.\d{3} s, -\d+\.\d{3} mm, \w+ – \w+")

    def test_parts_have_a_card_and_stand_below_their_link(self):
        self.humanoid()
        self.assertFalse(self.browser.find_element(By.ID, "parts").is_displayed())

        def split(data):
            data["summary"]["rows"] = {"whole": 130, "whole_us_per_tick": 17, "parts": 131, "parts_us_per_tick": 18, "hand_over": 132, "hand_over_live": 7,
                                       "hand_over_us_per_tick": 19}
            data["links"][0]["parts"] = 2
            for i, link in enumerate(data["links"][-2:]):
                link.update(part_of=data["links"][0]["name"], excess_max=0.001 * (i + 1))
            for pair in data["pairs"][:5]:
                pair.update(by_parts="BODY" in (pair["link1"], pair["link2"]))
        self.reopen(split)
        text = self.browser.find_element(By.ID, "parts").text
        self.assertIn("BODY in 2 parts, 2.000 mm from the mesh at most", text)
        self.assertRegex(text, "below 0.1 m, whole bodies above; 7 of the rows not constant 132 19.0")
        below = self.script("return [...document.querySelectorAll('#linktable tr.part')].map(r => r.previousElementSibling.cells[0].title.split(' ')[0])")
        self.assertEqual(below[0], "BODY")
        self.assertEqual(len(below), 2)

    def test_a_verdict_over_all_postures_is_not_mixed_with_this_one(self):
        self.humanoid(shown=False)
        self.reopen(lambda data: data["pairs"][0].update(reason="always"))
        self.assertIn("nearly always", self.rows()[0])
        self.assertIn("clear", self.detail())
        self.assertIn("over all postures: nearly always", self.detail())
        self.click("#words summary")
        self.assertIn("at least 95 %", self.browser.find_element(By.ID, "words").text)
        self.assertNotIn("rigid", self.browser.find_element(By.ID, "words").text)  # which no pair is

    def test_figures_filter_and_keys_sort(self):
        self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf")
        cards = "return [...document.querySelectorAll('.group .figure')].map(c => [c.textContent, c.click(), document.getElementById('count').textContent])"
        (hit, _, count), *causes = self.script(cards)
        self.assertEqual(hit, count.split()[0] + "in collision")
        self.assertEqual([text for text, *_ in causes], [count.split()[0] + cause for (_, _, count), cause in
                                                         zip(causes, [re.sub(r"^\d+", "", text) for text, *_ in causes])])
        self.assertEqual(sum(int(count.split()[0]) for _, _, count in causes), int(count.split()[0]))
        self.click("#figures button")
        self.assertEqual(self.browser.find_element(By.ID, "count").text, "465 pairs")
        self.browser.find_element(By.CSS_SELECTOR, "#table th[data-key=distance]").send_keys(" ")
        self.assertEqual(self.script("return document.querySelector('#table th[data-key=distance]').getAttribute('aria-sort')"), "ascending")

    def test_the_heat_map_shades_depth_and_shows_what_is_chosen(self):
        self.open(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf")
        heat = self.browser.find_element(By.ID, "heat")
        self.script("document.getElementById('heat').scrollIntoView()")
        at = self.script("const h = document.getElementById('heat').getBoundingClientRect(); return h.width - 8 - h.width / 2")
        ActionChains(self.browser).move_to_element_with_offset(heat, int(at), int(at) - 30).click().perform()
        seen = """
          const row = document.querySelector('#table tr.sel').getBoundingClientRect(), box = document.getElementById('tablebox').getBoundingClientRect();
          return row.top >= box.top && row.bottom <= box.bottom + 1 && box.top >= 0 && box.bottom <= innerHeight + 1;"""
        self.await_script(seen)
        before = self.script("return document.body.dataset.selected")
        heat.send_keys(webdriver.Keys.ARROW_UP)
        self.assertNotEqual(self.script("return document.body.dataset.selected"), before)
        self.assertGreater(self.script("const map = new HeatMap(scene.report, () => {}); map.draw(); "
                                       "return new Set(map.pairs.filter(p => p.checked && p.colliding).map(p => map.colour(p))).size"), 10)
        self.window(390)
        self.show()
        self.assertGreaterEqual(self.script("const map = new HeatMap(scene.report, () => {}); map.draw(); return map.cell"), 12)
        self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), 390)

    def test_the_first_view_shows_the_obstacle_of_the_closest_pair_beside_the_robot(self):
        wall = self.put("scene.urdf", '<robot name="scene"><link name="wall"><collision><origin xyz="0.5 0 0"/><geometry>'
                        '<box size="0.1 1 1.4"/></geometry></collision></link></robot>')
        self.humanoid("--obstacles", wall)
        self.assertEqual(self.script("return document.title"), "hrp2_style: collision report")
        self.reopen(lambda data: data["pairs"].sort(key=lambda p: p["link2"] != "wall"))
        corners, across = self.script("""
          const box = scene.bounds(scene.bodies.filter((_, i) => scene.report.bodies[i].obstacle)), far = [];
          scene.camera.updateMatrixWorld();
          for (const x of [box.min.x, box.max.x]) for (const y of [box.min.y, box.max.y]) for (const z of [box.min.z, box.max.z])
            far.push(...new THREE.Vector3(x, y, z).project(scene.camera).toArray().slice(0, 2));
          const way = scene.camera.position.clone().sub(scene.controls.target).normalize();
          return [far, way.x];""")
        self.assertLess(max(map(abs, corners)), 1.05)
        self.assertLess(across, 0.1)  # not from behind the wall
        self.humanoid()
        self.assertEqual(self.script("return document.title"), "hrp2_style: self-collision report")

    def test_the_cause_filter_keeps_the_pairs_of_one_cause(self):
        self.humanoid(shown=False)
        causes = ["meshes meet", "hull only", "margin only"]
        self.reopen(lambda data: [pair.update(cause=causes[i % 3]) for i, pair in enumerate(data["pairs"])])
        Select(self.browser.find_element(By.ID, "cause")).select_by_value("hull only")
        self.assertEqual(len(self.rows()), 155)
        self.assertTrue(all("hull only" in row for row in self.rows()))

    def test_columns_fit_and_the_page_is_small_and_turns_smoothly(self):
        size = self.humanoid()
        self.assertTrue(self.script("const box = document.getElementById('tablebox'); return box.scrollWidth <= box.clientWidth "
                                    "&& document.documentElement.scrollWidth <= innerWidth"))
        self.assertLess(size, 1e6)
        self.assert_turns_smoothly("hrp2_style, 31 links", size, 40, 27000)

    def test_45_links_in_990_postures_stay_below_a_megabyte(self):
        size = self.open(self.put("chain.urdf", primitives(45)))
        self.assertEqual(len(self.rows()), 990)
        self.assertLess(size, 1e6)
        self.assert_turns_smoothly("a chain of 45 links", size, 54, 37000)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=1)
