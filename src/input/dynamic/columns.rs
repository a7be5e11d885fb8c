//! What the columns of dynamic tests are called, in the languages of instruments, and what they hold.

use crate::input::data_file::column::{self, Column, Holds};
use crate::material::ModulusKind;
use crate::quantity::Dimension::{self, Angle, AngularFrequency, Stress};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Frequency,
    AngularFrequency,
    Storage,
    Loss,
    /// Magnitude of the complex modulus.
    Complex,
    TanDelta,
    PhaseAngle,
    Temperature,
    /// Number of the isotherm.
    Set,
    StorageError,
    LossError,
}

/// The columns of all roles.
#[rustfmt::skip]
static COLUMNS: [(Role, Column); 11] = [
    (Role::Frequency, Column::new(&[
            "f", "freq", "frequency", "test_frequency", "test_freq", "oscillation_frequency", "dynamic_frequency", "dyn_freq",
            "dynamic_freq", "ref_freq", "reference_frequency", "drive_frequency", "drive_freq", "excitation_frequency",
            "loading_frequency", "frequency_average", "frequenz", "messfrequenz", "prüffrequenz", "fréquence", "frecuencia",
            "frequenza", "frequência", "频率", "頻率", "周波数", "주파수",
        ], AngularFrequency, "frequencies")),
    (Role::AngularFrequency, Column {
        unit_may_be_absent: true,
        ..Column::new(&[
            "angular_frequency", "ang_frequency", "ang_freq", "angular_freq", "angfreq", "circular_frequency", "radian_frequency",
            "omega", "w", "ω", "kreisfrequenz", "winkelfrequenz", "pulsation", "fréquence_angulaire", "frecuencia_angular",
            "frequenza_angolare", "frequência_angular", "角频率", "角頻率", "角周波数", "각주파수",
        ], AngularFrequency, "angular frequencies")
    }),
    (Role::Storage, STORAGE),
    (Role::Loss, LOSS),
    (Role::Complex, modulus(&[
        "|e*|", "|g*|", "e*", "g*", "complex_modulus", "komplexer_modul", "module_complexe", "dynamic_modulus", "复数模量",
    ], "magnitudes of the complex modulus").by_unit()),
    (Role::TanDelta, Column::pure(&[
        "tan_delta", "tan(delta)", "tandelta", "tan_d", "tan(d)", "tan_δ", "tan(δ)", "tanδ", "loss_tangent", "loss_factor",
        "damping_factor", "verlustfaktor", "dämpfungsfaktor", "facteur_d'amortissement", "facteur_de_perte", "factor_de_pérdida",
        "factor_de_amortiguamiento", "损耗因子",
    ], "loss tangents")),
    (Role::PhaseAngle, Column::new(&[
        "phase_angle", "phase", "delta", "δ", "phasenwinkel", "phasenverschiebungswinkel", "angle_de_phase", "相位角",
    ], Angle, "phase angles").by_unit()),
    (Role::Temperature, TEMPERATURE),
    (Role::Set, Column::pure(&["set", "set_number", "isotherm", "isotherm_number", "set_no", "sweep_number"], "isotherms")),
    (Role::StorageError, errors(STORAGE, "errors of the storage modulus")),
    (Role::LossError, errors(LOSS, "errors of the loss modulus")),
];

#[rustfmt::skip]
const STORAGE: Column = modulus(&[
    "e'", "g'", "m'", "e_stor", "g_stor", "e_storage", "g_storage", "estor", "gstor", "e_prime", "g_prime", "ep", "gp", "e_real",
    "g_real", "storage_modulus", "storage_mod", "modulus_storage", "speichermodul", "module_de_conservation", "module_de_stockage",
    "module_élastique", "módulo_de_almacenamiento", "modulo_conservativo", "módulo_de_armazenamento", "储能模量", "儲能模數",
    "貯蔵弾性率", "저장_탄성률", "저장탄성률",
], "storage moduli");
#[rustfmt::skip]
const LOSS: Column = modulus(&[
    "e''", "g''", "m''", "e_loss", "g_loss", "eloss", "gloss", "e_double_prime", "g_double_prime", "epp", "gpp", "e_imag",
    "g_imag", "loss_modulus", "loss_mod", "modulus_loss", "verlustmodul", "module_de_perte", "module_visqueux",
    "módulo_de_pérdida", "modulo_dissipativo", "módulo_de_perda", "损耗模量", "損耗模數", "損失弾性率", "손실_탄성률",
    "손실탄성률",
], "loss moduli");
#[rustfmt::skip]
pub(super) const TEMPERATURE: Column = Column::new(&[
    "temperature", "temp", "t", "sample_temperature", "sample_temp", "temperature_sample", "temperatur", "probentemperatur",
    "ts", "ϑ", "θ", "température", "temperatura", "温度", "溫度", "온도",
], Dimension::Temperature, "temperatures").by_unit();

const fn modulus(names: &'static [&'static str], what: &'static str) -> Column {
    Column {
        besides: &[&OF_SHEAR, &OF_TENSION],
        ..Column::new(names, Stress, what)
    }
}

const fn errors(column: Column, what: &'static str) -> Column {
    column.of_errors(Holds::ErrorsOrShares, what).by_unit()
}

/// Words that say that a modulus is one of shear, and that it is one of tension.
const OF_SHEAR: [&str; 2] = ["shear", "schub"];
#[rustfmt::skip]
const OF_TENSION: [&str; 7] = ["tensile", "young's", "youngs", "longitudinal", "axial", "elongational", "bending"];

/// A column that was recognised.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    pub(super) role: Role,
    /// Where its name says which modulus it is.
    pub(super) kind: Option<ModulusKind>,
    /// Where the header gives its unit.
    pub(super) unit: Option<String>,
}

impl Role {
    pub(super) fn column(self) -> &'static Column {
        &COLUMNS[self as usize].1
    }
}

/// What a cell of a header names.
pub(super) fn recognise(cell: &str) -> Option<Named> {
    let ways = column::ways(cell);
    let found = COLUMNS
        .iter()
        .filter_map(|(role, column)| Some((*role, column.named(&ways)?)));
    let (role, named) = found.min_by_key(|(_, named)| named.rank)?;
    let is_modulus = role.column().dimension == Some(Stress);
    Some(Named {
        role,
        kind: kind_of(&named.name).filter(|_| is_modulus),
        unit: named.unit,
    })
}

/// Which modulus a name without words of errors speaks of: by a word, or by the letter of `g'`, `|e*|`, `e_stor`, `gpp`.
fn kind_of(name: &str) -> Option<ModulusKind> {
    name.split('_').find_map(|word| {
        let letter = word.trim_start_matches('|').chars().next()?;
        match letter {
            _ if OF_SHEAR.contains(&word) => Some(ModulusKind::Shear),
            _ if OF_TENSION.contains(&word) => Some(ModulusKind::Longitudinal),
            'g' => Some(ModulusKind::Shear),
            'e' => Some(ModulusKind::Longitudinal),
            _ => None,
        }
    })
}
