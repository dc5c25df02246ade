"""ssrlab view under a virtual display: what it shows is what render, ray and the truths say, and it changes with what is set."""
import json
import re
import shutil
import subprocess
import unittest

from support import HANGS_S, PROGRAM, Case, main

PANEL_PX = 400
SIZE = (320, 180)
SCENE = ("builtin:pole_field", "--size", "320x180")
MARCH = ("-t", "linear", "-p", "max_distance_m=40")


class Test(Case):
    def view(self, script, *more, code=0, says=(), scene=SCENE):
        """Runs the script in a window; returns what was printed."""
        if not shutil.which("xvfb-run"):
            raise unittest.SkipTest("xvfb is not installed")
        arguments = ["xvfb-run", "-a", "-s", "-screen 0 1600x1000x24", PROGRAM, "view", *scene, *more,
                     "--script", self.write("script.txt", script)]
        done = subprocess.run(arguments, env=self.environment, cwd=self.folder, timeout=HANGS_S, text=True, capture_output=True)
        text = done.stdout + done.stderr
        if "this build has no viewer" in text:
            raise unittest.SkipTest("built without libglfw3-dev or libimgui-dev")
        self.assertEqual(done.returncode, code, f"{' '.join(arguments)}\n{text}")
        for one in says:
            self.assertIn(one, text)
        return text

    def shown(self, name, box=None):
        """The picture in a screenshot of the window, or a part of it."""
        from PIL import Image
        left, top, right, bottom = box or (0, 0, *SIZE)
        return Image.open(self.path(name)).convert("RGB").crop((PANEL_PX + left, top, PANEL_PX + right, bottom))

    def rendered(self, *arguments):
        from PIL import Image
        self.ssrlab("render", *SCENE, *arguments, "-o", "render.png")
        return Image.open(self.path("render.png")).convert("RGB")

    def share(self, text, name):
        return [float(value) for value in re.findall(rf"^{name}: ([\d.]+) %$", text, re.M)]

    def test_a_slider_changes_picture_and_errors(self):
        text = self.view("set show=agreement\nset steps=512\nprint\nscreenshot many.png\nset steps=8\nprint\nscreenshot few.png\n"
                         "set steps=512\nscreenshot again.png\n", *MARCH)
        many, few = self.shown("many.png"), self.shown("few.png")
        self.assertEqual(few.tobytes(), self.rendered(*MARCH, "-p", "steps=8", "--show", "agreement").tobytes())
        self.assertEqual(many.tobytes(), self.rendered(*MARCH, "-p", "steps=512", "--show", "agreement").tobytes())
        self.assertEqual(many.tobytes(), self.shown("again.png").tobytes())
        missed = [sum(pixel == (0xd5, 0x5e, 0x00) for pixel in picture.getdata()) for picture in (many, few)]
        self.assertLess(missed[0], missed[1])
        recall, steps = self.share(text, "recall_1px"), re.findall(r"^steps a ray: ([\d.]+)$", text, re.M)
        self.assertGreater(recall[0], recall[1] + 10, text)
        self.assertGreater(float(steps[0]), 5 * float(steps[1]), text)
        self.assertNotEqual(self.shown("many.png", (-PANEL_PX, 0, 0, 180)).tobytes(), self.shown("few.png", (-PANEL_PX, 0, 0, 180)).tobytes(),
                            "the panel shows the new value")

    def test_technique_surface_and_split_against_the_truth(self):
        self.view("set technique=hiz\nset surface=plane\nset behind=stop\nscreenshot plane.png\nset split=0.5\nscreenshot split.png\n", *MARCH)
        plane = self.rendered("-t", "hiz", "-p", "max_distance_m=40", "-p", "surface=plane", "-p", "behind=stop")
        truth = self.rendered(*MARCH, "--truth")
        self.assertEqual(self.shown("plane.png").tobytes(), plane.tobytes())
        left, right = (0, 0, 159, 180), (162, 0, 320, 180)  # beside the line between them
        self.assertEqual(self.shown("split.png", left).tobytes(), plane.crop(left).tobytes())
        self.assertEqual(self.shown("split.png", right).tobytes(), truth.crop(right).tobytes())
        self.assertNotEqual(plane.crop(right).tobytes(), truth.crop(right).tobytes())

    def test_sources_answer_the_picture_and_the_ray(self):
        vouching = ("-t", "hiz", "-p", "surface=plane_infinite", "-p", "behind=stop")
        text = self.view("screenshot alone.png\nset sources=frame,world\nscreenshot a.png\nset show=sources\nscreenshot b.png\ncursor 160 140\n"
                         "print\nset sources=\nset show=picture\nprint\n", *vouching, says=["answered by ", "sources: frame,world"])
        self.assertEqual(text.count("all_f1"), 1, text)
        asked = ("--sources", "frame,world")
        for name, more in (("alone.png", ()), ("a.png", asked), ("b.png", (*asked, "--show", "sources"))):
            self.assertEqual(self.shown(name).tobytes(), self.rendered(*vouching, *more).tobytes(), name)
        self.assertNotEqual(self.shown("a.png").tobytes(), self.shown("alone.png").tobytes())
        self.assertGreater(self.share(text, "all_f1")[0], 97)
        self.view("set sources=frame,wrld\n", code=2, says=["script.txt:1: ", "did you mean 'world'?"])

    def test_the_ray_under_the_cursor(self):
        text = self.view("screenshot without.png\ncursor 160 140\nprint\nscreenshot with.png\n", "-t", "hiz")
        ray = json.loads(self.ssrlab("ray", *SCENE, "--pixel", "160,140", "-t", "hiz", "--json"))
        found = re.search(r"^pixel 160,140: hit at \(([\d.]+), ([\d.]+)\)$", text, re.M)
        self.assertTrue(found, text)
        at = [float(number) for number in found.groups()]
        self.assertEqual([int(number) for number in at], ray["techniques"][0]["pixel"])
        self.assertIn(f"truth: {ray['scene_truth']['class']}", text)
        middle = tuple(round((a + b) / 2) for a, b in zip((160.5, 140.5), at))
        around = (middle[0] - 2, middle[1] - 2, middle[0] + 3, middle[1] + 3)
        colours = [set(self.shown(name, around).getdata()) for name in ("without.png", "with.png")]
        self.assertIn((0, 158, 115), colours[1] - colours[0], f"the line to the true point passes {middle}")
        self.assertNotEqual(self.shown("without.png").tobytes(), self.shown("with.png").tobytes())

    def test_the_camera_moves(self):
        self.view("screenshot first.png\norbit 40 10\nscreenshot turned.png\norbit -40 -10\nscreenshot back.png\n"
                  "look 10 0\nfly 0 0 -1\nscreenshot flown.png\n", "-t", "hiz")
        first, turned, back, flown = (list(self.shown(f"{name}.png").getdata()) for name in ("first", "turned", "back", "flown"))
        changed = [sum(a != b for a, b in zip(first, other)) / len(first) for other in (turned, back, flown)]
        self.assertGreater(changed[0], 0.2)
        self.assertLess(changed[1], 0.02)
        self.assertGreater(changed[2], 0.2)

    def test_a_frame_of_another_renderer(self):
        self.ssrlab("gbuffer", *SCENE, "-o", "frame.exr")
        text = self.view("print\nset show=agreement\nscreenshot a.png\n", "-t", "dda", scene=("frame.exr",), says=["screen_f1_1px: 100.00 %"])
        self.assertNotIn("\nrecall_1px", text)
        self.assertIn((0x00, 0x9e, 0x73), self.shown("a.png").getdata())
        self.view("orbit 1 1\n", scene=("frame.exr",), code=2, says=["script.txt:1: ", "camera"])
        self.view("set show=causes\nprint\n", scene=("frame.exr",), code=2, says=["script.txt:2: ", "no triangles"])

    def test_mistakes_name_their_place(self):
        self.view("# a comment\nscreenshoot a.png\n", code=2, says=["script.txt:2: ", "did you mean 'screenshot'?"])
        self.view("set steps=0\n", *MARCH, code=2, says=["script.txt:1: ", "steps"])
        self.view("set show=thruth\n", code=2, says=["script.txt:1: ", "did you mean 'truth'?"])
        self.view("cursor 320 0\n", code=2, says=["script.txt:1: ", "320x180"])
        self.view("orbit 1\n", code=2, says=["script.txt:1: 'orbit' has 2 arguments, got 1"])


if __name__ == "__main__":
    main()
