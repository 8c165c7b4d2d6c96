"""Limner draws 3D models the way people draw.

    import limner
    picture = limner.draw("part.stl", look="hatch", size=(1024, 768))
    picture.save("part.png")
    picture.array                   # 768 × 1024 × 4 bytes: a numpy array, or without numpy a memoryview
    limner.draw_svg("part.stl", look="technical", page="A4").save("part.pdf")

Every mistake is an exception below limner.Error, with a hint what to do. In notebooks drawings show themselves.
"""
from __future__ import annotations

import ctypes
import json
import os
import threading
from collections.abc import Mapping, Sequence
from typing import Any, Union

from . import _arrays
from . import _declarations as c
from ._library import (CancelledError, Error, FormatError, GLError, Handle, InternalError, LimitError, OutOfMemoryError,
                       Progress, ReadError, UnsupportedError, UsageError, Watch, WriteError, call, encode, lib, take_text)

__all__ = [
    "Behaviour", "CancelledError", "Drawing", "Dynamics", "Error", "FormatError", "GLError", "InternalError", "LimitError", "Look", "OutOfMemoryError", "Picture",
    "ReadError", "Renderer", "Scene", "Sheet", "UnsupportedError", "UsageError", "WriteError", "draw", "draw_svg", "looks", "version",
]
__version__ = c.VERSION

Path = Union[str, "os.PathLike[str]"]
Vector = Sequence[float]
_VIEWS = {name.removeprefix("LMN_VIEW_").lower(): value for name, value in vars(c).items() if name.startswith("LMN_VIEW_")}
_UP = {None: c.LMN_UP_AUTO, "y": c.LMN_UP_Y, "z": c.LMN_UP_Z}
_ANGLES = {"third": c.LMN_THIRD_ANGLE, "first": c.LMN_FIRST_ANGLE}


def version() -> str:
    """The version of the library that is loaded."""
    return str(lib.lmn_version().decode())


def looks() -> list[str]:
    """The names of the looks that ship."""
    return [lib.lmn_look_name_at(i).decode() for i in range(lib.lmn_look_count())]


def _choice(name: str, value: Any, allowed: Mapping[Any, int]) -> int:
    if value not in allowed:
        words = ", ".join(str(word) for word in allowed if word is not None)
        raise UsageError(f"{name} is {value!r}; allowed are {words}")
    return allowed[value]


def _matrix(values: Any) -> Any:
    """Rows of an array are columns for C."""
    if hasattr(values, "tolist"):
        values = values.tolist()
    values = list(values)
    if len(values) == 4:
        values = [values[row][column] for column in range(4) for row in range(4)]
    if len(values) != 16:
        raise UsageError(f"matrix has {len(values)} numbers; it has 16")
    return (ctypes.c_double * 16)(*values)


