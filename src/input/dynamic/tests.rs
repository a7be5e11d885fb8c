//! Dynamic data in every dialect of a plain table, and what is refused.

mod hysitron;
mod pyvisco;
mod reptate;
mod rheocompass;
mod trios_csv;
mod trios_json;
mod trios_lims;
mod trios_text;

use super::*;
use crate::input::diagnostic::Styling;
use crate::material::dynamic::DynamicPoint;

/// Reads a text by itself.
pub(super) fn read_text(text: &str, kind: ModulusKind) -> Result<DynamicFile, String> {
    read_bytes(text.as_bytes(), kind)
}

/// Reads a file by itself; a refusal on one line.
pub(super) fn read_bytes(bytes: &[u8], kind: ModulusKind) -> Result<DynamicFile, String> {
    from_bytes("dma.csv", bytes, None, kind).map_err(|refused| {
        let text = refused.render(Styling::Plain);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    })
}

/// Temperature (K), angular frequency, storage and loss modulus of every point.
pub(super) fn points(file: &DynamicFile) -> Vec<[f64; 4]> {
    let row = |point: &DynamicPoint| {
        let temperature_k = point.temperature_k.unwrap_or(0.0);
        [
            temperature_k,
            point.angular_frequency_rad_per_s,
            point.storage_modulus_pa,
            point.loss_modulus_pa,
        ]
    };
    file.data.points().map(row).collect()
}

pub(super) fn assert_points(file: &DynamicFile, expected: &[[f64; 4]]) {
    let found = points(file);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        // Products of a few factors.
        assert!(
            (found - expected).abs() <= 1e-12 * expected.abs(),
            "{found} is not {expected}"
        );
    }
}

/// Whether a note of the file says this.
pub(super) fn assert_noted(file: &DynamicFile, words: &str) {
    let mut notes = file.notes.iter();
    assert!(notes.any(|note| note.contains(words)), "{:?}", file.notes);
}

pub(super) const TAU: f64 = std::f64::consts::TAU;

#[test]
fn one_table_in_every_dialect_is_the_same() {
    let expected = [
        [293.15, TAU, 2e6, 1e5],
        [293.15, 10.0 * TAU, 3e6, 2e5],
        [303.15, TAU, 1e6, 1.5e5],
        [303.15, 10.0 * TAU, 2e6, 2.5e5],
    ];
    for text in [
        "frequency_hz,storage_modulus_mpa,loss_modulus_mpa,temperature_c\n1,2,.1,20\n10,3,.2,20\n1,1,.15,30\n10,2,.25,30\n",
        "Frequency / Hz\tE' / MPa\tE'' / MPa\tT / °C\n1\t2\t0.1\t20\n10\t3\t0.2\t20\n1\t1\t0.15\t30\n10\t2\t0.25\t30\n",
        "f [Hz];E' [MPa];E'' [MPa];T [K]\n1;2;0,1;293,15\n10;3;0,2;293,15\n1;1;0,15;303,15\n10;2;0,25;303,15\n",
        "# f T Storage_modulus Loss_modulus\n# Hz C kPa kPa\n1 20 2000 100\n10 20 3000 200\n1 30 1000 150\n10 30 2000 250\n",
        "DMA of PMMA, 3 August\n\nT (K),f (Hz),E_stor (Pa),E_loss (Pa)\n293.15,1,2e6,1e5\n293.15,10,3e6,2e5\n303.15,1,1e6,1.5e5\n303.15,10,2e6,2.5e5\n,,,\n",
        "f/Hz,T/°C,E’/MPa,E’’/MPa\n10,30,2,0.25\n1,30,1,0.15\n10,20,3,.2\n1,20,2,.1\n",
        "f,T,Storage modulus,Tan(delta)\nHz,°C,MPa,\n1,20,2,0.05\n10,20,3,0.066666666666666666\n1,30,1,0.15\n10,30,2,0.125\n",
        "\"Frequency (Hz)\",\"Temp (°F)\",\"Storage Modulus (MPa)\",\"Loss Modulus (MPa)\"\n\"1\",\"68\",\"2\",\"0,1\"\n10,68,3,\"0,2\"\n1,86,1,\"0,15\"\n10,86,2,\"0,25\"\n",
    ] {
        for ends in ["\n", "\r\n", "\r"] {
            let text = text.replace('\n', ends);
            assert_points(
                &read_text(&text, ModulusKind::Longitudinal).unwrap(),
                &expected,
            );
        }
        let utf_16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let file = from_bytes(
            "a",
            &[b"\xff\xfe", utf_16.as_slice()].concat(),
            None,
            ModulusKind::Longitudinal,
        );
        assert_points(&file.unwrap(), &expected);
    }
}

