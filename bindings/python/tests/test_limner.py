"""Tests of the package. Environment: LIMNER_LIBRARY, the library; CC, a C compiler (else cc)."""
import array
import ctypes
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent.parent
sys.path.insert(0, str(HERE.parent))

import limner  # noqa: E402
from limner import _arrays  # noqa: E402
from limner import _declarations as c  # noqa: E402

BOX = ROOT / "examples" / "box.glb"
SMALL = {"size": (64, 48), "dpi": 96}


class Declarations(unittest.TestCase):
    """What ctypes is told is what the C compiler makes of the headers."""

    structs = [kind for kind in vars(c).values() if isinstance(kind, type) and issubclass(kind, ctypes.Structure) and kind.__module__ == c.__name__]

    def printed(self, lines):
        """What a C program with these statements prints."""
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "layout.c")
            source.write_text('#include <limner/limner.h>\n#include <stdio.h>\n#include <stddef.h>\nint main(void)\n{\n' + "\n".join(lines) +
                              "\nreturn 0;\n}\n", encoding="utf-8")
            program = pathlib.Path(folder, "layout")
            subprocess.run([os.environ.get("CC", "cc"), "-I", ROOT / "include", "-o", program, source], check=True)
            return subprocess.run([program], check=True, capture_output=True, text=True).stdout.split("\n")[:-1]

    def test_current(self):
        subprocess.run([sys.executable, HERE.parent / "make_declarations.py", "--check"], check=True)

    def test_layouts(self):
        self.assertGreater(len(self.structs), 15)
        lines, expected = [], []
        for kind in self.structs:
            name = kind.__name__
            lines.append(f'printf("{name} %zu\\n", sizeof({name}));')
            expected.append(f"{name} {ctypes.sizeof(kind)}")
            for field, _ in kind._fields_:
                lines.append(f'printf("{name}.{field} %zu %zu\\n", offsetof({name}, {field}), sizeof((({name} *)0)->{field}));')
                expected.append(f"{name}.{field} {getattr(kind, field).offset} {getattr(kind, field).size}")
        self.assertEqual(self.printed(lines), expected)

    def test_standards(self):
        """LMN_…_INIT byte by byte, callbacks and all."""
        lines, expected = [], []
        for kind, standard in c.STANDARDS.items():
            name = kind.__name__
            lines.append(f"{{ static const {name} s = {name.upper()}_INIT; const unsigned char *b = (const unsigned char *)&s;"
                         f'printf("{name} "); for (size_t i = 0; i < sizeof s; i++) printf("%02x", b[i]); printf("\\n"); }}')
            expected.append(f"{name} {bytes(standard()).hex()}")
        self.assertGreater(len(lines), 4)
        self.assertEqual(self.printed(lines), expected)

    def test_constants(self):
        names = [name for name in vars(c) if name.startswith("LMN_")]
        self.assertGreater(len(names), 40)
        self.assertEqual(self.printed([f'printf("{name} %d\\n", {name});' for name in names]), [f"{name} {getattr(c, name)}" for name in names])

    def test_functions(self):
        """Every function of the headers is known, with as many parameters."""
        declared = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "include" / "limner").glob("*.h"))
        self.assertEqual(len(c.FUNCTIONS), declared.count("LMN_API ") - declared.count("#define LMN_API "))
        # The compiler refuses calls with too many or too few.
        lines = [f"if (0) (void)sizeof({name}({', '.join('0' * len(arguments))}));" for name, (result, arguments) in c.FUNCTIONS.items()
                 if result is not None and not any(isinstance(a, type) and issubclass(a, ctypes.Structure) for a in arguments)]
        self.printed(lines)


