//! JSON of TRIOS: written after its schema and the examples of TA-Instruments/tadatakit.

use super::*;

/// An export of two steps at two temperatures, the derived one between them, in megapascals.
fn export(results: &str) -> String {
    format!(
        r#"{{"Schema": {{"Url": "https://software.tainstruments.com/schemas/TRIOSJSONExportSchema"}}, "Sample": {{"Name": "x"}},
        "Results": {results}}}"#
    )
}

const TABLE: &str = r#"{"ResultsSteps": [{"Id": "a", "Name": "Frequency sweep - 1"}, {"Id": "t", "Name": "TTS - master curve (20.0 C)"},
    {"Id": "b", "Name": "Frequency sweep - 2"}],
  "ColumnHeaders": {
    "Angular frequency_rad/s": {"DisplayName": "Angular frequency", "ValueType": "Number", "Unit": {"Name": "rad/s"}},
    "Loss modulus_MPa": {"DisplayName": "Loss modulus", "ValueType": "Number", "Unit": {"Name": "MPa"}},
    "Results Step Id": {"DisplayName": "Results Step Id", "ValueType": "Uuid"},
    "Status bits": {"DisplayName": "Status bits", "ValueType": "Text"},
    "Storage modulus_MPa": {"DisplayName": "Storage modulus", "ValueType": "Number", "Unit": {"Name": "MPa"}},
    "Tan(delta)": {"DisplayName": "Tan(delta)", "ValueType": "Number"},
    "Temperature_\u00b0C": {"DisplayName": "Temperature", "ValueType": "Number", "Unit": {"Name": "\u00b0C"}}},
  "Rows": [
    {"Results Step Id": "a", "Angular frequency_rad/s": 1, "Storage modulus_MPa": 10, "Loss modulus_MPa": 2.5, "Temperature_\u00b0C": 20, "Status bits": "0x1"},
    {"Results Step Id": "a", "Angular frequency_rad/s": 10, "Storage modulus_MPa": 20, "Loss modulus_MPa": 3, "Temperature_\u00b0C": 20},
    {"Results Step Id": "t", "Angular frequency_rad/s": 10, "Storage modulus_MPa": 99, "Loss modulus_MPa": 3, "Temperature_\u00b0C": 20},
    {"Results Step Id": "b", "Angular frequency_rad/s": 1, "Storage modulus_MPa": 5, "Loss modulus_MPa": 1, "Temperature_\u00b0C": 40},
    {"Results Step Id": "b", "Angular frequency_rad/s": 10, "Storage modulus_MPa": 8, "Loss modulus_MPa": 2, "Temperature_\u00b0C": 40}]}"#;

#[test]
fn steps_are_isotherms_and_what_trios_derived_is_no_data() {
    let expected = [
        [293.15, 1.0, 1e7, 2.5e6],
        [293.15, 10.0, 2e7, 3e6],
        [313.15, 1.0, 5e6, 1e6],
        [313.15, 10.0, 8e6, 2e6],
    ];
    for results in [format!(r#"{{"Processed": {TABLE}}}"#), TABLE.to_owned()] {
        let file = read_text(&export(&results), ModulusKind::Longitudinal).unwrap();
        assert_eq!(file.format, DynamicFormat::TriosJson);
        assert_points(&file, &expected);
    }
}

#[test]
fn json_that_is_no_such_export_is_refused() {
    let cut = export(TABLE);
    let refused = read_text(&cut[..900], ModulusKind::Shear).unwrap_err();
    assert!(
        refused.contains("cannot be read as a JSON export of TRIOS"),
        "{refused}"
    );
    let refused = read_text(r#"{"a": 1}"#, ModulusKind::Shear).unwrap_err();
    assert!(
        refused.contains("JSON and XML of other programs"),
        "{refused}"
    );
}