class Scene(Handle):
    """Models that are drawn together. One that is drawn several times is read once."""

    _end = "lmn_scene_destroy"

    def __init__(self, *paths: Path, up_axis: str | None = None, lod: str | float | None = None, terrain: Path | None = None,
                 populate: float = 0, deflection: float = 0, progress: Progress | None = None) -> None:
        super().__init__()
        call("lmn_scene_create", self._out)
        for path in paths:
            self.add(path, up_axis=up_axis, lod=lod, terrain=terrain, populate=populate, deflection=deflection, progress=progress)

    def add(self, path: Path, *, up_axis: str | None = None, lod: str | float | None = None, terrain: Path | None = None,
            populate: float = 0, deflection: float = 0, progress: Progress | None = None) -> None:
        """Reads a model file and adds it; when it cannot be read the scene is as before. Of city models `lod` is the level of detail that is not
        exceeded and `terrain` a raster of heights below it; of footprints `populate` is how densely people, cars and trees are put along roads. Of STEP and IGES
        files `deflection` is how far triangles may lie off curved surfaces, millimetres."""
        self._check()
        with Watch(progress) as watch:
            desc = c.STANDARDS[c.lmn_load_desc]()
            desc.up_axis, desc.progress = _choice("up_axis", up_axis, _UP), watch.function
            desc.lod = None if lod is None else str(lod).encode()
            desc.terrain, desc.populate = None if terrain is None else encode(terrain), populate
            desc.deflection = deflection
            call("lmn_scene_add_file", self, encode(path), ctypes.byref(desc))

    @classmethod
    def from_mesh(cls, positions: Any, indices: Any = None, *, normals: Any = None, colours: Any = None, uvs: Any = None, name: str | None = None,
                  colour: Vector | None = None, up_axis: str = "y") -> Scene:
        """A scene of one mesh; the arguments are those of add_mesh. limner.Scene.from_mesh(mesh.vertices, mesh.faces) takes one of trimesh."""
        scene = cls()
        call("lmn_scene_set_up", scene, _choice("up_axis", up_axis, {"y": c.LMN_UP_Y, "z": c.LMN_UP_Z}))
        scene.add_mesh(positions, indices, normals=normals, colours=colours, uvs=uvs, name=name, colour=colour)
        return scene

    def add_mesh(self, positions: Any, indices: Any = None, *, normals: Any = None, colours: Any = None, uvs: Any = None, name: str | None = None,
                 colour: Vector | None = None, matrix: Any = None) -> int:
        """Adds triangles as a part, and answers the number of its mesh, for move_mesh.

        positions: three numbers a vertex; indices: three vertices a triangle, from 0 on (None: vertices as they come); normals: three numbers a vertex;
        colours: three or four a vertex, 0 … 1 or bytes; uvs: two a vertex; colour: of the whole mesh, 0 … 1; matrix: 16 numbers, column after column, or
        a 4 × 4 array as NumPy programs write it. NumPy arrays and other buffers that are float32 or uint32 already are not copied on the way.
        """
        self._check()
        desc, held = self._mesh(positions, indices, normals, colours, uvs, name)
        mesh, node = ctypes.c_uint32(), c.STANDARDS[c.lmn_node_desc]()
        node.name = encode(name)
        if matrix is not None:
            node.matrix = _matrix(matrix)
        if colour is not None:
            desc.material = self._material(colour)
        call("lmn_scene_add_mesh", self, ctypes.byref(desc), ctypes.byref(mesh))
        del held
        node.mesh = mesh.value
        call("lmn_scene_add_node", self, ctypes.byref(node), None)
        return mesh.value

    def move_mesh(self, mesh: int, positions: Any, normals: Any = None) -> None:
        """Gives the vertices of a mesh other positions, as many as it has: for what deforms from picture to picture."""
        self._check()
        at, turned = _arrays.floats("positions", positions, 3), None if normals is None else _arrays.floats("normals", normals, 3)
        if turned and turned.count != at.count:
            raise UsageError(f"there are {turned.count} normals for {at.count} positions")
        call("lmn_scene_set_positions", self, mesh, at.pointer, turned.pointer if turned else None, at.count)

    def node_of_part(self, part: int) -> int:
        """The number of the node of a part, counted from 1 on: what behaviour moves."""
        self._check()
        node = int(lib.lmn_scene_node_of_part(self, part))
        if not node:
            raise UsageError(f"the scene has no part {part}")
        return node

    @staticmethod
    def _mesh(positions: Any, indices: Any, normals: Any, colours: Any, uvs: Any, name: str | None) -> tuple[Any, list[Any]]:
        """The description, and what must last as long as it."""
        desc, at = c.STANDARDS[c.lmn_mesh_desc](), _arrays.floats("positions", positions, 3)
        held: list[Any] = [at]
        desc.name, desc.positions, desc.vertex_count = encode(name), at.pointer, at.count
        for word, values, columns in (("normals", normals, 3), ("uvs", uvs, 2), ("colours", colours, 4)):
            if values is None:
                continue
            rows = _arrays.colours(values, at.count) if word == "colours" else _arrays.floats(word, values, columns)
            if rows.count != at.count:
                raise UsageError(f"there are {rows.count} {word} for {at.count} positions")
            setattr(desc, word, rows.pointer)
            held.append(rows)
        if indices is not None:
            corners = _arrays.indices("indices", indices)
            desc.indices, desc.index_count = corners.pointer, corners.numbers
            held.append(corners)
        return desc, held

    def _material(self, colour: Vector) -> int:
        if len(colour) not in (3, 4):
            raise UsageError(f"colour has {len(colour)} numbers; allowed are 3 or 4")
        desc, number = c.STANDARDS[c.lmn_material_desc](), ctypes.c_uint32()
        desc.colour = tuple(float(value) for value in (*colour, 1)[:4])
        call("lmn_scene_add_material", self, ctypes.byref(desc), ctypes.byref(number))
        return number.value

    @property
    def info(self) -> dict[str, Any]:
        """What is in it: parts, bounds, animations … (docs/reference/info.md)."""
        self._check()
        return dict(json.loads(take_text(lib.lmn_scene_info_json(self))))


