"""The viewer's window, step by step as a person uses it. Arguments: VIEWER COMMAND SOURCE FOLDER."""
import filecmp
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(__file__))
from window import Failure, Viewer, act, centre, corner, drag, editable, find_below, start_display, xdo

SOLID = "sphere"

VIEWER, COMMAND, SOURCE, FOLDER = sys.argv[1:5]
MODEL = os.path.join(FOLDER, "model.glb")
checks = failed = 0


def check(what, true):
    global checks, failed
    checks += 1
    failed += not true
    print(("ok   " if true else "FAIL ") + what, flush=True)


def picture_middle(v):
    return centre(v.find("Drawing"))


def opened_and_turned(v):
    v.wait("loaded parts=24")
    v.rests()
    x, y = picture_middle(v)
    since = v.mark()
    drag(x, y, 120, 30)
    v.wait("drawn .*whole=0", since=since)
    v.rests(since)
    check("a drag turns: pictures while it moves, then the whole one", True)
    since = v.mark()
    xdo("click", 4)
    v.rests(since)
    check("the wheel comes nearer", True)


def undone(v):
    for step in ("Undo", "Redo"):
        since = v.mark()
        v.click(step)
        v.rests(since)
    check("the view is undone and redone", True)


def seen_best(v):
    since = v.mark()
    xdo("key", "ctrl+8")
    v.wait("drawn .*whole=1", since=since)
    v.rests(since)
    check("the view from where most is seen is looked for, and drawn", True)


def look_chosen(v):
    since = v.mark()
    v.click("toon", "push button")
    v.wait("chosen look=toon", since=since)
    v.rests(since)
    check("a look is chosen in the gallery", True)


def part_hidden(v):
    x, y = picture_middle(v)
    since = v.mark()
    xdo("mousemove", x, y, "click", 1)
    part = int(v.wait(r"picked part=(\d+)", since=since).group(1))
    check("a click tells the part", part > 0)
    since = v.mark()
    v.click("Hide")
    v.rests(since)
    time.sleep(0.6)  # not a double click
    since = v.mark()
    xdo("mousemove", x + 1, y, "click", 1)
    check("what was hidden is not picked", int(v.wait(r"picked part=(\d+)", since=since).group(1)) != part)


def section_cut(v):
    since = v.mark()
    for item in ("Main menu", "Section", "Across X"):
        v.click(item)
        time.sleep(0.4)
    v.rests(since)
    check("a section from the menu", True)


def parameter_changed(v):
    xdo("mousemove", *centre(v.find("Controls", "page tab")), "click", 1)
    slider = v.find("lines.width", "slider")
    before = slider.get_current_value()
    since = v.mark()
    slider.set_current_value(0.9)
    v.rests(since)
    check("a slider made from the tables changes the drawing", abs(slider.get_current_value() - 0.9) < 0.02)
    since = v.mark()
    v.click("Undo")
    v.rests(since)
    check("undo puts the slider back, too", abs(slider.get_current_value() - before) < 0.02)
    typed = v.find("lines.width as text", "text")
    since = v.mark()
    typed.set_text_contents("wide")
    v.wait("refused", since=since)
    typed.set_text_contents("2.25")
    v.rests(since)
    check("a refused value is told, the next one is taken", True)


def time_scrubbed(v):
    since = v.mark()
    v.find("Time", "slider").set_current_value(0.4)
    v.rests(since)
    since = v.mark()
    v.click("One frame on")
    v.rests(since)
    since = v.mark()
    v.click("At rest", "push button")
    v.rests(since)
    check("time is scrubbed, stepped, and goes back to rest", True)


def huge_texts_typed(v):
    """Nobody types a million letters, but anybody may paste them."""
    for name, text in (("Which parts the rule draws", "a" * 1000000), ("Search parameters", "b" * 1000000), ("Search parts", "c" * 1000000)):
        entry = editable(v.find(name))
        before = entry.get_text(0, 200)
        entry.set_text_contents(text)
        time.sleep(0.3)
        entry.set_text_contents(before)
    since = v.mark()
    v.click("Undo")
    v.click("Redo")
    v.rests(since)
    check("huge texts in entries change nothing", v.process.poll() is None)


