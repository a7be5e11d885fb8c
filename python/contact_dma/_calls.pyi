# Written by `contact-dma renew` from the keys of the input files.
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from os import PathLike
from typing import Any, Literal, TypeVar

from numpy.typing import ArrayLike, NDArray

from ._result import Progress
from ._toml import ForceCurveLike, Quantity, TableLike, TopographyLike
from .histories import HistoryResult
from .indenters import Indenter
from .materials import BulkModulus, Material
from .measurements import IdentifiedMaterial
from .sweeps import SweepResult

_Body = TypeVar("_Body", bound=Callable[..., Any])

KEYS: dict[str, dict[str, str]]

def body(name: str) -> Callable[[_Body], _Body]: ...
def sweep(
    material: Material | Mapping[str, Material] | str | PathLike[str],
    indenter: Indenter | Mapping[str, Indenter] | None = None,
    *,
    control: Literal["load", "pressure", "approach"] | None = "load",
    mean: Quantity | None = None,
    amplitude: Quantity | None = None,
    phase: Quantity | None = "0 rad",
    hold: Quantity | None = "0 s",
    pairs: bool | None = False,
    refine: bool | None = False,
    angular_frequency: Quantity | ArrayLike | Mapping[str, Any] | None = None,
    frequency: Quantity | ArrayLike | Mapping[str, Any] | None = None,
    steps: int | None = 200,
    method: Literal["direct", "march"] | None = "direct",
    tolerance: float | None = 0.0001,
    max_cycles: int | None = 1000,
    at_cycle: int | None = None,
    error_bars: bool | None = True,
    accuracy: float | None = None,
    engine: Literal["axisymmetric", "half-space"] | None = None,
    cells: int | None = 128,
    springs: int | None = 400,
    solver_tolerance: float | None = None,
    time_rule: Literal["linear", "constant"] | None = "linear",
    title: str | None = None,
    indenter_material: Material | str | None = None,
    layer: Mapping[str, Any] | None = None,
    adhesion: Quantity | Mapping[str, Any] | None = None,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
    axes: Mapping[str, Sequence[Quantity] | NDArray[Any]] | None = None,
    executor: Executor | None = None,
    shards: int | None = None,
) -> SweepResult:
    """
    Args:
        material: What the half-space is made of; several by their names, `{"dry": dry, "wet": wet}`, are an axis. Or a file, which says all, with `overrides`.
        indenter: What is pressed into it; several by their names likewise.
        control: What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The values below are then forces, stresses or lengths. "load", "pressure" or "approach".
        mean: Mean; the sum of mean and amplitude must be above zero. A force or a length or a stress or modulus.
        amplitude: Amplitude; a load is held at zero where the sine would be negative. A force or a length or a stress or modulus above zero.
        phase: Phase at the start of the oscillation. An angle.
        hold: Hold at the mean before the oscillation. A time not below zero.
        pairs: Whether the values of several axes of equal length are paired one by one, instead of combined. `true` or `false`.
        refine: Whether frequencies are added where the given ones do not resolve the loss curve. `true` or `false`.
        angular_frequency: Angular frequencies: a list or a range. Hz is accepted too. A list or a range, each an angular frequency above zero.
        frequency: Frequencies: a list or a range. rad/s is accepted too. A list or a range, each a frequency above zero.
        steps: Time steps per cycle; with `accuracy`, the minimum. An integer from 8 to 1000000.
        method: `direct`: the stabilised cycle is solved for; `march`: cycles are computed one after another, after the hold, until it is reached. "direct" or "march".
        tolerance: Largest distance to the stabilised cycle, for the memory and for the closure of the loop. A number of at least 1e-13 and below 1.
        max_cycles: Number of marched cycles after which a frequency counts as not converged. An integer from 1 to 100000000.
        at_cycle: With `method = "march"`: records this cycle after the hold, counted from 1, whether it is stabilised or not. An integer from 1 to 100000000.
        error_bars: Whether every case is also solved with coarser steps and nodes to estimate its errors. `true` or `false`.
        accuracy: Largest relative error of every loss: steps, and springs or cells, are chosen to reach it. Same as `--accuracy`. A sweep whose `steps` are left out begins at 100. A number of at least 1e-8 and below 1.
        engine: The contact engine; left out: the axisymmetric one if the indenter is a convex body of revolution. "axisymmetric" or "half-space".
        cells: Half-space engine: cells along the longer side of the domain; a height map has its own. An integer from 8 to 4096.
        springs: Axisymmetric engine: springs over the domain. An integer from 10 to 10000.
        solver_tolerance: Half-space engine: tolerance at one instant; left out: chosen so that its effect on the loss is a tenth of `cycle.tolerance`. A number of at least 1e-13 and below 1.
        time_rule: `linear`: second order, in two stages where one would oscillate; `constant`: the first-order rule of the base paper. "linear" or "constant".
        title: Title of figures, tables and the page. A string.
        indenter_material: What the indenter is made of, as a material or a name of the library; rigid where it is left out.
        layer: Keys of a layer of the material on a base in place of the half-space, `{"thickness": "0.5 mm", "base": "bonded"}`.
        adhesion: Work of adhesion (J/m^2), or the keys of `[adhesion]`, `{"work": 0.05, "range": "1 nm"}`.
        overrides: Changes of a file by their keys, `{"cycle.steps": 48}`; None removes a key.
        threads: How many; left out: as many as `CONTACT_DMA_THREADS`, `RAYON_NUM_THREADS` or `OMP_NUM_THREADS` say, and otherwise one per processor. Results do not depend on it.
        progress: A function of what is done and what there is in all, or a bar of tqdm.
        axes: Other axes than the frequency, such as `{"indenter.radius": ["5 mm", "10 mm"], "drive.amplitude": [1.0, 2.0]}`.
        executor: Who solves the cases in other processes: a pool of `concurrent.futures` or of joblib, mpi4py or Dask (`client.get_executor()`). `threads` are then those of one shard, one where it is left out. Results do not depend on it.
        shards: With `executor`: in how many parts the cases are handed out; left out: four for each worker.
    """
