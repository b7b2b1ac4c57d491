# SPDX-License-Identifier: MIT
"""Lens flare of real lenses on NumPy pictures, without a GPU.

    import glint
    glint.overlay(picture, lens="heliar-tronnier")        uint8 [height, width, 3], in place
    light = glint.render("nikon-zoom-mid", (540, 960), [glint.Lamp(12, 33)])     float32
    model = glint.bake("heliar-tronnier")                 the bytes of a model file

Pictures are drawn on where they lie; rows may have padding. Functions let go of Python's lock while
they draw. Errors of lenses and arguments are ValueError, with the text that the command would say.
"""
from __future__ import annotations

import inspect
import os
import pathlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Callable, Dict, List, Optional, Sequence, Tuple, Union, get_type_hints

import numpy as np

from ._engine import ffi as _ffi, lib as _lib
from ._options import DEFAULTS as _DEFAULTS, Options

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Engine", "EngineOptions", "Lamp", "Options", "Report", "bake", "lenses", "overlay", "render"]
__version__ = "0.1.0"

MOST_LAMPS = 1024
_HERE = pathlib.Path(__file__).resolve().parent


@dataclass
class Lamp:
    """A lamp at infinity: degrees off the axis and about it (0 right, 90 up), and the light that its image
    would have over one pixel, 1 = display white."""

    theta: float
    phi: float
    power: float = 65536.0
    rgb: Tuple[float, float, float] = (1.0, 1.0, 1.0)
    axis: Tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0


@dataclass
class Report:
    """What was drawn: the lamps, how many lights these became, ghosts, bytes that drawing took, the factor on the
    lamps' powers."""

    lamps: List[Lamp]
    lights: int
    ghosts: int
    bytes: int
    scale: float


def _check(status: int, error=None) -> None:
    if status == _lib.GLINT_OK:
        return
    text = _ffi.string(error.text).decode() if error is not None else ""
    text = text or _ffi.string(_lib.glint_status_text(status)).decode()
    raise MemoryError(text) if status == _lib.GLINT_E_MEMORY else ValueError(text)


# ---------------------------------------------------------------------- lenses


def _folders() -> List[pathlib.Path]:
    given = os.environ.get("GLINT_LENSES")
    return ([pathlib.Path(given)] if given else []) + [_HERE / "lenses", pathlib.Path("/usr/share/glint/lenses")]


def lenses() -> List[str]:
    """Names of the lenses that there are."""
    return sorted({table.stem for folder in _folders() for table in folder.rglob("*.lens")})


def _table(lens: str) -> pathlib.Path:
    path = pathlib.Path(lens)
    if "/" in lens or path.suffix == ".lens":
        return path
    for folder in _folders():
        for table in [folder / f"{lens}.lens", *sorted(folder.glob(f"*/{lens}.lens"))]:
            if table.is_file():
                return table
    raise ValueError(f"no lens '{lens}'; there are {', '.join(lenses())}")


def _prescription(lens: str, coating: str, f_number: float = 0.0):
    path = _table(lens)
    text = path.read_bytes()
    table, error = _ffi.new("struct glint_prescription *"), _ffi.new("struct glint_error *")
    _check(_lib.glint_prescription_parse(table, text, len(text), str(path).encode(), error), error)
    if coating == "mixed":
        _lib.glint_coat_mixed_(table)
    elif coating != "table":
        coatings, n = _ffi.new("struct glint_coating[]", _lib.GLINT_MAX_COATINGS), _ffi.new("int *")
        _check(_lib.glint_coatings_parse_(coatings, n, coating.encode(), error), error)
        _lib.glint_coat_(table, coatings, n[0])
    if 0 < f_number < table.f_number:  # a model serves all stops narrower than its own
        _check(_lib.glint_prescription_set_f_number(table, f_number, error), error)
    return table


class _Pool:
    """Threads, which change no result."""

    def __init__(self, threads: int) -> None:
        at = _ffi.new("struct glint_workers **")
        _check(_lib.glint_pool_create(at, threads))
        self.workers = _ffi.gc(at[0], _lib.glint_pool_destroy)


def _bake(table, options) -> bytes:
    model, size, error = _ffi.new("unsigned char **"), _ffi.new("size_t *"), _ffi.new("struct glint_error *")
    report = _ffi.new("struct glint_bake_report *")
    _check(_lib.glint_bake(table, options, model, size, report, error), error)
    try:
        return bytes(_ffi.buffer(model[0], size[0]))
    finally:
        _lib.free(model[0])


