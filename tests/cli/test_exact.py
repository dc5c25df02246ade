"""-t exact: the fastest exact technique, chosen by a measurement that is kept; where a name is needed instead."""
import json
import os
import re
import shutil

from support import Case, SOURCE, SWEEP, main, read

FRAME = ("builtin:stairs", "--size", "64x36")
EXACT = {"dda", "hiz", "hiz_packets", "hiz_waves", "quadtree"}


class Test(Case):
    def setUp(self):
        super().setUp()
        self.environment["XDG_CACHE_HOME"] = self.path("cache")

    def times_file(self):
        names = [name for name in os.listdir(self.path("cache/ssrlab")) if name.startswith("exact_")]
        self.assertEqual(len(names), 1, names)
        return self.path("cache/ssrlab/" + names[0])

    def kept(self):
        return json.loads(read(self.times_file()))["measurements"]

    def chosen(self, text):
        found = re.search(r"^exact: (\w+): [\d.]+ ms(?:, \w+ [\d.]+)+, (measured|kept from a measurement) on .+ at 64x36, plane_solid$", text, re.M)
        self.assertTrue(found, text)
        return found[1], found[2]

    def copied(self, source, to):
        shutil.copytree(os.path.join(SOURCE, "techniques", source), self.path(to))

    def test_the_fastest_one_is_measured_kept_and_named_in_what_is_written(self):
        name, how = self.chosen(self.ssrlab("trace", *FRAME, "-t", "exact", "-o", "a.exr"))
        self.assertEqual(how, "measured")
        (kept,) = self.kept()
        self.assertEqual(set(kept["ms"]), EXACT)
        self.assertEqual(kept["ms"][name], min(kept["ms"].values()))
        self.assertGreater(kept["rays"], 100)
        self.assertEqual(self.chosen(self.ssrlab("trace", *FRAME, "-t", "exact", "-o", "b.exr")), (name, "kept from a measurement"))
        self.ssrlab("trace", *FRAME, "-t", name, "-o", "c.exr")
        self.assertEqual(self.bytes("a.exr"), self.bytes("c.exr"))
        self.assertEqual(self.bytes("b.exr"), self.bytes("c.exr"))
        self.assertEqual(self.ssrlab("--quiet", "trace", *FRAME, "-t", "exact", "-o", "b.exr"), "b.exr\n")

    def test_render_ray_plan_and_sources_take_it(self):
        name, _ = self.chosen(self.ssrlab("render", *FRAME, "-o", "a.exr"))
        self.assertIn(f" -t {name}".encode(), self.bytes("a.exr"))
        ray = ("ray", *FRAME, "--pixel", "30,30", "-t", "exact", "-t", "linear", "-p", "steps=9")
        self.assertEqual(self.chosen(self.ssrlab(*ray))[0], name)
        self.ssrlab(*ray, says=[f"\n{name}: ", "\nlinear: "])
        self.ssrlab("plan", *FRAME, "-t", "exact", "--repeats", "1", says=[f"64x36, {name} on"])
        self.ssrlab("sources", *FRAME, "-t", "exact", "--sources", "frame", says=[f"64x36, {name}, surface plane_solid"])

    def test_a_parameter_narrows_the_choice_to_those_that_have_it(self):
        self.chosen(self.ssrlab("trace", *FRAME, "-t", "exact", "-p", "arithmetic=exact", "-o", "a.exr"))
        self.assertLessEqual(set(self.kept()[0]["ms"]) | set(self.kept()[0]["left_out"]), {"dda", "hiz", "quadtree"})
        self.assertIn("hiz", self.kept()[0]["ms"])
        self.refused("trace", *FRAME, "-t", "exact", "-p", "stepps=3", "-o", "b.exr", code=2, says=["stepps"])
        self.refused("trace", *FRAME, "-t", "exact", "-p", "climb=2", "-p", "depth_pyramid.kind=minmax", "-o", "b.exr", code=2,
                     says=["no exact technique has all of these parameters: climb=2, depth_pyramid.kind=minmax"])

    def test_a_damaged_file_is_a_warning_and_a_changed_technique_is_measured_anew(self):
        self.copied("dda", "mine/walk")
        exact = ("--techniques", "mine", "trace", *FRAME, "-t", "exact", "-o", "a.exr")
        self.assertEqual(self.chosen(self.ssrlab(*exact))[1], "measured")
        whole = self.bytes(self.times_file())
        for damaged in (whole[:40], b"{}", whole.replace(b'"ms"', b'"s"'), re.sub(rb'"walk": [\d.]+', b'"walk": -1', whole)):
            with open(self.times_file(), "wb") as file:
                file.write(damaged)
            text = self.ssrlab(*exact, says=["warning: no times of techniques can be read, they are measured anew: " + self.times_file()])
            self.assertEqual(self.chosen(text)[1], "measured")
            self.assertEqual(self.chosen(self.ssrlab(*exact))[1], "kept from a measurement")
        with open(self.path("mine/walk/trace.glsl"), "a", encoding="utf-8") as file:
            file.write("// changed\n")
        self.assertEqual(self.chosen(self.ssrlab(*exact))[1], "measured")
        self.assertEqual(len(self.kept()), 1)

    def test_one_that_finds_other_hits_or_does_not_compile_is_left_out(self):
        for name, trace in (("blind", "TraceResult trace(Ray ray) { return miss(ray, 1); }\n"), ("broken", "TraceResult trace(Ray ray)\n")):
            self.write(f"mine/{name}/technique.toml", f'name = "{name}"\nsummary = "{name}"\nexact = true\n[parameters]\n')
            self.write(f"mine/{name}/trace.glsl", '#include "api/test_pixel.glsl"\n' + trace)
        exact = ("--techniques", "mine", "trace", *FRAME, "-t", "exact", "-o", "a.exr")
        for _ in range(2):  # the second time as kept
            text = self.ssrlab(*exact, says=["warning: exact leaves broken out: ", "trace.glsl:"])
            self.assertRegex(text, r"warning: exact leaves blind out: [1-9]\d* of \d+ rays differ from those of dda")
            self.assertIn(self.chosen(text)[0], EXACT)
        self.assertEqual(set(self.kept()[0]["left_out"]), {"blind", "broken"})

    def test_a_name_is_needed_elsewhere_and_no_folder_takes_the_word(self):
        needed = "expected a technique's name here, as of the exact ones: dda, hiz"
        spec = self.write("s.toml", SWEEP.replace("[techniques.dda]", "[techniques.exact]"))
        self.refused("run", spec, "-o", "out", code=2, says=["s.toml:8: 'exact' is measured and chosen only by", needed])
        for command in (("export", "exact", "--to", "glsl", "-o", "out"), ("shaders", "exact"), ("check", "exact")):
            self.refused(*command, code=2, says=[needed])
        self.assertFalse(os.path.exists(self.path("out")))
        self.copied("dda", "mine/exact")
        self.refused("--techniques", "mine", "list", code=2, says=["mine/exact: a technique cannot be called 'exact'"])
        self.refused("new-technique", "other/exact", code=2, says=["'exact' cannot be a technique's name"])


if __name__ == "__main__":
    main()