class Pictures(unittest.TestCase):
    def test_draw(self):
        picture = limner.draw(BOX, look="hatch", **SMALL)
        self.assertEqual(picture.size, (64, 48))
        self.assertEqual(picture.array.shape, (48, 64, 4))
        pixels = bytes(memoryview(picture.array).cast("B"))
        self.assertEqual(len(pixels), 48 * 64 * 4)
        self.assertGreater(len(set(pixels)), 4, "the picture is not empty")
        self.assertEqual(picture._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(picture.report["size"], [64, 48])
        self.assertEqual(picture.warnings, [])

    def test_same(self):
        """The same bytes as the command's, of several paths, scenes and looks that are kept."""
        scene, look = limner.Scene(BOX), limner.Look("line", {"lines.width": "3px"})
        first = limner.draw(scene, look, view="front", **SMALL).png()
        self.assertEqual(first, limner.draw([str(BOX)], "line", settings={"lines.width": "3px"}, view="front", **SMALL).png())
        self.assertNotEqual(first, limner.draw(scene, look, view="iso", **SMALL).png())
        self.assertNotEqual(first, limner.draw(scene, "line", view="front", **SMALL).png())

    def test_best_view(self):
        """A box shows most from where three of its sides are seen as much, which is the first direction that is tried."""
        camera = limner.draw(BOX, view="best", **SMALL).report["camera"]
        to_eye = [at - middle for at, middle in zip(camera["eye"], camera["target"])]
        for number in to_eye:
            self.assertAlmostEqual(number / math.hypot(*to_eye), 3 ** -0.5, 4)
        with self.assertRaises(limner.UsageError):
            limner.draw(BOX, view="best", select="[", **SMALL)

    def test_without_numpy(self):
        code = ("import sys; sys.modules['numpy'] = None; import limner; a = limner.draw(sys.argv[1], size=(32, 16), dpi=96).array;"
                "assert isinstance(a, memoryview) and a.shape == (16, 32, 4) and a[0, 0, 3] == 255, a.shape")
        subprocess.run([sys.executable, "-c", code, BOX], check=True, env={**os.environ, "PYTHONPATH": str(HERE.parent)})

    def test_numpy(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("numpy is not installed")
        array = limner.draw(BOX, **SMALL).array
        self.assertIsInstance(array, numpy.ndarray)
        self.assertTrue(array.flags.writeable)

    def test_eye(self):
        """Without target the viewer looks at the middle, as with the command."""
        eye = (3, 2, 5)
        self.assertEqual(limner.draw(BOX, eye=eye, **SMALL).png(), limner.draw(BOX, eye=eye, target=(0, 0, 0), up=(0, 1, 0), **SMALL).png())

    def test_sheets(self):
        sheet = limner.draw_svg(BOX, page="A5", title="A box")
        self.assertIn("<svg", sheet._repr_svg_())
        self.assertIn("A box", sheet.svg())
        with tempfile.TemporaryDirectory() as folder:
            sheet.save(pathlib.Path(folder, "box.pdf"))
            self.assertEqual(pathlib.Path(folder, "box.pdf").read_bytes()[:5], b"%PDF-")
        self.assertIn("<image", limner.draw_svg(BOX, look="toon").svg(), "surfaces are a picture below the lines")

    def test_scenes(self):
        scene = limner.Scene(BOX)
        with self.assertRaises(limner.UnsupportedError):
            scene.add(ROOT / "README.md")
        scene.add(ROOT / "examples" / "gearbox.stl", up_axis="z")
        self.assertGreater(len(scene.info["parts"]), 1)
        self.assertIn("hatch", limner.looks())
        self.assertEqual(limner.version(), c.VERSION)

    def test_towns(self):
        town = ROOT / "examples" / "town.geojson"
        empty, full = limner.Scene(town), limner.Scene(town, populate=1)
        self.assertGreater(len(full.info["parts"]), len(empty.info["parts"]))
        with self.assertRaises(limner.UsageError):
            limner.Scene(BOX, populate=1)
        with self.assertRaises(limner.UsageError):
            limner.Scene(BOX, terrain=town)

    def test_settings(self):
        look = limner.Look("toon")
        look.set("surface.bands", 2)
        look.set("scene.shadows", True)
        look.set("scene.light_direction", (1, 1, 1))
        with self.assertRaises(limner.UsageError) as caught:
            look.set("surface.bonds", 2)
        self.assertIn("'bands'", caught.exception.hint + caught.exception.message)

    def test_threads(self):
        """Each thread has its own renderer, and they give the same."""
        done = []
        threads = [threading.Thread(target=lambda: done.append(limner.draw(BOX, **SMALL).png())) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(done, [limner.draw(BOX, **SMALL).png()] * 3)


class Behaviours(unittest.TestCase):
    def setUp(self):
        self.scene = limner.Scene.from_mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
        self.box = self.scene.node_of_part(1)
        self.behaviour = limner.Behaviour(self.scene)

    def test_made_and_told(self):
        b = self.behaviour
        fall = b.constrain(self.box, "bounce", start=(0, 4, 0), floor_height=0.5, duration=2)
        turn = b.constrain(self.box, "linear", property="rotation", values=[0, 90], about=(0, 1, 0), duration=1)
        way = b.constrain(self.box, "linear", values=[[0, 0, 0], [3, 0, 0]], times=[0, 3])
        b.play(b.table((b.sequence(fall, b.reverse(way)), 0), (turn, 1, 4), (b.event("pow", self.box), 2)))
        dynamics = limner.Dynamics(self.scene)
        self.assertEqual(dynamics.duration, 5)
        self.assertEqual([row["property"] for row in dynamics.lifetimes], ["translation", "translation", "rotation", None])
        self.assertAlmostEqual(dynamics.point(self.box, 0.5)["position"][1], 4 - 9.81 / 8)
        self.assertAlmostEqual(dynamics.point(self.box, 3)["position"][0], 2)
        self.assertGreater(len(dynamics.trajectory(self.box, 0, 5, 0.01)), 10)
        hit = dynamics.contacts(self.box, 0, 1.9, 0.1)[0]
        self.assertAlmostEqual(hit["time_s"], (2 * 3.5 / 9.81) ** 0.5)
        self.assertEqual(hit["other"], 0)
        self.assertNotEqual(limner.draw(self.scene, time=0.5, fit_time=True, **SMALL).png(), limner.draw(self.scene, time=2.5, fit_time=True, **SMALL).png())

    def test_functions(self):
        b = self.behaviour
        b.play(b.constrain(self.box, "callback", function=lambda seconds: (seconds, 0, 0), duration=2))
        self.assertAlmostEqual(limner.Dynamics(self.scene).point(self.box, 1.5)["position"][0], 1.5)
        wrong = b.constrain(self.box, "callback", function=lambda seconds: 1 / 0, duration=2)
        with self.assertRaises(ZeroDivisionError):
            b.play(wrong)
        self.assertAlmostEqual(limner.Dynamics(self.scene).point(self.box, 1.5)["position"][0], 1.5)

    def test_mistakes(self):
        b = self.behaviour
        for action, words in [
            (lambda: b.constrain(self.box, "jump"), "bounce"),
            (lambda: b.constrain(99, "fall", duration=1), "no node 99"),
            (lambda: b.constrain(self.box, "constant", values=[1, 2], duration=1), "3"),
            (lambda: b.constrain(self.box, "fall"), "duration"),
            (lambda: b.constrain(self.box, "fall", duration=1, bounciness=2), "restitution"),
            (lambda: b.sequence(), "empty"),
            (lambda: b.play(7), "no activity 7"),
        ]:
            with self.subTest(words=words), self.assertRaises(limner.UsageError) as caught:
                action()
            self.assertIn(words, str(caught.exception))


class Mistakes(unittest.TestCase):
    def test_kinds(self):
        cases = [
            (limner.UsageError, lambda: limner.draw(BOX, look="hutch"), "hatch"),
            (limner.UsageError, lambda: limner.draw(BOX, view="inside"), "front"),
            (limner.UsageError, lambda: limner.draw(BOX, target=(0, 0, 0)), "viewer"),
            (limner.UsageError, lambda: limner.draw(BOX, eye=(0, 0)), "three"),
            (limner.UsageError, lambda: limner.draw(BOX, size=(0, 10)), "width"),
            (limner.UsageError, lambda: limner.draw([]), "model"),
            (limner.ReadError, lambda: limner.draw("missing.glb"), "missing.glb"),
            (limner.UnsupportedError, lambda: limner.draw(ROOT / "README.md"), "README.md"),
            (limner.WriteError, lambda: limner.draw(BOX, **SMALL).save("/nowhere/box.png"), "/nowhere"),
        ]
        for kind, action, words in cases:
            with self.subTest(words=words), self.assertRaises(kind) as caught:
                action()
            self.assertIn(words, str(caught.exception))
            self.assertIsInstance(caught.exception, limner.Error)
        self.assertTrue(issubclass(limner.ReadError, OSError) and issubclass(limner.UsageError, ValueError))

    def test_closed(self):
        with limner.draw(BOX, **SMALL) as picture:
            self.assertEqual(picture.size, (64, 48))
        for action in (lambda: picture.array, picture.png, lambda: picture.report):
            with self.assertRaises(ValueError):
                action()
        picture.close()

    def test_progress(self):
        seen = []
        limner.draw(BOX, progress=lambda fraction, stage: seen.append((fraction, stage)), **SMALL)
        self.assertTrue(seen and all(0 <= fraction <= 1 and stage for fraction, stage in seen))
        with self.assertRaises(limner.CancelledError):
            limner.draw(BOX, progress=lambda *_: False, **SMALL)

    def test_interrupts(self):
        def stop(*_):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            limner.draw(BOX, progress=stop, **SMALL)
        self.assertEqual(limner.draw(BOX, **SMALL).size, (64, 48))

    def test_encoded(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "box.png")
            picture = limner.draw(BOX, **SMALL)
            picture.save(path)
            self.assertEqual(picture.png(), path.read_bytes())
            sheet = limner.draw_svg(BOX, **SMALL)
            sheet.save(path.with_suffix(".svg"))
            self.assertEqual(sheet.svg().encode(), path.with_suffix(".svg").read_bytes())

    def test_no_library(self):
        done = subprocess.run([sys.executable, "-c", "import limner"], capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(HERE.parent), "LIMNER_LIBRARY": "/nowhere/liblimner.so.1"})
        self.assertIn("ImportError", done.stderr)
        self.assertIn("/nowhere/liblimner.so.1", done.stderr)


CORNERS = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1), (0, 1.5, 0)]
FACES = [(0, 1, 2), (0, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)]