def simulate(
    material: Material | str | PathLike[str],
    indenter: Indenter | None = None,
    *,
    control: Literal["load", "pressure", "approach"] | None = "load",
    segments: Sequence[Mapping[str, Any]] | None = None,
    step: Quantity | None = None,
    profiles_at: ArrayLike | None = None,
    fields_at: ArrayLike | None = None,
    error_bars: bool | None = True,
    field_cells: int | None = 128,
    engine: Literal["axisymmetric", "half-space"] | None = None,
    cells: int | None = 128,
    springs: int | None = 400,
    solver_tolerance: float | None = None,
    time_rule: Literal["linear", "constant"] | None = "linear",
    title: str | None = None,
    indenter_material: Material | str | None = None,
    layer: Mapping[str, Any] | None = None,
    adhesion: Quantity | Mapping[str, Any] | None = None,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
    progress: Progress | Any | None = None,
) -> HistoryResult:
    """
    Args:
        material: What the half-space is made of. Or a file, which says all, with `overrides`.
        indenter: What is pressed into it.
        control: What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The values below are then forces, stresses or lengths. "load", "pressure" or "approach".
        segments: The segments, one after another; jumps between them are resolved exactly. An array of tables.
        step: Time step; left out: chosen from drive and material. A time above zero.
        profiles_at: Times at which profiles along a radius, or along the axes of the grid, are written. An array, each item a time.
        fields_at: Times at which whole fields are written, as `.npy` and as `.vti` for ParaView. An array, each item a time.
        error_bars: Whether the history is repeated with fewer steps and nodes to estimate the error of every row. `true` or `false`.
        field_cells: Axisymmetric engine: cells per side of these fields, which are revolved. An integer from 8 to 4096.
        engine: The contact engine; left out: the axisymmetric one if the indenter is a convex body of revolution. "axisymmetric" or "half-space".
        cells: Half-space engine: cells along the longer side of the domain; a height map has its own. An integer from 8 to 4096.
        springs: Axisymmetric engine: springs over the domain. An integer from 10 to 10000.
        solver_tolerance: Half-space engine: tolerance at one instant; left out: chosen so that its effect on the loss is a tenth of `cycle.tolerance`. A number of at least 1e-13 and below 1.
        time_rule: `linear`: second order, in two stages where one would oscillate; `constant`: the first-order rule of the base paper. "linear" or "constant".
        title: Title of figures, tables and the page. A string.
        indenter_material: What the indenter is made of, as a material or a name of the library; rigid where it is left out.
        layer: Keys of a layer of the material on a base in place of the half-space, `{"thickness": "0.5 mm", "base": "bonded"}`.
        adhesion: Work of adhesion (J/m^2), or the keys of `[adhesion]`, `{"work": 0.05, "range": "1 nm"}`.
        overrides: Changes of a file by their keys, `{"cycle.steps": 48}`; None removes a key.
        threads: How many; left out: as many as `CONTACT_DMA_THREADS`, `RAYON_NUM_THREADS` or `OMP_NUM_THREADS` say, and otherwise one per processor. Results do not depend on it.
        progress: A function of what is done and what there is in all, or a bar of tqdm.
    """
