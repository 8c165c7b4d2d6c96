"""What happens in a scene, made and told of: limner/behaviour.h."""
from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Union

from . import _declarations as c
from ._library import Handle, UsageError, call, encode, lib

if TYPE_CHECKING:
    from . import Scene

Vector = Sequence[float]
Child = Union[int, Sequence[float]]


def _words(prefix: str) -> dict[str, int]:
    return {name.removeprefix(prefix).lower(): value for name, value in vars(c).items() if name.startswith(prefix)}


_KINDS, _FITS, _MAPS = _words("LMN_ACTIVITY_"), _words("LMN_FIT_"), _words("LMN_TIME_MAP_")
_PROPERTIES, _CURVES = _words("LMN_PROPERTY_"), _words("LMN_CURVE_")
_NUMBERS = {"translation": 3, "rotation": 4, "scale": 3, "camera_fov": 1, "camera_half_height": 1, "light_colour": 3, "light_intensity": 1}
_VECTORS = {"start", "velocity", "gravity", "amplitude", "offset", "forward", "up"}
_SINGLE = {"floor_height", "restitution", "frequency", "phase", "rate_deg", "phase_deg", "delay_s"}


def _choice(what: str, word: str, allowed: dict[str, int]) -> int:
    if word not in allowed:
        raise UsageError(f"{what} is {word!r}; allowed are {', '.join(allowed)}")
    return allowed[word]


def _vector(what: str, values: Vector) -> Any:
    if len(values) != 3:
        raise UsageError(f"{what} has {len(values)} numbers; it has three")
    return (ctypes.c_double * 3)(*values)


def _flat(values: Any) -> list[float]:
    """Numbers, or rows of them, one behind the other."""
    if isinstance(values, (int, float)):
        return [float(values)]
    flat: list[float] = []
    for value in values:
        flat += [float(value)] if isinstance(value, (int, float)) else _flat(value)
    return flat


