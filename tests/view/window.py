"""A viewer in a window of its own display, driven as a person drives it; what happens is read from its trace."""
import os
import re
import subprocess
import time

import gi

gi.require_version("Atspi", "2.0")
from gi.repository import Atspi


class Failure(Exception):
    pass


def start_display():
    """An X server on a free display; its process, after DISPLAY is set."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1400x1000x24", "-nolisten", "tcp"],
                              pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    number = os.read(read, 16).decode().strip()
    os.environ["DISPLAY"] = ":" + number
    return server


class Viewer:
    def __init__(self, program, arguments, environment=None):
        read, write = os.pipe()
        os.set_blocking(read, False)
        self.trace, self.lines, self.rest = read, [], ""
        changed = dict(os.environ, LIMNER_VIEW_TRACE=str(write), **(environment or {}))
        self.process = subprocess.Popen([program] + arguments, pass_fds=[write], env=changed, stderr=subprocess.PIPE)
        os.close(write)

    def read(self):
        try:
            self.rest += os.read(self.trace, 1 << 16).decode()
        except BlockingIOError:
            return
        *lines, self.rest = self.rest.split("\n")
        self.lines += lines

    def wait(self, pattern, seconds=20, since=0):
        """The first line of the trace from number `since` on that the pattern is in."""
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            self.read()
            for line in self.lines[since:]:
                found = re.search(pattern, line)
                if found:
                    return found
            if self.process.poll() is not None:
                raise Failure(f"the viewer ended with {self.process.returncode}: {self.process.stderr.read().decode()}")
            time.sleep(0.005)
        last = [line for line in self.lines if " thumbnail " not in line][-8:]
        raise Failure(f"no '{pattern}' in {seconds} s; the last lines: {last}")

    def mark(self):
        """How many lines there are now, for `since`."""
        self.read()
        return len(self.lines)

    def rests(self, since=0, seconds=20):
        """Waits for a whole picture."""
        return self.wait(r"drawn .*whole=1", seconds, since)

    def close(self):
        """Its exit status, after its windows were closed, the last one that was opened first."""
        for window in reversed(self.windows()):
            act(find_below(window, "Close", "push button"), "click")
            time.sleep(0.2)
        try:
            return self.process.wait(15)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise Failure("the viewer does not end")

    # --- the accessibility tree ---

    def application(self):
        for _ in range(200):
            desktop = Atspi.get_desktop(0)
            for i in range(desktop.get_child_count()):
                child = desktop.get_child_at_index(i)
                if child and child.get_process_id() == self.process.pid:
                    return child
            time.sleep(0.05)
        raise Failure("the viewer is not on the accessibility bus")

    def windows(self):
        application = self.application()
        return [application.get_child_at_index(i) for i in range(application.get_child_count())]

    def find(self, name, role=None, seconds=5):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            found = find_below(self.application(), name, role)
            if found:
                return found
            time.sleep(0.05)
        raise Failure(f"nothing is called '{name}'" + (f" and is a {role}" if role else ""))

    def click(self, name, role=None):
        act(self.find(name, role), "click")


def find_below(node, name, role):
    try:
        if node.get_name() == name and (role is None or node.get_role_name() == role):
            return node
        for i in range(min(node.get_child_count(), 300)):
            child = node.get_child_at_index(i)
            found = child and find_below(child, name, role)
            if found:
                return found
    except gi.repository.GLib.Error:
        pass  # it went away meanwhile
    return None


def act(node, action):
    """Does an action of a widget, or of its child, as menu buttons have it."""
    for at in [node] + [node.get_child_at_index(i) for i in range(node.get_child_count())]:
        for i in range(at.get_n_actions()):
            if at.get_action_name(i) == action:
                at.do_action(i)
                return
    raise Failure(f"'{node.get_name()}' has no action {action}")


def centre(node):
    """The middle of a widget on the display. Without a window manager the window lies in the corner, its frame 5 wide."""
    e = node.get_extents(Atspi.CoordType.WINDOW)
    return e.x + e.width // 2 + 5, e.y + e.height // 2 + 5


def editable(node):
    """The node, or what is below it, that holds a text."""
    if node.get_editable_text_iface():
        return node
    for i in range(node.get_child_count()):
        found = editable(node.get_child_at_index(i))
        if found:
            return found
    return None


def corner(node):
    """Its upper left corner, in the same way."""
    e = node.get_extents(Atspi.CoordType.WINDOW)
    return e.x + 5, e.y + 5


def xdo(*words):
    subprocess.run(["xdotool"] + [str(w) for w in words], check=True)


def drag(x, y, dx, dy, button=1, steps=12):
    xdo("mousemove", x, y)
    time.sleep(0.05)
    xdo("mousedown", button)
    for i in range(1, steps + 1):
        xdo("mousemove", x + dx * i // steps, y + dy * i // steps)
        time.sleep(0.02)
    xdo("mouseup", button)