#[test]
fn angular_frequencies_shear_errors_and_sets_are_read() {
    let text = "Set,omega_rad_s,G' (kPa),G'' (kPa),T_c,G' error [%],G'' error [kPa]\n7,1,2,1,20,1,0.5\n7,2,3,1,20.6,2,0.5\n9,1,1,1,21.2,1,\
                0.5\n9,2,2,1,21.8,1,0.5\n";
    let file = read_text(text, ModulusKind::Shear).unwrap();
    let isotherms = file.data.isotherms();
    assert_eq!(isotherms.len(), 2);
    assert_eq!(isotherms[0].points[1].errors_pa, Some((60.0, 500.0)));
    assert_eq!(isotherms[0].points[1].angular_frequency_rad_per_s, 2.0);
    assert!((isotherms[0].temperature_k.unwrap() - 293.45).abs() < 1e-9);
    // Angular frequencies need no unit, and this is said.
    let file = read_text(
        "omega G'(Pa) G''(Pa)\n1 2 1\n2 3 1\n3 4 1\n",
        ModulusKind::Shear,
    )
    .unwrap();
    assert_eq!(file.data.isotherms()[0].temperature_k, None);
    assert_noted(&file, "taken in rad/s");
}

#[test]
fn a_name_with_another_word_or_in_the_other_case_is_another_name() {
    for cell in [
        "Set temperature (°C)",
        "F (N)",
        "W",
        "t (s)",
        "T (mm)",
        "Static E' (MPa)",
    ] {
        assert_eq!(columns::recognise(cell), None, "{cell}");
    }
    let named = columns::recognise("Shear storage modulus G' (mPa)").unwrap();
    assert_eq!(named.kind, Some(ModulusKind::Shear));
    assert_eq!(named.unit.as_deref(), Some("mPa"));
}

#[test]
fn isotherms_are_found_from_scattered_temperatures() {
    let mut rows =
        String::from("frequency_hz,storage_modulus_mpa,loss_modulus_mpa,temperature_c\n");
    for (isotherm, temperature) in [-20.0, -10.0, 0.0, 3.0, 6.0, 26.0].into_iter().enumerate() {
        for k in 0..8 {
            let scatter = 0.4 * ((7 * k + isotherm) as f64).sin();
            rows += &format!("{},{},1,{}\n", k + 1, 10 + k, temperature + scatter);
        }
    }
    let file = read_text(&rows, ModulusKind::Longitudinal).unwrap();
    let counts: Vec<usize> = file
        .data
        .isotherms()
        .iter()
        .map(|isotherm| isotherm.points.len())
        .collect();
    assert_eq!(counts, [8; 6]);
    let ramp: String = (0..20)
        .map(|k| format!("1,{},1,{}\n", 100 - k, 20.0 + 0.4 * f64::from(k)))
        .collect();
    let ramp = format!("frequency_hz,storage_modulus_mpa,loss_modulus_mpa,temperature_c\n{ramp}");
    let refused = read_text(&ramp, ModulusKind::Longitudinal).unwrap_err();
    assert!(
        refused.contains("dma.csv:2:1") && refused.contains("from 20 °C to 27.6 °C without a gap"),
        "{refused}"
    );
}

#[test]
fn missing_numbers_are_passed_over_and_counted() {
    let text = "f [Hz],E' [MPa],E'' [MPa]\n1,2,1\n2,---,1\n3,3,\n4,NaN,1\n5,4,1\n6,5,1\n";
    let file = read_text(text, ModulusKind::Longitudinal).unwrap();
    assert_eq!(points(&file).len(), 3);
    assert!(
        file.notes
            .iter()
            .any(|note| note.starts_with("3 rows passed over")),
        "{:?}",
        file.notes
    );
}