def motion_drawn(v):
    since = v.mark()
    v.find("Time", "slider").set_current_value(0.4)
    v.rests(since)
    chosen = v.find("Motion", "combo box")
    before = v.mark()
    x, y = centre(chosen)
    xdo("mousemove", x, y, "click", 1)
    time.sleep(0.5)
    xdo("key", "Down", "Return")
    v.rests(before)
    exposure = v.find("Exposure", "spin button")
    before = v.mark()
    exposure.set_current_value(0.25)
    v.rests(before)
    check("motion and its exposure are chosen beside the time", abs(exposure.get_current_value() - 0.25) < 1e-6)
    check("ways to tell of motion are offered by name", v.find("speed-lines") is not None)
    for _ in range(3):
        before = v.mark()
        v.click("Undo")
        v.rests(before)
    check("undo takes the motion away, too", v.find("Drawing") is not None)


def section_dragged(v):
    at = v.wait(r"handle kind=1 axis=0 x=([0-9.]+) y=([0-9.]+)")
    x, y = corner(v.find("Drawing"))
    since = v.mark()
    drag(x + int(at.group(1)), y + int(at.group(2)), 40, 0)
    v.wait("drawn .*whole=0", since=since)
    v.rests(since)
    moved = [line for line in v.lines[since:] if "handle kind=1 axis=0" in line]
    check("the section follows its handle", at.group(0) not in moved[-1])
    since = v.mark()
    v.click("Undo")
    v.rests(since)


def look_dropped(v):
    x, y = centre(v.find("blueprint", "push button"))
    to_x, to_y = picture_middle(v)
    since = v.mark()
    drag(x, y, to_x - x, to_y - y, steps=30)
    part = int(v.wait(r"dropped look=blueprint part=(\d+)", since=since).group(1))
    v.rests(since)
    check("a look is dragged on a part", part > 0)
    since = v.mark()
    v.click("Undo")
    v.rests(since)


def file_opened(v):
    since = v.mark()
    x, y = picture_middle(v)
    xdo("mousemove", x, y)
    xdo("key", "ctrl+o")
    time.sleep(1.5)
    xdo("key", "slash")
    xdo("type", "--delay", "5", os.path.join(SOURCE, "examples", "box.glb")[1:])
    time.sleep(0.3)
    xdo("key", "Return")
    v.wait("loaded parts=1", since=since)
    v.rests(since)
    check("a file is opened by the dialog", True)


def solid_edited():
    v = Viewer(VIEWER, [os.path.join(SOURCE, "examples", "csg", "widget.csg")])
    v.wait("loaded parts")
    v.rests()
    row = find_below(v.find("Solids", "list"), SOLID, "label")
    xdo("mousemove", *centre(row), "click", 1)
    seen = v.wait(r"handle kind=2 axis=0 x=([0-9.]+) y=([0-9.]+)")
    turn = v.wait(r"handle kind=3 axis=2 x=([0-9.]+) y=([0-9.]+)")
    check("a marked operand has handles that move and turn it", True)
    x, y = corner(v.find("Drawing"))
    for what, at in (("moves", seen), ("turns", turn)):
        since = v.mark()
        drag(x + int(at.group(1)), y + int(at.group(2)), 30, 12)
        v.rests(since)
        moving = [line for line in v.lines[since:] if "whole=0" in line]
        check(f"a handle {what} it, and the drawing follows: {len(moving)} pictures", len(moving) > 0)
        since = v.mark()
        v.click("Undo")
        v.rests(since)
    since = v.mark()
    v.click("Show " + SOLID)
    v.wait("solid node=[0-9]+ hidden=1", since=since)
    v.rests(since)
    check("an operand is hidden", True)
    since = v.mark()
    v.click("Main menu")
    time.sleep(0.4)
    v.click("Copy as command")
    v.wait("not-copied", since=since)
    check("what no command can say is not copied", True)
    since = v.mark()
    v.click("Put back")
    v.rests(since)
    check("it ends after solids were edited", v.close() == 0)


