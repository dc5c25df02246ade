"""The table of stress tests that were run: results/reference/stress.md."""
import datetime
import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
HEAD = "# Stress tests\nEach row is one call.\n\n| day | commit | command | minutes | result |\n|---|---|---|--:|---|\n"


def add_row(path, command, minutes, result):
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty"], capture_output=True, text=True).stdout.strip()
    new = not os.path.exists(path)
    with open(path, "a", encoding="utf-8") as file:
        file.write((HEAD if new else "") + f"| {datetime.date.today()} | {commit} | `{command}` | {minutes:.1f} | {result} |\n")
