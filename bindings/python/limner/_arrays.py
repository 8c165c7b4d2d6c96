"""Numbers of callers as C arrays: NumPy arrays and other buffers without copying where they are already what C takes, anything else by copying."""
from __future__ import annotations

import array
import ctypes
from typing import Any

from ._library import UsageError

_FLOAT, _UINT32 = "f", "I"
_TYPES: dict[str, Any] = {_FLOAT: ctypes.c_float, _UINT32: ctypes.c_uint32}


class Rows:
    """Rows of numbers of one type. `pointer` is what C takes; it is valid while this is there."""

    def __init__(self, pointer: Any, count: int, columns: int, owner: Any) -> None:
        self.pointer, self.count, self.columns, self._owner = pointer, count, columns, owner

    @property
    def numbers(self) -> int:
        """How many numbers there are in all."""
        return self.count * self.columns


def _flat(values: Any) -> list[Any]:
    """The numbers of sequences in sequences."""
    if isinstance(values, memoryview):
        values = values.tolist()
    if hasattr(values, "tolist"):
        values = values.tolist()
    out: list[Any] = []
    for value in values:
        if hasattr(value, "__iter__") or hasattr(value, "tolist"):
            out.extend(_flat(value) if hasattr(value, "__iter__") else [value.tolist()])
        else:
            out.append(value)
    return out


def _copied(name: str, values: Any, code: str) -> array.array[Any]:
    try:
        return array.array(code, _flat(values))
    except (TypeError, ValueError, OverflowError) as error:
        kind = "numbers" if code == _FLOAT else "whole numbers from 0 on"
        raise UsageError(f"{name} holds something else than {kind}: {error}") from None


def _columns_of(values: Any) -> int | None:
    """How long a row is, where the values say it."""
    shape = getattr(values, "shape", None)
    if shape is not None:
        return int(shape[1]) if len(shape) == 2 else None
    try:
        return len(values[0])
    except (TypeError, IndexError, KeyError):
        return None


def _address(view: memoryview, code: str) -> Any:
    """A pointer into the buffer; None where only a copy can be had."""
    if view.readonly:
        return None
    kind = _TYPES[code]
    return (kind * (view.nbytes // ctypes.sizeof(kind))).from_buffer(view.cast("B"))


def rows(name: str, values: Any, code: str, allowed: tuple[int, ...]) -> Rows:
    """`values` as rows of so many numbers: of an array with two dimensions as it is, of one with one dimension allowed[0] numbers each."""
    columns = _columns_of(values) or allowed[0]
    if columns not in allowed:
        raise UsageError(f"{name} has {columns} numbers a row; allowed are {' or '.join(str(count) for count in allowed)}")
    held: Any = None
    try:
        view = memoryview(values)
    except TypeError:
        view = None
    # L is as large as I on some machines, and then NumPy may call it so.
    if view is not None and view.c_contiguous and view.nbytes and view.format in (code, "L" if code == _UINT32 else code) and view.itemsize == 4:
        held = _address(view, code)
    elif view is not None and hasattr(values, "astype") and getattr(values, "dtype", None) is not None:
        if code == _UINT32 and (values.dtype.kind not in "iu" or (values.size and int(values.min()) < 0)):
            raise UsageError(f"{name} holds something else than whole numbers from 0 on")
        fresh = values.astype("=f4" if code == _FLOAT else "=u4", order="C")
        held = _address(memoryview(fresh), code) if fresh.size else None
    if held is None:
        numbers = _copied(name, values, code)
        held = (_TYPES[code] * len(numbers)).from_buffer(numbers) if len(numbers) else (_TYPES[code] * 0)()
    if len(held) % columns:
        raise UsageError(f"{name} has {len(held)} numbers, which are no rows of {columns}")
    return Rows(ctypes.cast(held, ctypes.POINTER(_TYPES[code])), len(held) // columns, columns, held)


def floats(name: str, values: Any, *allowed: int) -> Rows:
    """Numbers with a fraction."""
    return rows(name, values, _FLOAT, allowed)


def indices(name: str, values: Any) -> Rows:
    """Numbers of vertices, three a triangle."""
    return rows(name, values, _UINT32, (3,))


def colours(values: Any, count: int) -> Rows:
    """Red, green, blue and perhaps opacity of each vertex: 0 … 1, or bytes 0 … 255."""
    item = getattr(getattr(values, "dtype", None), "itemsize", 0) or (memoryview(values).itemsize if isinstance(values, (bytes, bytearray, memoryview)) else 0)
    allowed = (4, 3) if not count or _columns_of(values) else ((3,) if len(values) == 3 * count else (4,))
    if item != 1:
        given = floats("colours", values, *allowed)
        if given.columns == 4:
            return given
        numbers = [given.pointer[i] for i in range(given.numbers)]
    else:
        columns = _columns_of(values) or allowed[0]
        numbers, given = [value / 255 for value in _flat(values)], Rows(None, 0, columns, None)
    step, out = given.columns, array.array(_FLOAT)
    if step not in (3, 4) or len(numbers) % step:
        raise UsageError(f"colours have {step} numbers a row; allowed are 3 or 4")
    for i in range(0, len(numbers), step):
        out.extend([*numbers[i:i + 3], numbers[i + 3] if step == 4 else 1])
    return floats("colours", out, 4)