def signs_edited():
    script = os.path.join(FOLDER, "told.json")
    shutil.copy(os.path.join(SOURCE, "examples", "scripts", "bounce.json"), script)
    with open(script) as file:
        before = file.read()
    v = Viewer(VIEWER, [script])
    v.wait("loaded parts")
    xdo("mousemove", *centre(v.find("Signs", "page tab")), "click", 1)
    v.rests()
    slider = v.find("path.width", "slider")
    check("a script's expressions are listed with their options", v.find("still.count", "slider") is not None)
    since = v.mark()
    slider.set_current_value(0.9)
    v.wait("expressions count=4", since=since)
    v.rests(since)
    check("an option changes the signs, and the picture follows", True)
    since = v.mark()
    v.find("path.from", "text").set_text_contents("soon")
    v.wait("refused", since=since)
    check("a refused option is told", True)
    since = v.mark()
    v.click("Save expressions")
    v.wait("saved-expressions", since=since)
    with open(script) as file:
        after = file.read()
    told, first = json.loads(after), json.loads(before)
    check("they are saved in the script, and nothing else is changed",
          told["expressions"] != first["expressions"] and {**told, "expressions": 0} == {**first, "expressions": 0} and
          after.startswith(before[:before.index('"expressions"')]))
    since = v.mark()
    v.click("Take all signs away")
    v.wait("expressions count=0", since=since)
    since = v.mark()
    v.click("Propose signs")
    count = int(v.wait(r"expressions count=(\d+)", since=since).group(1))
    check("signs are proposed from what moves", count > 1)
    since = v.mark()
    v.click("Main menu")
    time.sleep(0.4)
    v.click("Copy as command")
    v.wait("not-copied", since=since)
    check("signs are not copied as a command", True)
    check("it ends with signs", v.close() == 0)


def copied_and_exported(v):
    since = v.mark()
    v.click("Main menu")
    time.sleep(0.4)
    v.click("Copy as command")
    line = v.wait(r"copied (limner draw .*)", since=since).group(1)
    words = shlex.split(line)
    check("the command has look, section and what is hidden",
          "toon" in words and any(w.startswith("scene.cut=") for w in words) and "--select" in words and
          any(w.endswith(".width=2.25") for w in words))
    ours, theirs = os.path.join(FOLDER, "ours.png"), os.path.join(FOLDER, "theirs.png")
    words[words.index("-o") + 1] = theirs
    subprocess.run([COMMAND] + words[1:] + ["-q"], check=True)
    since = v.mark()
    v.click("Export", "push button")
    path = v.find("File", "text")
    path.set_text_contents(ours)
    time.sleep(0.2)
    dialog = [w for w in v.windows() if w.get_name() == "Export"][0]
    act(find_below(dialog, "Export", "push button"), "click")
    v.wait("exported", since=since, seconds=30)
    check("the exported file is the command's, byte for byte", filecmp.cmp(ours, theirs, shallow=False))
    act(find_below(dialog, "Close", "push button"), "click")


def exported_meanwhile(v):
    since = v.mark()
    v.click("Export", "push button")
    whole = os.path.join(FOLDER, "whole.png")
    v.wait("preview", since=since)
    dialog = [w for w in v.windows() if w.get_name() == "Export"][-1]
    find_below(dialog, "File", "text").set_text_contents(whole)
    for side in ("Width", "Height"):
        find_below(dialog, side, "spin button").set_current_value(4000)
    time.sleep(0.3)
    since = v.mark()
    act(find_below(dialog, "Export", "push button"), "click")
    time.sleep(0.3)
    v.click("Undo")
    drawn = v.wait("drawn |exported", since=since, seconds=30).group(0)
    check("the window goes on while a file is drawn", drawn == "drawn ")
    act(find_below(dialog, "Cancel", "push button"), "click")
    v.wait("export-cancelled", since=since, seconds=60)
    check("what is cancelled leaves nothing", not os.path.exists(whole))
    act(find_below(dialog, "Close", "push button"), "click")
    v.click("Redo")