class Look(Handle):
    """A look that ships, by its name, or a file's."""

    _end = "lmn_look_destroy"

    def __init__(self, name_or_path: Path, settings: Mapping[str, Any] | None = None) -> None:
        super().__init__()
        call("lmn_look_load", self._out, encode(name_or_path))
        for key, value in (settings or {}).items():
            self.set(key, value)

    def set(self, key: str, value: Any) -> None:
        """Sets a parameter: look.set("lines.width", "2px")."""
        self._check()
        if isinstance(value, bool):
            value = "true" if value else "false"
        elif isinstance(value, (list, tuple)):
            value = ",".join(str(item) for item in value)
        call("lmn_look_set", self, encode(key), encode(str(value)))

    @property
    def needs_pixels(self) -> bool:
        """Would vectors of it have a picture below the lines?"""
        self._check()
        return bool(lib.lmn_look_needs_pixels(self))


class Renderer(Handle):
    """What draws. Any thread may use it, one at a time; without one, draw() makes one for each thread."""

    _end = "lmn_renderer_destroy"

    def __init__(self) -> None:
        super().__init__()
        desc = c.STANDARDS[c.lmn_renderer_desc]()
        call("lmn_renderer_create", self._out, ctypes.byref(desc))


_own = threading.local()


def _own_renderer() -> Renderer:
    renderer: Renderer | None = getattr(_own, "renderer", None)
    if renderer is None:
        renderer = _own.renderer = Renderer()
    return renderer


class Drawing(Handle):
    """What pictures and sheets have in common."""

    _name = ""  # of their functions in C

    def save(self, path: Path) -> None:
        """Writes it into a file, whole or not at all; the ending is the format."""
        self._check()
        call(f"{self._name}_write", self, encode(path), None, None)

    @property
    def report(self) -> dict[str, Any]:
        """What was drawn (docs/reference/report.md)."""
        self._check()
        return dict(json.loads(take_text(getattr(lib, f"{self._name}_report_json")(self))))

    @property
    def warnings(self) -> list[str]:
        """What should be known, one text each."""
        self._check()
        count = getattr(lib, f"{self._name}_warning_count")(self)
        at = getattr(lib, f"{self._name}_warning_at")
        return [at(self, i, None, None).decode("utf-8", "replace") for i in range(count)]

    def _encoded(self, ending: str) -> bytes:
        self._check()
        data, size = ctypes.POINTER(ctypes.c_uint8)(), ctypes.c_size_t()
        call(f"{self._name}_encode", self, encode(ending), ctypes.byref(data), ctypes.byref(size))
        try:
            return ctypes.string_at(data, size.value)
        finally:
            lib.lmn_bytes_free(data)


