"""Commands, their words and exit codes; an installed program."""
import json
import os
import re
import signal
import subprocess

from support import Case, PROGRAM, SOURCE, SWEEP, main

BUILD = os.path.dirname(os.path.dirname(PROGRAM))


class Test(Case):
    def test_a_misspelt_command_is_answered(self):
        self.refused("rendr", code=2, says=["unknown command 'rendr': did you mean 'render'?"])
        self.refused("--quiet", "--device", "0", "--passes", "serial", "chek", code=2, says=["did you mean 'check'?"])
        self.ssrlab(code=2, says=["subcommand is required"])
        self.ssrlab("render", "--sise", "3x3", code=2)
        self.ssrlab("render", "builtin:stairs", code=2)

    def test_settings_are_shown(self):
        self.ssrlab("show", "thickness_m", says=["[trace]", "default 0.1", "0 … 1000000"])
        self.ssrlab("show", "gloss", says=["[passes]", "|"])
        self.refused("show", "thicknes_m", code=2, says=["did you mean 'thickness_m'?"])
        self.assertNotIn("known:", self.refused("show", "hzi", code=2, says=["did you mean 'hiz'?"]), "a long list hides the suggestion")
        self.assertIn("known: dda,", self.refused("show", "nothing_of_this", code=2, says=["unknown technique, surface model, setting or part"]))

    def test_json_says_what_list_and_show_say(self):
        everything = json.loads(self.ssrlab("list", "--json"))
        hiz = next(one for one in everything["techniques"] if one["name"] == "hiz")
        self.assertEqual(json.loads(self.ssrlab("show", "hiz", "--json")), hiz)
        self.assertTrue(hiz["exact"])
        self.assertIn("max_steps", [one["name"] for one in hiz["parameters"]])
        self.assertIn("interior", [one["name"] for one in everything["scenes"]])
        thickness = next(one for one in everything["settings"] if one["name"] == "thickness_m")
        self.assertEqual((thickness["table"], thickness["default"]), ("trace", "0.1"))

    def test_version_names_the_commit_that_was_built(self):
        self.assertRegex(self.ssrlab("--version"), r"^\d+\.\d+\.\d+ \(([0-9a-f]{40}( with changes)?|not known)\)$")

    def test_a_picture_knows_its_command(self):
        self.ssrlab("render", "builtin:stairs", "--size", "64x36", "-t", "linear", "-p", "steps=9", "-o", "a.exr")
        command = re.search(rb"ssrlab (render builtin:stairs[ -~]*steps=9)", self.bytes("a.exr"))[1].decode()
        self.ssrlab(*command.split(), "-o", "b.exr")
        self.assertEqual(self.bytes("a.exr"), self.bytes("b.exr"))

    def test_nothing_that_reflects_is_a_warning_unless_quiet(self):
        render = ("render", "builtin:matte", "--size", "64x36", "-t", "hiz", "-o", "a.png")
        self.ssrlab(*render, says=["warning: nothing reflects"])
        self.assertNotIn("warning", self.ssrlab("--quiet", *render))
        self.assertNotIn("warning", self.ssrlab("render", "builtin:stairs", *render[2:]))

    def test_samples_that_meet_nothing_are_a_warning(self):
        stairs = ("builtin:stairs", "--size", "64x36", "-t", "linear")
        said = r"warning: linear: 0 of \d+ rays hit\. .* max_distance_m = 1000000000 .*: -p max_distance_m=\d+ is about the scene's size"
        for command in (("trace", *stairs, "-o", "a.exr"), ("render", *stairs, "-o", "a.png"), ("plan", *stairs, "--repeats", "1")):
            text = self.ssrlab(*command)
            self.assertRegex(text, said)
            self.assertNotIn("warning", self.ssrlab(*command, "-p", re.search(r"max_distance_m=\d+", text)[0]))
        self.assertNotIn("warning", self.ssrlab("--quiet", "trace", *stairs, "-o", "a.exr"))
        self.assertNotIn("warning", self.ssrlab("trace", *stairs[:-1], "dda", "-p", "max_distance_m=0.001", "-o", "a.exr"))
        self.ssrlab("trace", *stairs, "-p", "surface=box", "-p", "thickness_m=0", "-p", "max_distance_m=9", "-o", "a.exr", says=["A sample needs a thickness"])

    def test_endings_are_refused_before_the_work(self):
        for command in (("render", "-t", "hiz"), ("trace", "-t", "hiz"), ("gbuffer",)):
            self.refused(command[0], "builtin:stairs", *command[1:], "-o", "a.gif", code=2, says=["-o a.gif: expected a file that ends in"])
        self.refused("trace", "builtin:stairs", "-t", "hiz", "-o", "a.png", code=2, says=["ends in .exr"])

    def test_a_sweep_that_is_stopped_ends_with_130_and_a_quiet_one_says_little(self):
        process = self.start("run", self.write("s.toml", SWEEP), "-o", "out")
        self.assertEqual(self.stop_in_the_middle(process, signal.SIGINT), 130)
        text = self.ssrlab("--quiet", "run", "s.toml", "-o", "out", "--resume")
        self.assertEqual(len(text.splitlines()), 1, text)

    def test_the_installed_program_uses_its_own_data(self):
        subprocess.run(["cmake", "--install", BUILD, "--prefix", self.path("there")], check=True, stdout=subprocess.DEVNULL)
        program = self.path("there/bin/ssrlab")
        shown = subprocess.run([program, "show", "hiz"], check=True, capture_output=True, text=True, cwd="/").stdout
        self.assertIn(f"folder: {self.path('there/share/ssrlab/techniques/hiz')}", shown)
        command = [program, "render", "builtin:stairs", "-t", "hiz", "--size", "64x36", "-o", self.path("a.png")]
        subprocess.run(command, check=True, capture_output=True, cwd="/")

    def test_an_option_takes_one_word(self):
        self.ssrlab("new-technique", "mine/first")
        self.ssrlab("new-technique", "other/second")
        self.ssrlab("show", "--techniques", "mine", "first", says=["Looks at places"])
        self.ssrlab("list", "--techniques", "mine", "--techniques", "other", says=["first", "second"])
        self.ssrlab("trace", "-p", "stride_px=4", "builtin:stairs", "-t", "first", "--techniques", "mine", "-p", "max_steps=9", "--size", "16x9", "-o", "a.exr")
        self.ssrlab("--quiet", "export", "--techniques", "mine", "--keep", "max_steps", "first", "--to", "glsl", "--size", "64x36", "-o", "out")
        self.ssrlab("ray", "--pixel", "32,30", "-t", "dda", "builtin:stairs", "--size", "64x36")

    def test_numbers_are_refused_as_those_of_parameters(self):
        stairs = ("builtin:stairs", "-o", "a.png")
        for words, fault in ((("export", "dda", "--near", "-1"), "--near: expected a number above 0, got '-1'"),
                             (("export", "dda", "--near", "0.1m"), "--near: expected a number above 0, got '0.1m'"),
                             (("export", "dda", "--near", "inf"), "--near: expected a number above 0, got 'inf'"),
                             (("fit", "builtin:stairs", "--budget-ms", "0.5ms"), "--budget-ms: expected a number above 0, got '0.5ms'"),
                             (("fit", "builtin:stairs", "--budget-fetches", "0"), "--budget-fetches: expected a number above 0, got '0'"),
                             (("fit", "builtin:stairs", "--budget-instructions", "many"), "--budget-instructions: expected a number above 0, got 'many'"),
                             (("fit", "builtin:stairs", "--frame", "1.5"), "--frame: expected an integer in [0, 1000000], got '1.5'"),
                             (("render", *stairs, "--frame", "-1"), "--frame: expected an integer in [0, 1000000], got '-1'"),
                             (("render", *stairs, "--frames", "0"), "--frames: expected an integer in [1, 1000000], got '0'"),
                             (("render", *stairs, "--jitter", "x"), "--jitter: expected an integer in [0, "),
                             (("render", *stairs, "--samples", "99999999999"), "--samples: expected an integer in [1, "),
                             (("render", *stairs, "--exposure", "2ev"), "--exposure: expected a number, got '2ev'"),
                             (("judge", "f.exr", "h.exr", "--min-f1", "90%"), "--min-f1: expected a number in [0, 1], got '90%'"),
                             (("judge", "f.exr", "h.exr", "--frame", "x"), "--frame: expected an integer in [0, "),
                             (("plan", "builtin:stairs", "--repeats", "0"), "--repeats: expected an integer in [1, 2147483647], got '0'"),
                             (("plot", "out", "--bandwidth-gbps", "fast"), "--bandwidth-gbps: expected a number above 0, got 'fast'")):
            with self.subTest(words=words):
                self.ssrlab(*words, code=2, says=[fault])

    def test_a_new_technique_passes_the_check(self):
        self.ssrlab("new-technique", "mine/first", says=["ssrlab --techniques mine/first check first"])
        self.ssrlab("--techniques", "mine/first", "check", "first", "--quick", says=["rows hold what the technique claims"])
        case = ("--techniques", "mine/first", "check", "first", "--quick", "--case", "one_object_in_the_sky")
        self.assertNotEqual(re.search(r"first .*", self.ssrlab(*case))[0], re.search(r"first .*", self.ssrlab(*case, "-p", "stride_px=40"))[0])
        self.refused(*case, "-p", "stride=40", code=2, says=["stride"])
        self.refused("new-technique", "mine/first", code=2, says=["mine/first: already there"])
        for name, fault in (("a-b", "expected letters, digits and underscores"), ("2nd", "expected a letter first"),
                            ("flat", "it is a word of GLSL"), ("vec3", "it is a word of GLSL"), ("trace", "it is a name of the shader functions"),
                            ("gl_x", "GLSL reserves 'gl_' and '__'")):
            self.refused("new-technique", f"mine/{name}", code=2, says=[f"'{name}' cannot be a technique's name: {fault}"])

    def test_completion_knows_commands_techniques_and_scenes(self):
        def completed(*words):
            script = f"""source {SOURCE}/framework/app/completion.bash
                COMP_WORDS=({PROGRAM} {' '.join(repr(word) for word in words)}); COMP_CWORD={len(words)}
                _ssrlab {PROGRAM}; printf '%s\\n' "${{COMPREPLY[@]}}" """
            return subprocess.run(["bash", "-c", script], check=True, capture_output=True, text=True, cwd=self.folder).stdout.split()

        self.assertEqual(completed("ren"), ["render"])
        self.assertEqual(completed("render", "thin"), ["thin_yard"])
        self.assertEqual(completed("render", "thin_yard", "-t", "quad"), ["quadtree"])
        self.assertEqual(completed("render", "thin_yard", "-t", "exa"), ["exact"])
        self.assertEqual(completed("export", "exa"), [])
        self.assertEqual(completed("render", "thin_yard", "--siz"), ["--size"])


if __name__ == "__main__":
    main()
