"""experiments/web: the page that traces by WebGPU and measures a GPU, in Chromium on its software device."""
import os
import subprocess

import numpy
import OpenImageIO

from support import PROGRAM, SOURCE, Case, browser, main

WEBGPU = ("enable-unsafe-webgpu", "use-webgpu-adapter=swiftshader", "enable-unsafe-swiftshader", "use-angle=swiftshader",
          "enable-features=Vulkan", "use-vulkan=swiftshader")
HITS = """const done = arguments[2];
trace("builtin:corridor", arguments[0], "plane_solid", arguments[1]).then(({ rays, hits }) =>
    done([...hits].map((word, i) => [rays[8 * (i >> 1) + 7], word])), (error) => done(error.message));"""
FILES = """const done = arguments[0];
Promise.all([...document.querySelectorAll("#downloads a")].map(async (link) => [link.download, await (await fetch(link.href)).text()])).then(done);"""


class Test(Case):
    def wait(self, page, script):
        from selenium.webdriver.support.ui import WebDriverWait
        WebDriverWait(page, 120).until(lambda one: one.execute_script("return " + script), script)

    def traced(self, technique, *parameters):
        """Of each pixel with a ray: (status, hit x, hit y, t)."""
        path = self.path(f"{technique}.exr")
        self.ssrlab("trace", "builtin:corridor", "--size", "64x36", "-t", technique, "-o", path,
                    *(word for pair in ("surface=plane_solid", *parameters) for word in ("-p", pair)))
        image = OpenImageIO.ImageBuf(path)
        names = list(image.spec().channelnames)
        return {name: image.get_pixels(OpenImageIO.FLOAT)[:, :, names.index(name)] for name in names}

    def assert_hits(self, page, technique, numbers, *parameters):
        """The page's hits are those of ssrlab trace, to the bit of t."""
        found = page.execute_async_script(HITS, technique, numbers)
        self.assertIsInstance(found, list, found)
        lab = self.traced(technique, *parameters)
        rays = 0
        for (pixel, word), (_, t) in zip(found[::2], found[1::2]):
            x, y = pixel & 0x3FFF, pixel >> 14 & 0x3FFF
            self.assertEqual(word >> 28, lab["status"][y, x], (x, y))
            if word >> 28 == 1:
                self.assertEqual((word & 0x3FFF, word >> 14 & 0x3FFF), (int(lab["pixel.x"][y, x]), int(lab["pixel.y"][y, x])), (x, y))
                self.assertEqual(numpy.uint32(t).view(numpy.float32), lab["hit.t"][y, x], (x, y))
            rays += 1
        self.assertEqual(rays, numpy.count_nonzero(lab["status"]))
        self.assertGreater(rays, 300)

    def test_the_page(self):
        subprocess.run([os.path.join(SOURCE, "experiments", "web", "build"), "-o", self.path("web"), "--scenes", "builtin:corridor", "--size",
                        "64x36", "--techniques", "dda", "linear", "--surfaces", "plane_solid"], check=True,
                       env=dict(self.environment, SSRLAB=PROGRAM), stdout=subprocess.DEVNULL)
        page = browser(self.path("profile"), 390, 800, ("disable-dev-shm-usage",) + WEBGPU)
        page.set_script_timeout(120)
        self.addCleanup(page.quit)
        page.get("file://" + self.path("web/index.html"))
        self.wait(page, "document.getElementById('picture').dataset.shown")
        self.assertLessEqual(page.execute_script("return document.documentElement.scrollWidth"), 390)
        self.assert_hits(page, "dda", {})
        self.assert_hits(page, "linear", {"steps": 64}, "space=screen", "steps=64")

        page.find_element("id", "sweep").send_keys("\n")  # by keyboard
        self.wait(page, "document.querySelectorAll('#downloads a').length === 2")
        for name, text in page.execute_async_script(FILES):
            self.write(f"measured/{name}", text)
        rows = self.rows("measured")
        self.assertEqual([row["outcome"] for row in rows], ["ok"] * 7, rows)
        self.assertTrue(all(float(row["trace_ms_median"]) > 0 for row in rows))
        self.ssrlab("plot", self.path("measured"), says=["7 of 7 rows ok"])
        self.assertIn("swiftshader", self.text("measured/report.md"))

        page.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": "Object.defineProperty(navigator, 'gpu', { value: undefined });"})
        page.refresh()
        self.wait(page, "document.getElementById('device').textContent.includes('recorded results')")
        self.wait(page, "document.querySelectorAll('#curve circle').length === 7")
        self.assertIn("Recorded by ssrlab on llvmpipe", page.find_element("id", "source").text)
        self.assertEqual(page.get_log("browser"), [])


if __name__ == "__main__":
    main()
