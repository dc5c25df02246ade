"""A technique outside the source tree, without rebuilding."""
import os

from support import Case, main

MANIFEST = """name    = "Coin toss"
summary = "Looks at one place along the ray."
[parameters]
place = { default = 0.5, min = 0.0, max = 1.0, doc = "Where, as a part of the ray on screen." }
"""
TRACE = """#include "api/sampling.glsl"
TraceResult trace(Ray ray)
{
    ivec2 pixel = pixel_at(ray, real(place));
    Contact contact = test_sample(ray, pixel, real(place));
    if (pixel != ray.start_pixel && contact.found) return hit(ray, contact, 1);
    return miss(ray, 1);
}
"""
OWN_TEST = """#include "api/sampling.glsl"
TraceResult trace(Ray ray)
{
    ivec2 pixel = pixel_at(ray, real(place));
    if (fetch_depth(pixel) > ray.origin.z) return TraceResult(TRACE_HIT, pixel, real(place), 1);
    return miss(ray, 1);
}
"""
SWEEP = """scenes = ["builtin:mirror_floor_wall"]
sizes  = ["64x36"]
[techniques.coin]
place = [0.25, 0.75]
[techniques.dda]
[measure]
min_repeats = 1
max_repeats = 1
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        self.assertLess(len((MANIFEST + TRACE).splitlines()), 25)
        self.manifest = self.write("mine/coin/technique.toml", MANIFEST)
        self.trace = self.write("mine/coin/trace.glsl", TRACE)
        self.spec = self.write("s.toml", SWEEP)

    def test_is_listed_shown_and_rendered(self):
        self.ssrlab("--techniques", "mine", "list", says=["coin", "Looks at one place"])
        self.ssrlab("--techniques", "mine", "show", "coin", says=["place", "0 … 1", "mine/coin"])
        self.ssrlab("list", says=["coin"], SSRLAB_TECHNIQUES=self.path("mine"))
        self.ssrlab("render", "builtin:mirror_floor_wall", "-t", "coin", "-p", "place=0.3", "--techniques", "mine/coin",
                    "--size", "64x36", "-o", "a.png")

    def test_is_swept_and_recorded(self):
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 3)
        self.assertEqual(sorted(row["place"] for row in rows if row["technique"] == "coin"), ["0.25", "0.75"])
        coin = next(row for row in rows if row["technique"] == "coin")
        self.assertLessEqual(float(coin["fetches_mean"]), 1)
        self.assertNotEqual(coin["screen_same_pixel"], "")

    def test_says_in_its_row_what_its_hit_test_ignores(self):
        self.write("mine/coin/technique.toml", MANIFEST.replace("summary", 'ignores = ["behind", "surface"]\nsummary', 1))
        self.ssrlab("--techniques", "mine", "show", "coin", says=["its own hit test ignores: behind, surface"])
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine")
        self.assertEqual({row["technique"]: row["technique_ignores"] for row in self.rows()}, {"coin": "behind surface", "dda": ""})

    def test_warns_of_an_own_hit_test_of_which_nothing_is_said(self):
        self.write("mine/coin/trace.glsl", OWN_TEST)
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine", says=["warning: mine/coin/technique.toml: expected 'ignores'"])
        self.assertEqual({row["technique"]: row["technique_ignores"] for row in self.rows()}, {"coin": "unknown", "dda": ""})

    def shader_refused(self, text, says, never=()):
        self.write("mine/coin/trace.glsl", text)
        out = self.refused("render", "builtin:mirror_floor_wall", "-t", "coin", "--techniques", "mine", "--size", "64x36", "-o", "a.png",
                           code=2, says=says)
        for secret in never:
            self.assertNotIn(secret, out)
        return out

    def test_mistakes_in_its_shader_are_said_of_its_file(self):
        for text, says in (
                (TRACE.replace("ivec2 pixel = pixel_at", "ivec2 pixel = pixle_at").replace("return miss(ray, 1)", "return mis(ray, 1)"),
                 ["mine/coin/trace.glsl:4: 'pixle_at'", "mine/coin/trace.glsl:7: 'mis'"]),
                (TRACE.replace("trace(Ray", "trace_it(Ray"), ["ssrlab: mine/coin/trace.glsl:8: trace.glsl defines no TraceResult trace(Ray)"]),
                (TRACE.replace("    return miss", "    fetch_cell(pixel, 3);\n    return miss", 1),
                 ["'fetch_cell' : no matching overloaded function found", "(write structures = [\"depth_pyramid\"] in technique.toml)"]),
                (TRACE.split("\n", 1)[1], ["mine/coin/trace.glsl:3: 'pixel_at'", '(write #include "api/sampling.glsl")']),
                ("// main()\nvoid main() {}\n" + TRACE, ["mine/coin/trace.glsl:2: 'main' is reserved"]),
                (TRACE.rstrip().removesuffix("}"), ["mine/coin/trace.glsl:3: this '{' is never closed"]),
                ("// { in a comment\n" + TRACE + "}\n", ["mine/coin/trace.glsl:10: "])):
            with self.subTest(says=says):
                self.shader_refused(text, says, never=["store_result"])

    def test_a_file_is_included_once(self):
        self.write("mine/coin/half.glsl", "const int taken = 1;\n")
        twice = '#include "half.glsl"\n#include "half.glsl"\n' + TRACE.replace("ray, 1)", "ray, taken)")
        self.write("mine/coin/trace.glsl", twice)
        self.ssrlab("render", "builtin:mirror_floor_wall", "-t", "coin", "--techniques", "mine", "--size", "64x36", "-o", "a.png")
        self.shader_refused(twice.replace("ivec2 pixel = pixel_at", "ivec2 pixel = pixle_at"), ["mine/coin/trace.glsl:6: 'pixle_at'"])

    def test_a_variant_stands_for_its_file_where_its_macro_is_defined(self):
        self.write("mine/coin/look.glsl", "const real look_t = real(0.5);\n")
        self.write("mine/coin/look.pixel_planes.glsl", "const real look_t = real(nowhere);\n")
        self.write("mine/coin/trace.glsl", '#include "look.glsl"\n' + TRACE.replace("real(place)", "look_t"))
        render = ("render", "builtin:mirror_floor_wall", "-t", "coin", "--techniques", "mine", "--size", "64x36", "-o", "a.png", "-p")
        self.ssrlab(*render, "surface=box")
        self.refused(*render, "surface=plane", code=2, says=["mine/coin/look.pixel_planes.glsl:1: 'nowhere'"])
        self.write("mine/coin/look.layered.glsl", "")
        self.refused(*render, "surface=plane", "-p", "layers=2", code=2, says=["mine/coin/look.layered.glsl or ", "look.pixel_planes.glsl"])

    def test_check_ends_with_its_failure(self):
        self.write("mine/coin/trace.glsl", "TraceResult trace(Ray ray)\n{\n    return miss(ray, 1);\n}\n")
        out = self.ssrlab("--techniques", "mine", "check", "coin", "--quick", "--case", "one_object_in_the_sky", code=1)
        self.assertRegex(out.splitlines()[-1], r"^the check fails: \d+ findings?, each above$")

    def test_includes_come_from_its_folder_and_the_project_alone(self):
        secret = self.write("mine/secret.glsl", "top secret text\n")
        self.write("mine/coin/link.glsl", "")
        os.remove(self.path("mine/coin/link.glsl"))
        os.symlink(secret, self.path("mine/coin/link.glsl"))
        for name in (secret, "../secret.glsl", "sub/../../secret.glsl", "link.glsl", "none.glsl"):
            for brackets in ('"{}"', "<{}>"):
                self.shader_refused(f"\n#include {brackets.format(name)}\n" + TRACE, ["mine/coin/trace.glsl:2: '#include'", name],
                                    never=["secret text", "top"])
        self.shader_refused('#include "api/hash.glsl"\n#include "loop.glsl"\n' + TRACE, ["mine/coin/trace.glsl:2", "loop.glsl"])

    def test_does_not_stand_for_a_shader_of_the_project(self):
        self.write("mine/coin/api/slab.glsl", "")
        self.shader_refused(TRACE, ["api/slab.glsl", "mine/coin/api/slab.glsl"])

    def test_helper_beside_it_is_found_and_part_of_what_is_compiled(self):
        self.write("mine/coin/parts/half.glsl", "const int taken = 1;\n")
        self.write("mine/coin/trace.glsl", '#include "parts/half.glsl"\n' + TRACE.replace("ray, 1)", "ray, taken)"))
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine")
        self.assertEqual({row["steps_mean"] for row in self.rows() if row["technique"] == "coin"}, {"1"})
        self.write("mine/coin/parts/half.glsl", "const int taken = 9;\n")
        self.refused("run", self.spec, "-o", "out", "--resume", "--techniques", "mine", code=2, says=["cannot be resumed", "technique coin"])
        self.ssrlab("run", self.spec, "-o", "other", "--techniques", "mine")
        self.assertGreater(max(float(row["steps_mean"]) for row in self.rows("other") if row["technique"] == "coin"), 1)
        self.write("mine/coin/parts/half.glsl", "const int taken = oops;\n")
        self.shader_refused('\n#include "parts/half.glsl"\n' + TRACE, ["mine/coin/parts/half.glsl:1: 'oops'"])

    def test_parameter_with_the_name_of_a_type_is_refused(self):
        for name in ("vec3", "ivec2", "mat4x3", "sampler2D", "uimage2DArray", "dvec4", "uint", "precise", "real3"):
            self.write("mine/coin/technique.toml", MANIFEST.replace("place =", name + " ="))
            self.refused("list", "--techniques", "mine", code=2, says=["mine/coin/technique.toml:4", f"'{name}'"])

    def test_error_in_its_shader_is_a_failed_row(self):
        self.write("mine/coin/trace.glsl", TRACE.replace("ivec2 pixel = pixel_at", "ivec2 pixel = pixle_at"))
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine", code=1)
        outcome = {(row["technique"], row["outcome"], "coin/trace.glsl:4" in row["message"]) for row in self.rows()}
        self.assertEqual(outcome, {("coin", "failed", True), ("dda", "ok", False)})

    def test_error_in_its_manifest_names_file_and_line(self):
        self.write("mine/coin/technique.toml", MANIFEST.replace("default = 0.5", "default = 2.0"))
        self.refused("list", "--techniques", "mine", code=2, says=["mine/coin/technique.toml:4", "place"])


if __name__ == "__main__":
    main()