class Behaviour:
    """Makes what happens in a scene: activities in groups, constraints that drive properties. Activities are numbers.

    Example:
        b = limner.Behaviour(scene)
        fall = b.constrain(ball, "bounce", floor_height=0.5, duration=4)
        b.play(b.sequence(fall, b.reverse(fall)))
        limner.draw(scene, time=1.5)
    """

    def __init__(self, scene: Scene) -> None:
        scene._check()
        self._scene = scene
        self._held: dict[int, Any] = getattr(scene, "_functions", {})  # functions live as long as the scene
        scene._functions = self._held  # type: ignore[attr-defined]
        self._raised: BaseException | None = None

    def sequence(self, *children: int, name: str | None = None, duration: float = 0) -> int:
        """One after the other."""
        return self._group("sequence", children, name, duration)

    def together(self, *children: int, fit: str = "start", name: str | None = None, duration: float = 0) -> int:
        """All at once; fit: what shorter ones do, "start", "centre", "end", "stretch", or "shrink": all last as long as the shortest."""
        return self._group("simultaneity", children, name, duration, fit=_choice("fit", fit, _FITS))

    def table(self, *rows: Child, name: str | None = None, duration: float = 0) -> int:
        """Each at its own time; a row is (activity, start) or (activity, start, duration)."""
        return self._group("table", rows, name, duration)

    def reverse(self, child: int, *, name: str | None = None, duration: float = 0) -> int:
        """From the end to the begin."""
        return self._group("reverse", (child,), name, duration)

    def repeat(self, child: int, times: int, *, name: str | None = None, duration: float = 0) -> int:
        """So many times."""
        return self._group("repeat", (child,), name, duration, times=times)

    def creep(self, child: int, exponent: float = 2, *, name: str | None = None, duration: float = 0) -> int:
        """Slow at first, fast at last."""
        return self._group("creep", (child,), name, duration, exponent=exponent)

    def clip(self, clip: str | int, *, name: str | None = None, duration: float = 0) -> int:
        """An animation of the scene, by name or number from 1 on."""
        return self._group("clip", (), name, duration, clip=encode(str(clip)))

    def event(self, name: str, node: int = 0) -> int:
        """Something that happens, without duration."""
        return self._group("event", (), name, 0, node=node)

    def constrain(self, node: int, map: str, *, property: str = "translation", values: Any = None, times: Sequence[float] | None = None,
                  function: Callable[[float], Any] | None = None, about: Vector | None = None, axis: Vector | None = None, curve: str = "catmull_rom",
                  closed: bool = False, by_length: bool = False, follows: int = 0, name: str | None = None, duration: float = 0, **more: Any) -> int:
        """A map of time drives a property of a node.

        map: constant, linear, curve, tangent, fall, bounce, oscillate, spin, follow, callback; property: translation, rotation, scale, weights, camera_fov,
        camera_half_height, light_colour, light_intensity; values: a value or rows of them; function: of a callback, seconds to a value; about: the axis that
        a rotation's angles are about; more: start, velocity, gravity, amplitude, offset, forward, up (three numbers each), floor_height, restitution,
        frequency, phase, rate_deg, phase_deg, delay_s, as limner/behaviour.h has them.
        """
        self._scene._check()
        desc = c.STANDARDS[c.lmn_constraint_desc]()
        desc.node, desc.map, desc.property = node, _choice("map", map, _MAPS), _choice("property", property, _PROPERTIES)
        desc.curve, desc.closed, desc.by_length = _choice("curve", curve, _CURVES), closed, by_length
        desc.name, desc.duration_s, desc.follows = encode(name), duration, follows
        if about is not None or axis is not None:
            desc.about_axis, desc.axis = about is not None, _vector("axis", about if about is not None else axis or ())
        for word, value in more.items():
            if word in _VECTORS:
                setattr(desc, word, _vector(word, value))
            elif word in _SINGLE:
                setattr(desc, word, value)
            else:
                raise UsageError(f"{word!r} is no word of a constraint; there are {', '.join(sorted(_VECTORS | _SINGLE))}")
        desc.start_given = "start" in more
        flat = [] if values is None else _flat(values)
        at = (ctypes.c_double * len(flat))(*flat)
        numbers = 1 if about is not None else 3 if map == "tangent" else _NUMBERS.get(property, 0)
        desc.values, desc.value_count = at, self._count(flat, numbers, values, times)
        seconds = (ctypes.c_double * len(times))(*times) if times is not None else None
        desc.times_s = seconds
        asked = self._callback(function, numbers, property) if function is not None else None
        if asked is not None:
            desc.function = asked
        number = self._add("lmn_behaviour_add_constraint", desc)
        if asked is not None:
            self._held[number] = asked
        return number

    @staticmethod
    def _count(flat: list[float], numbers: int, values: Any, times: Sequence[float] | None) -> int:
        """How many values these numbers are."""
        if not flat:
            return 0
        numbers = numbers or (len(flat) // len(values) if hasattr(values[0], "__len__") else len(flat))  # weights
        if len(flat) % numbers:
            raise UsageError(f"there are {len(flat)} numbers, and a value has {numbers}")
        if times is not None and len(times) != len(flat) // numbers:
            raise UsageError(f"there are {len(times)} times for {len(flat) // numbers} values")
        return len(flat) // numbers

    def _callback(self, function: Callable[[float], Any], numbers: int, property: str) -> Any:
        if not numbers:
            raise UsageError(f"functions cannot drive {property}")

        def ask(seconds: float, out: Any, _user: object) -> None:
            try:
                values = _flat(function(seconds))
                if len(values) != numbers:
                    raise UsageError(f"the function gives {len(values)} numbers, and a value has {numbers}")
            except BaseException as error:  # it must not pass through C; it goes on behind the call
                self._raised = self._raised or error
                values = [math.nan] * numbers  # which ends the call
            for k, value in enumerate(values):
                out[k] = value

        return c.lmn_behaviour_fn(ask)

    def play(self, *activities: int) -> None:
        """Says which begin at 0: from now on drawings of a time show it."""
        self._scene._check()
        self._call("lmn_behaviour_play", self._scene, (ctypes.c_uint32 * len(activities))(*activities), len(activities))

    def stop(self) -> None:
        """Takes back what `play`, or a script, has said: nothing of it plays any longer."""
        self._scene._check()
        self._call("lmn_behaviour_stop", self._scene)

    def _group(self, kind: str, children: Sequence[Child], name: str | None, duration: float, **more: Any) -> int:
        self._scene._check()
        desc = c.STANDARDS[c.lmn_activity_desc]()
        rows = (c.lmn_activity_child * len(children))()
        for row, child in zip(rows, children):
            whole = (child,) if isinstance(child, int) else tuple(child)
            row.activity, row.start_s, row.duration_s = int(whole[0]), *(float(v) for v in (*whole[1:3], 0, 0)[:2])
        desc.kind, desc.name, desc.duration_s, desc.children, desc.child_count = _KINDS[kind], encode(name), duration, rows, len(children)
        for word, value in more.items():
            setattr(desc, word, value)
        return self._add("lmn_behaviour_add", desc)

    def _add(self, function: str, desc: Any) -> int:
        number = ctypes.c_uint32()
        self._call(function, self._scene, ctypes.byref(desc), ctypes.byref(number))
        return number.value

    def _call(self, function: str, *arguments: Any) -> None:
        self._raised = None
        try:
            call(function, *arguments)
        except UsageError:
            if self._raised is not None:
                raise self._raised from None
            raise


class Dynamics(Handle):
    """What happens in a scene, laid out in time. The scene must neither change nor be closed before it."""

    _end = "lmn_dynamics_destroy"

    def __init__(self, scene: Scene, clips: str | None = None) -> None:
        super().__init__()
        scene._check()
        self._scene = scene
        call("lmn_dynamics_create", scene, encode(clips), self._out)

    @property
    def duration(self) -> float:
        """Seconds."""
        self._check()
        return float(lib.lmn_dynamics_duration(self))

    @property
    def lifetimes(self) -> list[dict[str, Any]]:
        """What drives what, when: activity, is_event, node, property, from_s, to_s, open_from, open_to."""
        self._check()
        found: list[dict[str, Any]] = []
        one = c.lmn_lifetime()
        while lib.lmn_dynamics_lifetime_at(self, len(found), ctypes.byref(one)):
            row = {field: getattr(one, field) for field, _ in one._fields_}
            names = [word for word, value in _PROPERTIES.items() if value == one.property]
            row["property"] = None if one.is_event else names[0]
            found.append(row)
        return found

    def point(self, node: int, time: float, point: Vector = (0, 0, 0)) -> dict[str, Any]:
        """Where a point of a node's axes is: position, velocity, acceleration."""
        self._check()
        state = c.lmn_point_state()
        call("lmn_dynamics_point", self, node, _vector("point", point), time, ctypes.byref(state))
        return self._row(state)

    def trajectory(self, node: int, start: float, end: float, tolerance: float, point: Vector = (0, 0, 0)) -> list[dict[str, Any]]:
        """Its way, as states whose straight lines are nowhere farther than the tolerance from it."""
        return self._listed(c.lmn_point_state, "lmn_dynamics_trajectory", node, _vector("point", point), start, end, tolerance)

    def contacts(self, node: int, start: float, end: float, least: float = 0) -> list[dict[str, Any]]:
        """Where it meets something: time_s, place, normal, impulse, other (a node; 0: nothing is near), distance."""
        return self._listed(c.lmn_contact, "lmn_dynamics_contacts", node, start, end, least)

    def _listed(self, kind: Any, function: str, *arguments: Any) -> list[dict[str, Any]]:
        self._check()
        count, room = ctypes.c_size_t(), (kind * 64)()
        call(function, self, *arguments, room, len(room), ctypes.byref(count))
        if count.value > len(room):
            room = (kind * count.value)()
            call(function, self, *arguments, room, len(room), ctypes.byref(count))
        return [self._row(row) for row in room[:count.value]]

    @staticmethod
    def _row(row: Any) -> dict[str, Any]:
        return {field: list(value) if hasattr(value, "__len__") else value for field, value in ((field, getattr(row, field)) for field, _ in row._fields_)}
