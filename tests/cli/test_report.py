"""The report in a browser: nothing breaks, everything answers, nothing overflows. Skipped without Chromium."""
import os
import re
import shlex
import shutil

from support import Case, browser, main

SMALL = """
title  = "Report"
scenes = ["builtin:stairs", "builtin:sphere_over_mirror"]
sizes  = ["96x54"]
[passes]
pass_set = "shading"
[trace]
max_distance_m = 9
[techniques.linear]
steps = [8, 128]
[techniques.dda]
[techniques.hiz]
[measure]
min_repeats = 6
max_repeats = 6
budget_s    = 0
"""


def offline_browser(folder, width, dark=False):
    page = browser(folder, width, 1000, ("disable-gpu", "disable-quic", "disable-background-networking", "disable-component-update",
                                         "disable-sync", f"window-size={width},1000"))
    page.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
    page.execute_cdp_cmd("Network.enable", {})
    page.execute_cdp_cmd("Network.emulateNetworkConditions", {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0})
    return page


class Test(Case):
    def test_what_it_would_cost_on_a_gpu(self):
        """Instructions of the compiler for RDNA2 times the iterations that were counted."""
        spec = SMALL.replace("[measure]", "[techniques.hiz_packets]\n[measure]")
        self.ssrlab("run", self.write("small.toml", spec), "-o", self.path("out"))
        self.ssrlab("plot", self.path("out"))
        text = self.text("out/report.md")
        part = text[text.index("## What this would cost on RDNA2, by its compiler"):]
        lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in part.splitlines() if line.startswith("|")]
        heads, rows = lines[0], [dict(zip(lines[0], line)) for line in lines[2:6]]
        self.assertIn("wave instructions a ray", heads)
        self.assertEqual({row["technique"] for row in rows}, {"linear", "dda", "hiz", "hiz_packets"}, part)
        counted = self.rows()
        for row in rows:
            self.assertEqual((row["spills"], row["group"]), ("0", "64"))
            rays = 128 if row["technique"] == "hiz_packets" else 64  # two an invocation
            loop, iterations = float(row["innermost loop"]), float(row["iterations of a wave"])
            self.assertAlmostEqual(float(row["wave instructions a ray"]), loop * iterations / rays, delta=0.02 * loop)
            means = [float(one[f"wave{rays}_iterations_mean"]) for one in counted if one["technique"] == row["technique"]]
            self.assertTrue(min(means) - 0.01 <= iterations <= max(means) + 0.01, (means, row))

    def report(self):
        """Made by a run, and moved away from everything beside it."""
        self.ssrlab("run", self.write("small.toml", SMALL), "-o", self.path("out"))
        self.assertRegex(self.ssrlab("plot", self.path("out")), r"is (the|one of the) cheapest tracers? that finds? 99 % of what the depth buffer holds")
        os.makedirs(self.path("alone"))
        return shutil.move(self.path("out/report.html"), self.path("alone/report.html"))

    def open(self, path, width, dark=False):
        page = offline_browser(self.path(f"browser{width}"), width, dark)
        self.addCleanup(page.quit)
        page.get("file://" + path)
        return page

    def test_report_answers_in_a_browser(self):
        page = self.open(self.report(), 1400)
        run = page.execute_script
        self.assertEqual(page.get_log("browser"), [], "console")
        self.assertEqual(run("return [...document.images].filter(i => i.getAttribute('src') && !(i.complete && i.naturalWidth)).length"), 0, "a picture is missing")
        self.assertEqual(run("return [...document.images].filter(i => i.closest('.shots, .plot') && !i.alt).length"), 0, "alt texts")

        # Hover shows a setting and its values; a click opens the run with its command.
        point = run("const p = chart.getDatasetMeta(0).data[0], b = chart.canvas.getBoundingClientRect(); chart.canvas.scrollIntoView({block: 'center'});"
                    "const c = chart.canvas.getBoundingClientRect(); return [c.left + p.x, c.top + p.y]")
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            page.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": point[0], "y": point[1], "button": "left" if kind != "mouseMoved" else "none", "clickCount": 1})
            if kind == "mouseMoved":
                self.wait(page, "return chart.tooltip.opacity > 0")
                self.assertRegex(" ".join(run("return chart.tooltip.body.flatMap(b => b.lines)")), r"\d ms .*fetches a ray")
        self.wait(page, "return document.getElementById('run').open")
        self.assertRegex(run("return document.querySelector('#run .command').textContent"), r"run .*small\.toml --only r[0-9a-f]{16} -o again/")
        run("document.getElementById('run').close()")

        # Other measures and costs.
        for select, value in (("measure", "screen_f1_1px"), ("measure", "flip_visible"), ("cost", "fetches_mean"), ("cost", "steps_mean")):
            run(f"const s = document.getElementById('curve-{select}'); s.value = '{value}'; s.dispatchEvent(new Event('change'))")
            self.assertGreater(run("return chart.data.datasets.reduce((n, set) => n + set.data.length, 0)"), 3, value)

        # The slider moves the border of the right picture, the choice changes it.
        before = run("return document.querySelector('.stage .right').style.clipPath")
        run("const s = document.querySelector('.compare input'); s.value = 20; s.dispatchEvent(new Event('input'))")
        self.assertNotEqual(run("return document.querySelector('.stage .right').style.clipPath"), before)
        kinds = run("return [...document.querySelectorAll('.choose-right optgroup')].map(g => g.label)")
        self.assertEqual(set(kinds), {"picture", "agreement", "causes", "FLIP", "fetches"})
        names = run("return [...document.querySelectorAll('.choose-left option')].map(o => o.textContent)")
        self.assertTrue({"off", "truth", "hiz", "dda"} <= set(names), names)

        # A click on a pixel shows the command of its ray, which runs.
        box = run("const s = document.querySelector('.stage'); s.scrollIntoView({block: 'center'}); const b = s.getBoundingClientRect(); return [b.left, b.top, b.width, b.height]")
        run("const s = document.querySelector('.compare input'); s.value = 90; s.dispatchEvent(new Event('input'))")
        self.assertFalse(run("return document.querySelector('.pixel').checkVisibility()"))
        at = [box[0] + box[2] * 48.5 / 96, box[1] + box[3] * 40.5 / 54]
        for kind in ("mousePressed", "mouseReleased"):
            page.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": kind, "x": at[0], "y": at[1], "button": "left", "clickCount": 1})
        self.wait(page, "return document.querySelector('.pixel').checkVisibility()")
        self.assertEqual(run("return document.querySelector('.compare input').value"), "90", "a click leaves the border")
        command = shlex.split(run("return document.querySelector('.pixel code').textContent"))
        shown = run("const c = document.querySelector('.choose-left'); const i = [...document.querySelectorAll('.frame')][0].querySelectorAll('.shots img')[c.value];"
                    "return data.runs[i.closest('[data-run]').dataset.run].name")
        self.assertEqual(command[command.index("-t") + 1], shown.split(",")[0])
        self.assertEqual(command[-2:], ["--pixel", "48,40"])
        self.assertIn("max_distance_m=9", command)
        self.ssrlab(*command[1:], says=["Ray of pixel (48, 40)", "screen truth: "])
        run("document.querySelector('.pixel button').click()")
        self.assertEqual(shlex.split(run("return String(getSelection())")), command)

        # Sorting and filtering.
        values = ("return [...document.querySelectorAll('#ranking tbody tr')].filter(r => !r.hidden).map(r => r.cells[arguments[0]].dataset.sort)")
        at = run("return [...document.querySelectorAll('#ranking th')].findIndex(h => h.textContent === 'ms')")
        for order in (False, True):
            run("document.querySelectorAll('#ranking th button')[arguments[0]].click()", at)
            shown = [float(value) for value in run(values, at)]
            self.assertEqual(shown, sorted(shown, reverse=order))
        run("const f = document.querySelector('#ranking .filter input'); f.value = 'hiz'; f.dispatchEvent(new Event('input'))")
        self.assertEqual(len(run(values, at)), 1)
        self.assertEqual(page.get_log("browser"), [], "console")

    def test_report_fits_a_phone_and_the_dark(self):
        path = self.report()
        for width, dark in ((1400, True), (400, False)):
            page = self.open(path, width, dark)
            self.assertLessEqual(page.execute_script("return document.documentElement.scrollWidth"), width)
            self.assertEqual(page.get_log("browser"), [], "console")
            ground = page.execute_script("return getComputedStyle(document.body).backgroundColor")
            self.assertEqual(max(map(int, re.findall(r"\d+", ground)[:3])) < 80, dark, ground)

    def test_an_unlimited_setting_is_shown(self):
        far = SMALL.replace("max_distance_m = 9", "max_distance_m = inf").replace("= 6\n", "= 1\n")
        self.ssrlab("run", self.write("far.toml", far), "-o", self.path("far"))
        self.ssrlab("plot", self.path("far"))
        self.assertIn('"inf"', self.text("far/report.html"))

    def test_commands_of_the_report_measure_the_run_again(self):
        self.report()
        for row in self.rows():
            self.assertTrue(os.path.exists(self.path(f"out/{row['truth_picture']}")), row["run_id"])
        one = self.rows()[-1]["run_id"]
        self.ssrlab("run", self.path("small.toml"), "--only", one, "-o", self.path("again"))
        again = self.rows("again")
        self.assertEqual([row["run_id"] for row in again], [one])

    def wait(self, page, condition):
        from selenium.webdriver.support.ui import WebDriverWait
        WebDriverWait(page, 10).until(lambda _: page.execute_script(condition))


if __name__ == "__main__":
    main()
