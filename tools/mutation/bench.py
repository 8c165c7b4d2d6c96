"""Where mutants are built and tested: a copy of the tree, a build folder of its own, and the tests that name the room."""
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

import mutants

# How much longer than the right program a test may take before it counts as one that hangs: times, and seconds besides.
TIMES_SLOWER, SECONDS_MORE = 6, 20
MEMORY_MOST = 12 << 30
# A test that says so is red: what is left of it need not run.
RED = re.compile(rb"^(FAIL |\[  FAILED  \])", re.MULTILINE)
# GLSL that does not compile is no program.
NO_PROGRAM = re.compile(rb"src/\S+\.(?:glsl|frag|vert|comp):\d+[(:].*error")
CONFIGURE = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=", "-DCMAKE_C_FLAGS=-O1", "-DLIMNER_VIEWER=OFF", "-DLIMNER_INSTALL=OFF", "-DLIMNER_STATIC=OFF"]


def read_table(path):
    """Rows `room: expression expression ...`, each for names of tests as `ctest -R` takes them, in the order in which they run."""
    table = {}
    for line in pathlib.Path(path).read_text().splitlines():
        line = line.partition("#")[0].strip()
        if line:
            room, _, expressions = line.partition(":")
            table[room.strip()] = expressions.split()
    return table


def copy_tree(root, work):
    """The tree's files as they are now, below `work`: what git knows, or everything where git does not know the folder."""
    tree = work / "tree"
    tree.mkdir(parents=True, exist_ok=True)
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=root, capture_output=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        names = {n for n in listed.stdout.decode().split("\0") if n and (root / n).is_file()}
    else:
        names = {p.relative_to(root).as_posix() for p in root.rglob("*") if p.is_file() and work not in p.parents}
    for old in [p for p in tree.rglob("*") if p.is_file() and p.relative_to(tree).as_posix() not in names]:
        old.unlink()
    for name in names:
        source, copy = root / name, tree / name
        # Compared by content: a mutant that a killed run left behind has the right size and any time.
        if not copy.exists() or source.stat().st_size != copy.stat().st_size or source.read_bytes() != copy.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, copy)
            shutil.copymode(source, copy)
    return tree


def list_tests(build):
    """All tests of a build folder. `ctest --show-only` leaves out the commands of those that are not built yet, so its own files are read."""
    quoted = r'\[=\[(?P<name>.*?)\]=\]'
    tests = {}
    for path in sorted(build.rglob("CTestTestfile.cmake")):
        text = path.read_text()
        for match in re.finditer(rf"^add_test\({quoted}\s+(?P<command>.*)\)$", text, re.MULTILINE):
            command = [re.sub(r"\\(.)", r"\1", word) for word in re.findall(r'"((?:\\.|[^"\\])*)"', match["command"])]
            tests[match["name"]] = {"name": match["name"], "command": command, "folder": path.parent, "environment": {}, "skip": None}
        for match in re.finditer(rf"^set_tests_properties\({quoted}\s+PROPERTIES\s+(?P<rows>.*)\)$", text, re.MULTILINE):
            test, rows = tests[match["name"]], dict(re.findall(r'(\w+) "((?:\\.|[^"\\])*)"', match["rows"]))
            test["folder"] = rows.get("WORKING_DIRECTORY", test["folder"])
            test["environment"] = dict(pair.split("=", 1) for pair in rows.get("ENVIRONMENT", "").split(";") if pair)
            test["skip"] = int(rows["SKIP_RETURN_CODE"]) if "SKIP_RETURN_CODE" in rows else None
    return list(tests.values())