def bake(lens: str, *, coating: str = "mixed", tolerance: float = 1.0, threads: int = 0) -> bytes:
    """The model of LENS, a name or a .lens file: that of glint bake without the note at its end. Takes seconds to minutes for narrow
    stops, minutes to an hour for wide ones, and hours for anamorphic lenses. COATING as of --coating: mixed, table, none or a list."""
    pool, options = _Pool(threads), _ffi.new("struct glint_bake_options *")
    _lib.glint_bake_defaults(options)
    options.tolerance, options.workers = tolerance, pool.workers
    return _bake(_prescription(lens, coating), options)


def _cache() -> pathlib.Path:
    return pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "glint"


def _cached(lens: str, coating: str, f_number: float, pool: _Pool) -> bytes:
    """The model of LENS from glint's own cache, or baked and kept there."""
    table, options = _prescription(lens, coating, f_number), _ffi.new("struct glint_bake_options *")
    _lib.glint_bake_defaults(options)
    options.workers = pool.workers
    name = _ffi.string(table.name).decode()
    path = _cache() / f"{name}-{_lib.glint_bake_key(table, options):016x}.glint"
    if path.is_file():
        return path.read_bytes()
    model = _bake(table, options)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_suffix(f".{os.getpid()}.part")
        part.write_bytes(model)
        part.replace(path)
    except OSError:
        pass  # is baked again next time
    return model


# --------------------------------------------------------------------- options

_Stop = Union[str, Tuple[int, float], None]


class EngineOptions(Options, total=False):
    """Keyword arguments of Engine but exposure."""

    stop: _Stop
    rotation: float
    threads: int


def _options(values: Dict[str, object]):
    """Returns struct glint_options with VALUES, and the texts that it points to. None or "": the default."""
    options, error, texts = _ffi.new("struct glint_options *"), _ffi.new("struct glint_error *"), []
    _lib.glint_options_defaults(options)
    for key, value in values.items():
        name = key.replace("_", "-").encode()
        if value is None or value == "":
            continue
        if isinstance(value, str):
            texts.append(_ffi.new("char[]", value.encode()))
            status = _lib.glint_options_set_text(options, name, texts[-1], error)
        else:
            status = _lib.glint_options_set(options, name, value, error)
        if status != _lib.GLINT_OK:
            raise ValueError(f"{key} is {_ffi.string(error.text).decode()}, not {value}")
    if options.rays:
        raise ValueError("exact rays need the command: glint overlay --rays exact")
    return options, texts


def _shown(function: Callable[..., object], more: List[inspect.Parameter]) -> None:
    """Adds MORE keyword arguments to the signature of FUNCTION that help() prints, in place of **options."""
    own = inspect.signature(function)
    kept = [p for p in own.parameters.values() if p.kind is not p.VAR_KEYWORD]
    setattr(function, "__signature__", own.replace(parameters=kept + [p for p in more if p.name not in own.parameters]))


# --------------------------------------------------------------------- drawing


