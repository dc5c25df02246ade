"""A reprojection strategy outside the source tree, without rebuilding."""
from support import Case, main

MANIFEST = """name    = "Fixed shift"
summary = "Every reflection was so many pixels farther right."
[parameters]
right_px = { default = 2.0, min = -64.0, max = 64.0, doc = "How far." }
"""
SHADER = """Reprojected reproject(Reflection now)
{
    return seen_at(now.incidence_px + vec2(right_px, 0));
}
"""
SEQUENCE = ["render", "builtin:moving_boxes", "-t", "hiz", "--view", "truck", "--frames", "2", "--size", "64x36"]


class Test(Case):
    def setUp(self):
        super().setUp()
        self.write("mine/fixed_shift/reprojection.toml", MANIFEST)
        self.shader = self.write("mine/fixed_shift/reproject.glsl", SHADER)

    def picture(self, *parameters):
        self.ssrlab("--techniques", "mine", *SEQUENCE, *[word for pair in parameters for word in ("-p", pair)], "-o", "out.exr")
        return self.bytes("out_0001.exr")

    def test_is_selected_with_its_parameters(self):
        first, again = self.picture("reprojection=fixed_shift"), self.picture("reprojection=fixed_shift")
        self.assertEqual(first, again)
        self.assertNotEqual(first, self.picture("reprojection=fixed_shift", "fixed_shift.right_px=9"))
        self.ssrlab("--techniques", "mine", "show", "reprojection", says=["fixed_shift", "plane", "smallest"])
        self.ssrlab("--techniques", "mine", "show", "fixed_shift.right_px", says=["How far.", "-64 … 64"])

    def test_is_swept(self):
        spec = self.write("s.toml", """scenes = ["builtin:moving_boxes"]
sizes  = ["64x36"]
[passes]
reprojection = ["fixed_shift", "plane"]
"fixed_shift.right_px" = [1.0, 3.0]
[techniques.hiz]
[measure]
min_repeats = 1
max_repeats = 1
""")
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 4)
        self.assertEqual({(row["reprojection"], row["fixed_shift.right_px"]) for row in rows},
                         {("fixed_shift", "1"), ("fixed_shift", "3"), ("plane", "1"), ("plane", "3")})

    def test_is_found_by_the_environment(self):
        self.environment["SSRLAB_TECHNIQUES"] = self.path("mine")
        self.ssrlab("show", "reprojection", says=["fixed_shift"])

    def test_mistakes_name_file_and_line(self):
        self.write("mine/fixed_shift/reproject.glsl", SHADER.replace("right_px", "left_px"))
        self.refused("--techniques", "mine", *SEQUENCE, "-p", "reprojection=fixed_shift", "-o", "a.png", code=2,
                     says=["mine/fixed_shift/reproject.glsl:3", "left_px"])
        self.write("mine/fixed_shift/reprojection.toml", MANIFEST.replace("summary", "sumary"))
        self.refused("--techniques", "mine", "show", "reprojection", code=2, says=["reprojection.toml:2", "sumary"])

    def test_unknown_strategy_is_refused(self):
        self.refused(*SEQUENCE, "-p", "reprojection=mirror", "-o", "a.png", code=2, says=["reprojection", "plane", "'mirror'"])


if __name__ == "__main__":
    main()