def identify(
    data: str | PathLike[str] | TableLike | ForceCurveLike | Sequence[ForceCurveLike] | None = None,
    indenter: Indenter | None = None,
    *,
    file: str | PathLike[str] | None = None,
    branches: Literal["auto"] | int | None = None,
    law: Sequence[Literal["auto", "power-law", "standard-solid", "fractional-zener", "fractional-maxwell", "kelvin-voigt", "kww", "series"]] | None = None,
    samples: int | None = 0,
    attraction: Literal["known", "work", "work-and-range"] | None = "known",
    approach_zero: Literal["first-contact", "unknown"] | None = None,
    curve: Sequence[str] | None = None,
    poisson_ratio: float | None = None,
    bulk_modulus: Quantity | Mapping[str, Any] | None = None,
    control: Literal["load", "pressure", "approach"] | None = "load",
    mean: Quantity | None = None,
    amplitude: Quantity | None = None,
    phase: Quantity | None = "0 rad",
    hold: Quantity | None = "0 s",
    segments: Sequence[Mapping[str, Any]] | None = None,
    steps: int | None = 64,
    method: Literal["direct", "march"] | None = "direct",
    tolerance: float | None = 1e-6,
    max_cycles: int | None = 200,
    at_cycle: int | None = None,
    error_bars: bool | None = False,
    accuracy: float | None = None,
    engine: Literal["axisymmetric", "half-space"] | None = None,
    cells: int | None = 32,
    springs: int | None = 64,
    solver_tolerance: float | None = None,
    time_rule: Literal["linear", "constant"] | None = "linear",
    title: str | None = None,
    indenter_material: Material | str | None = None,
    layer: Mapping[str, Any] | None = None,
    adhesion: Quantity | Mapping[str, Any] | None = None,
    overrides: Mapping[str, Any] | None = None,
    threads: int | None = None,
) -> IdentifiedMaterial:
    """
    Args:
        data: Measured cycles, with columns of a sweep and their errors where they are known: arrays by name, a data frame, a result of `analyse`, a CSV file, or a folder of `contact-dma analyse`. NaN or None where nothing was measured. Of a history `time_s` and `approach_m`, or `load_n` under a prescribed approach. Or a force curve of afmformats, or a list of several.
        indenter: What is pressed into it.
        file: An identification file in place of all others, with `overrides`.
        branches: Branches of the series: a number, or `auto` (the default): as many as the data require. "auto", or an integer from 1 to 6.
        law: Laws between which the data choose: `auto` for all, a name, or a list of names. Left out: all of force curves, and series of cycles and histories. An array, each item "auto", "power-law", "standard-solid", "fractional-zener", "fractional-maxwell", "kelvin-voigt", "kww" or "series".
        samples: How often the material is found again with the noise drawn anew. Of cycles, a history or a single curve these are replicas of the material, from which a sweep has a band about its loss. An integer from 0 to 1000.
        attraction: What of the attraction is sought beside the material, from the values in `[adhesion]` on. "known", "work" or "work-and-range".
        approach_zero: What smallest, largest and mean approaches of cycles are counted from; left out: unknown in a table of `analyse`, from first contact in any other. Where it is unknown they are not data, and the mean of a prescribed approach is that of `[drive]`. "first-contact" or "unknown".
        curve: A force curve: a table with `time_s`, `force_n` and `indentation_m`, or with `piezo_m` and `deflection_m` or `force_n`; several curves where it has a column `curve`. Or a list of such files. Where the contact begins is found. An array, each item a string.
        poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
        bulk_modulus: Bulk modulus in place of the Poisson ratio, which then increases as the body relaxes: constant in time, or a table with the series of a relaxing one. A stress or modulus above zero, or a table with a series.
        control: What is prescribed: the load; the mean pressure on a periodic surface (load over the area of one period); or the approach. The values below are then forces, stresses or lengths. "load", "pressure" or "approach".
        mean: Mean; the sum of mean and amplitude must be above zero. A force or a length or a stress or modulus.
        amplitude: Amplitude; a load is held at zero where the sine would be negative. A force or a length or a stress or modulus above zero.
        phase: Phase at the start of the oscillation. An angle.
        hold: Hold at the mean before the oscillation. A time not below zero.
        segments: The segments, one after another; jumps between them are resolved exactly. An array of tables.
        steps: Time steps per cycle; with `accuracy`, the minimum. An integer from 8 to 1000000.
        method: `direct`: the stabilised cycle is solved for; `march`: cycles are computed one after another, after the hold, until it is reached. "direct" or "march".
        tolerance: Largest distance to the stabilised cycle, for the memory and for the closure of the loop. A number of at least 1e-13 and below 1.
        max_cycles: Number of marched cycles after which a frequency counts as not converged. An integer from 1 to 100000000.
        at_cycle: With `method = "march"`: records this cycle after the hold, counted from 1, whether it is stabilised or not. An integer from 1 to 100000000.
        error_bars: Whether every case is also solved with coarser steps and nodes to estimate its errors. `true` or `false`.
        accuracy: Largest relative error of every loss: steps, and springs or cells, are chosen to reach it. Same as `--accuracy`. A sweep whose `steps` are left out begins at 100. A number of at least 1e-8 and below 1.
        engine: The contact engine; left out: the axisymmetric one if the indenter is a convex body of revolution. "axisymmetric" or "half-space".
        cells: Half-space engine: cells along the longer side of the domain; a height map has its own. An integer from 8 to 4096.
        springs: Axisymmetric engine: springs over the domain. An integer from 10 to 10000.
        solver_tolerance: Half-space engine: tolerance at one instant; left out: chosen so that its effect on the loss is a tenth of `cycle.tolerance`. A number of at least 1e-13 and below 1.
        time_rule: `linear`: second order, in two stages where one would oscillate; `constant`: the first-order rule of the base paper. "linear" or "constant".
        title: Title of figures, tables and the page. A string.
        indenter_material: What the indenter is made of, as a material or a name of the library; rigid where it is left out.
        layer: Keys of a layer of the material on a base in place of the half-space, `{"thickness": "0.5 mm", "base": "bonded"}`.
        adhesion: Work of adhesion (J/m^2), or the keys of `[adhesion]`, `{"work": 0.05, "range": "1 nm"}`.
        overrides: Changes of a file by their keys, `{"cycle.steps": 48}`; None removes a key.
        threads: How many; left out: as many as `CONTACT_DMA_THREADS`, `RAYON_NUM_THREADS` or `OMP_NUM_THREADS` say, and otherwise one per processor. Results do not depend on it.
    """