/// Texts, and where and why they are refused.
const REFUSED: [(&str, &str, &str); 19] = [
    ("", "dma.csv", "no line names the columns"),
    (
        "1,2,3\n2,3,4\n",
        "dma.csv:1:1",
        "frequency_hz,storage_modulus_mpa",
    ),
    (
        "f,E' [MPa],E'' [MPa]\n1,2,3\n",
        "dma.csv:1:1",
        "write `f [Hz]` or `f [rad/s]`",
    ),
    (
        "f [Hz],E',E'' [MPa]\n1,2,3\n",
        "dma.csv:1:8",
        "the column of storage moduli has no unit",
    ),
    (
        "f [Hz],E' [psi],E'' [MPa]\n1,2,3\n",
        "dma.csv:1:8",
        "1 psi is 6894.7573 Pa",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa],T\n1,2,3,4\n",
        "dma.csv:1:27",
        "write its unit, such as `T [°C]`",
    ),
    (
        "f [Hz],E' [MPa]\n1,2\n",
        "dma.csv:1:1",
        "no column of loss moduli",
    ),
    (
        "f [Hz],G' [MPa],G'' [MPa]\n1,2,3\n",
        "dma.csv:1:8",
        "--modulus shear",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,x,3\n",
        "dma.csv:3:3",
        "not a number",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,-1,3\n",
        "dma.csv:3:3",
        "storage moduli must be positive",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,1,inf\n",
        "dma.csv:3:5",
        "not a finite number",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,1\n",
        "dma.csv:3:1",
        "a row of 2 cells in a table of 3 columns",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa],E'' [Pa]\n1,2,3,4\n",
        "dma.csv:1:27",
        "two columns of loss moduli",
    ),
    (
        "f [Hz];E' [MPa];E'' [MPa]\n1,5;2.5;3\n2;1;1\n",
        "dma.csv:2:1",
        "a decimal comma in a file with decimal points",
    ),
    (
        "f [Hz];E' [MPa];E'' [MPa]\n1;2,500;3\n2;1,250;1\n",
        "dma.csv:2:3",
        "may separate decimals or thousands",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa],T [C]\n1,2,3,-300\n",
        "dma.csv:2:1",
        "absolute temperature must be positive",
    ),
    (
        "f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,1,1\n",
        "dma.csv",
        "at least 3 points, and there are 2",
    ),
    (
        "t,E_relax,T,Set\ns,MPa,C,-\n1,2,3,0\n",
        "dma.csv:1:1",
        "--quantity relaxation",
    ),
    (
        "time_s,relaxation_modulus_pa\n1,2\n",
        "dma.csv:1:1",
        "--quantity relaxation",
    ),
];

#[test]
fn a_loss_that_noise_has_pushed_below_zero_takes_its_row_out_with_a_note() {
    let text = "f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,3,-0.1\n4,4,3\n8,5,2\n";
    let file = read_text(text, ModulusKind::Longitudinal).unwrap();
    assert_eq!(points(&file).len(), 3);
    let passed = "1 row passed over: a value is not positive";
    assert!(
        file.notes.iter().any(|note| note.contains(passed)),
        "{:?}",
        file.notes
    );
}

#[test]
fn what_is_ambiguous_or_wrong_is_refused_at_its_place() {
    for (text, place, reason) in REFUSED {
        let refused = read_text(text, ModulusKind::Longitudinal).unwrap_err();
        assert!(
            refused.contains(place) && refused.contains(reason),
            "{text}\n{refused}"
        );
    }
}

#[test]
fn the_data_set_of_pyvisco_is_read_whole() {
    let path =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/pyvisco-freq-user-raw.csv");
    let file = read(&[path], None, ModulusKind::Longitudinal).unwrap();
    assert_eq!(file.format, DynamicFormat::Pyvisco);
    let isotherms = file.data.isotherms();
    assert_eq!(isotherms.len(), 21);
    assert!(isotherms.iter().all(|isotherm| isotherm.points.len() == 10));
    assert_eq!(isotherms[0].points[0].storage_modulus_pa, 8_097_175_545.0);
    let text = file.notes.join("\n");
    assert!(
        text.contains("format pyvisco: the names `f,E_stor,E_loss,T,Set`"),
        "{text}"
    );
    // By their temperatures alone they are the same isotherms.
    let bytes = std::fs::read(
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/pyvisco-freq-user-raw.csv"),
    )
    .unwrap();
    let unnumbered = String::from_utf8(bytes).unwrap().replace("Set", "No");
    let clustered = read_text(&unnumbered, ModulusKind::Longitudinal).unwrap();
    assert_eq!(clustered.data, file.data);
}

#[test]
fn several_files_are_isotherms_of_one_specimen() {
    let file = |name: &str, celsius: f64| {
        let text = format!("f [Hz],E' [MPa],E'' [MPa],T [C]\n1,2,1,{celsius}\n2,3,1,{celsius}\n");
        (name.to_owned(), text.into_bytes())
    };
    let both = [file("a.csv", 20.0), file("b.csv", 40.0)];
    let read = from_files(&both, None, ModulusKind::Longitudinal).unwrap();
    assert_eq!(read.data.isotherms().len(), 2);
    assert!(
        read.notes
            .iter()
            .any(|note| note.starts_with("b.csv: format table")),
        "{:?}",
        read.notes
    );
    let without = both.map(|(name, bytes)| {
        (
            name,
            String::from_utf8(bytes)
                .unwrap()
                .replace("T [C]", "x")
                .into_bytes(),
        )
    });
    let refused = from_files(&without, None, ModulusKind::Longitudinal)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("none says its temperature"), "{refused}");
    assert!(from_files(&[], None, ModulusKind::Shear).is_err());
}