def picture_copied(v):
    since = v.mark()
    v.click("Main menu")
    time.sleep(0.4)
    v.click("Copy the picture")
    v.wait("copied-picture", since=since)
    check("the picture is copied", True)


def look_file_changed():
    look = os.path.join(FOLDER, "my.json")
    text = '{"version": 1, "rules": [{"select": "*", "surface": "%s"}]}'
    with open(look, "w") as file:
        file.write(text % "flat")
    v = Viewer(VIEWER, [MODEL, "--look", look])
    v.wait("loaded parts")
    v.rests()
    since = v.mark()
    with open(look, "w") as file:
        file.write(text % "toon" + "\n,")
    v.wait("not-reloaded-look 2:", since=since)
    check("a look file that is half written is said, with the line", True)
    since = v.mark()
    with open(look, "w") as file:
        file.write(text % "toon")
    v.wait("[0-9] reloaded-look", since=since)
    v.rests(since)
    check("a look file that changes is read again", True)
    check("it ends with a watched look", v.close() == 0)


def watched(v):
    since = v.mark()
    shutil.copy(os.path.join(SOURCE, "examples", "box.glb"), MODEL)
    v.wait("loaded parts=1 reload=1", since=since)
    v.rests(since)
    check("a file that changes is read again", True)
    since = v.mark()
    with open(MODEL, "r+b") as file:
        file.truncate(300)
    v.wait("not-loaded", since=since)
    check("half of a file is an error that is said, and the last picture stays", v.process.poll() is None)
    since = v.mark()
    os.remove(MODEL)
    shutil.copy(os.path.join(SOURCE, "examples", "pump.glb"), MODEL)
    v.wait("loaded parts=24", since=since)
    check("a file that comes back is read", True)


def ends(v):
    status = v.close()
    check(f"it ends with status 0: {status}", status == 0)
    if status:
        print(v.process.stderr.read().decode()[-2000:], flush=True)


def goes_on_where_it_was():
    v = Viewer(VIEWER, [])
    v.wait("loaded parts=1")
    v.rests()
    check("the next start goes on with the same file", True)
    check("it ends again", v.close() == 0)


def says_what_is_wrong():
    v = Viewer(VIEWER, [os.path.join(SOURCE, "README.md")])
    v.wait("not-loaded")
    check("what is no model is said", v.close() == 0)
    v = Viewer(VIEWER, [MODEL], {"MESA_GL_VERSION_OVERRIDE": "3.1", "MESA_GLES_VERSION_OVERRIDE": "2.0"})
    v.wait("failed")
    check("a driver without OpenGL 3.3 is said", v.close() == 0)
    environment = {k: w for k, w in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    without = subprocess.run([VIEWER, MODEL], env=environment, capture_output=True, text=True)
    check("without a display: status 3 and what to do instead",
          without.returncode == 3 and "limner draw" in without.stderr)


def main():
    server = start_display()
    try:
        shutil.copy(os.path.join(SOURCE, "examples", "pump.glb"), MODEL)
        v = Viewer(VIEWER, [MODEL])
        for step in (opened_and_turned, undone, seen_best, look_dropped, look_chosen, part_hidden, section_cut, section_dragged, parameter_changed, huge_texts_typed, time_scrubbed, motion_drawn, copied_and_exported, exported_meanwhile, picture_copied, watched, file_opened, ends):
            try:
                step(v)
            except Failure as e:
                check(f"{step.__name__}: {e}", False)
                if v.process.poll() is not None:
                    break
        if v.process.poll() is None:
            v.process.send_signal(signal.SIGKILL)
        for step in (goes_on_where_it_was, solid_edited, signs_edited, look_file_changed, says_what_is_wrong):
            try:
                step()
            except Failure as e:
                check(f"{step.__name__}: {e}", False)
    finally:
        server.terminate()
    print(f"{checks} checks, {failed} failed")
    return failed != 0


sys.exit(main())