class MaterialForms:
    @classmethod
    def library(
        cls,
        name: str,
        *,
        poisson_ratio: float | None = None,
        temperature: Quantity | None = None,
    ) -> Material:
        """A material that comes with the program; `contact-dma material list` lists them.
        Args:
            name: A material that comes with the program; `contact-dma material list` lists them. A string.
            poisson_ratio: Poisson ratio in place of that of the library. A number above -1 and at most 0.5.
            temperature: Temperature of the body, for a material that is known at several temperatures. Left out: the reference temperature of the dynamic data, or the temperature of the only isotherm or of the library's data. A temperature above zero.
        """
    @classmethod
    def elastic(
        cls,
        modulus: Quantity,
        poisson_ratio: float,
        *,
        name: str | None = None,
    ) -> Material:
        """An elastic body, without losses.
        Args:
            modulus: Young's modulus. A stress or modulus above zero.
            poisson_ratio: Poisson ratio. A number above -1 and at most 0.5.
            name: Name of the material in tables and figures. A string.
        """
    @classmethod
    def relaxation(
        cls,
        equilibrium: Quantity,
        branches: Sequence[tuple[Quantity, Quantity] | Mapping[str, Any]],
        *,
        modulus: Literal["longitudinal", "shear"] = "longitudinal",
        replicas: Sequence[Mapping[str, Any]] | None = None,
        name: str | None = None,
        poisson_ratio: float | None = None,
        measured: ArrayLike | None = None,
        alternative: Sequence[Mapping[str, Any]] | None = None,
        bulk_modulus: BulkModulus | None = None,
    ) -> Material:
        """Generalised Maxwell model (Prony series of the relaxation modulus).
        Args:
            equilibrium: Equilibrium modulus; zero for a fluid. A stress or modulus not below zero.
            branches: The branches of the series: pairs of modulus (Pa) and relaxation time (s), of a creep series of compliance (1/Pa) and retardation time (s).
            modulus: Whether the moduli are Young's or shear moduli. "longitudinal" or "shear".
            replicas: Series fitted to random realisations of the noise in the data. The spread of the losses computed with them is the uncertainty of the loss due to the material. An array of tables.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            measured: First and last time of the test that the series was fitted to, if known. An array of two, each a time above zero.
            alternative: Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their `modulus` or `compliance`. What they change is reported as an uncertainty. An array of tables.
            bulk_modulus: Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of modulus and time.
        """
    @classmethod
    def creep(
        cls,
        instantaneous: Quantity,
        branches: Sequence[tuple[Quantity, Quantity] | Mapping[str, Any]],
        *,
        compliance: Literal["longitudinal", "shear"] = "longitudinal",
        viscosity: Quantity | None = None,
        name: str | None = None,
        poisson_ratio: float | None = None,
        measured: ArrayLike | None = None,
        alternative: Sequence[Mapping[str, Any]] | None = None,
        bulk_modulus: BulkModulus | None = None,
    ) -> Material:
        """Generalised Kelvin model (series of the creep compliance).
        Args:
            instantaneous: Instantaneous compliance. A compliance not below zero.
            branches: The branches of the series: pairs of modulus (Pa) and relaxation time (s), of a creep series of compliance (1/Pa) and retardation time (s).
            compliance: Whether the compliances are uniaxial or in shear. "longitudinal" or "shear".
            viscosity: Viscosity of a fluid, which adds t / viscosity to the compliance. A viscosity above zero.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            measured: First and last time of the test that the series was fitted to, if known. An array of two, each a time above zero.
            alternative: Other series that fit the same data: a relaxation series beside `relaxation`, a creep series beside `creep`, without their `modulus` or `compliance`. What they change is reported as an uncertainty. An array of tables.
            bulk_modulus: Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of modulus and time.
        """
    @classmethod
    def maxwell(
        cls,
        modulus: Quantity,
        time: Quantity,
        *,
        name: str | None = None,
        poisson_ratio: float | None = None,
        measured: ArrayLike | None = None,
        bulk_modulus: BulkModulus | None = None,
    ) -> Material:
        """Spring and dashpot in series: a fluid, for single histories only.
        Args:
            modulus: Shear modulus of the spring. A stress or modulus above zero.
            time: Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit. A time above zero.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            measured: First and last time of the test that the series was fitted to, if known. An array of two, each a time above zero.
            bulk_modulus: Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of modulus and time.
        """
    @classmethod
    def zener(
        cls,
        spring: Quantity,
        kelvin_spring: Quantity,
        time: Quantity,
        *,
        name: str | None = None,
        poisson_ratio: float | None = None,
        measured: ArrayLike | None = None,
        bulk_modulus: BulkModulus | None = None,
    ) -> Material:
        """Spring in series with a Kelvin unit: the standard linear solid.
        Args:
            spring: Shear modulus of the spring. A stress or modulus above zero.
            kelvin_spring: Shear modulus of the spring in the Kelvin unit. A stress or modulus above zero.
            time: Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit. A time above zero.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            measured: First and last time of the test that the series was fitted to, if known. An array of two, each a time above zero.
            bulk_modulus: Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of modulus and time.
        """
    @classmethod
    def kelvin_voigt(
        cls,
        spring: Quantity,
        time: Quantity,
        *,
        name: str | None = None,
        poisson_ratio: float,
        measured: ArrayLike | None = None,
    ) -> Material:
        """Spring and dashpot in parallel; without instantaneous compliance it cannot make contact, so only `material show` accepts it.
        Args:
            spring: Shear modulus of the spring. A stress or modulus above zero.
            time: Viscosity over modulus: relaxation time of a Maxwell body, retardation time of a Kelvin unit. A time above zero.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            measured: First and last time of the test that the series was fitted to, if known. An array of two, each a time above zero.
        """
    @classmethod
    def fractional(
        cls,
        model: Literal["springpot", "zener", "maxwell"],
        *,
        modulus: Literal["longitudinal", "shear"] = "longitudinal",
        stiffness: Quantity,
        time: Quantity,
        exponent: float,
        band: ArrayLike,
        accuracy: float = 0.001,
        equilibrium: Quantity | None = None,
        second_exponent: float | None = 0.0,
        name: str | None = None,
        poisson_ratio: float | None = None,
        bulk_modulus: BulkModulus | None = None,
    ) -> Material:
        """Springpot, fractional Zener or fractional Maxwell model, represented by a Prony series over a band.
        Args:
            model: `springpot`: E* = stiffness (i omega time)^exponent. `zener`: E* = equilibrium + stiffness (i omega time)^exponent / (1 + (i omega time)^exponent). `maxwell`: E* = stiffness (i omega time)^exponent / (1 + (i omega time)^(exponent - second_exponent)), two springpots in series. Springpot and Maxwell are fluids, for single histories only. "springpot", "zener" or "maxwell".
            modulus: Whether the stiffnesses are Young's or shear moduli. "longitudinal" or "shear".
            stiffness: Modulus of the fractional element. A stress or modulus above zero.
            time: Time of the fractional element. A time above zero.
            exponent: Exponent alpha of the fractional element, above 0 and at most 1 (springpot: below 1). A number above zero and at most 1.
            band: Lowest and highest angular frequency between which a series represents the model; outside, results are extrapolations. An array of two, each an angular frequency above zero.
            accuracy: Largest relative difference between series and model over the band: of E*, and of the loss modulus and the loss compliance on their own. A number from 1e-8 to 0.1.
            equilibrium: Equilibrium modulus; zero for a fluid. A stress or modulus not below zero.
            second_exponent: Exponent beta of the second springpot, below `exponent`; zero is a spring. A number not below zero and below 1.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            bulk_modulus: Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of modulus and time.
        """
    @classmethod
    def from_dynamic(
        cls,
        file: str | PathLike[str] | Sequence[str | PathLike[str]] | TableLike | None = None,
        *,
        angular_frequency: ArrayLike | None = None,
        frequency: ArrayLike | None = None,
        storage_modulus: ArrayLike | None = None,
        loss_modulus: ArrayLike | None = None,
        tan_delta: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        format: Literal["table", "pyvisco", "trios-text", "trios-lims", "trios-csv", "trios-json", "rheocompass", "reptate", "eplexor", "hysitron"] | None = None,
        modulus: Literal["longitudinal", "shear"] = "longitudinal",
        reference_temperature: Quantity | None = None,
        shift: Literal["free", "wlf", "arrhenius", "none"] | Mapping[str, Any] | None = None,
        vertical_shift: bool = False,
        branches: Literal["auto"] | int | None = None,
        replicas: int = 0,
        seed: int = 1,
        name: str | None = None,
        poisson_ratio: float,
        temperature_of_sweep: Quantity | None = None,
    ) -> Material:
        """Storage and loss modulus over frequency, measured at one or several temperatures, from which a master curve is made and a series fitted.
        Args:
            file: A file, or several; or a data frame or dictionary whose columns have the names of the arguments below (SI units), or names with units that a file may have, such as `"Frequency (Hz)"`.
            angular_frequency: In place of a file: angular frequencies (rad/s).
            frequency: Frequencies (Hz) in place of these.
            storage_modulus: Storage moduli (Pa).
            loss_modulus: Loss moduli (Pa).
            tan_delta: Loss factors in place of the loss moduli.
            temperature: Temperatures (K, or strings such as `"20 °C"`) of several isotherms.
            format: Format of the files; left out: detected from their content. "table", "pyvisco", "trios-text", "trios-lims", "trios-csv", "trios-json", "rheocompass", "reptate", "eplexor" or "hysitron".
            modulus: Whether the moduli are Young's or shear moduli. "longitudinal" or "shear".
            reference_temperature: Temperature of the master curve; left out: that of the middle isotherm. A temperature above zero.
            shift: How isotherms are shifted onto one curve: each individually (`free`, the default), by a law fitted to the data, not at all, or by factors from a file. "free", "wlf", "arrhenius" or "none", or a table with a file.
            vertical_shift: Whether they are also shifted vertically, along the moduli. `true` or `false`.
            branches: Branches of the series: a number, or `auto` (the default): as many as the data resolve. "auto", or an integer from 1 to 1000.
            replicas: Number of replicas of the material for the uncertainty of the results due to the noise of the data; 50 determine it to about 10 %. An integer from 0 to 1000.
            seed: Seed of the random numbers for the replicas. An integer from 0 to 9223372036854775807.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            temperature_of_sweep: Temperature of the body, for a material that is known at several temperatures. Left out: the reference temperature of the dynamic data, or the temperature of the only isotherm or of the library's data. A temperature above zero.
        """
    @classmethod
    def table(
        cls,
        time: ArrayLike,
        values: ArrayLike,
        *,
        quantity: Literal["creep", "relaxation"],
        modulus: Literal["longitudinal", "shear"] = "longitudinal",
        evaluation: Literal["fit", "direct"] = "fit",
        flow: bool | None = None,
        name: str | None = None,
        poisson_ratio: float | None = None,
        bulk_modulus: BulkModulus | None = None,
    ) -> Material:
        """Measured creep compliance or relaxation modulus.
        Args:
            time: Times (s), ascending.
            values: Compliances (1/Pa) or moduli (Pa) at these times.
            quantity: What the data are of. "creep" or "relaxation".
            modulus: Whether they are uniaxial or in shear. "longitudinal" or "shear".
            evaluation: `fit`: a series is fitted and its misfit reported with the results; `direct` (single histories only): the samples are used directly. "fit" or "direct".
            flow: Whether to fit a fluid; left out: as the data indicate, a solid if they do not decide. `true` or `false`.
            name: Name of the material in tables and figures. A string.
            poisson_ratio: Poisson ratio, constant in time. A number above -1 and at most 0.5.
            bulk_modulus: Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of modulus and time.
        """

