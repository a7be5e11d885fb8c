"""Dynamic mechanical analysis by contact: energy loss, hysteresis loops and equivalent moduli of viscoelastic half-spaces.

A material and an indenter, a load that oscillates about a mean, and out comes what every cycle dissipates:

    >>> import numpy as np
    >>> import contact_dma as cd
    >>> w = np.logspace(-3, -1, 5)
    >>> result = cd.sweep(cd.Material.library("pmma"), cd.Sphere(10e-3), mean=10.0, amplitude=5.0, angular_frequency=w,
    ...                   springs=32, steps=32)
    >>> result["energy_loss_j"].shape
    (5,)
    >>> len(result.peaks)
    1

Quantities are numbers in SI units, strings with units, ``"10 mm"``, or quantities of pint and astropy. A mistake raises ValueError with
the message of the program; what has no result, or a fit to be looked at, warns with `ContactDmaWarning`.
Numbers are those of the program ``contact-dma``, bit for bit, on any number of threads.
"""

from . import _calls
from ._calls import *
from ._contact_dma import BUILD as build
from ._contact_dma import COMMIT as commit
from ._contact_dma import VERSION as __version__
from ._result import ContactDmaWarning, Figure, Status, Table
from ._result import Warning as Warning  # Not in __all__: a star would put it in the place of Python's own.
from ._toml import Quantity
from .fits import MaterialFit
from .folders import read, schema
from .histories import Field, HistoryResult, SurfaceLine, SurfaceProfile
from .indenters import Indenter
from .materials import Material, Prony, library_materials
from .measurements import AnalysisResult, IdentifiedMaterial, MeasuredCycle, analyse
from .sweeps import Cycle, Cycles, Peak, PressureLine, PressureProfile, SweepResult

__all__ = [
    "AnalysisResult", "ContactDmaWarning", "Cycle", "Cycles", "Field", "Figure", "HistoryResult", "IdentifiedMaterial",
    "Indenter", "Material", "MaterialFit", "MeasuredCycle", "Peak", "PressureLine", "PressureProfile", "Prony", "Quantity",
    "Status", "SurfaceLine", "SurfaceProfile", "SweepResult", "Table", "__version__", "analyse", "build", "commit",
    "library_materials", "read", "schema",
]
# Functions of files, and a class for every shape of an indenter.
__all__ += _calls.__all__
