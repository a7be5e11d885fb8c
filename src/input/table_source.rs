//! Where the values of a table in an input file stand: in a data file, or in the input file itself.

/// One of the two.
#[derive(Debug, Clone, Copy)]
pub(super) enum TableSource {
    File,
    WrittenOut,
}

/// The keys that tell them apart.
pub(super) const TABLE_SOURCES: [(&str, TableSource); 2] = [
    ("file", TableSource::File),
    ("times", TableSource::WrittenOut),
];