class Engine:
    """Draws the flares of one lens on pictures of one size.

    lens      a name, a .lens or .glint file, or the bytes of a model
    stop      as --stop, or blades and roundness, 0 blades a circle; None: (8, 0.2), or the circle of the table
    rotation  degrees of the first corner of such blades
    exposure  stops, instead of strength: 0 is physical
    threads   0: one a processor
    Others are the options of glint overlay of the same names, with their ranges and defaults (class Options): numbers,
    or texts as on the command line. None: the default.
    """

    def __init__(self, lens: Union[str, bytes], height: int, width: int, *, stop: _Stop = None, rotation: float = 0.0,
                 exposure: Optional[float] = None, threads: int = 0, **options: Unpack[Options]) -> None:
        self._engine = None
        for key in options.keys() - _DEFAULTS.keys():
            raise TypeError(f"there is no keyword argument {key}")
        if options.get("f_number") == 0:
            options["f_number"] = None
        stop = stop or None
        set_, texts = _options({**options, "exposure": exposure, "stop": stop if isinstance(stop, str) else None})
        coating, f_number = _ffi.string(set_.coating).decode(), set_.f_number
        self._pool = _Pool(threads)
        if stop is None:
            is_circle = isinstance(lens, str) and not lens.endswith(".glint") and _prescription(lens, coating).stop_is_circle
            stop = (0, 0.0) if is_circle else (8, 0.2)
        if isinstance(lens, str):
            lens = pathlib.Path(lens).read_bytes() if lens.endswith(".glint") else _cached(lens, coating, f_number, self._pool)
        # words of 32 bits: memory of C is aligned, that of bytes need not be
        self._model = _ffi.new("uint32_t[]", (len(lens) + 3) // 4)
        _ffi.memmove(self._model, lens, len(lens))
        self._lens, reason = _ffi.new("struct glint_lens *"), _ffi.new("const char **")
        if _lib.glint_lens_open(self._lens, self._model, len(lens), reason) != _lib.GLINT_OK:
            raise ValueError("not a model: " + _ffi.string(reason[0]).decode())
        cfg, error = _ffi.new("struct glint_engine_config *"), _ffi.new("struct glint_error *")
        _lib.glint_engine_defaults(cfg, width, height)
        cfg.model, cfg.workers, cfg.sets = self._lens, self._pool.workers, _lib.glint_system_sets()
        if not isinstance(stop, str):
            cfg.camera.n_blades, cfg.camera.iris.roundness, cfg.camera.blade_rotation_deg = stop[0], stop[1], rotation
        _lib.glint_engine_configure(cfg, set_)
        at = _ffi.new("struct glint_engine **")
        _check(_lib.glint_engine_create(at, cfg, error), error)
        self._engine = _ffi.gc(at[0], _lib.glint_engine_destroy)
        film = _ffi.new("double[2]")
        _lib.glint_film_mm_(self._lens, film)
        if cfg.camera.sensor_width_mm > 0:
            film[0], film[1] = cfg.camera.sensor_width_mm, cfg.camera.sensor_height_mm
        self._view = _ffi.new("struct glint_view *", _lib.glint_view_fit(width, height, film[0], film[1]))
        self._focal_mm = _lib.glint_focal_mm_(self._lens)
        self.height, self.width = height, width
        self._lamps = _ffi.new("struct glint_engine_lamp[]", MOST_LAMPS)

    def set(self, **options: float) -> None:
        """Changes options of the pictures to come: strength or exposure, of which the last one counts, gain,
        starburst, f_number. ValueError: an option that is fixed, or a value out of its range."""
        error = _ffi.new("struct glint_error *")
        for name, value in options.items():
            _check(_lib.glint_engine_set(self._engine, name.replace("_", "-").encode(), value, error), error)

    def _image(self, array: np.ndarray, kind: int, channels: int, item: int):
        if array.shape[:2] != (self.height, self.width):
            raise ValueError(f"a picture of {array.shape[1]}x{array.shape[0]}, and the engine is for "
                             f"{self.width}x{self.height}")
        if not array.flags.writeable:
            raise ValueError("the array is read-only")
        if array.strides[1] != channels * item or (channels > 1 and array.strides[2] != item):
            raise ValueError("pixels of a row have to lie side by side: numpy.ascontiguousarray() copies")
        image = _ffi.new("struct glint_image *")
        image.format, image.width, image.height = kind, self.width, self.height
        image.plane[0] = _ffi.cast("uint8_t *", array.__array_interface__["data"][0])
        image.stride_bytes[0] = array.strides[0]
        return image

    def _codes(self, array: np.ndarray, order: str):
        kinds = {("RGB", 3): _lib.GLINT_RGB24, ("BGR", 3): _lib.GLINT_BGR24, ("BGR", 4): _lib.GLINT_XRGB8888}
        channels = array.shape[2] if array.ndim == 3 else 1
        kind = _lib.GLINT_GREY if array.ndim == 2 else kinds.get((order, channels))
        if array.dtype != np.uint8 or array.ndim not in (2, 3) or kind is None:
            raise ValueError(f"takes uint8 [height, width], [height, width, 3] in RGB or BGR, or [height, width, 4] "
                             f"in BGR with order='BGR', not {array.dtype} {list(array.shape)} in {order}")
        return self._image(array, kind, channels, 1)

    def _put(self, lamps: Sequence[Lamp]) -> int:
        if len(lamps) > MOST_LAMPS:
            raise ValueError(f"at most {MOST_LAMPS} lamps")
        for i, lamp in enumerate(lamps):
            to = _ffi.new("struct glint_lamp *", [lamp.theta, lamp.phi, lamp.power, lamp.rgb, lamp.axis, lamp.turn])
            self._lamps[i] = _lib.glint_engine_lamp_of(to, i + 1)
        return len(lamps)

    def _draw(self, n: int, image) -> Report:
        report = _ffi.new("struct glint_engine_report *")
        _check(_lib.glint_engine_draw(self._engine, self._lamps, n, image, report))
        lamps = [Lamp(l.theta_deg, l.phi_deg, l.power, tuple(l.rgb), tuple(l.axis), l.turn_deg)
                 for l in (known.lamp for known in self._lamps[0:n])]
        return Report(lamps, report.drawn_lights, report.ghosts, report.arena_bytes, report.scale)

    def lamp_at(self, x: float, y: float, ev: float = 16.0) -> Lamp:
        """A lamp at a pixel from the top left, EV stops over white."""
        at = _ffi.new("struct glint_lamp *")
        _lib.glint_view_to_angles(self._view, self._focal_mm, x, y, at)
        return Lamp(at.theta_deg, at.phi_deg, 2.0 ** ev)

    def place_of(self, lamp: Lamp) -> Tuple[float, float]:
        """The pixel that LAMP is seen at."""
        at = _ffi.new("struct glint_lamp *", {"theta_deg": lamp.theta, "phi_deg": lamp.phi})
        xy = _ffi.new("double[2]")
        _lib.glint_view_to_pixel(self._view, self._focal_mm, at, xy, xy + 1)
        return xy[0], xy[1]

    def overlay(self, array: np.ndarray, lamps: Optional[Sequence[Lamp]] = None, *, elapsed: float = 0.0,
                order: str = "RGB") -> Report:
        """Adds the flare to ARRAY, in place: uint8, sRGB. Without LAMPS they are found; of a video, which comes
        ELAPSED seconds after the picture before, they are followed. 0: a picture by itself, whose flare is drawn
        small first to see how bright it is."""
        image = self._codes(array, order)
        us = min(max(round(1e6 * elapsed), 0), 10 ** 9)
        if lamps is not None:
            _lib.glint_engine_elapsed(self._engine, us)
            return self._draw(self._put(lamps), image)
        return self._draw(_lib.glint_engine_find(self._engine, image, us, self._lamps, MOST_LAMPS), image)

    def render(self, lamps: Sequence[Lamp]) -> np.ndarray:
        """The flare of LAMPS alone, linear light as float32 [height, width, 3], 1 = display white."""
        light = np.zeros((self.height, self.width, 3), np.int32)
        self._draw(self._put(lamps), self._image(light, _lib.GLINT_LINEAR_Q20, 3, 4))
        return light.astype(np.float32) / np.float32(1 << 20)


def overlay(array: np.ndarray, lens: Union[str, bytes] = "nikon-zoom-short", lamps: Optional[Sequence[Lamp]] = None, *,
            lights_at: Sequence[Sequence[float]] = (), order: str = "RGB", exposure: Optional[float] = None,
            **options: Unpack[EngineOptions]) -> Report:
    """Adds the flare of the lamps in ARRAY to it, in place, as glint overlay does. LIGHTS_AT: lamps by pixel,
    (x, y) or (x, y, stops over white). OPTIONS are those of Engine."""
    if array.ndim < 2:
        raise ValueError("takes a picture, [height, width] or [height, width, channels]")
    engine = Engine(lens, array.shape[0], array.shape[1], exposure=exposure, **options)
    if lights_at:
        lamps = list(lamps or []) + [engine.lamp_at(*at) for at in lights_at]
    return engine.overlay(array, lamps, order=order)


def render(lens: Union[str, bytes], shape: Tuple[int, int], lamps: Sequence[Lamp], *, exposure: float = 0.0,
           **options: Unpack[EngineOptions]) -> np.ndarray:
    """The flare of LAMPS alone as linear light, float32 [height, width, 3]. SHAPE is (height, width)."""
    return Engine(lens, shape[0], shape[1], exposure=exposure, **options).render(lamps)


_shown(Engine.__init__, [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_DEFAULTS[name], annotation=hint)
                         for name, hint in get_type_hints(Options).items()])
_keywords = [p for p in inspect.signature(Engine).parameters.values() if p.kind is p.KEYWORD_ONLY]
_shown(overlay, _keywords)
_shown(render, _keywords)
