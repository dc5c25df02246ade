"""./experiments/reproduce goes on after a sweep that failed, and says what is missing. The program is a stand-in here."""
import os
import subprocess
from pathlib import Path

from support import SOURCE, Case, main

# run: the first try of `steps` fails, and every try of `compare` does.
STAND_IN = """#!/bin/bash
[[ $1 == --quiet ]] && shift
case $1 in
    run)
        mkdir -p "$4"
        touch "$4/results.csv"
        echo "$@" >> runs.txt
        [[ $2 == */compare.toml && ! -e mended ]] && exit 1
        [[ $2 == */steps.toml && $5 != --resume ]] && exit 1
        exit 0 ;;
    plot) sleep 0.01; touch "$2/report.html"; printf '## Verdict\\n- good\\n## Ranking\\n' > "$2/report.md" ;;
esac
"""


class Test(Case):
    def executable(self, name, text):
        os.chmod(self.write(name, text), 0o755)

    def reproduce(self):
        return subprocess.run([self.path("experiments/reproduce"), "--no-install"], capture_output=True, text=True,
                              env=os.environ | {"PATH": f"{self.path('bin')}:{os.environ['PATH']}"})

    def runs_of(self, name):
        return [line for line in Path(self.path("runs.txt")).read_text().splitlines() if f"/{name}.toml" in line]

    def test_goes_on_after_a_failure(self):
        for name in ("experiments/reproduce", "experiments/steps.sh"):
            self.executable(name, Path(SOURCE, name).read_text())
        self.executable("bin/cmake", "#!/bin/sh\n")
        self.executable("experiments/prepare_scenes", "#!/bin/sh\n")
        self.executable("build/bin/ssrlab", STAND_IN)
        done = self.reproduce()
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        missing = done.stdout[done.stdout.index("Not complete:"):].splitlines()[1:]
        self.assertEqual(len(missing), 1, missing)
        self.assertIn("compare: exit code 1", missing[0])
        self.assertIn("run experiments/compare.toml -o results/compare --resume", missing[0])
        self.assertEqual([len(self.runs_of(name)) for name in ("steps", "compare", "resolution")], [2, 2, 1])
        for name in ("steps", "compare", "resolution", "figures/s4"):
            self.assertTrue(os.path.exists(self.path(f"results/{name}/report.html")), name)
        self.write("mended", "")
        done = self.reproduce()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertNotIn("Not complete", done.stdout)


if __name__ == "__main__":
    main()
