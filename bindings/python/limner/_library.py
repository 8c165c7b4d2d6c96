"""The shared library: where it is, its functions with their types, and its errors as exceptions."""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import pathlib
from typing import Any, Callable, Optional

from . import _declarations as c

Progress = Callable[[float, str], Optional[bool]]


class Error(Exception):
    """What Limner says went wrong. `hint` tells what to do about it; `file`, `line` and `column` where it is, when that is known."""

    def __init__(self, message: str, hint: str = "", file: str = "", line: int = 0, column: int = 0) -> None:
        super().__init__(message)
        self.message, self.hint, self.file, self.line, self.column = message, hint, file, line, column

    def __str__(self) -> str:
        place = ":".join([self.file, *(str(n) for n in (self.line, self.column) if n)]) + ": " if self.file else ""
        return f"{place}{self.message}" + (f" ({self.hint})" if self.hint else "")


class UsageError(Error, ValueError):
    """An argument is wrong."""


class ReadError(Error, OSError):
    """A file is missing or cannot be read."""

    __str__ = Error.__str__


class FormatError(Error, ValueError):
    """A file's content is wrong."""


class LimitError(Error):
    """A limit for files from strangers is exceeded."""


class UnsupportedError(Error):
    """What is asked for is valid, and this build cannot do it."""


class WriteError(Error, OSError):
    """An output cannot be written."""

    __str__ = Error.__str__


class GLError(Error):
    """There is no usable OpenGL, or the driver failed."""


class OutOfMemoryError(Error, MemoryError):
    """Memory is gone."""


class CancelledError(Error):
    """The progress function asked to stop."""


class InternalError(Error):
    """A defect of Limner itself."""


_KINDS: dict[int, type[Error]] = {
    c.LMN_USAGE: UsageError, c.LMN_READ: ReadError, c.LMN_FORMAT: FormatError, c.LMN_LIMIT: LimitError,
    c.LMN_UNSUPPORTED: UnsupportedError, c.LMN_WRITE: WriteError, c.LMN_GL: GLError, c.LMN_MEMORY: OutOfMemoryError,
    c.LMN_CANCELLED: CancelledError,
}


def _candidates() -> list[str]:
    """Places of the library: what LIMNER_LIBRARY says and nothing else, or the package, its prefix, the system."""
    given = os.environ.get("LIMNER_LIBRARY")
    if given:
        return [given]
    here = pathlib.Path(__file__).resolve().parent
    found = [str(here / "liblimner.so.1")]
    # PREFIX/lib/python3/…/limner: the library is below PREFIX/lib.
    found += [str(folder / "liblimner.so.1") for folder in here.parents if folder.name in ("lib", "lib64")]
    found.append("liblimner.so.1")
    return found


def _load() -> ctypes.CDLL:
    candidates, reasons = _candidates(), []
    for path in candidates:
        if "/" in path and not os.path.exists(path):
            reasons.append(f"there is no {path}")
            continue
        try:
            library = ctypes.CDLL(path)
            break
        except OSError as error:
            reasons.append(str(error))
    else:
        raise ImportError("the library liblimner.so.1 was not found: " + "; ".join(reasons) +
                          "; install Limner, or say with LIMNER_LIBRARY where it is")
    for name, (result, arguments) in c.FUNCTIONS.items():
        try:
            function = getattr(library, name)
        except AttributeError:
            raise ImportError(f"{library._name} has no {name}: it is older than this package ({c.VERSION})") from None
        function.restype, function.argtypes = result, arguments
    version = library.lmn_version().decode()
    if version.split(".")[:2] != c.VERSION.split(".")[:2]:
        raise ImportError(f"{library._name} is of version {version}, and this package is for {c.VERSION}")
    return library


lib = _load()


def call(name: str, *arguments: Any) -> None:
    """Calls a function whose last parameter is an error, and raises that."""
    error = c.lmn_error()
    status = getattr(lib, name)(*arguments, ctypes.byref(error))
    if status == c.LMN_OK:
        return
    text = [part.decode("utf-8", "replace") for part in (error.message, error.hint, error.file)]
    if not text[0]:
        text[0] = lib.lmn_status_text(status).decode()
    raise _KINDS.get(status, InternalError)(text[0], text[1], text[2], error.line, error.column)


def take_text(address: int | None) -> str:
    """Text that the library gave away, which is freed."""
    if not address:
        raise OutOfMemoryError("out of memory")
    try:
        return ctypes.string_at(address).decode("utf-8", "replace")
    finally:
        lib.lmn_text_free(address)


def encode(text: Any) -> bytes | None:
    """Text or a path for C."""
    return None if text is None else os.fsencode(text)


class Handle:
    """Something that the library made, and that ends with its owner."""

    _end = ""

    def __init__(self) -> None:
        self._as_parameter_ = ctypes.c_void_p()

    @property
    def _out(self) -> Any:
        return ctypes.byref(self._as_parameter_)

    def close(self) -> None:
        """Frees it now; nothing else can be done with it then."""
        if self._as_parameter_:
            getattr(lib, self._end)(self._out)

    def __del__(self) -> None:
        if getattr(self, "_as_parameter_", None):
            self.close()

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _check(self) -> None:
        if not self._as_parameter_:
            raise ValueError(f"this {type(self).__name__} is closed")


class Watch:
    """Hands progress to a Python function, and brings its exceptions (Ctrl-C too) back out of the library."""

    def __init__(self, progress: Progress | None) -> None:
        self._raised: BaseException | None = None
        self._progress = progress
        self.function = c.lmn_progress_fn(self._report)

    def _report(self, fraction: float, stage: bytes | None, _user: object) -> bool:
        try:
            if self._raised is not None:
                return False
            return self._progress is None or self._progress(fraction, (stage or b"").decode("utf-8", "replace")) is not False
        except BaseException as error:  # it must not pass through C; it goes on behind the call
            self._raised = error
            return False

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, _kind: object, error: BaseException | None, _trace: object) -> None:
        if self._raised is not None and (error is None or isinstance(error, CancelledError)):
            raise self._raised from None
