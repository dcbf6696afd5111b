"""Real-time hair: load or grow a groom, simulate it, draw it.

    import strandline

    groom = strandline.grow("wavy", strand_count=500)
    with strandline.Simulation(groom=groom, motion="shake") as simulation:
        for frame in simulation.frames(48):
            print(frame.time, frame.points.mean(axis=(0, 1)))
        simulation.picture("three_quarter").save("wavy.png")

Arrays are float32, C-contiguous, in metres with y up; shapes are (strand, point, 3).
"""

from dataclasses import dataclass

from . import _native
from .body import Body
from .cache import Cache
from .errors import Error
from .film import Film
from .groom import Groom, grow, load
from .picture import Camera, Picture
from .scene import Look, Motion, Scene, Settings
from .simulation import Frame, Simulation, StepReport, Written
from .sweeps import sweep
from .window import view

__version__: str = _native.__version__

__all__ = [
    "Body",
    "Cache",
    "Camera",
    "Error",
    "Film",
    "Frame",
    "Gpu",
    "Groom",
    "Look",
    "Motion",
    "Picture",
    "Scene",
    "Settings",
    "Simulation",
    "StepReport",
    "Written",
    "gpus",
    "grow",
    "load",
    "sweep",
    "view",
]


@dataclass(frozen=True)
class Gpu:
    """A GPU of this machine; ``backend="gpu:INDEX"`` takes it."""

    index: int
    name: str
    interface: str
    software: bool


def gpus() -> list[Gpu]:
    """The GPUs of this machine, hardware before software."""
    return [Gpu(*gpu) for gpu in _native.gpus()]