class Picture(Drawing):
    """Pixels."""

    _end, _name = "lmn_drawing_destroy", "lmn_drawing"

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        self._check()
        width, height = ctypes.c_int(), ctypes.c_int()
        lib.lmn_drawing_pixels(self, ctypes.byref(width), ctypes.byref(height))
        return width.value, height.value

    @property
    def array(self) -> Any:
        """A copy of the pixels: rows from the top, each with red, green, blue and opacity (sRGB, straight) of its pixels, 8 bits each. A numpy array of
        height × width × 4, or without numpy a memoryview of this shape."""
        width, height = self.size
        pixels = bytearray(ctypes.string_at(lib.lmn_drawing_pixels(self, None, None), width * height * 4))
        try:
            import numpy
        except ImportError:
            return memoryview(pixels).cast("B", (height, width, 4))
        return numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 4)

    def png(self) -> bytes:
        """The picture as a PNG file."""
        return self._encoded(".png")

    def _repr_png_(self) -> bytes:
        return self.png()


class Sheet(Drawing):
    """Vectors; save() writes .svg, .pdf or .dxf."""

    _end, _name = "lmn_sheet_destroy", "lmn_sheet"

    def svg(self) -> str:
        """The sheet as an SVG document."""
        return self._encoded(".svg").decode()

    def _repr_svg_(self) -> str:
        return self.svg()


def _place(desc: c.lmn_draw_desc, scene: Scene, eye: Vector | None, target: Vector | None, up: Vector | None) -> None:
    """Where the viewer is; target and up that are not given come from the scene."""
    if eye is None:
        if target is not None or up is not None:
            raise UsageError("target and up go with eye", "say where the viewer is")
        return
    info = lib.lmn_scene_info_of(scene)
    if target is None:
        target = [(low + high) / 2 for low, high in zip(info.bounds_min, info.bounds_max)]
    if up is None:
        up = (0, 0, 1) if info.up == b"z" else (0, 1, 0)
    desc.eye_given = True
    for name, vector in (("eye", eye), ("target", target), ("up", up)):
        if len(vector) != 3:
            raise UsageError(f"{name} has {len(vector)} numbers; it has three: x, y, z")
        setattr(desc, name, tuple(float(number) for number in vector))


def _describe(scene: Scene, size: tuple[int, int], view: str, eye: Vector | None, target: Vector | None, up: Vector | None,
              camera: str | None, ortho: bool, fov: float, fit: float, time: float | None, clip: str | None, fit_time: bool, seed: int, samples: int,
              background: str | None, select: str | None, dpi: float, lenient: bool) -> c.lmn_draw_desc:
    desc: c.lmn_draw_desc = c.STANDARDS[c.lmn_draw_desc]()
    desc.width, desc.height = size
    best = view == "best" and eye is None and camera is None
    desc.view, desc.camera = c.LMN_VIEW_ISO if view == "best" else _choice("view", view, _VIEWS), encode(camera)
    _place(desc, scene, eye, target, up)
    desc.orthographic, desc.fov_deg, desc.fit = ortho, fov, fit
    desc.time_given, desc.time_s = time is not None, time or 0
    desc.clip, desc.fit_time = encode(clip), fit_time
    desc.seed, desc.samples, desc.dpi, desc.lenient = seed, samples, dpi, lenient
    desc.background, desc.select = encode(background), encode(select)
    if best:
        call("lmn_scene_best_view", scene, ctypes.byref(desc))
    return desc


def _scene_of(models: Scene | Path | Sequence[Path], up_axis: str | None, progress: Progress | None) -> Scene:
    if isinstance(models, Scene):
        models._check()
        return models
    paths = [models] if isinstance(models, (str, os.PathLike)) else list(models)
    if not paths:
        raise UsageError("no model is given")
    return Scene(*paths, up_axis=up_axis, progress=progress)


def _look_of(look: Look | Path, settings: Mapping[str, Any] | None) -> Look:
    if isinstance(look, Look):
        if settings:
            raise UsageError("settings go with the name of a look", "set them by Look.set")
        look._check()
        return look
    return Look(look, settings)


