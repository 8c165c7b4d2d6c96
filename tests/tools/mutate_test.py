#!/usr/bin/env python3
"""tools/mutate on a project of a few lines: what its test asks is killed, what it does not ask survives, a loop that does not end counts
as killed, comments and texts are no code, and neither the project nor the copy is left changed.
Usage: tests/tools/mutate_test.py SOURCE_FOLDER"""
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOM = """/* a + b in a comment, and "1 * 2". */
#define TWICE(x) ((x) + (x))
static const char *const said = "3 - 4 /* 5 */";

int area(int width, int height)
{
    return width * height; // 6 + 7
}

int count_down(int from)
{
    volatile float left = (float)from;
    while (left > 0)
        left -= 1;
    return (int)left;
}

int not_asked(int a)
{
    return said[0] == '3' ? a + TWICE(a) : 0;
}
"""
TEST = """int area(int, int);
int count_down(int);
int main(void)
{
    return area(3, 5) != 15 || area(2, 0) != 0 || count_down(4) != 0;
}
"""
BUILD = """cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES C)
enable_testing()
add_executable(tiny_test test.c src/room/room.c)
add_test(NAME unit.tiny COMMAND tiny_test)
"""


def check(good, what):
    if not good:
        sys.exit(f"mutate_test: {what}")


def write_project(root):
    (root / "src/room").mkdir(parents=True)
    (root / "src/room/room.c").write_text(ROOM)
    (root / "test.c").write_text(TEST)
    (root / "CMakeLists.txt").write_text(BUILD)
    (root / "rooms.txt").write_text("room: ^unit.tiny$  # the only one\n")


def main():
    tool = pathlib.Path(sys.argv[1]) / "tools/mutate"
    if not shutil.which("ninja"):
        print("ninja is not installed")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        root, work = pathlib.Path(folder) / "tiny", pathlib.Path(folder) / "work"
        write_project(root)
        command = [tool, "room", "--root", root, "--table", root / "rooms.txt", "--work", work, "--sample", "100", "--limit", "2"]

        def run(*more):
            done = subprocess.run([*command, *more], capture_output=True, text=True, check=False)
            check(done.returncode == 0, f"{more}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
            return done.stdout

        listed = run("--list")
        check(listed == run("--list"), "the same seed lists other mutants")
        check(listed != run("--list", "--seed", "2"), "another seed lists the same ones in the same order")
        check(all(int(line.split(":")[1]) >= 5 for line in listed.splitlines()), f"a comment, a macro or a text is taken for code:\n{listed}")

        # Stopped in the middle, the copy is what the project is.
        stopped = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        check("green" in stopped.stdout.readline(), "the first line does not say that the test is green")
        time.sleep(0.3)
        stopped.send_signal(signal.SIGTERM)
        stopped.communicate()
        check((work / "tree/src/room/room.c").read_text() == ROOM, "a run that was stopped leaves a mutant in the copy")

        run()
        rows = [json.loads(line) for line in (work / "results.jsonl").read_text().splitlines()]
        said = {row["mutant"]: row["outcome"] for row in rows}
        check(len(said) == len(rows) == len(listed.splitlines()), "a mutant was tried twice, or not at all")
        for mutant, outcome in said.items():
            line = int(mutant.split(":")[1])
            wanted = "survived" if line >= 20 else "killed"
            check(outcome == wanted, f"{outcome} instead of {wanted}: {mutant}")
        check(any("area" not in m and ": sign: -= -> +=" in m for m in said), f"no loop without end among {list(said)}")
        check(sum(outcome == "survived" for outcome in said.values()) >= 3, "what is not asked is not found")
        check((root / "src/room/room.c").read_text() == ROOM, "the project was changed")
        check((work / "tree/src/room/room.c").read_text() == ROOM, "the copy was left changed")
        before = len(rows)
        run()
        check(len((work / "results.jsonl").read_text().splitlines()) == before, "what was tried is tried again")
        check("| `room` |" in run("--summary"), "no summary")


if __name__ == "__main__":
    main()
