"""One ray explained: table, JSON and picture; techniques from outside the tree; what is refused."""
import json
import os

from support import Case, main

MANIFEST = """name    = "Three looks"
summary = "Looks at three places along the ray."
limits  = ["point_sampled"]
[parameters]
looks = { default = 3, min = 1, max = 9, doc = "Places." }
"""
TRACE = """#include "api/sampling.glsl"

TraceResult trace(Ray ray)
{
    Contact contact = no_contact();
    int     taken   = 0;
    while (!contact.found && taken < looks)
    {
        ++taken;
        real  t     = real(taken) / real(looks + 1);
        ivec2 pixel = pixel_at(ray, t);
        if (pixel != ray.start_pixel) contact = test_sample(ray, pixel, t);
    }
    if (contact.found) return hit(ray, contact, taken);
    return miss(ray, taken);
}
"""
RAY = ("ray", "builtin:mirror_floor_wall", "--size", "160x90", "--pixel", "80,60", "-p", "max_distance_m=30")


class Test(Case):
    def test_tells_visits_endings_and_truths(self):
        text = self.ssrlab(*RAY, "-t", "dda", "-t", "hiz", says=["Ray of pixel (80, 60)", "screen truth: hit at pixel", "scene truth: visible",
                                                                "dda: hit at pixel", "the hit contract's answer", "opens", "skips"])
        self.assertEqual(text.count("  hit\n"), 2)

    def test_json_and_picture_of_a_technique_from_outside(self):
        self.write("mine/three/technique.toml", MANIFEST)
        self.write("mine/three/trace.glsl", TRACE)
        out = self.ssrlab("--techniques", "mine", *RAY, "-t", "three", "-t", "dda", "-p", "looks=4", "--json", "-o", "ray.png")
        ray = json.loads(out)
        three, dda = ray["techniques"]
        self.assertEqual((three["technique"], dda["technique"]), ("three", "dda"))
        self.assertEqual([round(v["t_in"], 5) for v in three["visits"]], [0.2, 0.4, 0.6, 0.8][:len(three["visits"])])
        self.assertEqual(dda["pixel"], ray["screen_truth"]["pixel"])
        walk = [v["pixel"] for v in ray["walk"]]
        self.assertEqual([v["pixel"] for v in dda["visits"]], walk[:len(dda["visits"])])
        self.assertEqual(dda["visits"][-1]["then"], "hit")
        self.assertEqual((ray["scene_truth"]["class"], ray["scene_truth"]["starts_off_surface"]), ("visible", False))
        self.assertGreater(os.path.getsize(self.path("ray.png")), 20000)
        self.assertEqual(sorted(os.listdir(self.folder)), ["mine", "ray.png"])

    def test_tells_which_source_answers(self):
        by = (*RAY, "-t", "hiz", "-p", "surface=plane_infinite", "-p", "behind=stop", "--sources")
        ray = json.loads(self.ssrlab(*by, "frame,world", "--json"))
        true_m, sources = ray["scene_truth"]["distance_m"], ray["sources"]
        self.assertEqual(sources["answered_by"], "frame")
        frame, world = sources["answers"]
        self.assertEqual((frame["source"], frame["kind"], frame["certain"], frame["right"]), ("frame", "point", True, True))
        self.assertAlmostEqual(frame["distance_m"], true_m, delta=sources["allowed_m"])
        self.assertEqual(world, {"source": "world", "asked": False})
        self.ssrlab(*by, "world", says=["answered by world", "certain, right"])
        self.refused(*by, "wurld", code=2, says=["--sources wurld: unknown source 'wurld': did you mean 'world'?"])

    def test_check_shows_the_techniques_own_steps(self):
        self.ssrlab("check", "hiz", "--case", "one_object_in_the_sky", "--ray", "0:0", says=["level", "then", "hiz: "])

    def test_what_is_refused(self):
        self.refused(*RAY[:-4], "--pixel", "80", "-t", "dda", code=2, says=["--pixel: expected X,Y, got '80'"])
        self.refused(*RAY[:-4], "--pixel", "200,3", "-t", "dda", code=2, says=["outside the image of 160x90"])
        self.refused(*RAY[:-4], "--pixel", "80,2", "-t", "dda", code=2, says=["does not reflect: depth"])
        self.refused(*RAY, "-t", "dda", "-o", "ray.svg", code=2, says=["expected a file that ends in .json or .png"])
        self.refused(*RAY, "-t", "dda", "-t", "linear", "-p", "stepps=3", code=2, says=["stepps"])


if __name__ == "__main__":
    main()