def draw(models: Scene | Path | Sequence[Path], look: Look | Path = "edges", size: tuple[int, int] = (1024, 1024), *,
         settings: Mapping[str, Any] | None = None, view: str = "iso", eye: Vector | None = None, target: Vector | None = None,
         up: Vector | None = None, camera: str | None = None, ortho: bool = False, fov: float = 30, fit: float = 0.9,
         time: float | None = None, clip: str | None = None, fit_time: bool = False, seed: int = 0, samples: int = 0,
         background: str | None = None, select: str | None = None, dpi: float = 0, up_axis: str | None = None, lenient: bool = False,
         renderer: Renderer | None = None, progress: Progress | None = None) -> Picture:
    """Draws models into a picture.

    The arguments are those of `limner draw` (docs/reference/draw.md); `settings` is what --set is there: {"lines.width": "2px"}.
    `progress` is called with the fraction done and what is done; when it gives False, drawing is cancelled.
    """
    scene, look = _scene_of(models, up_axis, progress), _look_of(look, settings)
    desc = _describe(scene, size, view, eye, target, up, camera, ortho, fov, fit, time, clip, fit_time, seed, samples, background, select, dpi, lenient)
    renderer = renderer or _own_renderer()
    renderer._check()
    picture = Picture()
    with Watch(progress) as watch:
        desc.progress = watch.function
        call("lmn_draw", picture._out, renderer, scene, look, ctypes.byref(desc))
    return picture


def draw_svg(models: Scene | Path | Sequence[Path], look: Look | Path = "technical", size: tuple[int, int] = (1024, 1024), *,
             settings: Mapping[str, Any] | None = None, page: str | None = None, scale: str | None = None, unit: str | None = None,
             views: str | None = None, angle: str = "third", title: str | None = None, frame: bool = False, plotter: bool = False,
             lines_only: bool = False, fill: bool = False, smooth: float = 0.02, line_group: float = 0, centre_lines: bool = False,
             sections: str | None = None, details: str | None = None, auxiliary: str | None = None, fields: str | None = None, loose_hatch: bool = False, threads: str | None = None, view: str = "iso", eye: Vector | None = None, target: Vector | None = None,
             up: Vector | None = None, camera: str | None = None, ortho: bool = False, fov: float = 30, fit: float = 0.9,
             time: float | None = None, clip: str | None = None, fit_time: bool = False, seed: int = 0, samples: int = 0,
             background: str | None = None, select: str | None = None, dpi: float = 0, up_axis: str | None = None,
             lenient: bool = False, renderer: Renderer | None = None, progress: Progress | None = None) -> Sheet:
    """Draws models as vectors (docs/VECTOR.md, docs/DRAFTING.md): lines with exact visibility, for SVG, PDF and, with lines_only, DXF."""
    scene, look = _scene_of(models, up_axis, progress), _look_of(look, settings)
    desc = _describe(scene, size, view, eye, target, up, camera, ortho, fov, fit, time, clip, fit_time, seed, samples, background, select, dpi, lenient)
    paper = c.STANDARDS[c.lmn_sheet_desc]()
    paper.page, paper.scale, paper.unit, paper.views, paper.title = (encode(text) for text in (page, scale, unit, views, title))
    paper.angle = _choice("angle", angle, _ANGLES)
    paper.frame, paper.plotter, paper.lines_only, paper.fill, paper.smooth = frame, plotter, lines_only, fill, smooth
    paper.line_group, paper.centre_lines, paper.loose_hatch = line_group, centre_lines, loose_hatch
    paper.sections, paper.details, paper.auxiliary, paper.fields, paper.threads = (encode(text) for text in (sections, details, auxiliary, fields, threads))
    if renderer is None and look.needs_pixels and not (lines_only or plotter or fill):
        renderer = _own_renderer()
    sheet = Sheet()
    with Watch(progress) as watch:
        desc.progress = watch.function
        call("lmn_draw_sheet", sheet._out, renderer, scene, look, ctypes.byref(desc), ctypes.byref(paper))
    return sheet


from ._behaviour import Behaviour, Dynamics  # noqa: E402  (it needs Scene)
