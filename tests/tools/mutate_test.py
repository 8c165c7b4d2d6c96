#!/usr/bin/env python3
"""tools/mutate on a project of a few lines: what its test asks is killed, what it does not ask survives, what no test calls or reads meets
none, a loop that does not end counts as killed, what does not compile is no mutant and spoils no other, comments and texts are no code, and
neither the project nor the copy's shaders are left changed.
Usage: tests/tools/mutate_test.py SOURCE_FOLDER"""
import json
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile

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

int distance(const char *to, const char *from)
{
    return (int)(to - from);
}

int not_asked(int a)
{
    return said[0] == '3' ? a + TWICE(a) : 0;
}

int not_called(int a)
{
    return a - 2 > 0;
}
"""
EQUIVALENT = "src/room/room.c: sign: + -> - | return said[0] == '3' ? a «+» TWICE(a) : 0; | nobody asks\n"
# Lines of the room from which on nothing is asked, and nothing called.
NOT_ASKED, NOT_CALLED = (1 + ROOM[:ROOM.index(f"int not_{what}")].count("\n") for what in ("asked", "called"))
SHADER = """float shade(float x, float y)
{
    return x - y;
}
"""
TEST = """#include <stdio.h>
#include <stdlib.h>
#include <string.h>
int area(int, int);
int count_down(int);
int distance(const char *, const char *);
int not_asked(int);
static int is_shader_right(void)
{
    char path[1000], text[1000] = {0};
    snprintf(path, sizeof path, "%s/room/read.glsl", getenv("LIMNER_SHADER_DIR"));
    FILE *file = fopen(path, "r");
    size_t size = file ? fread(text, 1, sizeof text - 1, file) : 0;
    return file && fclose(file) == 0 && size && strstr(text, "return x - y;") != NULL;
}
static const char text[] = "ab";
int main(void)
{
    static const char text[] = "ab";
    not_asked(1);
    return area(3, 5) != 15 || area(2, 0) != 0 || count_down(4) != 0 || distance(text + 2, text) != 2 || !is_shader_right();
}
"""
SHADERS = ("read.glsl", "unread.glsl")
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
    for name in SHADERS:
        (root / "src/room" / name).write_text(SHADER)
    (root / "tools/mutation").mkdir(parents=True)
    (root / "tools/mutation/equivalent.txt").write_text(EQUIVALENT)
    (root / "test.c").write_text(TEST)
    (root / "CMakeLists.txt").write_text(BUILD)
    (root / "rooms.txt").write_text("room: ^unit.tiny$  # the only one\n")


def line_of(mutant):
    return int(mutant.split(":")[1])


def wanted_of(mutant):
    if "to - from" in ROOM.splitlines()[line_of(mutant) - 1] and ": sign:" in mutant and ".c:" in mutant:
        return "invalid"  # two pointers have no sum
    if ".c:" in mutant and ": sign: + -> -" in mutant and line_of(mutant) == NOT_ASKED + 2:
        return "equivalent"
    if "unread" in mutant or ".c:" in mutant and line_of(mutant) >= NOT_ASKED:
        return "survived"
    return "killed"


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
        check(all(int(line.split(":")[1]) >= 5 for line in listed.splitlines() if ".c:" in line), f"a comment, a macro or a text is taken for code:\n{listed}")

        # Stopped in the middle, it goes on where it was.
        stopped = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        check("src/room" in stopped.stdout.readline(), "the first line is about no mutant")
        stopped.send_signal(signal.SIGTERM)
        stopped.communicate()
        check((root / "src/room/room.c").read_text() == ROOM, "a run that was stopped leaves a mutant in the project")

        run()
        rows = [json.loads(line) for line in (work / "results.jsonl").read_text().splitlines()]
        said = {row["mutant"]: row for row in rows}
        check(len(said) == len(rows) == len(listed.splitlines()), "a mutant was tried twice, or not at all")
        for mutant, row in said.items():
            wanted = wanted_of(mutant)
            check(row["outcome"] == wanted, f"{row['outcome']} instead of {wanted}: {mutant}")
            met = not ("unread" in mutant or ".c:" in mutant and line_of(mutant) >= NOT_CALLED)
            check(row["outcome"] in ("invalid", "equivalent") or bool(row["tests"]) == met, f"met {row['tests']}: {mutant}")
        check(any("area" not in m and ": sign: -= -> +=" in m for m in said), f"no loop without end among {list(said)}")
        outcomes = [row["outcome"] for row in rows]
        check(outcomes.count("survived") >= 6 and outcomes.count("invalid") == 1, f"other outcomes than there are: {outcomes}")
        check((root / "src/room/room.c").read_text() == ROOM, "the project was changed")
        check(all((work / "tree/src/room" / name).read_text() == SHADER for name in SHADERS), "the copy was left changed")
        before = len(rows)
        run()
        check(len((work / "results.jsonl").read_text().splitlines()) == before, "what was tried is tried again")
        check("| `room` |" in run("--summary"), "no summary")


if __name__ == "__main__":
    main()
