//! Arguments of Python's functions that are no keys of files: materials and indenters as values, and data as arrays.

/// Arguments that are no keys, or tables whose form in Python is another: name, type, meaning.
pub(super) type Own = (&'static str, &'static str, &'static str);

pub(super) const SAMPLES: [Own; 2] = [
    ("time", "ArrayLike", "Times (s), ascending."),
    (
        "values",
        "ArrayLike",
        "Compliances (1/Pa) or moduli (Pa) at these times.",
    ),
];

pub(super) const DYNAMIC: [Own; 7] = [
    (
        "file",
        "str | PathLike[str] | Sequence[str | PathLike[str]] | TableLike | None",
        "A file, or several; or a data frame or dictionary whose columns have the names of the arguments below (SI units), or names with \
         units that a file may have, such as `\"Frequency (Hz)\"`.",
    ),
    (
        "angular_frequency",
        "ArrayLike | None",
        "In place of a file: angular frequencies (rad/s).",
    ),
    (
        "frequency",
        "ArrayLike | None",
        "Frequencies (Hz) in place of these.",
    ),
    (
        "storage_modulus",
        "ArrayLike | None",
        "Storage moduli (Pa).",
    ),
    ("loss_modulus", "ArrayLike | None", "Loss moduli (Pa)."),
    (
        "tan_delta",
        "ArrayLike | None",
        "Loss factors in place of the loss moduli.",
    ),
    (
        "temperature",
        "ArrayLike | None",
        "Temperatures (K, or strings such as `\"20 °C\"`) of several isotherms.",
    ),
];

pub(super) const PROFILE: [Own; 2] = [
    (
        "file",
        "str | PathLike[str] | TableLike | ArrayLike",
        "A file with these columns, or a table of them, such as a data frame; or radii (m) from the axis outwards.",
    ),
    (
        "gap",
        "ArrayLike | None",
        "Gaps (m) at these radii, where no file is given.",
    ),
];

pub(super) const HEIGHTS: [Own; 1] = [(
    "heights",
    "ArrayLike | PathLike[str] | TopographyLike",
    "An array of shape (cells along y, cells along x), first row at the smallest y; or a file (CSV, ``.npy``); or a topography of SurfaceTopography.",
)];

pub(super) const MATERIAL: Own = (
    "material",
    "Material | str | PathLike[str]",
    "What the half-space is made of. Or a file, which says all, with `overrides`.",
);
/// Of a sweep, which may have several.
pub(super) const MATERIALS: Own = (
    "material",
    "Material | Mapping[str, Material] | str | PathLike[str]",
    "What the half-space is made of; several by their names, `{\"dry\": dry, \"wet\": wet}`, are an axis. Or a file, which says all, \
     with `overrides`.",
);
pub(super) const INDENTERS: Own = (
    "indenter",
    "Indenter | Mapping[str, Indenter] | None",
    "What is pressed into it; several by their names likewise.",
);
pub(super) const INDENTER: Own = ("indenter", "Indenter | None", "What is pressed into it.");
pub(super) const DATA: Own = (
    "data",
    "str | PathLike[str] | TableLike | ForceCurveLike | Sequence[ForceCurveLike] | None",
    "Measured cycles, with columns of a sweep and their errors where they are known: arrays by name, a data frame, a result of `analyse`, a \
     CSV file, or a folder of `contact-dma analyse`. NaN or None where nothing was measured. Of a history `time_s` and `approach_m`, or \
     `load_n` under a prescribed approach. Or a force curve of afmformats, or a list of several.",
);
pub(super) const FILE: Own = (
    "file",
    "str | PathLike[str] | None",
    "An identification file in place of all others, with `overrides`.",
);
pub(super) const COMMON: [Own; 6] = [
    (
        "indenter_material",
        "Material | str | None",
        "What the indenter is made of, as a material or a name of the library; rigid where it is left out.",
    ),
    (
        "layer",
        "Mapping[str, Any] | None",
        "Keys of a layer of the material on a base in place of the half-space, `{\"thickness\": \"0.5 mm\", \"base\": \"bonded\"}`.",
    ),
    (
        "adhesion",
        "Quantity | Mapping[str, Any] | None",
        "Work of adhesion (J/m^2), or the keys of `[adhesion]`, `{\"work\": 0.05, \"range\": \"1 nm\"}`.",
    ),
    (
        "overrides",
        "Mapping[str, Any] | None",
        "Changes of a file by their keys, `{\"cycle.steps\": 48}`; None removes a key.",
    ),
    (
        "threads",
        "int | None",
        "How many; left out: as many as `CONTACT_DMA_THREADS`, `RAYON_NUM_THREADS` or `OMP_NUM_THREADS` say, and otherwise one per \
         processor. Results do not depend on it.",
    ),
    (
        "progress",
        "Progress | Any | None",
        "A function of what is done and what there is in all, or a bar of tqdm.",
    ),
];
/// Of a sweep alone.
pub(super) const OF_SWEEP: [Own; 3] = [
    (
        "axes",
        "Mapping[str, Sequence[Quantity] | NDArray[Any]] | None",
        "Other axes than the frequency, such as `{\"indenter.radius\": [\"5 mm\", \"10 mm\"], \"drive.amplitude\": [1.0, 2.0]}`.",
    ),
    (
        "executor",
        "Executor | None",
        "Who solves the cases in other processes: a pool of `concurrent.futures` or of joblib, mpi4py or Dask (`client.get_executor()`). \
         `threads` are then those of one shard, one where it is left out. Results do not depend on it.",
    ),
    (
        "shards",
        "int | None",
        "With `executor`: in how many parts the cases are handed out; left out: four for each worker.",
    ),
];

/// Arguments of materials and indenters that stand for tables, in the form that they have in Python: name, type, meaning.
pub(super) const AS_PYTHON: [Own; 3] = [
    (
        "asperities",
        "Sequence[Sequence[Quantity] | Mapping[str, Any]]",
        "For each `(x, y, radius)` or `(x, y, radius, height)` (m), or a table of its keys `center`, `radius`, `height`.",
    ),
    (
        "branches",
        "Sequence[tuple[Quantity, Quantity] | Mapping[str, Any]]",
        "The branches of the series: pairs of modulus (Pa) and relaxation time (s), of a creep series of compliance (1/Pa) and retardation \
         time (s).",
    ),
    (
        "bulk_modulus",
        "BulkModulus | None",
        "Bulk modulus (Pa) in place of the Poisson ratio: constant in time, or a pair of that at rest and a list of branches, pairs of \
         modulus and time.",
    ),
];
