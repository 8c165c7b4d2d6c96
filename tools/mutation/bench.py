"""Where mutants are built and tested: a copy of the tree, a build folder of its own, and the tests that name the room."""
import ctypes.util
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import mutants
import weave

# How much longer than the right program a test may take before it counts as one that hangs: times, and seconds besides.
TIMES_SLOWER, SECONDS_MORE = 6, 20
MEMORY_MOST = 12 << 30
# What writes beside its memory is red: the project's tests run with sanitizers, too, and glibc can see that much without them.
MALLOC_CHECK = ctypes.util.find_library("c_malloc_debug")
CHECKED_MEMORY = {"LD_PRELOAD": MALLOC_CHECK, "MALLOC_CHECK_": "3", "MALLOC_PERTURB_": "165"} if MALLOC_CHECK else {}
# What a test is taken to cost before it ran for the first time.
SECONDS_UNKNOWN = 1
# A test that says so is red: what is left of it need not run.
RED = re.compile(rb"^(FAIL |\[  FAILED  \])", re.MULTILINE)
# GLSL that does not compile is no program.
NO_PROGRAM = re.compile(rb"src/\S+\.(?:glsl|frag|vert|comp):\d+[(:].*error")
# As the preset `dev` builds, so that ccache knows what has no mutants.
CONFIGURE = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=RelWithDebInfo", "-DLIMNER_WERROR=OFF", "-DLIMNER_VIEWER=OFF", "-DLIMNER_INSTALL=OFF", "-DLIMNER_STATIC=OFF"]
# Row of the table that is no room: tests that take names of cases as arguments, and list them when they are called with `--cases`.
CASES = "cases"


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
        # What is woven for this run is written when it is known; that of files that are gone goes.
        if old.suffix != weave.WOVEN or old.with_suffix("").relative_to(tree).as_posix() not in names:
            old.unlink()
    for name in names:
        source, copy = root / name, tree / name
        # Compared by content: a mutant that a killed run left behind has the right size and any time.
        if copy.with_name(copy.name + weave.WOVEN).exists():
            continue
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
            tests[match["name"]] = {"name": match["name"], "command": command, "folder": path.parent, "environment": {}, "skip": None, "cost": SECONDS_UNKNOWN}
        for match in re.finditer(rf"^set_tests_properties\({quoted}\s+PROPERTIES\s+(?P<rows>.*)\)$", text, re.MULTILINE):
            test, rows = tests[match["name"]], dict(re.findall(r'(\w+) "((?:\\.|[^"\\])*)"', match["rows"]))
            test["folder"] = rows.get("WORKING_DIRECTORY", test["folder"])
            test["environment"] = dict(pair.split("=", 1) for pair in rows.get("ENVIRONMENT", "").split(";") if pair)
            test["skip"] = int(rows["SKIP_RETURN_CODE"]) if "SKIP_RETURN_CODE" in rows else None
            test["cost"] = float(rows.get("COST", SECONDS_UNKNOWN))
    return list(tests.values())