class Bench:
    def __init__(self, work, table, seconds_more):
        self.seconds_more = seconds_more
        self.tree, self.build, self.table = work / "tree", work / "build", table
        self.work, self.tests, self.baseline = work, [], {}
        self.mutated = None  # (path, right text, its times)
        # Shaders are read from the copy, so that mutants of them need no build.
        self.environment = {**os.environ, "LIMNER_SHADER_DIR": str(self.tree / "src"), "LIMNER_CACHE": str(work / "cache"),
                            "CCACHE_BASEDIR": str(work), "CCACHE_NOHASHDIR": "1"}
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):
            self.environment.pop(name, None)

    def prepare(self):
        launcher = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        self.must("configure", ["cmake", "-S", self.tree, "-B", self.build, *CONFIGURE, *launcher])
        self.tests = list_tests(self.build)

    def must(self, what, command):
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=self.environment, check=False)
        if done.returncode:
            sys.exit(f"mutate: cannot {what}:\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
        return done.stdout

    def tests_of(self, room):
        found = []
        for expression in self.table[room]:
            named = [t for t in self.tests if re.search(expression, t["name"]) and t not in found]
            if not named:
                sys.exit(f"mutate: no test is named as '{expression}' says (row '{room}' of the table)")
            found += named
        return found

    def judge(self, m):
        """Does a test notice? `killed` by which, `survived`, or `invalid`: no program."""
        begun, ran = time.monotonic(), []
        outcome, by = "survived", None
        for test in self.tests_of(m.room):
            self.settle(test)
            self.apply(m)
            ran.append(test["name"])
            outcome = self.verdict(m, test)
            if outcome != "survived":
                by = test["name"]
                break
        self.restore()
        return {"outcome": outcome, "by": by, "tests": ran, "seconds": round(time.monotonic() - begun, 1)}

    def verdict(self, m, test):
        shader = pathlib.Path(m.path).suffix in mutants.SHADERS
        if not shader and not self.make(test):
            return "invalid"
        passed, _, said = self.run(test, self.baseline[test["name"]])
        if passed:
            return "survived"
        return "invalid" if shader and NO_PROGRAM.search(said) else "killed"

    def settle(self, test):
        """A test says something only when it is green for the right program."""
        if test["name"] in self.baseline:
            return
        self.restore()
        if not self.make(test, aloud=True):
            sys.exit(f"mutate: {test['name']} cannot be built")
        passed, seconds, said = self.run(test, None)
        if not passed:
            sys.exit(f"mutate: {test['name']} is red for the right program:\n{said.decode(errors='replace')[-4000:]}")
        self.baseline[test["name"]] = seconds
        print(f"          {test['name']} is green in {seconds:.0f} s", flush=True)

    def targets(self, test):
        """What ninja has to make for a test: those of its words that lie in the build folder, and the command that many of them run."""
        words = [os.path.relpath(w, self.build) for w in test["command"] if w.startswith(f"{self.build}/")]
        return words + (["limner_command"] if (self.tree / "apps/cli").exists() else [])

    def make(self, test, aloud=False):
        done = subprocess.run(["ninja", "-C", str(self.build), *self.targets(test)], capture_output=True, env=self.environment, check=False)
        if done.returncode and aloud:
            print(done.stdout.decode(errors="replace")[-4000:], file=sys.stderr)
        return done.returncode == 0

    def run(self, test, baseline):
        """Runs a test until it ends, says that it is red, or has had its time: (green, seconds of CPU, what it said)."""
        limit = TIMES_SLOWER * baseline + self.seconds_more if baseline is not None else 1200
        environment = {**self.environment, **test["environment"]}
        log = self.work / "test.log"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(log, "wb") as out:
            child = subprocess.Popen(test["command"], cwd=test["folder"], env=environment, stdout=out,
                                     stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=lambda: bound(limit))
            try:
                status = wait(child, log, limit)
            finally:
                end(child)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        green = status == 0 or status is not None and status == test["skip"]
        return green, seconds, log.read_bytes()

    def apply(self, m):
        if self.mutated:
            return
        path = self.tree / m.path
        source = path.read_text()
        status = path.stat()
        self.mutated = (path, source, (status.st_atime_ns, status.st_mtime_ns))
        path.write_text(source[:m.begin] + m.after + source[m.end:])

    def restore(self):
        if self.mutated:
            path, source, times = self.mutated
            path.write_text(source)
            # C keeps its new time: ninja has to see that the object is of another text. No build ever saw the shader.
            if path.suffix in mutants.SHADERS:
                os.utime(path, ns=times)
            self.mutated = None


def bound(limit):
    """In the child: no process of a test computes for longer, or takes all memory."""
    seconds = int(limit) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_MOST, MEMORY_MOST))


def wait(child, log, limit):
    """The exit status; None when it had to be ended. The clock of the wall gets more: others may use the machine."""
    until = time.monotonic() + 4 * limit
    with open(log, "rb") as said:
        text = b""
        while True:
            try:
                return child.wait(timeout=0.1)
            except subprocess.TimeoutExpired:
                text += said.read()
            if RED.search(text) or time.monotonic() > until:
                return None


def end(child):
    try:
        os.killpg(child.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    child.wait()