class Sphere(Indenter):
    def __init__(
        self,
        radius: Quantity,
        *,
        offset: ArrayLike | None = None,
    ) -> None:
        """A sphere, as the paraboloid of its radius.
        Args:
            radius: Radius. A length above zero.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def radius(self) -> float: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class Cone(Indenter):
    def __init__(
        self,
        half_angle: Quantity,
        *,
        offset: ArrayLike | None = None,
    ) -> None:
        """A cone.
        Args:
            half_angle: Angle between axis and flank; 90 deg is a plane. An angle above zero.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def half_angle(self) -> float: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class FlatPunch(Indenter):
    def __init__(
        self,
        radius: Quantity,
        *,
        offset: ArrayLike | None = None,
    ) -> None:
        """A flat cylindrical punch.
        Args:
            radius: Radius. A length above zero.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def radius(self) -> float: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class Ellipsoid(Indenter):
    def __init__(
        self,
        radius_x: Quantity,
        radius_y: Quantity,
        *,
        offset: ArrayLike | None = None,
    ) -> None:
        """An elliptic paraboloid.
        Args:
            radius_x: Principal radius of curvature along x. A length above zero.
            radius_y: Principal radius of curvature along y. A length above zero.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def radius_x(self) -> float: ...
    @property
    def radius_y(self) -> float: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class PowerLaw(Indenter):
    def __init__(
        self,
        exponent: float,
        radius: Quantity,
        height: Quantity,
        *,
        offset: ArrayLike | None = None,
    ) -> None:
        """gap = height (r / radius)^exponent.
        Args:
            exponent: Exponent of the gap; 2 is a paraboloid. A number.
            radius: Radius at which the gap is `height`. A length above zero.
            height: Gap at `radius`. A length above zero.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def exponent(self) -> float: ...
    @property
    def radius(self) -> float: ...
    @property
    def height(self) -> float: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class Profile(Indenter):
    def __init__(
        self,
        file: str | PathLike[str] | TableLike | ArrayLike,
        gap: ArrayLike | None = None,
        *,
        sha256: str | None = None,
        offset: ArrayLike | None = None,
    ) -> None:
        """A profile of revolution: columns `r_m`, `gap_m`, from the axis outwards.
        Args:
            file: A file with these columns, or a table of them, such as a data frame; or radii (m) from the axis outwards.
            gap: Gaps (m) at these radii, where no file is given.
            sha256: SHA-256 of the data file, in hexadecimal, to make sure that it has not changed. A string.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def sha256(self) -> str | None: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class HeightMap(Indenter):
    def __init__(
        self,
        heights: ArrayLike | PathLike[str] | TopographyLike,
        spacing: ArrayLike | None = None,
        *,
        sha256: str | None = None,
        quantity: Literal["height", "gap"] = "height",
        height_unit: Literal["m", "mm", "um", "µm", "nm", "pm"] = "m",
        level: Literal["none", "mean", "plane"] = "none",
        edge: Literal["unknown", "rim", "periodic"] = "unknown",
        offset: ArrayLike | None = None,
    ) -> None:
        """A measured surface: a matrix (CSV or `.npy`), or columns `x_m`, `y_m`, `z_m`.
        Args:
            heights: An array of shape (cells along y, cells along x), first row at the smallest y; or a file (CSV, ``.npy``); or a topography of SurfaceTopography.
            spacing: Distance between points of a matrix, or one for x and one for y; not for files with columns `x_m`, `y_m`, `z_m`. An array of two, each a length above zero.
            sha256: SHA-256 of the data file, in hexadecimal, to make sure that it has not changed. A string.
            quantity: Whether values are heights, positive towards the half-space, or gaps. "height" or "gap".
            height_unit: Unit of the values of a matrix. "m", "mm", "um", "µm", "nm" or "pm".
            level: What is subtracted from the values first: nothing, their mean, or the best-fit plane. "none", "mean" or "plane".
            edge: What lies outside the map: unknown, so the contact must stay within; nothing (`rim`); or periodic repetitions of the map (`periodic`), under a prescribed load. "unknown", "rim" or "periodic".
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def spacing(self) -> tuple[float, ...] | None: ...
    @property
    def sha256(self) -> str | None: ...
    @property
    def quantity(self) -> str: ...
    @property
    def height_unit(self) -> str: ...
    @property
    def level(self) -> str: ...
    @property
    def edge(self) -> str: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class Asperities(Indenter):
    def __init__(
        self,
        asperities: Sequence[Sequence[Quantity] | Mapping[str, Any]],
        *,
        offset: ArrayLike | None = None,
    ) -> None:
        """Paraboloids side by side.
        Args:
            asperities: For each `(x, y, radius)` or `(x, y, radius, height)` (m), or a table of its keys `center`, `radius`, `height`.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def asperities(self) -> tuple[dict[str, Any], ...]: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