class Bench:
    """Tests are run in pieces where they have cases: a mutant meets only those cases that call its function or read its shader, the
    quickest first and those first that have found others of its file."""

    def __init__(self, root, work, table, seconds_more, budget):
        self.root, self.seconds_more, self.budget = root, seconds_more, budget
        self.tree, self.build = work / "tree", work / "build"
        self.table, self.cases = table, table.get(CASES, [])
        self.work, self.tests, self.probes = work, [], {}
        self.known_path = work / "tests.json"  # what right programs did: seconds, functions, shaders
        self.known = json.loads(self.known_path.read_text()) if self.known_path.exists() else {}
        self.kills = {}
        self.numbers, self.invalid, self.functions = {}, set(), {}
        self.mutated = None  # (path, right text, its times) of a shader
        # Shaders are read from the copy, so that mutants of them need no build.
        self.environment = {**os.environ, "LIMNER_SHADER_DIR": str(self.tree / "src"), "LIMNER_CACHE": str(work / "cache"),
                            "CCACHE_BASEDIR": str(work), "CCACHE_NOHASHDIR": "1"}
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):
            self.environment.pop(name, None)

    # --- building ---

    def prepare(self, todo):
        """Builds one program with all mutants of C in it, and what their tests are. Those that do not compile are left out."""
        launcher = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        self.numbers = {m.key: k + 1 for k, m in enumerate(m for m in todo if m.path.endswith(".c"))}
        self.weave(todo)
        self.must("configure", ["cmake", "-S", self.tree, "-B", self.build, *CONFIGURE, *launcher])
        self.tests = list_tests(self.build)
        rooms = list(dict.fromkeys(m.room for m in todo))
        targets = sorted({target for room in rooms for test in self.tests_of(room) for target in self.targets(test)})
        self.build_all(todo, targets)
        self.digest = self.digest_of(self.root / "src")
        for room in rooms:
            self.probes[room] = [probe for test in self.tests_of(room) for probe in self.split(test)]

    def weave(self, todo):
        """The C of all rooms, so that the next run builds only what has other mutants."""
        for room in self.table:
            for path in sorted((self.root / "src" / room).rglob("*.c")) if room != CASES else []:
                name = path.relative_to(self.root).as_posix()
                numbered = [(self.numbers[m.key], m) for m in todo if m.path == name and m.key not in self.invalid]
                copy = self.tree / name
                write_if_other(copy.with_name(copy.name + weave.WOVEN), weave.weave(name, path.read_text(), numbered))
                write_if_other(copy, f'#include "{copy.name}{weave.WOVEN}"\n')

    def build_all(self, todo, targets):
        while True:
            done = subprocess.run(["ninja", "-C", str(self.build), "-k", "0", *targets], capture_output=True, env=self.environment, check=False)
            if done.returncode == 0:
                return
            said = (done.stdout + done.stderr).decode(errors="replace")
            wrong = {int(n) for n in re.findall(rf"{weave.NAME}(\d+):\d+(?::\d+)?: (?:fatal )?error", said)}
            found = {m.key for m in todo if self.numbers.get(m.key) in wrong} - self.invalid
            if not found:
                sys.exit(f"mutate: the right program cannot be built:\n{said[-4000:]}")
            self.invalid |= found
            self.weave(todo)

    def must(self, what, command):
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=self.environment, check=False)
        if done.returncode:
            sys.exit(f"mutate: cannot {what}:\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
        return done.stdout

    def targets(self, test):
        """What ninja has to make for a test: those of its words that lie in the build folder, and the command that many of them run."""
        words = [os.path.relpath(w, self.build) for w in test["command"] if w.startswith(f"{self.build}/")]
        return words + (["limner_command"] if (self.tree / "apps/cli").exists() else [])

    # --- tests ---

    def tests_of(self, room):
        found = []
        for expression in self.table[room]:
            named = [t for t in self.tests if re.search(expression, t["name"]) and t not in found]
            if not named:
                sys.exit(f"mutate: no test is named as '{expression}' says (row '{room}' of the table)")
            found += named
        return found

    def split(self, test):
        """A test's cases as tests of their own."""
        if not any(re.search(expression, test["name"]) for expression in self.cases):
            return [test]
        names = self.must(f"list the cases of {test['name']}", [*test["command"], "--cases"]).splitlines()
        return [{**test, "name": f"{test['name']}:{case}", "command": [*test["command"], case]} for case in names]

    def digest_of(self, *places):
        """Of all files below, by their content."""
        digest = hashlib.sha1()
        for place in places:
            for path in sorted(place.rglob("*")) if place.is_dir() else [place]:
                if path.is_file():
                    digest.update(path.relative_to(self.root).as_posix().encode() + b"\0" + path.read_bytes())
        return digest.hexdigest()[:16]

    def know(self, test):
        """What a test does with the right program: is it green, in how many seconds, and which functions and shaders has it to do with?"""
        stem = re.sub(r"^(analytic|table)_", "", pathlib.Path(test["command"][0]).name)
        own = [p for p in self.root.glob("tests/*/*.c") if p.stem == stem] or [self.root / "tests"]
        support = [p for p in (self.root / "tests/support", self.root / "looks") if p.exists()]
        digest = self.digest + self.digest_of(*own, *support)
        known = self.known.get(test["name"])
        if known and known["digest"] == digest:
            return known
        self.restore()
        shaders = self.shaders()
        for path in shaders:
            os.utime(path, ns=(0, path.stat().st_mtime_ns))  # the next one who reads leaves a later time
        reached = self.work / "reached.txt"
        reached.unlink(missing_ok=True)
        with tempfile.TemporaryDirectory(dir=self.work) as cache:  # what is kept is made here, too
            green, seconds, said = self.run(test, None, MUTANT_REACHED=str(reached), LIMNER_CACHE=cache)
        read = [p.relative_to(self.tree).as_posix() for p in shaders if p.stat().st_atime_ns]
        functions = sorted(set(reached.read_text().splitlines())) if reached.exists() else []
        known = {"digest": digest, "green": green, "seconds": seconds, "reached": functions + read}
        if not green:
            print(f"          {test['name']} is red for the right program, and not asked:\n{said.decode(errors='replace')[-600:]}", flush=True)
        self.known[test["name"]] = known
        self.known_path.write_text(json.dumps(self.known))
        return known

    def shaders(self):
        return [p for p in (self.tree / "src").rglob("*") if p.suffix in mutants.SHADERS]

    def place_of(self, m):
        """What `know` says that is reached, for a mutant."""
        if m.path.endswith(".c"):
            return f"{m.path}:{weave.function_of((self.root / m.path).read_text(), m)}"
        return m.path

    def in_turn(self, m):
        """The tests that have to do with a mutant, and what is known of them, by what they cost and found; None where one is dearer than the budget."""
        place = self.place_of(m)

        def cost(test):
            return self.known[test["name"]]["seconds"] if test["name"] in self.known else test["cost"]

        def price(test):
            return cost(test) / (1 + 3 * self.kills.get((test["name"], m.path), 0))

        for test in sorted(self.probes[m.room], key=price):
            if cost(test) > self.budget:
                yield None, None
            else:
                known = self.know(test)
                if known["green"] and place in known["reached"]:
                    yield test, known

    # --- mutants ---

    def judge(self, m):
        """Does a test notice? `killed` by which, `survived`, `unfinished` when the budget was spent before all tests ran, or `invalid`: no program."""
        ran, spent, outcome, by = [], 0, "invalid" if m.key in self.invalid else "survived", None
        if outcome == "survived":
            for test, known in self.in_turn(m):
                if test is None or spent > self.budget:
                    outcome = "unfinished"
                    break
                ran.append(test["name"])
                outcome, seconds = self.verdict(m, test, known)
                spent += seconds
                if outcome != "survived":
                    by = test["name"]
                    self.kills[by, m.path] = self.kills.get((by, m.path), 0) + (outcome == "killed")
                    break
        self.restore()
        return {"outcome": outcome, "by": by, "tests": ran, "seconds": round(spent, 1)}

    def verdict(self, m, test, known):
        shader = pathlib.Path(m.path).suffix in mutants.SHADERS
        if shader:
            self.apply(m)
            passed, seconds, said = self.run(test, known["seconds"])
        else:
            # What it makes and would keep is not what the right program keeps.
            with tempfile.TemporaryDirectory(dir=self.work) as cache:
                passed, seconds, said = self.run(test, known["seconds"], MUTANT_NUMBER=str(self.numbers[m.key]), LIMNER_CACHE=cache, **CHECKED_MEMORY)
        if passed:
            return "survived", seconds
        return ("invalid" if shader and NO_PROGRAM.search(said) else "killed"), seconds

    def run(self, test, baseline, **more):
        """Runs a test until it ends, says that it is red, or has had its time: (green, seconds of CPU, what it said)."""
        limit = TIMES_SLOWER * baseline + self.seconds_more if baseline is not None else 1200
        environment = {**self.environment, **test["environment"], **more}
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
            os.utime(path, ns=times)  # no build ever saw it
            self.mutated = None


def write_if_other(path, text):
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


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
                return child.wait(timeout=0.05)
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