class Meshes(unittest.TestCase):
    """Scenes from numbers, however they are held."""

    @staticmethod
    def flat(rows):
        return [number for row in rows for number in row]

    def pixels(self, *arguments, **settings):
        return bytes(limner.draw(limner.Scene.from_mesh(*arguments, **settings), "toon", **SMALL).array)

    def test_all_ways_are_the_same(self):
        floats, whole = array.array("f", self.flat(CORNERS)), array.array("I", self.flat(FACES))
        expected = self.pixels(CORNERS, FACES)
        self.assertGreater(len(set(expected)), 3)
        self.assertEqual(self.pixels(floats, whole), expected)
        self.assertEqual(self.pixels(array.array("d", floats), array.array("q", whole)), expected)
        self.assertEqual(self.pixels(memoryview(bytes(floats)).cast("f"), whole), expected)  # read only
        self.assertEqual(self.pixels(memoryview(bytearray(floats)).cast("B").cast("f", (5, 3)), FACES), expected)
        self.assertEqual(self.pixels([CORNERS[i] for face in FACES for i in face]), expected)
        self.assertNotEqual(self.pixels(CORNERS, FACES[:4]), expected)

    def test_not_copied(self):
        floats = array.array("f", self.flat(CORNERS))
        rows = _arrays.floats("positions", floats, 3)
        self.assertEqual(ctypes.addressof(rows.pointer.contents), floats.buffer_info()[0])

    def test_numpy(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("numpy is not installed")
        expected = self.pixels(CORNERS, FACES)
        corners, faces = numpy.array(CORNERS), numpy.array(FACES)
        self.assertEqual(self.pixels(corners, faces), expected)  # float64, int64
        single = corners.astype(numpy.float32)
        self.assertEqual(self.pixels(single, faces.astype(numpy.uint32)), expected)
        self.assertEqual(_arrays.floats("positions", single, 3).pointer[13], 1.5)
        self.assertEqual(ctypes.addressof(_arrays.floats("p", single, 3).pointer.contents), single.ctypes.data)
        self.assertEqual(self.pixels(numpy.asfortranarray(single), faces), expected)
        self.assertEqual(self.pixels(single[::-1][::-1], faces.astype(numpy.uint8)), expected)
        red = numpy.full((5, 3), (255, 0, 0), numpy.uint8)
        self.assertEqual(self.pixels(corners, faces, colours=red), self.pixels(CORNERS, FACES, colours=[(1, 0, 0)] * 5))
        with self.assertRaisesRegex(limner.UsageError, "whole numbers"):
            limner.Scene.from_mesh(corners, faces - 1)
        with self.assertRaisesRegex(limner.UsageError, "2 numbers a row"):
            limner.Scene.from_mesh(corners[:, :2], faces)

    def test_colours(self):
        plain, whole = self.pixels(CORNERS, FACES), self.pixels(CORNERS, FACES, colour=(1, 0, 0))
        self.assertNotEqual(plain, whole)
        red = self.pixels(CORNERS, FACES, colours=[(1, 0, 0)] * 5)
        for colours in ([(1, 0, 0, 1)] * 5, array.array("f", [1, 0, 0] * 5), bytes([255, 0, 0]) * 5, bytearray([255, 0, 0, 255]) * 5):
            self.assertEqual(self.pixels(CORNERS, FACES, colours=colours), red)

    def test_several(self):
        scene = limner.Scene.from_mesh(CORNERS, FACES, name="left", normals=None, uvs=[(0, 0)] * 5)
        mesh = scene.add_mesh(CORNERS, FACES, name="right", matrix=[[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        parts = scene.info["parts"]
        self.assertEqual([part["name"] for part in parts], ["left", "right"])
        self.assertEqual(scene.info["bounds"]["max"][0], 4)
        scene.move_mesh(mesh, [(x, 2 * y, z) for x, y, z in CORNERS])
        self.assertEqual(scene.info["bounds"]["max"][1], 3)

    def test_refused(self):
        for arguments, settings, words in (
                ((CORNERS, [(0, 1, 5)]), {}, "5"), ((self.flat(CORNERS)[:-1], FACES), {}, "14 numbers"), (([(0, 0)], FACES), {}, "2 numbers a row"),
                ((CORNERS, [(0, 1, -1)]), {}, "whole numbers"), ((CORNERS, FACES), {"normals": CORNERS[1:]}, "4 normals for 5"),
                ((CORNERS, FACES), {"colour": (1, 0)}, "2 numbers"), ((["a"] * 9, None), {}, "positions"), ((CORNERS, FACES), {"up_axis": "x"}, "up_axis")):
            with self.assertRaisesRegex(limner.UsageError, words):
                limner.Scene.from_mesh(*arguments, **settings)


if __name__ == "__main__":
    unittest.main()