class Rough(Indenter):
    def __init__(
        self,
        cells: int,
        *,
        spacing: Quantity,
        hurst_exponent: float,
        rms_height: Quantity,
        cut_off_wavelength: Quantity,
        seed: int,
        edge: Literal["unknown", "rim", "periodic"] = "unknown",
        roll_off_wavelength: Quantity | None = None,
        sphere_radius: Quantity | None = None,
        offset: ArrayLike | None = None,
    ) -> None:
        """A random self-affine surface.
        Args:
            cells: Points per side. An integer from 8 to 4096.
            spacing: Distance between points. A length above zero.
            hurst_exponent: Hurst exponent of the self-affine spectrum. A number.
            rms_height: Root mean square height. A length above zero.
            cut_off_wavelength: Shortest wavelength. A length above zero.
            seed: Seed of the random phases: the same seed gives the same surface. An integer from 0 to 9223372036854775807.
            edge: What lies outside the map: unknown, so the contact must stay within; nothing (`rim`); or periodic repetitions of the map (`periodic`), under a prescribed load. "unknown", "rim" or "periodic".
            roll_off_wavelength: Wavelength above which the spectrum is flat; left out: no such limit. A length above zero.
            sphere_radius: Radius of a sphere under the roughness; left out: the surface is nominally flat. A length above zero.
            offset: Moves the indenter along x and y. An array of two, each a length.
        """
    @property
    def cells(self) -> int: ...
    @property
    def spacing(self) -> float: ...
    @property
    def hurst_exponent(self) -> float: ...
    @property
    def rms_height(self) -> float: ...
    @property
    def cut_off_wavelength(self) -> float: ...
    @property
    def seed(self) -> int: ...
    @property
    def edge(self) -> str: ...
    @property
    def roll_off_wavelength(self) -> float | None: ...
    @property
    def sphere_radius(self) -> float | None: ...
    @property
    def offset(self) -> tuple[float, ...] | None: ...

__all__ = ["sweep", "simulate", "identify", "Sphere", "Cone", "FlatPunch", "Ellipsoid", "PowerLaw", "Profile", "HeightMap", "Asperities", "Rough"]