#[test]
fn shift_factors_are_read_as_pyvisco_and_as_this_program_write_them() {
    for text in [
        "\u{feff}T,log_aT\nC,-\n-50,12.5\n25,0\n",
        "temperature_c,log10_a_t,log10_a_t_error\n-50,12.5,0.1\n25,0,\n",
        "T [K];log_aT\n223,15;12,5\n298,15;0\n",
    ] {
        let pairs = shift_factors_from_bytes("shift.csv", text.as_bytes()).unwrap();
        assert_eq!(pairs.len(), 2, "{text}");
        assert!(
            (pairs[0].0 - 223.15).abs() < 1e-9 && pairs[0].1 == 12.5,
            "{pairs:?}"
        );
    }
    for (text, reason) in [
        ("T,aT\n1,2\n", "no table of shift factors"),
        ("T,log_aT\n1,2\n", "no unit"),
        ("temperature_c,log10_a_t\n1,x\n", "must be a number"),
        ("temperature_c,log10_a_t\n-300,1\n", "above -273.15"),
        ("temperature_c,log10_a_t\n", "no rows"),
        ("", "no table of shift factors"),
    ] {
        let refused = shift_factors_from_bytes("shift.csv", text.as_bytes())
            .unwrap_err()
            .to_string();
        assert!(refused.contains(reason), "{text}\n{refused}");
    }
}

#[test]
fn names_may_have_symbols_and_blanks_and_stand_below_other_lines() {
    let expected = [
        [298.15, 0.1 * TAU, 2e6, 1e5],
        [298.15, TAU, 3e6, 2e5],
        [298.15, 10.0 * TAU, 4e6, 3e5],
    ];
    let latin = "Frequenz f [Hz];Speichermodul E' [MPa];Verlustmodul E'' [MPa];Temperatur [°C]\r\n0,1;2;0,1;25\r\n1;3;0,2;25\r\n10;4;0,3;25\r\n";
    let latin: Vec<u8> = latin.chars().map(|c| c as u8).collect();
    assert_points(
        &read_bytes(&latin, ModulusKind::Longitudinal).unwrap(),
        &expected,
    );
    for text in [
        "# f [Hz]  E' [MPa]  E'' [MPa]  T [°C]\n0.1 2 0.1 25\n1 3 0.2 25\n10 4 0.3 25\n",
        "Curve:\n  film\n  Frequency   Storage modulus   Tan Delta   Temp.\n  [Hz]   [MPa]   []   [°C]\n  0.1  2  0.05  25\n  1  3  0.066666666666666666  25\n  10  4  0.075  25\n",
        "DMA;X\n\nTime min;Frequency Hz;Temperature °C;Storage Modulus MPa;Loss Modulus MPa\n1;0.1;25;2;0.1\n2;1;25;3;0.2\n3;10;25;4;0.3\n",
        "#FORMAT:\tX\n##Temp./°C\tTime/min\tf/Hz\tE'/MPa\tE''/MPa\n25\t1\t0.1\t2\t0.1\n25\t2\t1\t3\t0.2\n25\t3\t10\t4\t0.3\n",
        "f [Hz],E' [kPa],E'' [kPa],ϑ / °C\n0.1,\"2,000.0\",100,25\n1,\"3,000\",200,25\n10,4000,300,25\n",
        "f [Hz]\tE' [kPa]\tE'' [kPa]\tT [°C]\n0,1\t2.000,0\t100\t25\n1\t3.000\t200\t25\n10\t4000\t300\t25\n",
    ] {
        assert_points(
            &read_text(text, ModulusKind::Longitudinal).unwrap(),
            &expected,
        );
    }
    let text =
        "Frequency (Hz),E' [MPa],E'' [MPa],temperature_c\n1,2,0.1,25\n2,3,0.2,25\n3,4,0.3,25\n";
    let file = read_text(text, ModulusKind::Longitudinal).unwrap();
    let columns = "columns read: `Frequency (Hz)`, `E' [MPa]`, `E'' [MPa]`, `temperature_c` [°C]";
    assert!(file.notes.contains(&columns.to_owned()), "{:?}", file.notes);
    let refused = read_text(
        "log f [Hz],log E' [Pa],log E'' [Pa]\n-1,9,8\n0,9.1,8\n",
        ModulusKind::Longitudinal,
    )
    .unwrap_err();
    assert!(refused.contains("not their logarithms"), "{refused}");
    let complex = "Frequency [Hz],|G*| [Pa],phase angle [deg]\n1,1000,45\n2,1000,30\n3,1000,60\n";
    let file = read_text(complex, ModulusKind::Shear).unwrap();
    let point = file.data.isotherms()[0].points[1];
    assert!(
        (point.loss_modulus_pa - 500.0).abs() < 1e-9
            && (point.storage_modulus_pa - 750_000_f64.sqrt()).abs() < 1e-9,
        "{point:?}"
    );
}
