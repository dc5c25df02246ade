"""A library sees its own headers and those of what it links; an include of anything else does not compile."""
import json
import os
import shlex
import subprocess
import unittest

from support import HANGS_S, PROGRAM, read

BUILD = os.path.dirname(os.path.dirname(PROGRAM))

# Of each library a header that it may include, and some that it may not.
WALLS = {
    "core": ("core/view.h", ["scene/scene.h", "gpu/gpu.h", "trace/lab.h"]),
    "scene": ("core/view.h", ["gpu/gpu.h", "trace/lab.h", "truth/scene_bvh.h"]),
    "gpu": ("gpu/gpu.h", ["scene/scene.h", "trace/lab.h"]),
    "trace": ("gpu/gpu.h", ["scene/scene.h", "frame/frame.h", "compare/measures.h"]),
    "export": ("trace/lab.h", ["scene/scene.h", "frame/frame.h", "check/judge.h", "harness/experiment.h"]),
    "frame": ("trace/lab.h", ["truth/scene_bvh.h", "compare/measures.h", "harness/experiment.h"]),
    "truth": ("scene/scene.h", ["gpu/gpu.h", "trace/lab.h", "compare/measures.h"]),
    "compare": ("core/trace_image.h", ["truth/scene_truth.h", "scene/scene.h", "gpu/gpu.h"]),
    "harness": ("frame/stage.h", ["check/judge.h", "viewer/viewer.h", "app/commands.h"]),
    "check": ("trace/lab.h", ["viewer/viewer.h", "app/commands.h"]),
    "viewer": ("harness/choice.h", ["app/commands.h", "check/judge.h"]),
    "app": ("viewer/viewer.h", []),
}


class Test(unittest.TestCase):
    def preprocess(self, command, header):
        """Whether a source of the library that includes this header gets past the preprocessor."""
        return subprocess.run([*command, "-E", "-x", "c++", "-", "-o", os.devnull], input=f'#include "{header}"\n', text=True,
                              capture_output=True, cwd=BUILD, timeout=HANGS_S)

    def test_each_library_sees_what_it_links_and_nothing_else(self):
        entries = json.loads(read(BUILD, "compile_commands.json"))
        for library, (allowed, forbidden) in WALLS.items():
            words = next(shlex.split(entry["command"]) for entry in entries if f"/framework/{library}/" in entry["file"])
            words = words[1:] if words[0].endswith("ccache") else words
            command = [words[0], *(word for word in words[1:] if word.startswith(("-I", "-D", "-std")))]
            command += [part for i, word in enumerate(words) if word == "-isystem" for part in words[i:i + 2]]
            done = self.preprocess(command, allowed)
            self.assertEqual(done.returncode, 0, f"{library} may include {allowed}: {done.stderr}")
            for header in forbidden:
                self.assertTrue(os.path.exists(os.path.join(BUILD, "include", header.split("/")[0], header)), header)
                done = self.preprocess(command, header)
                self.assertNotEqual(done.returncode, 0, f"{library} includes {header}, and nothing stops it")
                self.assertIn(header, done.stderr)


if __name__ == "__main__":
    unittest.main()
